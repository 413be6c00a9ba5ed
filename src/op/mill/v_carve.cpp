// V-carving. The axis of the tool follows the medial axis as far as the tool may go down, and the walls at
// the depth beyond that. The axis becomes trails from corner to corner, so that the tool mostly starts and
// ends at the surface; with a stepdown, a trail is cut again and again only where it is deeper than the pass
// before.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "geom/medial/medial_axis.h"
#include "op/base/cutter.h"
#include "op/base/option_check.h"
#include "op/base/reach.h"
#include "op/base/trails.h"
#include "op/mill/carving_edge.h"
#include "op/mill/floor_corners.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kMinTolerance = 1e-4;  // mm
constexpr int kMaxHalvings = 12;        // of a chord along which the depth is not linear
constexpr double kMinLoop = 10.0;       // of the weld tolerance: a shorter wall is a point
constexpr double kBeside = 0.1;         // mm outside of the region that rapids above it may be

/// The tolerance of a carved surface, split between the errors that add up in it.
struct CarvingTolerances {
  explicit CarvingTolerances(Length whole)
      : boundary(0.2 * whole),
        axis(0.1 * whole),
        nodes(0.3 * whole),
        depths(0.1 * whole),
        trails(0.3 * whole) {}
  Length boundary;  // of chords of the region's arcs
  Length axis;      // of chords of the axis
  Length nodes;     // of short parts of the axis that are a point
  Length depths;    // of depths that are not linear along a chord of the axis
  Length trails;    // of points left out of a trail
};

/// The points of an axis at the depths of their circles.
class AxisTrails {
 public:
  AxisTrails(const CutOptions& cut, const CarvingTolerances& parts, double start, const CarvingEdge& edge,
             double tip, double widest)
      : cut_(cut), parts_(parts), start_(start), edge_(edge), tip_(tip), widest_(widest) {}

  /// The parts of the axis whose circles are within the range of the tool.
  std::vector<TrailEdge> edges(const MedialAxis& axis) {
    std::vector<TrailEdge> made;
    auto free_node = static_cast<std::uint32_t>(axis.nodes.size());
    for (const MedialEdge& edge : axis.edges) {
      TrailEdge part{edge.from, edge.to, {}};
      const auto flush = [&](std::uint32_t to) {
        part.to = to;
        if (part.points.size() > 1) made.push_back(part);
        part.points.clear();
      };
      for (std::size_t i = 0; i + 1 < edge.points.size(); ++i) {
        const auto [t0, t1] = range(edge.points[i].radius.mm(), edge.points[i + 1].radius.mm());
        if (!(t0 <= t1)) {
          flush(free_node++);
          continue;
        }
        if (t0 > 0.0) flush(free_node++), part.from = free_node++;
        if (part.points.empty()) {
          if (i > 0 && t0 == 0.0) part.from = free_node++;
          part.points.push_back(point(at(edge.points[i], edge.points[i + 1], t0)));
        }
        add(part.points, at(edge.points[i], edge.points[i + 1], t0),
            at(edge.points[i], edge.points[i + 1], t1), 0);
        if (t1 < 1.0) flush(free_node++);
      }
      flush(edge.to);
    }
    // The node of a disc has no edge.
    std::vector<bool> connected(axis.nodes.size(), false);
    for (const MedialEdge& edge : axis.edges) connected[edge.from] = connected[edge.to] = true;
    for (std::uint32_t i = 0; i < axis.nodes.size(); ++i) {
      const double radius = axis.nodes[i].radius.mm();
      if (const auto [t0, t1] = range(radius, radius); !connected[i] && t0 <= t1)
        made.push_back({i, i, {point(axis.nodes[i])}});
    }
    for (TrailEdge& edge : made) edge.points = simplified(edge.points, parts_.trails.mm());
    return made;
  }

 private:
  /// The parameters of a chord between which its circles are within the range of the tool; t0 > t1: none are.
  std::pair<double, double> range(double r0, double r1) const {
    const double slack = cut_.tolerance.chord.mm();
    const double low = tip_ > 0.0 ? tip_ - 0.5 * slack : -slack, high = widest_ + slack;
    double t0 = 0.0, t1 = 1.0;
    const auto limit = [&](double a, double b) {  // a at t = 0 and b at t = 1 must not be below 0
      if (a < 0.0 && b < 0.0) t0 = 2.0;
      if (a < 0.0 && b >= 0.0) t0 = std::max(t0, a / (a - b));
      if (a >= 0.0 && b < 0.0) t1 = std::min(t1, a / (a - b));
    };
    limit(r0 - low, r1 - low);
    limit(high - r0, high - r1);
    return {t0, t1};
  }
  static MedialPoint at(const MedialPoint& a, const MedialPoint& b, double t) {
    if (t == 0.0) return a;
    if (t == 1.0) return b;
    return {a.at + t * (b.at - a.at), a.radius + t * (b.radius - a.radius)};
  }
  double level(double radius) const {
    return cut_.top - start_ - edge_.height_of(std::clamp(radius, tip_, widest_));
  }
  Point3 point(const MedialPoint& p) const { return {p.at.x, p.at.y, level(p.radius.mm())}; }

  /// Appends the end of a chord, and points between where the depth is not linear along it.
  void add(std::vector<Point3>& points, const MedialPoint& a, const MedialPoint& b, int halvings) const {
    const MedialPoint midpoint = at(a, b, 0.5);
    const double linear = 0.5 * (level(a.radius.mm()) + level(b.radius.mm()));
    if (halvings < kMaxHalvings && std::abs(level(midpoint.radius.mm()) - linear) > parts_.depths.mm()) {
      add(points, a, midpoint, halvings + 1);
      add(points, midpoint, b, halvings + 1);
      return;
    }
    points.push_back(point(b));
  }

  const CutOptions& cut_;
  const CarvingTolerances& parts_;
  double start_;
  const CarvingEdge& edge_;
  double tip_, widest_;
};

/// What is carved: the axis of `region` up to circles of the radius `widest`, and `walls` at the depth.
struct Carving {
  Region region;
  std::vector<Outline> walls;  // with the material to be removed on their left
  double start = 0.0, widest = 0.0;
  Length tolerance{};
};

/// Options with the depth set, and the edge of the tool; nothing, with an error, where they do not fit.
struct Prepared {
  CutOptions cut;
  CarvingEdge edge;
};
std::optional<Prepared> prepared(const CutOptions& cut, Length start, const Tool& tool,
                                 Diagnostics& diagnostics) {
  const auto edge = CarvingEdge::of(tool);
  if (!edge) {
    fail(cut, codes::op_option,
         fmt::format("tool {} has no sloping edge; carving needs a V tool or a ball", tool.number),
         diagnostics);
    return std::nullopt;
  }
  Prepared made{cut, *edge};
  made.cut.allowance = Length{};
  if (cut.depth == Length{}) made.cut.depth = mm(edge->height());
  if (!valid(made.cut, tool, diagnostics)) return std::nullopt;
  if (!(start >= Length{} && start < made.cut.depth)) {
    fail(cut, codes::op_option,
         fmt::format("start depth is {:g}; it must be 0 mm or more, and less than the depth of {:g} mm",
                     start.mm(), made.cut.depth.mm()),
         diagnostics);
    return std::nullopt;
  }
  if (made.cut.depth.mm() > edge->height() + cut.tolerance.chord.mm()) {
    fail(cut, codes::op_option,
         fmt::format("depth is {:g}; it must be at most {:.4g} mm, up to where the edge of tool {} slopes",
                     made.cut.depth.mm(), edge->height(), tool.number),
         diagnostics);
    return std::nullopt;
  }
  return made;
}

std::optional<Region> shrunk(const Region& region, double by, const CutOptions& cut,
                             Diagnostics& diagnostics) {
  if (std::abs(by) <= cut.tolerance.weld.mm()) return region;
  auto made = offset(region, mm(-by), region_options(cut), diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->region);
}

/// The option of the ridges, and those of the surface; false, with an error.
bool valid_carving(Length tolerance, const FloorCorners& corners, const CutOptions& cut,
                   Diagnostics& diagnostics) {
  OptionCheck check(cut, diagnostics);
  check.expect(tolerance.mm() >= kMinTolerance && tolerance.mm() <= 1.0, "tolerance", tolerance.mm(),
               fmt::format("from {:g} to 1 mm", kMinTolerance));
  check.expect(corners.ridge.mm() >= kMinTolerance && corners.ridge.mm() <= limits::kMaxToolSize, "ridge",
               corners.ridge.mm(), fmt::format("{:g} mm or more", kMinTolerance));
  return check.valid();
}

/// Adds the corners of a floor, and takes them off what is left of it.
bool add_corners(Operation& made, const FloorCorners& corners, const Region& permitted, const Tool& tool,
                 const Prepared& how, Diagnostics& diagnostics) {
  if (corners.left.empty()) return true;
  const auto cut = carved_corners(corners, permitted, tool, how.edge, how.cut, diagnostics);
  if (!cut) return false;
  if (cut->path.size() > 0) append(made.path, cut->path);
  auto left = combine(made.unreached, corners.left, Boolean::subtract, region_options(how.cut), diagnostics);
  if (!left) return false;
  made.unreached = std::move(left->region);
  return true;
}

/// The walls at the depth, then the trails.
std::optional<Operation> carved(const Carving& carving, const Prepared& how, const Tool& tool,
                                Diagnostics& diagnostics) {
  const CutOptions& cut = how.cut;
  const CarvingTolerances parts(carving.tolerance);
  MedialOptions options{.region = region_options(cut), .axis = parts.axis, .nodes = parts.nodes};
  options.region.tolerance.chord = parts.boundary;
  const auto axis = medial_axis(carving.region, options, diagnostics);
  if (!axis) return std::nullopt;
  Operation made;
  std::vector<Outline> walls;
  for (const Outline& loop : carving.walls)
    if (length(loop) > kMinLoop * cut.tolerance.weld)
      walls.push_back(cut.direction == CutDirection::climb ? loop : reversed(loop));
  if (!walls.empty()) {
    auto along = contour_on(walls, tool, cut, diagnostics);
    if (!along) return std::nullopt;
    made.path = std::move(along->path);
  }
  AxisTrails depths(cut, parts, carving.start, how.edge, how.edge.tip(), carving.widest);
  const std::vector<TrailEdge> edges = depths.edges(*axis);
  if (stop_requested(cut.progress)) return std::nullopt;
  // Beside the region there may be a clamp, higher than rapids from one trail to the next.
  Cutter cutter(cut, tool, Walls::around(carving.region, kBeside));
  cut_trails(cutter, edges, cut);
  auto trails = finished(cutter, cut, diagnostics);
  if (!trails) return std::nullopt;
  if (made.path.size() == 0)
    made.path = std::move(trails->path);
  else
    append(made.path, trails->path);
  return made;
}

}  // namespace

std::optional<Operation> v_carve(const Region& region, const Tool& tool, const VCarveOptions& options,
                                 Diagnostics& diagnostics) {
  const auto how = prepared(options.cut, options.start, tool, diagnostics);
  if (!how || !valid_carving(options.tolerance, options.corners, how->cut, diagnostics) ||
      !usable(region, how->cut, diagnostics))
    return std::nullopt;
  const double tip = how->edge.tip();
  Carving carving{region, {}, options.start.mm(), 0.0, options.tolerance};
  carving.widest = how->edge.radius_at((how->cut.depth - options.start).mm());
  std::vector<NarrowPart> narrow;
  Region left;
  if (tip > 0.0) {
    CutOptions at_tip = how->cut;
    at_tip.depth = Length{};
    auto reached = reach(region, tool, ReachSide::inside, at_tip, diagnostics);
    if (!reached) return std::nullopt;
    narrow = std::move(reached->narrow), left = std::move(reached->unreached);
  }
  auto walls = shrunk(region, carving.widest, how->cut, diagnostics);
  auto floor = walls && tip > 0.0 ? shrunk(*walls, tip, how->cut, diagnostics) : walls;
  if (!walls || !floor) return std::nullopt;
  carving.walls = walls->loops;
  auto made = carved(carving, *how, tool, diagnostics);
  if (!made) return std::nullopt;
  made->narrow = std::move(narrow), made->unreached = std::move(*floor);
  if (!add_corners(*made, options.corners, *walls, tool, *how, diagnostics)) return std::nullopt;
  for (Outline& loop : left.loops) made->unreached.loops.push_back(std::move(loop));
  return made;
}

std::optional<Region> v_carve_floor(const Region& region, const Tool& tool, const VCarveOptions& options,
                                    Diagnostics& diagnostics) {
  const auto how = prepared(options.cut, options.start, tool, diagnostics);
  if (!how || !usable(region, how->cut, diagnostics)) return std::nullopt;
  const double widest = how->edge.radius_at((how->cut.depth - options.start).mm());
  return shrunk(region, widest - how->edge.tip(), how->cut, diagnostics);
}

namespace {

/// The figures of a plug.
struct Plug {
  Prepared how;
  Region mirrored;
  double start = 0.0, widest = 0.0, margin = 0.0;  // mm
};

std::optional<Plug> plug_of(const Region& region, const Tool& tool, const InlayOptions& options,
                            Diagnostics& diagnostics) {
  for (const auto& [length, what] :
       {std::pair(options.glue_gap, "glue gap"), {options.base_gap, "base gap"}, {options.margin, "margin"}})
    if (!(length >= Length{} && length.mm() <= limits::kMaxToolSize)) {
      fail(options.cut, codes::op_option,
           fmt::format("{} is {:g}; it must be 0 mm or more", what, length.mm()), diagnostics);
      return std::nullopt;
    }
  if (!(options.cut.depth > Length{})) {
    fail(options.cut, codes::op_option, "a plug needs the depth of its pocket", diagnostics);
    return std::nullopt;
  }
  const Length start = options.cut.depth - options.glue_gap;
  if (!(start > Length{})) {
    fail(options.cut, codes::op_option,
         fmt::format("glue gap is {:g}; it must be less than the depth, {:g} mm", options.glue_gap.mm(),
                     options.cut.depth.mm()),
         diagnostics);
    return std::nullopt;
  }
  CutOptions cut = options.cut;
  cut.depth = inlay_plug_depth(options);
  // The depth of the pocket itself is checked as well, since the plug may be less deep.
  if (!prepared(options.cut, Length{}, tool, diagnostics)) return std::nullopt;
  const auto how = prepared(cut, std::min(start, 0.999999 * cut.depth), tool, diagnostics);
  if (!how || !usable(region, how->cut, diagnostics)) return std::nullopt;
  const Box2 box = bounds(region);
  Plug plug{*how, placed(region, {.offset = {box.low.x + box.high.x, 0.0}, .factor = {-1.0, 1.0}}),
            start.mm()};
  plug.widest = how->edge.radius_at(options.base_gap.mm());
  const double least = 2.5 * plug.widest + how->edge.radius_at(how->cut.depth.mm());
  plug.margin =
      options.margin > Length{} ? std::max(options.margin.mm(), least) : 2.0 * tool.diameter.mm() + least;
  return plug;
}

/// What is within the margin of a plug, less what is within `distance` of it.
std::optional<Region> around(const Plug& plug, double distance, Diagnostics& diagnostics) {
  const auto outer = shrunk(plug.mirrored, -plug.margin, plug.how.cut, diagnostics);
  const auto inner = shrunk(plug.mirrored, -distance, plug.how.cut, diagnostics);
  if (!outer || !inner) return std::nullopt;
  auto made = combine(*outer, *inner, Boolean::subtract, region_options(plug.how.cut), diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->region);
}

}  // namespace

Length inlay_plug_depth(const InlayOptions& options) {
  return options.cut.depth - options.glue_gap + options.base_gap;
}

std::optional<Operation> inlay_plug(const Region& region, const Tool& tool, const InlayOptions& options,
                                    Diagnostics& diagnostics) {
  const auto plug = plug_of(region, tool, options, diagnostics);
  if (!plug || !valid_carving(options.tolerance, options.corners, plug->how.cut, diagnostics))
    return std::nullopt;
  auto free = around(*plug, 0.0, diagnostics);
  auto part = free ? shrunk(plug->mirrored, -plug->widest, plug->how.cut, diagnostics) : std::nullopt;
  if (!free || !part) return std::nullopt;
  Carving carving{std::move(*free), {}, plug->start, plug->widest, options.tolerance};
  for (const Outline& loop : part->loops) carving.walls.push_back(reversed(loop));
  auto made = carved(carving, plug->how, tool, diagnostics);
  auto floor = made ? around(*plug, plug->widest + plug->how.edge.tip(), diagnostics) : std::nullopt;
  if (!floor) return std::nullopt;
  made->unreached = std::move(*floor);
  if (options.corners.left.empty()) return made;
  const auto permitted = around(*plug, plug->widest, diagnostics);
  if (!permitted || !add_corners(*made, options.corners, *permitted, tool, plug->how, diagnostics))
    return std::nullopt;
  return made;
}

std::optional<Region> inlay_plug_floor(const Region& region, const Tool& tool, const InlayOptions& options,
                                       Diagnostics& diagnostics) {
  const auto plug = plug_of(region, tool, options, diagnostics);
  if (!plug) return std::nullopt;
  return around(*plug, plug->widest - plug->how.edge.tip(), diagnostics);
}

}  // namespace kerf
