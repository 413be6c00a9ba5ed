// Keyholes and slots of undercutting tools.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/mill/beside.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

/// Distances from the centre line of passes that make a slot wider by `half` on both sides, from the inside.
std::vector<double> widening(double half, double step) {
  std::vector<double> distances;
  const double count = std::ceil(half / step - 1e-9);
  for (double k = 1.0; k <= count; k += 1.0) distances.push_back(half * (k / count));
  return distances;
}

bool usable(const KeyholeOptions& o, const std::vector<Point2>& points, const Tool& tool,
            Diagnostics& diagnostics) {
  if (!valid(o.cut, tool, diagnostics)) return false;
  if (points.empty()) return fail(o.cut, codes::op_empty, "no points; nothing to cut", diagnostics);
  if (!(o.length.mm() > 0.0 && o.length.mm() <= limits::kMaxCoordinate))
    return fail(o.cut, codes::op_option, fmt::format("length is {:g}; it must be above 0 mm", o.length.mm()),
                diagnostics);
  if (!(o.clearance.mm() >= 0.0 && o.clearance.mm() <= limits::kMaxToolSize))
    return fail(o.cut, codes::op_option,
                fmt::format("clearance of the slot is {:g}; it must be 0 mm or more", o.clearance.mm()),
                diagnostics);
  if (!may_plunge(tool, "go down where a keyhole starts", o.cut, diagnostics)) return false;
  if (!std::isfinite(o.angle.rad()) || !std::all_of(points.begin(), points.end(), in_range))
    return fail(o.cut, codes::op_option, "an angle or a point is out of range", diagnostics);
  return true;
}

}  // namespace

std::optional<Operation> keyhole(const std::vector<Point2>& points, const Tool& tool,
                                 const KeyholeOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!usable(options, points, tool, diagnostics)) return std::nullopt;
  const double bottom = cut.top - cut.depth.mm(), half = 0.5 * options.clearance.mm();
  const Point2 along{std::cos(options.angle.rad()), std::sin(options.angle.rad())};
  Cutter cutter(cut, tool, Walls(Walls::Kind::unknown));
  for (const Point2 at : points) {
    if (cutter.full()) break;
    const Point2 end = at + options.length.mm() * along;
    cutter.lift();
    cutter.travel(at, cut.top);
    cutter.rapid_down(cut.top + cut.clearance.mm());
    cutter.plunge(bottom);
    cutter.line(end);
    cutter.line(at);
    // Around the slot: with a clockwise spindle, counter-clockwise has the wall on the right.
    const double side = cut.direction == CutDirection::climb ? -1.0 : 1.0;
    for (const double d : widening(half, 0.25 * tool.diameter.mm())) {
      const Point2 aside = (side * d) * left_of(along);
      cutter.line(at + aside);
      cutter.line(end + aside);
      cutter.arc(end - aside, end, side < 0.0 ? Turn::ccw : Turn::cw, bottom);
      cutter.line(at - aside);
      cutter.line(at);
    }
  }
  return finished(cutter, cut, diagnostics);
}

namespace {

/// The outline with straight parts of length `by` before its start and after its end.
Outline extended(const Outline& outline, double by) {
  const CurvePoint first = at_length(outline, Length{}), last = at_length(outline, length(outline));
  const auto unit = [](Angle a) { return Point2{std::cos(a.rad()), std::sin(a.rad())}; };
  Outline out;
  out.start = outline.start - by * unit(first.heading);
  out.segments.push_back({outline.start, {}});
  out.segments.insert(out.segments.end(), outline.segments.begin(), outline.segments.end());
  out.segments.push_back({out.segments.back().to + by * unit(last.heading), {}});
  return out;
}

/// How far passes go beyond the end of a line, that all within half the width of the slot is cut there:
/// between two passes, too.
double end_of(double half, double step, double radius) {
  return half + radius - std::sqrt(radius * radius - 0.25 * step * step);
}

/// A pass from beside the start of a line to beside its end, which the tool enters and leaves nowhere else.
std::optional<Outline> side_pass(const Outline& line, double to_left, NextPasses passes,
                                 const CutOptions& cut, Diagnostics& diagnostics) {
  auto parts = offset_path(line, mm(to_left), region_options(cut), diagnostics);
  if (!parts) return std::nullopt;
  const double weld = cut.tolerance.weld.mm();
  Outline whole = beside(line, to_left, passes, weld);
  // The offset has fewer turns, but ends where the line crosses itself, and where its end is near to another
  // part of it. Its tips at sharp inner corners are too far apart where passes are.
  const auto same = [&](Point2 a, Point2 b) { return distance(a, b) <= 10.0 * weld; };
  const bool complete = parts->size() == 1 && passes.step <= passes.radius &&
                        same(parts->front().start, whole.start) &&
                        same(parts->front().segments.back().to, whole.segments.back().to);
  return complete ? std::move(parts->front()) : std::move(whole);
}

bool usable(const SlotOptions& o, const std::vector<Outline>& outlines, const Tool& tool,
            Diagnostics& diagnostics) {
  if (!valid(o.cut, tool, diagnostics) || !valid_stepover(o.stepover, o.cut, diagnostics)) return false;
  const double diameter = tool.diameter.mm();
  if (!(o.width.mm() == 0.0 || (o.width.mm() >= diameter && o.width.mm() <= limits::kMaxToolSize)))
    return fail(o.cut, codes::op_tool_wide,
                fmt::format("width is {:g} mm; it must be at least {:g} mm, the diameter of tool {}",
                            o.width.mm(), diameter, tool.number),
                diagnostics);
  if (!(o.overhang >= 0.5 && o.overhang <= 10.0))
    return fail(o.cut, codes::op_option,
                fmt::format("overhang is {:g}; it must be from 0.5 to 10", o.overhang), diagnostics);
  if (outlines.empty()) return fail(o.cut, codes::op_empty, "no open outline; nothing to cut", diagnostics);
  for (const Outline& outline : outlines) {
    if (outline.closed())
      return fail(o.cut, codes::op_option, "the tool has no way into a closed outline: it needs an open one",
                  diagnostics);
    const Box2 box = bounds(outline);
    if (!(in_range(box.low) && in_range(box.high)) || !(length(outline).mm() > o.cut.tolerance.weld.mm()))
      return fail(o.cut, codes::op_option, "an outline has no length or is out of range", diagnostics);
  }
  return true;
}

}  // namespace

std::optional<Operation> slot(const std::vector<Outline>& outlines, const Tool& tool,
                              const SlotOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!usable(options, outlines, tool, diagnostics)) return std::nullopt;
  const double bottom = cut.top - cut.depth.mm(), diameter = tool.diameter.mm();
  const double half = std::max(0.5 * (options.width.mm() - diameter), 0.0), weld = cut.tolerance.weld.mm();
  const std::vector<double> distances = widening(half, options.stepover * diameter);
  const double step = distances.empty() ? 0.0 : distances.front();
  const double beyond = std::max(options.overhang * diameter, end_of(half, step, 0.5 * diameter));
  Cutter cutter(cut, tool, Walls(Walls::Kind::unknown));
  const auto run = [&](const Outline& outline) {
    const Track track(outline, weld);
    if (track.empty() || cutter.full()) return;
    cutter.lift();
    const Point2 start = track.at(0.0);
    // Down at feed, in case that there is material after all, and not straight: these tools cannot plunge.
    cutter.travel(start - std::max(cut.depth.mm(), 0.5 * diameter) * track.direction(0.0), cut.top);
    cutter.rapid_down(cut.top + cut.clearance.mm());
    cutter.slope({start.x, start.y, bottom});
    cutter.follow(track, 0.0, track.length(), bottom);
  };
  for (const Outline& outline : outlines) {
    const Outline centre_line = extended(outline, beyond);
    run(centre_line);
    for (const double d : distances)
      for (const double side : {1.0, -1.0}) {
        const auto path = side_pass(centre_line, side * d, {step, 0.5 * diameter}, cut, diagnostics);
        if (!path) return std::nullopt;
        // The wall is on the side of the pass: on the left where it runs forwards.
        const bool forwards = (side < 0.0) == (cut.direction == CutDirection::climb);
        run(forwards ? *path : reversed(*path));
      }
  }
  return finished(cutter, cut, diagnostics);
}

}  // namespace kerf
