// The corners of a whole outline: their order, what each leaves of its segments, and the messages.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "corner.h"
#include "outline_check.h"

#include "kerf/base/limits.h"
#include "kerf/geom/outline.h"

namespace kerf {
namespace {

using namespace outline_detail;

Code code_of(SharpReason reason) {
  switch (reason) {
    case SharpReason::straight: return codes::corner_straight;
    case SharpReason::folded: return codes::corner_folded;
    case SharpReason::no_neighbour: return codes::corner_no_neighbour;
    case SharpReason::tiny: return codes::corner_radius_tiny;
    case SharpReason::shared: return codes::corner_shared;
    default: return codes::corner_too_large;
  }
}

/// Cuts the corners of one outline. Corner i joins segment i - 1 and segment i; of a closed outline corner 0
/// joins the last segment and the first.
class CornerPass {
 public:
  /// `requests`: one for each element.
  CornerPass(const Outline& outline, const CornerRequests& requests, const CornerOptions& options,
             Diagnostics& diagnostics)
      : outline_(outline),
        requests_(requests),
        options_(options),
        diagnostics_(diagnostics),
        weld_(options.tolerance.weld.mm()),
        closed_(outline.closed()) {
    limits_ = {weld_, std::sin(options.straight.rad())};
  }
  CutOutline run();

 private:
  double request(std::size_t corner) const { return requests_[corner].mm(); }
  Carrier carrier(std::size_t segment) const {
    return make_carrier(outline_.point(segment), outline_.segments[segment], weld_);
  }
  void reserve();
  void divide_evenly();
  void start(const Carrier& first);
  void cut(std::size_t corner, const Carrier& before, const Carrier& after);
  std::size_t copy_lines(std::size_t corner);
  std::size_t smooth_lines(std::size_t corner);
  void finish(const Carrier& last);
  void note_straight_arc(std::size_t segment);
  void report_cut(std::size_t corner, int count);
  void report_sharp(std::size_t corner, SharpReason reason, const Side& in, const Side& out);
  void warn(const CornerReport& report);
  void follow(const Carrier& carrier, Point2 to);
  void append(const Replacement& made, Point2 corner);
  std::uint32_t elements() const { return static_cast<std::uint32_t>(result_.outline.elements()); }

  const Outline& outline_;
  const CornerRequests& requests_;
  const CornerOptions& options_;
  Diagnostics& diagnostics_;
  double weld_;
  CornerLimits limits_;
  std::vector<bool> crowded_;    // EdgeSharing::even: corners that are not to be cut
  std::vector<Room> rooms_;      // and what is available to each
  Point2 here_;                  // end of the result so far
  std::size_t warned_[16] = {};  // by reason
  std::size_t straight_arcs_ = 0;
  bool closed_;
  CutOutline result_;
};

void CornerPass::reserve() {
  std::size_t requests = request(0) != 0.0 ? 1 : 0, more = 3 * requests;
  for (std::size_t i = 1; i < requests_.size(); ++i) {
    if (request(i) == 0.0) continue;
    ++requests;
    more += request(i) < 0.0 ? 3 : 1;
  }
  result_.outline.segments.reserve(outline_.segments.size() + more + 1);
  result_.corners.reserve(requests);
}

void CornerPass::note_straight_arc(std::size_t segment) {
  const bool in_words = straight_arcs_++ < limits::kMaxMessagesPerCode;
  diagnostics_.warning(
      codes::outline_arc_straight, options_.where,
      in_words ? fmt::format("the arc to {}.{} is straight: a line is cut", options_.name, segment + 1)
               : std::string());
}

/// Finds the corners that need more than half of an edge whose other corner leaves less than that.
void CornerPass::divide_evenly() {
  const std::size_t n = outline_.segments.size();
  crowded_.assign(n + 1, false);
  rooms_.assign(n + 1, {});
  struct Want {
    double before = 0.0, after = 0.0;  // along the arriving and the leaving segment
  };
  std::vector<Want> wants(n + 1);
  for (std::size_t i = closed_ ? 0 : 1; i < n; ++i) {
    if (request(i) == 0.0) continue;
    const Carrier before = carrier(i == 0 ? n - 1 : i - 1), after = carrier(i);
    Side in = arriving(before, before.from), out = leaving(after, after.to);
    const Replacement made = solve_corner(in, out, request(i), limits_);
    if (made.reason != SharpReason::none) continue;
    wants[i] = {taken(in, made.first), taken(out, made.pieces[made.count - 1].to)};
  }
  constexpr double kFit = 1e-9;  // as for the fit of one corner
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = i + 1 == n && closed_ ? 0 : i + 1;
    const double a = wants[i].after, b = wants[next].before;
    if (a <= 0.0 && b <= 0.0) continue;
    const Carrier c = carrier(i);
    const double whole = c.is_arc() ? taken(leaving(c, c.to), c.to - c.from) : c.length;
    rooms_[i].out = std::max(0.5 * whole, whole - b);
    rooms_[next].in = std::max(0.5 * whole, whole - a);
    if (a <= 0.0 || b <= 0.0 || a + b <= whole + weld_ + kFit * whole) continue;
    if (a > 0.5 * whole) crowded_[i] = true;
    if (b > 0.5 * whole) crowded_[next] = true;
  }
}

/// Appends what is left of a segment up to `to`; nothing where that is no length.
void CornerPass::follow(const Carrier& carrier, Point2 to) {
  const Point2 rest = to - here_;
  if (dot(rest, rest) <= weld_ * weld_) return;
  Segment segment{to, std::nullopt};
  if (carrier.is_arc())  // relative to the segment's start, where its centre is accurate
    segment.via = carrier.from + arc_midpoint(here_ - carrier.from, to - carrier.from, carrier.centre,
                                              carrier.radius, carrier.turn);
  result_.outline.segments.push_back(segment);
  here_ = to;
}

void CornerPass::append(const Replacement& made, Point2 corner) {
  for (int i = 0; i < made.count; ++i) {
    const Segment& piece = made.pieces[i];
    here_ = corner + piece.to;
    Segment& segment = result_.outline.segments.emplace_back();
    segment.to = here_;
    if (piece.via) segment.via = corner + *piece.via;
  }
}

void CornerPass::start(const Carrier& first) {
  here_ = result_.outline.start = outline_.start;
  if (!closed_ || request(0) == 0.0) return;
  const Carrier last = carrier(outline_.segments.size() - 1);
  Side in = arriving(last, last.from), out = leaving(first, first.to);
  Replacement made = solve_corner(in, out, request(0), limits_);
  if (!crowded_.empty() && crowded_[0]) made.reason = SharpReason::shared;
  if (made.reason != SharpReason::none) return report_sharp(0, made.reason, in, out);
  here_ = result_.outline.start = outline_.start + made.first;
  append(made, outline_.start);
  report_cut(0, made.count);
}

void CornerPass::cut(std::size_t corner, const Carrier& before, const Carrier& after) {
  if (request(corner) == 0.0) return follow(before, before.to);
  const bool meets_start = corner + 1 == outline_.segments.size() && closed_;
  Side in = arriving(before, here_), out = leaving(after, meets_start ? result_.outline.start : after.to);
  Replacement made = solve_corner(in, out, request(corner), limits_);
  if (!crowded_.empty() && crowded_[corner]) made.reason = SharpReason::shared;
  if (made.reason != SharpReason::none) {
    follow(before, before.to);
    return report_sharp(corner, made.reason, in, out);
  }
  follow(before, before.to + made.first);
  append(made, before.to);
  report_cut(corner, made.count);
}

/// Copies lines up to the next corner with a request or the next arc; returns the corner that ends them.
std::size_t CornerPass::copy_lines(std::size_t corner) {
  const std::vector<Segment>& from = outline_.segments;
  for (; corner < from.size(); ++corner) {
    const Segment& line = from[corner - 1];
    if (line.via || request(corner) != 0.0) break;
    const Point2 rest = line.to - here_;
    if (dot(rest, rest) <= weld_ * weld_) continue;
    result_.outline.segments.push_back(line);
    here_ = line.to;
  }
  return corner;
}

/// A faster computation for the most common corners: smooths corners of two lines from `corner` on, until one
/// is of another kind, does not fit or fits closely. Returns that one.
std::size_t CornerPass::smooth_lines(std::size_t corner) {
  const std::vector<Segment>& from = outline_.segments;
  std::vector<Segment>& made = result_.outline.segments;
  const std::size_t end =
      from.size() - (closed_ ? 1 : 0);  // the last corner of a closed outline meets the first
  if (!crowded_.empty() || corner >= end || from[corner - 1].via || from[corner].via) return corner;
  if (request(corner) <= 0.0) return corner;
  Point2 at = from[corner - 1].to, u = at - outline_.point(corner - 1);
  double length = norm(u);
  if (!(length > weld_)) return corner;
  u = (1.0 / length) * u;
  for (; corner < end; ++corner) {
    const double r = request(corner);
    if (from[corner].via || r <= weld_) break;
    const Point2 next = from[corner].to;
    Point2 v = next - at;
    length = norm(v);
    if (!(length > weld_)) break;
    v = (1.0 / length) * v;
    const double sine = std::abs(cross(u, v)), cosine = dot(u, v);
    if (sine < limits_.straight) break;
    const double reach = r * sine / (1.0 + cosine);  // from the corner to where the arc touches
    if (reach > dot(at - here_, u) - weld_ || reach > length - weld_) break;
    // The midpoint of the arc lies between that of its chord and the corner.
    const double fraction = 0.5 * reach / (1.0 + std::sqrt(0.5 * (1.0 + cosine)));
    here_ = at + reach * v;
    made.push_back({at - reach * u, std::nullopt});
    made.push_back({here_, at + fraction * (v - u)});
    report_cut(corner, 1);
    at = next;
    u = v;
  }
  return corner;
}

void CornerPass::finish(const Carrier& last) {
  std::vector<Segment>& made = result_.outline.segments;
  const Point2 end = closed_ ? result_.outline.start : outline_.segments.back().to;
  const std::size_t before = made.size();
  follow(last, end);
  // Nothing was left to add: the last segment ends within the tolerance of the end, and is moved to it.
  if (made.size() == before && !made.empty()) made.back().to = end;
}

void CornerPass::report_cut(std::size_t corner, int count) {
  CornerReport& report = result_.corners.emplace_back();
  report.element = static_cast<std::uint32_t>(corner);
  report.outcome = request(corner) > 0.0 ? CornerOutcome::smoothed : CornerOutcome::enlarged;
  report.count = static_cast<std::uint32_t>(count) + 1;
  report.first = elements() - report.count;
}

void CornerPass::report_sharp(std::size_t corner, SharpReason reason, const Side& in, const Side& out) {
  CornerReport& report = result_.corners.emplace_back();
  report.element = static_cast<std::uint32_t>(corner);
  report.reason = reason;
  if (reason == SharpReason::shared || code_of(reason) == codes::corner_too_large)
    report.largest =
        mm(largest_radius(in, out, request(corner), limits_, rooms_.empty() ? Room() : rooms_[corner]));
  warn(report);
}

void CornerPass::warn(const CornerReport& report) {
  const bool in_words = warned_[static_cast<std::size_t>(report.reason)]++ < limits::kMaxMessagesPerCode;
  diagnostics_.warning(
      code_of(report.reason), options_.where,
      in_words ? corner_message(report, mm(request(report.element)), options_.name) : std::string());
}

CutOutline CornerPass::run() {
  reserve();
  if (options_.sharing == EdgeSharing::even) divide_evenly();
  const std::size_t n = outline_.segments.size();
  Carrier before = carrier(0);
  start(before);
  for (std::size_t corner = 1; corner < n; ++corner) {
    const std::size_t first = corner;
    corner = smooth_lines(copy_lines(corner));
    if (corner != first) before = carrier(corner - 1);
    if (outline_.segments[corner - 1].via && !before.is_arc()) note_straight_arc(corner - 1);
    if (corner == n) break;
    const Carrier after = carrier(corner);
    cut(corner, before, after);
    before = after;
  }
  if (outline_.segments[n - 1].via && !before.is_arc()) note_straight_arc(n - 1);
  finish(before);
  return std::move(result_);
}

/// The requests of an outline, one for each element, without those at its ends, where there is no corner.
CornerRequests usable_requests(const Outline& outline, const CornerRequests& requests,
                               const CornerOptions& options, Diagnostics& diagnostics) {
  CornerRequests made = requests;
  made.resize(outline.elements());
  const auto leave = [&](std::size_t element, const char* what) {
    if (made[element] == Length()) return;
    made[element] = Length();
    diagnostics.warning(codes::outline_end_request, options.where,
                        fmt::format("{}.{}: {}; its request is ignored", options.name, element, what));
  };
  if (!outline.closed()) leave(0, "an open outline has no corner at its start");
  leave(outline.segments.size(), outline.closed()
                                     ? "the corner of a closed outline's end is that of its start"
                                     : "an open outline has no corner at its end");
  return made;
}

std::string_view words(SharpReason reason) {
  switch (reason) {
    case SharpReason::straight: return "its neighbours are tangent already";
    case SharpReason::folded: return "the outline turns back on itself";
    case SharpReason::short_segment: return "its neighbours are too short";
    case SharpReason::no_circle: return "no circle of this radius touches both of its neighbours";
    case SharpReason::no_neighbour: return "a neighbour has no length";
    case SharpReason::tiny: return "the radius is below the tolerance";
    case SharpReason::shared: return "the corner at the other end of a shared edge needs it, too";
    case SharpReason::none: break;
  }
  return "";
}

/// To the six digits that are printed, so that the value in a message can be used.
double rounded_down(double value) {
  constexpr double kRounding = 1e-14;  // of the product; a round number must not lose its last digit
  const double unit = std::pow(10.0, 5.0 - std::floor(std::log10(value)));
  if (!std::isfinite(unit)) return value;
  return std::floor(value * unit * (1.0 + kRounding)) / unit;
}

}  // namespace

std::string_view to_string(CornerOutcome outcome) {
  static constexpr std::string_view kNames[] = {"smoothed", "enlarged", "sharp"};
  return kNames[static_cast<std::size_t>(outcome)];
}

std::string_view to_string(SharpReason reason) {
  static constexpr std::string_view kNames[] = {"none",      "straight",     "folded", "short_segment",
                                                "no_circle", "no_neighbour", "tiny",   "shared"};
  return kNames[static_cast<std::size_t>(reason)];
}

std::string corner_message(const CornerReport& report, Length request, std::string_view name) {
  const double r = std::abs(request.mm());
  std::string text =
      fmt::format("corner {}.{} stays sharp, it cannot be {} with radius {:g}: {}", name, report.element,
                  request.mm() > 0.0 ? "smoothed" : "enlarged", r, words(report.reason));
  if (report.largest > Length()) {
    const double largest = rounded_down(report.largest.mm());
    text += fmt::format("; the radius is {:g} too large, the largest here is {:g}", r - largest, largest);
  }
  return text;
}

std::optional<CutOutline> cut_corners(const Outline& outline, const CornerRequests& requests,
                                      const CornerOptions& options, Diagnostics& diagnostics) {
  if (!check_outline(outline, options.name, options.where, diagnostics) ||
      !check_requests(requests, options.name, options.where, diagnostics))
    return std::nullopt;
  const CornerRequests usable = usable_requests(outline, requests, options, diagnostics);
  return CornerPass(outline, usable, options, diagnostics).run();
}

}  // namespace kerf
