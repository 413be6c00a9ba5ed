// Dog-bones and T-bones at the corners of finished paths.
#include "op/mill/bones.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "geom/base/box_tree.h"
#include "op/base/cutter.h"
#include "op/base/option_check.h"
#include "op/base/track.h"

#include "kerf/geom/offset.h"

namespace kerf::op_detail {
namespace {

constexpr double kNear = 1e-7;   // mm: a point this near to a wall is on it
constexpr int kMaxSteps = 500;   // towards a wall, enough for a corner of 5 degrees
constexpr double kLevel = 1e-6;  // mm: heights that are one level

/// A corner of the axis' path, and the point from which the tool touches that of the walls.
struct Bone {
  Point2 corner, tip;
};

/// The walls as the axis sees them.
class BoneWalls {
 public:
  BoneWalls(const Region& region, ReachSide side)
      : region_(region), search_(region), sign_(side == ReachSide::inside ? 1.0 : -1.0) {}

  /// How far a ray goes until it meets them. Each step is the distance from the nearest wall, so that none is
  /// passed.
  double way_to(Point2 from, Point2 direction) const {
    double way = 0.0;
    for (int i = 0; i < kMaxSteps; ++i) {
      const auto clear = search_.clearance(from + way * direction);
      const double step = clear ? sign_ * clear->mm() : 0.0;
      if (!(step > kNear)) break;
      way += step;
    }
    return way;
  }
  /// The ends of the straight wall that a point is on, or the point where it is a corner or on an arc.
  std::vector<Point2> corners_at(Point2 at) const {
    const auto point = search_.nearest(at);
    if (!point) return {};
    const Outline& loop = region_.loops[point->loop];
    const Segment& wall = loop.segments[point->segment];
    const Point2 from = point->segment == 0 ? loop.start : loop.segments[point->segment - 1].to;
    const bool corner = distance(at, from) <= kCorner || distance(at, wall.to) <= kCorner;
    if (corner || wall.via) return {at};
    return {from, wall.to};
  }

 private:
  static constexpr double kCorner = 1e-4;  // mm
  const Region& region_;
  RegionSearch search_;
  double sign_;
};

/// A corner between two elements of the axis, with the directions of travel.
struct Corner {
  Point2 at, in, out;
  double length_in = 0.0, length_out = 0.0;  // mm
};

/// Where the tool touches the corner; none where the way there is less than `least`. `radius`: of the axis
/// from the walls, `allowance` of which stays.
std::vector<Bone> bones_of(const Corner& corner, const BoneWalls& walls, double radius, double allowance,
                           const BoneOptions& options, double least) {
  const Point2 beyond = corner.in - corner.out;
  const double size = norm(beyond);
  if (!(size > 0.0)) return {};
  const Point2 outwards = (1.0 / size) * beyond;
  const double way = walls.way_to(corner.at, outwards);
  const std::vector<Point2> corners = walls.corners_at(corner.at + way * outwards);
  if (corners.size() == 1 && options.kind == BoneKind::t_bone && way - radius > least) {
    const bool forwards = (corner.length_in >= corner.length_out) == (options.edge == BoneEdge::longer);
    const Point2 along = forwards ? corner.in : -corner.out;
    const double part = (radius - allowance) / radius;
    return {{corner.at, corner.at + (part * way * dot(outwards, along)) * along}};
  }
  // A corner that is blunted by a short edge is two.
  std::vector<Bone> bones;
  for (const Point2 c : corners)
    if (const double far = distance(corner.at, c); far - radius > least)
      bones.push_back({corner.at, c + (radius / far) * (corner.at - c)});
  return bones;
}

/// Those of the corners that the axis has along the walls.
std::vector<Bone> bones_at(const BoneWork& work, const Reach& reach, Length allowance) {
  std::vector<Bone> bones;
  const BoneOptions& options = work.options;
  const CutOptions& cut = work.cut;
  const BoneWalls walls(work.region, work.side);
  const double free = work.side == ReachSide::inside ? 1.0 : -1.0;  // the side of a loop where the axis is
  const double sharp = std::numbers::pi - options.angle.rad() - 1e-9;
  for (const Outline& loop : reach.axis.loops) {
    const Track track(loop, cut.tolerance.weld.mm());
    if (track.empty()) continue;
    const std::vector<LineArc> pieces = track.pieces(0.0, track.length());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const LineArc &before = pieces[i], &after = pieces[(i + 1) % pieces.size()];
      const Corner corner{after.from, end_direction(before), start_direction(after), length_of(before),
                          length_of(after)};
      const double turn = std::atan2(free * cross(corner.in, corner.out), dot(corner.in, corner.out));
      if (!(turn >= sharp)) continue;
      for (const Bone& bone :
           bones_of(corner, walls, reach.radius, allowance.mm(), options, cut.tolerance.chord.mm()))
        bones.push_back(bone);
    }
  }
  return bones;
}

/// The path with the bones, once on each level.
Toolpath with_bones(const Toolpath& path, const std::vector<Bone>& bones, const CutOptions& cut) {
  const double near = 2.0 * cut.tolerance.weld.mm();
  std::vector<Box2> boxes;
  for (const Bone& bone : bones) boxes.push_back(Box2{bone.corner, bone.corner}.grown(near));
  const BoxTree tree(boxes);
  std::vector<double> done(bones.size(), INFINITY);  // the last level
  Toolpath out;
  std::optional<Point3> here;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    out.add_copy(path, i);
    if (!s.is_motion()) continue;
    const Point3 to = s.to();
    if (s.is_cutting() && here && std::abs(here->z - to.z) <= kLevel)
      tree.query(Box2{to.xy(), to.xy()}, [&](std::uint32_t k) {
        if (std::abs(done[k] - to.z) <= kLevel) return;
        done[k] = to.z;
        const Point2 tip = bones[k].tip;
        out.add(step::Cut{{tip.x, tip.y, to.z}, s.feed()}, out.copy_origin(path, i));
        out.add(step::Cut{to, s.feed()}, out.copy_origin(path, i));
      });
    here = to;
  }
  return out;
}

/// Removes from `unreached` what the tool cuts along the bones. False, with an error, if that fails.
bool remove_bones(Region& unreached, const std::vector<Bone>& bones, double radius, const CutOptions& cut,
                  Diagnostics& diagnostics) {
  if (bones.empty() || unreached.empty()) return true;
  const RegionOptions regions = region_options(cut);
  std::vector<Region> swept;
  for (const Bone& bone : bones) {
    auto one = buffer({bone.corner, {{bone.tip, {}}}}, mm(radius), PathEnds::round, regions, diagnostics);
    if (!one) return false;
    swept.push_back(std::move(*one));
  }
  const auto all = unite(swept, regions, diagnostics);
  auto left = all ? combine(unreached, *all, Boolean::subtract, regions, diagnostics) : std::nullopt;
  if (left) unreached = without_slivers(left->region, cut.tolerance.chord);
  return left.has_value();
}

}  // namespace

bool add_bones(Operation& made, const BoneWork& work, Diagnostics& diagnostics) {
  if (work.options.kind == BoneKind::none) return true;
  const CutOptions& cut = work.cut;
  std::vector<Bone> bones = bones_at(work, work.reach, cut.allowance);
  if (!remove_bones(made.unreached, bones, work.reach.radius - cut.allowance.mm(), cut, diagnostics))
    return false;
  if (work.finish > Length{}) {
    CutOptions rough = cut;
    rough.allowance = cut.allowance + work.finish;
    Diagnostics unused;  // the passes before have reported it
    if (const auto before = reach(work.region, work.tool, work.side, rough, unused))
      for (const Bone& bone : bones_at(work, *before, rough.allowance)) bones.push_back(bone);
  }
  if (bones.empty()) return true;
  made.path = with_bones(made.path, bones, cut);
  if (made.path.size() <= cut.max_steps) return true;
  return fail(cut, codes::op_limit, fmt::format("more than {} steps", cut.max_steps), diagnostics);
}

bool valid(const BoneOptions& options, const CutOptions& cut, Diagnostics& diagnostics) {
  OptionCheck check(cut, diagnostics);
  check.expect(options.angle.deg() > 0.0 && options.angle.deg() < 180.0, "angle of corners with bones",
               options.angle.deg(), "above 0 and below 180 degrees");
  return check.valid();
}

}  // namespace kerf::op_detail
