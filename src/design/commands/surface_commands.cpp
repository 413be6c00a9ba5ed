// Surfaces, countersinks and threads.
#include <cmath>
#include <fmt/format.h>

#include "design/commands/entities.h"
#include "design/commands/outline_values.h"
#include "design/commands/rows.h"
#include "op/mesh/surface_rows.h"

#include "kerf/base/limits.h"
#include "kerf/geom/shapes.h"

namespace kerf::design {
namespace {

constexpr double kRoughStepover = 0.4;
constexpr double kSmallestCone = 10.0, kLargestCone = 170.0;  // degrees
constexpr int kMaxRings = 100'000, kMaxLevels = 100'000;

class ShapedSurface final : public Surface {
 public:
  explicit ShapedSurface(const BezierSurface& surface) : surface_(surface) {}
  double height(Point2 at) const override { return surface_.at(at); }

 private:
  BezierSurface surface_;
};

Value bezier_surface(Machine&, Call& call) {
  BezierSurface surface;
  surface.corner = call.point2(0);
  surface.width = positive(call.number(2), "width");
  surface.height = positive(call.number(3), "height");
  const Value& rows = call[4];
  if (!rows.is(Type::list) || rows.list().size() != 4) refuse("heights: four rows of four are required");
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double> row = numbers_of(rows.list()[i], "heights");
    if (row.size() != 4) refuse("heights: four rows of four are required");
    for (std::size_t k = 0; k < 4; ++k) surface.heights[i][k] = row[k];
  }
  return std::shared_ptr<const Surface>(std::make_shared<ShapedSurface>(surface));
}

/// That of bezier_surface(), or a function of x and y.
HeightFunction height_of(Call& call, std::size_t i) {
  if (!call[i].is(Type::surface)) call.wrong_type(i, "bezier_surface(...) or a function of x and y");
  const Surface& surface = *call[i].surface();
  return [&surface](Point2 p) { return surface.height(p); };
}

using SurfaceRows = std::vector<std::vector<Point3>>;

void run_rows(Machine& machine, const SurfaceRows& rows, std::size_t every, double lowest) {
  machine.lift();
  machine.rapid_xy(rows.front().front().xy());
  for (std::size_t i = 0; i < rows.size(); i += every)
    for (const Point3 p : rows[i]) machine.cut({p.x, p.y, std::max(p.z, lowest)});
  machine.lift();
}

/// surface, bx, by, width, height, stepover, stepdown
void cutsurface(Machine& machine, Call& call) {
  const HeightFunction surface = height_of(call, 0);
  SurfaceRowOptions options;
  options.low = call.point2(1);
  options.high = options.low + Point2{positive(call.number(3), "width"), positive(call.number(4), "height")};
  options.stepover = call.number(5);
  options.where = machine.where();
  options.progress = machine.options().progress;
  const double stepdown = not_negative(call.number(6), "stepdown");
  const auto rows = surface_rows(surface, machine.tool().tool, options, machine.diagnostics());
  if (!rows) throw Reported{};
  double lowest = 0.0;
  for (const std::vector<Point3>& row : *rows)
    for (const Point3 p : row) lowest = std::min(lowest, p.z);
  const double levels = stepdown > 0.0 ? std::ceil(-lowest / stepdown) : 0.0;
  if (levels > kMaxLevels) refuse(fmt::format("stepdown: more than {} passes", kMaxLevels));
  const auto every = static_cast<std::size_t>(std::max(1.0, std::round(kRoughStepover / options.stepover)));
  for (int i = 1; i < levels; ++i) run_rows(machine, *rows, every, -stepdown * i);
  run_rows(machine, *rows, 1, -limits::kMaxCoordinate);
}

/// A cone by rings of a ball mill from the inside out: xcenter, ycenter, diameter, angle, bz, stepover.
void cutcountersink(Machine& machine, Call& call) {
  const Point2 centre = call.point2(0);
  const double d = positive(call.number(2), "diameter"), angle = call.number(3);
  const double top = coordinate(call.number(4), "bz"), stepover = positive(call.number(5), "stepover");
  if (!(angle >= kSmallestCone && angle <= kLargestCone))
    refuse(
        fmt::format("angle must be from {:g} to {:g} degrees, not {:g}", kSmallestCone, kLargestCone, angle));
  if (machine.tool().shape() != "ball") refuse_now("a ball nose must be in use");
  const double half = degrees(angle / 2).rad(), r = machine.tool().diameter() / 2;
  const double last = d / 2 - r * std::cos(half);  // radius of the ring at which the ball touches the edge
  if (last <= 0.0) refuse(fmt::format("diameter: the ball of {:g} mm does not fit into {:g} mm", 2 * r, d));
  const int count =
      whole(std::ceil(last / (stepover * 2 * r * std::sin(half))), "the number of rings", 1, kMaxRings);
  machine.lift();
  machine.rapid_xy(centre);
  for (int i = 0; i <= count; ++i) {
    const double ring = last * i / count;
    const double tip = top + (ring - d / 2 + r / std::cos(half)) / std::tan(half) - r;
    const Point3 start{centre.x + ring, centre.y, tip};
    machine.cut(start);
    if (i > 0) machine.arc_to(start, centre, Turn::ccw);
  }
  machine.lift();
}

/// An internal thread: a helix of whole turns from the bottom up. xcenter, ycenter, diameter, pitch, bz,
/// zdepth, hand
void cutthread(Machine& machine, Call& call) {
  const Point2 centre = call.point2(0);
  const double d = positive(call.number(2), "diameter"), pitch = positive(call.number(3), "pitch");
  const double top = call.number(4), z = bottom_of(machine, top, call.number(5));
  const Turn turn = choice(call.text(6), {"right", "left"}, "hand") == 0 ? Turn::ccw : Turn::cw;
  const double radius = (d - machine.tool().diameter()) / 2;
  if (radius <= 0.0)
    refuse(
        fmt::format("diameter: the tool of {:g} mm does not fit into {:g} mm", machine.tool().diameter(), d));
  constexpr double kRounding = 1e-9;  // of turns
  machine.expect_tool("thread mill", "cutthread");
  // The last turn may end above the surface, so that the thread is open there.
  const double turns = std::ceil((top - z) / pitch - kRounding);
  if (turns < 1) refuse("zdepth: the thread has no depth");
  const int extra = whole(turns - 1, "the number of turns", 0, limits::kMaxTurns);
  machine.lift();
  machine.rapid_xy(centre);
  machine.rapid_z(top);
  machine.cut_at(centre, z);
  const Point2 start{centre.x + radius, centre.y};
  machine.cut_at(start, z);
  machine.arc_to({start.x, start.y, z + turns * pitch}, centre, turn, extra);
  machine.cut_at(centre, z + turns * pitch);
  machine.lift();
}

}  // namespace

void add_surface_commands(Rows& rows) {
  rows.push_back(making<bezier_surface>(
      "bezier_surface", "bx, by, width, height, heights",
      "The height above (x, y) of a bicubic Bézier surface over a rectangle.\n"
      "\n"
      "`heights` are the Z of its four rows of four control points, which are evenly spaced, "
      "from the lower left\n"
      "corner along X."));
  rows.push_back(motion<cutsurface>(
      "cutsurface", "surface, bx, by, width, height, stepover=0.1, stepdown=0",
      "Cut a surface in rows along X with the tool in use, without cutting below it.\n"
      "\n"
      "Parameters\n"
      "----------\n"
      "surface : callable\n"
      "    The height (Z) above (x, y), mm: a function, or `shapes.bezier_surface(...)`.\n"
      "bx, by, width, height : float\n"
      "    The rectangle, mm: its lower left corner and size. The tool's axis stays inside of "
      "it.\n"
      "stepover : float\n"
      "    Stepover of the rows, as a fraction of the tool's diameter.\n"
      "stepdown : float\n"
      "    Roughing passes of this depth from Z0 down, mm; 0: none."));
  rows.push_back(motion<cutcountersink>(
      "cutcountersink", "xcenter, ycenter, diameter, angle, bz=0, stepover=0.1",
      "Cut a conical countersink with a ball nose, ring by ring from the inside out.\n"
      "\n"
      "`diameter` is that at the surface `bz`, `angle` that between its sides in degrees, "
      "`stepover` the\n"
      "distance of the rings as a fraction of the tool's diameter."));
  rows.push_back(motion<cutthread>(
      "cutthread", "xcenter, ycenter, diameter, pitch, bz, zdepth, hand=\"right\"",
      "Cut an internal thread with a thread mill: a helix of whole turns from the bottom up.\n"
      "\n"
      "`diameter` is the nominal one; the hole must exist. `zdepth` mm below `bz` is the lowest"
      " point of the\n"
      "tool."));
}

}  // namespace kerf::design
