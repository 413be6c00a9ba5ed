// Threads by helices of a thread mill, and countersinks by circles of a ball mill.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "op/base/cutter.h"

#include "kerf/base/limits.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kExternalDepth = 0.6134;  // of an external ISO thread, in pitches (ISO 68-1: 17/24 H)
constexpr double kInternalDepth = 0.5413;  // of an internal one (5/8 H)
constexpr double kMaxTurns = 1000.0;

bool usable_circle(const Circle& c) {
  return in_range(c.centre) && c.radius.mm() > 0.0 && c.radius.mm() <= limits::kMaxCoordinate;
}

class ThreadRun {
 public:
  ThreadRun(const ThreadOptions& options, const Tool& tool, Diagnostics& diagnostics)
      : o_(options),
        tool_(tool),
        diagnostics_(diagnostics),
        cutter_(options.cut, tool, Walls(Walls::Kind::none)) {}

  bool check(const std::vector<Circle>& circles) {
    const CutOptions& cut = o_.cut;
    if (!valid(cut, tool_, diagnostics_)) return false;
    if (circles.empty()) return fail(cut, codes::op_empty, "no circles; nothing to cut", diagnostics_);
    const double pitch = o_.pitch.mm();
    if (!(pitch > 0.0 && pitch <= limits::kMaxToolSize && cut.depth.mm() / pitch <= kMaxTurns))
      return fail(cut, codes::op_option, fmt::format("pitch is {:g}; it must be above 0 mm", pitch),
                  diagnostics_);
    if (o_.passes < 1 || o_.passes > 100 || o_.teeth < 1 || o_.teeth > 1000)
      return fail(cut, codes::op_option,
                  fmt::format("{} passes with {} teeth are not possible", o_.passes, o_.teeth), diagnostics_);
    const double radius = 0.5 * tool_.diameter.mm();
    for (const Circle& c : circles) {
      if (!usable_circle(c)) return fail(cut, codes::op_option, "a circle is out of range", diagnostics_);
      const double depth = pitch * (inside() ? kInternalDepth : kExternalDepth);
      // The tool must pass through the minor diameter without touching it.
      if ((inside() && c.radius.mm() - depth <= radius) || (!inside() && c.radius.mm() <= depth))
        return fail(
            cut, codes::op_tool_wide,
            fmt::format("tool {} of {:.4g} mm does not fit into a thread of {:.4g} mm at {:.6g}, {:.6g}, "
                        "whose minor diameter is {:.4g} mm",
                        tool_.number, 2.0 * radius, 2.0 * c.radius.mm(), c.centre.x, c.centre.y,
                        std::max(2.0 * (c.radius.mm() - depth), 0.0)),
            diagnostics_);
    }
    return true;
  }

  void cut(const Circle& circle) {
    const double radius = 0.5 * tool_.diameter.mm(), pitch = o_.pitch.mm();
    const double depth = pitch * (inside() ? kInternalDepth : kExternalDepth);
    for (int pass = 1; pass <= o_.passes && !cutter_.full(); ++pass) {
      // Equal areas of the profile, whose width grows with its depth.
      const double fraction = std::sqrt(static_cast<double>(pass) / o_.passes);
      const double minor = circle.radius.mm() - depth;
      const double at =
          inside() ? minor + fraction * depth - radius : circle.radius.mm() - fraction * depth + radius;
      one_pass(circle.centre, at, inside() ? 0.0 : circle.radius.mm() + radius + pitch);
    }
  }
  std::optional<Operation> take() { return finished(cutter_, o_.cut, diagnostics_); }

 private:
  bool inside() const { return o_.side == ThreadSide::inside; }

  /// A helix of radius `at`, reached by a half circle from the radius `from`.
  void one_pass(Point2 centre, double at, double from) {
    const CutOptions& cut = o_.cut;
    const double bottom = cut.top - cut.depth.mm(), pitch = o_.pitch.mm();
    // Inside, counter-clockwise has the wall on the right, which is climb; around a rod the other way.
    const bool ccw = (cut.direction == CutDirection::climb) == inside();
    const Turn turn = ccw ? Turn::ccw : Turn::cw;
    // A right-hand thread rises counter-clockwise.
    const bool rises = ccw == (o_.hand == ThreadHand::right);
    const double block = pitch * o_.teeth;  // height that one turn cuts
    const double blocks = std::max(std::ceil(cut.depth.mm() / block - 1e-9), 1.0);
    // A single tooth cuts all turns in one helix.
    const double helices = o_.teeth == 1 ? 1.0 : blocks, turns = o_.teeth == 1 ? blocks : 1.0;
    const Point2 start = centre + Point2{from, 0.0}, wall = centre + Point2{at, 0.0},
                 lead = 0.5 * (start + wall);
    cutter_.lift();
    cutter_.travel(start, cut.top);
    cutter_.rapid_down(cut.top + cut.clearance.mm());
    for (double k = 0.0; k < helices && !cutter_.full(); k += 1.0) {
      const double low = bottom + k * block, high = low + turns * pitch;
      move_to(rises ? low : high);
      half_circle(wall, lead, rises ? low : high);
      cutter_.arc(wall, centre, turn, rises ? high : low, static_cast<int>(turns));
      half_circle(start, lead, rises ? high : low);
    }
    cutter_.lift();
  }
  /// Beside the thread, straight up or down: in the hole, or beside the rod. Thread mills cannot plunge, so
  /// there is no material that they could be fed into.
  void move_to(double z) {
    if (z >= cutter_.position()->z)
      cutter_.rise(z);
    else if (tool_.plunges)
      cutter_.plunge(z);
    else
      cutter_.rapid_down(z);
  }
  void half_circle(Point2 to, Point2 centre, double z) {
    const bool ccw = (o_.cut.direction == CutDirection::climb) == inside();
    // The half circle meets the helix without a corner: inside in its sense, outside against it.
    cutter_.arc(to, centre, ccw == inside() ? Turn::ccw : Turn::cw, z);
  }

  const ThreadOptions& o_;
  const Tool& tool_;
  Diagnostics& diagnostics_;
  Cutter cutter_;
};

}  // namespace

std::optional<Operation> thread(const std::vector<Circle>& circles, const Tool& tool,
                                const ThreadOptions& options, Diagnostics& diagnostics) {
  ThreadRun run(options, tool, diagnostics);
  if (!run.check(circles)) return std::nullopt;
  for (const Circle& circle : circles) run.cut(circle);
  return run.take();
}

std::optional<Operation> countersink(const std::vector<Circle>& circles, const Tool& tool,
                                     const CountersinkOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!valid(cut, tool, diagnostics)) return std::nullopt;
  const auto* ball = std::get_if<shape::Ball>(&tool.shape);
  const double half = 0.5 * options.angle.rad(), scallop = options.scallop.mm();
  const bool good =
      options.angle.deg() >= 10.0 && options.angle.deg() <= 170.0 && scallop >= 1e-4 && scallop <= 1.0;
  if (ball == nullptr || !good || circles.empty()) {
    fail(cut, circles.empty() ? codes::op_empty : codes::op_option,
         circles.empty() ? std::string("no circles; nothing to cut")
         : ball == nullptr
             ? fmt::format("tool {} is no ball mill", tool.number)
             : std::string("the angle must be from 10 to 170 degrees, the scallop from 0.0001 to 1 mm"),
         diagnostics);
    return std::nullopt;
  }
  const double radius = 0.5 * ball->diameter.mm(), across = std::cos(half), up = std::sin(half);
  Cutter cutter(cut, tool, Walls(Walls::Kind::none));
  const Turn turn = cut.direction == CutDirection::climb ? Turn::ccw : Turn::cw;
  for (const Circle& circle : circles) {
    const double wide = circle.radius.mm();
    const double narrow = wide - cut.depth.mm() * std::tan(half);
    if (!usable_circle(circle) || narrow < 0.0 || wide <= radius * across) {
      fail(cut, codes::op_tool_wide,
           fmt::format("a cone {:.4g} mm deep from a circle of {:.4g} mm at {:.6g}, {:.6g} cannot be cut by "
                       "tool {} of "
                       "{:.4g} mm",
                       cut.depth.mm(), 2.0 * wide, circle.centre.x, circle.centre.y, tool.number,
                       2.0 * radius),
           diagnostics);
      return std::nullopt;
    }
    // The ball touches the cone at the radius `contact`; its centre is one radius from there, square to the
    // cone.
    const double first = std::max(narrow, radius * across);
    const double step = 2.0 * std::sqrt(2.0 * radius * scallop - scallop * scallop) * up;
    const double count = std::max(std::ceil((wide - first) / step), 1.0);
    for (double k = 0.0; k <= count && !cutter.full(); k += 1.0) {
      const double contact = first + (wide - first) * (k / count);
      const double axis = std::max(contact - radius * across, 0.0);
      const double tip = cut.top - (wide - contact) / std::tan(half) + radius * up - radius;
      const Point2 at = circle.centre + Point2{axis, 0.0};
      if (k == 0.0) {
        cutter.lift();
        cutter.travel(at, cut.top);
        cutter.rapid_down(cut.top + cut.clearance.mm());
        cutter.plunge(tip);
      } else {
        cutter.slope({at.x, at.y, tip});
      }
      if (axis > cut.tolerance.weld.mm()) cutter.arc(at, circle.centre, turn, tip, 1);
    }
    // Off the wall before the tool rises.
    cutter.line(circle.centre);
  }
  return finished(cutter, cut, diagnostics);
}

}  // namespace kerf
