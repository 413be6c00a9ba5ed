// Geometric checks of cut outlines.
#include "outline_checks.h"

#include <fmt/format.h>

namespace outline_checks {
namespace {

using kerf::CornerOutcome;
using kerf::CornerReport;
using kerf::Outline;

std::string wrong_with_smoothing(const CheckedSegment& in, const CheckedSegment& out,
                                 const CheckedSegment& arc) {
  const double turn = angle_between(in.tangent(in.to), out.tangent(out.from));
  if (std::abs(angle_between(in.tangent(arc.from), arc.tangent(arc.from))) > kTangent)
    return "not tangent to the arriving";
  if (std::abs(angle_between(out.tangent(arc.to), arc.tangent(arc.to))) > kTangent)
    return "not tangent to the leaving";
  if (std::numbers::pi - std::abs(turn) > kFlat && arc.sense * turn < 0.0) return "turns to the wrong side";
  return "";
}

std::string wrong_with_enlarging(const CheckedSegment& in, const Outline& made, const CheckedSegment& arc,
                                 double r) {
  const Point2 corner = in.to;
  if (std::abs(distance(arc.centre, corner) - r) > kSlack * std::max(1.0, r))
    return "the bit does not reach the corner";
  const double at = arc.along(corner);
  if (at < -kSlack || at > arc.length + kSlack) return "the corner is not on the arc";
  Point2 from = made.start;
  for (const kerf::Segment& s : made.segments) {
    const CheckedSegment segment(from, s.to, s.via);
    if (!segment.arc() && std::abs(cross(segment.direction, unit(arc.centre - corner))) > kSlack)
      return "a channel's wall is not parallel to its centre line";
    from = s.to;
  }
  return "";
}

/// The outline of a replaced corner alone.
Outline part_of(const Outline& result, const CornerReport& report) {
  Outline part;
  part.start = result.point(report.first);
  for (std::uint32_t i = report.first; i + 1 < report.first + report.count; ++i)
    part.segments.push_back(result.segments[i]);
  return part;
}

std::string wrong_with_ends(const Outline& outline, const Outline& made) {
  if (outline.closed() != made.closed()) return "closed became open, or open closed";
  if (!outline.closed() && !(made.start == outline.start)) return "the open start was moved";
  if (!outline.closed() && !(made.segments.back().to == outline.segments.back().to))
    return "the open end was moved";
  for (std::size_t i = 0; i < made.segments.size(); ++i)
    if (distance(made.point(i), made.point(i + 1)) < 1e-9)
      return fmt::format("element {} has no length", i + 1);
  return "";
}

}  // namespace

std::string wrong_with_corner(const CheckedSegment& in, const CheckedSegment& out, double request,
                              const Outline& made) {
  const double r = std::abs(request), slack = kSlack * std::max(1.0, r);
  const Point2 first = made.start, last = made.segments.back().to;
  if (in.off(first) > slack) return "starts beside the arriving segment";
  if (out.off(last) > slack) return "ends beside the leaving segment";
  if (in.along(first) < -slack)
    return fmt::format("starts {:g} before the arriving segment", -in.along(first));
  if (in.along(first) > in.length + slack) return "starts beyond the corner";
  if (out.along(last) > out.length + slack)
    return fmt::format("ends {:g} after the leaving segment", out.along(last));
  if (out.along(last) < -slack) return "ends before the corner";
  std::vector<CheckedSegment> arcs;
  Point2 from = first;
  for (const kerf::Segment& s : made.segments) {
    const CheckedSegment segment(from, s.to, s.via);
    if (segment.arc()) arcs.push_back(segment);
    from = s.to;
  }
  if (arcs.size() != 1) return fmt::format("has {} arcs", arcs.size());
  // Rounded coordinates move the arc's midpoint relative to its chord, which changes its radius.
  const double rounding =
      8e-16 * std::max({std::abs(first.x), std::abs(first.y), std::abs(last.x), std::abs(last.y)});
  const double rise = r * (1.0 - std::cos(0.5 * arcs[0].sweep));
  if (std::abs(arcs[0].radius - r) > (1e-6 + rounding / rise) * r + 1e-9)
    return fmt::format("has radius {:.9g}, not {:.9g}", arcs[0].radius, r);
  return request > 0.0 ? wrong_with_smoothing(in, out, arcs[0]) : wrong_with_enlarging(in, made, arcs[0], r);
}

std::string wrong_with_cut(const Outline& outline, const kerf::CornerRequests& requests,
                           const kerf::CutOutline& cut, bool even) {
  const Outline& result = cut.outline;
  if (std::string wrong = wrong_with_ends(outline, result); !wrong.empty()) return wrong;
  const std::size_t n = outline.segments.size();
  std::vector<const CornerReport*> of(n + 1, nullptr);
  for (const CornerReport& report : cut.corners) of[report.element] = &report;
  const auto start_of = [&](std::size_t i) {
    return of[i] && of[i]->count ? part_of(result, *of[i]).start : outline.point(i);
  };
  const auto end_of = [&](std::size_t i) {
    return of[i] && of[i]->count ? part_of(result, *of[i]).segments.back().to : outline.point(i);
  };
  const auto segment_at = [&](std::size_t i) {
    return CheckedSegment(outline.point(i), outline.point(i + 1), outline.segments[i].via);
  };
  // The rest of segment i between the corners at its ends must run forward.
  for (std::size_t i = 0; i < n; ++i) {
    const CheckedSegment whole = segment_at(i);
    const std::size_t next = i + 1 == n && outline.closed() ? 0 : i + 1;
    const double run = whole.along(next == n ? outline.point(n) : start_of(next)) - whole.along(end_of(i));
    if (run < -kSlack) return fmt::format("segment {} runs {:g} backwards", i + 1, -run);
  }
  for (const CornerReport& report : cut.corners) {
    const std::size_t i = report.element;
    const double request = requests[i].mm();
    const CheckedSegment in = segment_at(i == 0 ? n - 1 : i - 1), out = segment_at(i);
    std::string wrong;
    if (report.outcome != CornerOutcome::sharp) {
      wrong = wrong_with_corner(in, out, request, part_of(result, report));
    } else if (request > 0.0 && !even) {
      // Its segments are shortened by the corner before it, and that of the last one also by corner 0.
      const auto rest = [](const CheckedSegment& p, Point2 a, Point2 b) {
        CheckedSegment part = p;
        const double from = p.along(a), to = p.along(b);
        part.length = std::max(0.0, to - from);
        part.from = a;
        part.to = b;
        if (p.arc()) part.sweep = part.length / p.radius;
        return part;
      };
      const CheckedSegment seen_in = i == 0 ? in : rest(in, end_of(i - 1), in.to);
      const CheckedSegment seen_out = i + 1 == n && outline.closed() ? rest(out, out.from, start_of(0)) : out;
      if (can_be_smoothed(seen_in, seen_out, request)) wrong = "stays sharp though it can be smoothed";
    }
    if (!wrong.empty()) return fmt::format("corner {} (request {:g}): {}", i, request, wrong);
  }
  return "";
}

}  // namespace outline_checks
