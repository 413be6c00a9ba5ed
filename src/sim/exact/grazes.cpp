// Contacts between columns. A query point lies on the surface of the tool, moved inwards by the depth below
// which contacts are ignored. It is in the material if it is inside the block and no earlier sweep contains
// it.
#include "sim/exact/grazes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "sim/cut/simulation_plan.h"
#include "sim/dexel/tile.h"
#include "sim/exact/sweep_distance.h"

namespace kerf {
namespace sim {
namespace {

constexpr int kSides = 16;      // directions examined around the tool along a motion
constexpr int kEndSides = 144;  // and at its ends, where the direction of the deepest contact is unknown
constexpr int kHalvings = 40;   // iterations of a search for a radius
constexpr double kAboveBottom = 1.5;  // depths; the surface moved inwards starts above one
constexpr int kBlockLevels = 4;       // heights between two heights of the profile
constexpr double kCovered = -1e-6;    // mm: points this far inside a sweep are removed

/// A sweep with the box around the tool along it.
struct PastSweep {
  Sweep sweep;
  Box3 box;  // block frame
};

/// A tool with the heights at which its radius is examined, mm above the tip.
struct GrazingTool {
  ToolDistance distance;
  ToolDistance flutes;  // extended upwards: what a shank that is not wider follows through
  std::vector<double> heights;
  std::array<double, 4> bottoms;  // of cutting, neck, shank, holder; above all if there is none

  explicit GrazingTool(const Silhouette& silhouette, double depth)
      : distance(silhouette), flutes(Silhouette{silhouette.cutting, {}, {}, {}}) {
    bottoms.fill(kAboveAll);
    const Silhouette whole = held(silhouette);
    const Profile* parts[] = {&whole.cutting, &whole.neck, &whole.shank, &whole.holder};
    for (std::size_t part = 0; part < 4; ++part) {
      if (parts[part]->empty()) continue;
      bottoms[part] = parts[part]->knots.front().z;
      for (const Knot& knot : parts[part]->knots) {
        heights.push_back(knot.z - depth);
        heights.push_back(knot.z + depth);
      }
    }
    std::sort(heights.begin(), heights.end());
  }

  /// The radius of the surface that is `depth` inside the tool at a height; 0 if there is none.
  double radius_at(double height, double depth) const {
    if (distance.at(0.0, height).value > -depth) return 0.0;
    double low = 0.0, high = distance.rim();
    for (int n = 0; n < kHalvings; ++n) {
      const double midpoint = 0.5 * (low + high);
      (distance.at(midpoint, height).value > -depth ? high : low) = midpoint;
    }
    return low;
  }
  ToolPart part_at(double height) const {
    std::size_t part = 0;
    for (std::size_t p = 1; p < 4; ++p)
      if (height >= bottoms[p]) part = p;
    return static_cast<ToolPart>(part);
  }
};

HazardKind kind_of(ToolPart part) {
  return part == ToolPart::neck    ? HazardKind::neck_contact
         : part == ToolPart::shank ? HazardKind::shank_contact
                                   : HazardKind::holder_contact;
}

double distance_to(const Sweep& sweep, const ToolDistance& tool, Point3 point) {
  if (is_level(sweep))
    return distance_to_level(tool, nearest_in_plan(sweep, point.xy()), sweep.z, point).value;
  return distance_along(sweep, tool, point, tool.rim()).distance.value;
}

class GrazeFinder {
 public:
  GrazeFinder(const Simulation& simulation, const GrazeOptions& options, Progress* progress)
      : simulation_(simulation),
        body_(simulation.workpiece.body()),
        size_(body_.bounds.size()),
        options_(options),
        depth_(options.depth.mm()),
        progress_(progress),
        of_tile_(body_.tiles.size()) {
    for (const Hazard& hazard : simulation.hazards) known_.emplace(hazard.step, hazard.kind);
    const Survey& survey = simulation.plan->survey;
    std::vector<const Silhouette*> silhouettes(survey.solids.size());
    for (const auto& [number, index] : survey.index)
      silhouettes[index] = &simulation.job.tools.find(number)->silhouette;
    for (const Silhouette* silhouette : silhouettes) tools_.emplace_back(*silhouette, depth_);
  }

  std::vector<Hazard> run();

 private:
  template <class Visit>
  void visit_batches(const Visit& visit);
  bool take(const Batch& batch);
  bool can_touch(const Sweep& sweep) const;
  void examine(const Sweep& sweep);
  void examine_position(const Sweep& sweep, Point3 tip, int sides);
  void examine_edges(const Sweep& sweep);
  void examine_point(const Sweep& sweep, Point3 tip, Point3 point);
  std::vector<double> levels(const Sweep& sweep, double tip) const;
  bool is_material(Point3 point);
  double height_of_material(Point3 point);
  void add(const Sweep& sweep, HazardKind kind, Point3 point, double lowest);
  std::size_t tile_of(Point3 point) const {
    const double per_tile = body_.pitch * kTileColumns;
    const int column = std::min(static_cast<int>(point.x / per_tile), body_.tiles_x - 1);
    const int row = std::min(static_cast<int>(point.y / per_tile), body_.tiles_y - 1);
    return static_cast<std::size_t>(row * body_.tiles_x + column);
  }
  bool is_in_block(Point3 p) const {
    return p.x > 0.0 && p.x < size_.x && p.y > 0.0 && p.y < size_.y && p.z > 0.0 && p.z < size_.z;
  }
  bool is_done() const {
    return computed_ >= options_.max_distances || past_.size() >= options_.max_sweeps ||
           stop_requested(progress_);
  }

  const Simulation& simulation_;
  const Workpiece::Body& body_;
  Point3 size_;
  const GrazeOptions& options_;
  double depth_;
  Progress* progress_;
  std::vector<GrazingTool> tools_;
  std::vector<PastSweep> past_;
  std::vector<std::vector<std::uint32_t>> of_tile_;  // numbers in past_
  std::size_t computed_ = 0;
  std::set<std::pair<std::uint32_t, HazardKind>> known_;
  std::vector<Hazard> found_;
};

/// Examines each sweep of a batch, then adds it to the past ones. False at the end of the search.
bool GrazeFinder::take(const Batch& batch) {
  std::vector<std::vector<std::uint32_t>> tiles_of(batch.sweeps.size());
  for (std::size_t k = 0; k < batch.busy.size(); ++k)
    for (std::size_t at = batch.start[k]; at < batch.start[k + 1]; ++at)
      tiles_of[batch.list[at]].push_back(batch.busy[k]);
  for (std::size_t n = 0; n < batch.sweeps.size(); ++n) {
    const Sweep& sweep = batch.sweeps[n];
    examine(sweep);
    if (is_done()) return false;
    PastSweep past{sweep, {}};
    const ToolDistance& tool = tools_[sweep.tool].distance;
    const double around = tool.rim() + (sweep.is_arc ? sweep.radius : 0.0);
    past.box.add(Point3{sweep.x, sweep.y, std::min(sweep.z, sweep.z_end) + tool.bottom()});
    if (!sweep.is_arc)
      past.box.add(Point3{sweep.x + sweep.length * sweep.ux, sweep.y + sweep.length * sweep.uy, size_.z});
    past.box.low = past.box.low - Point3{around, around, 0.0};
    past.box.high = past.box.high + Point3{around, around, size_.z};
    for (const std::uint32_t tile : tiles_of[n])
      of_tile_[tile].push_back(static_cast<std::uint32_t>(past_.size()));
    past_.push_back(past);
  }
  return true;
}

/// Heights of query points in the block, mm: on both sides of each height of the profile, and between.
/// Without the flutes for a sweep at feed.
std::vector<double> GrazeFinder::levels(const Sweep& sweep, double tip) const {
  const GrazingTool& tool = tools_[sweep.tool];
  const bool rapid = (sweep.passes & kPassRapid) != 0;
  const double lowest = tip + (rapid ? tool.distance.bottom()
                                     : *std::min_element(tool.bottoms.begin() + 1, tool.bottoms.end()));
  const double low = std::max(lowest + kAboveBottom * depth_, depth_), high = size_.z - depth_;
  if (low >= high) return {};
  std::vector<double> all;
  for (int k = 0; k <= kBlockLevels; ++k) all.push_back(low + k * (high - low) / kBlockLevels);
  for (const double height : tool.heights)
    if (tip + height > low && tip + height < high) all.push_back(tip + height);
  std::sort(all.begin(), all.end());
  return all;
}

/// Whether a sweep at rapid speed, or the part above its flutes, reaches below the top of the block.
bool GrazeFinder::can_touch(const Sweep& sweep) const {
  const bool rapid = (sweep.passes & kPassRapid) != 0;
  if (!rapid && (sweep.passes & (kPassNeck | kPassShank | kPassHolder)) == 0) return false;
  return !levels(sweep, std::min(sweep.z, sweep.z_end)).empty();
}

void GrazeFinder::examine(const Sweep& sweep) {
  if (!can_touch(sweep)) return;
  const double length = sweep.is_arc         ? std::abs(sweep.turn) * sweep.radius
                        : sweep.length > 0.0 ? sweep.length
                                             : std::abs(sweep.z_end - sweep.z);
  const int count = static_cast<int>(std::clamp(std::ceil(length / options_.spacing.mm()), 1.0, 1e6));
  for (int k = 0; k <= count && computed_ < options_.max_distances; ++k) {
    const double t = static_cast<double>(k) / count;
    Point3 tip{sweep.x, sweep.y, sweep.z + t * (sweep.z_end - sweep.z)};
    if (sweep.is_arc) {
      const double angle = std::atan2(sweep.uy, sweep.ux) + t * sweep.turn;
      tip = {sweep.x + sweep.radius * std::cos(angle), sweep.y + sweep.radius * std::sin(angle), sweep.z};
    } else {
      tip.x += t * sweep.length * sweep.ux;
      tip.y += t * sweep.length * sweep.uy;
    }
    examine_position(sweep, tip, k == 0 || k == count ? kEndSides : kSides);
  }
  examine_edges(sweep);
}

void GrazeFinder::examine_position(const Sweep& sweep, Point3 tip, int sides) {
  const GrazingTool& tool = tools_[sweep.tool];
  const double rim = tool.distance.rim();
  if (tip.x + rim < 0.0 || tip.x - rim > size_.x || tip.y + rim < 0.0 || tip.y - rim > size_.y) return;
  // The first direction is perpendicular to the motion; those parallel to the axes are always included.
  const double first = sweep.is_arc ? std::atan2(tip.y - sweep.y, tip.x - sweep.x)
                                    : std::atan2(sweep.uy, sweep.ux) + 0.5 * std::numbers::pi;
  for (const double z : levels(sweep, tip.z)) {
    const double radius = tool.radius_at(z - tip.z, depth_);
    if (!(radius > 0.0)) continue;
    const auto examine_direction = [&](double angle) {
      examine_point(sweep, tip, {tip.x + radius * std::cos(angle), tip.y + radius * std::sin(angle), z});
    };
    for (int n = 0; n < sides; ++n) examine_direction(first + 2.0 * std::numbers::pi * n / sides);
    for (int n = 0; n < 4; ++n) examine_direction(0.5 * std::numbers::pi * n);
  }
}

/// A vertical edge of the block may reach into the tool between two query points.
void GrazeFinder::examine_edges(const Sweep& sweep) {
  const GrazingTool& tool = tools_[sweep.tool];
  for (const double x : {depth_, size_.x - depth_})
    for (const double y : {depth_, size_.y - depth_}) {
      const Point2 nearest = nearest_in_plan(sweep, {x, y});
      if (std::hypot(nearest.x - x, nearest.y - y) > tool.distance.rim()) continue;
      const double along = (nearest.x - sweep.x) * sweep.ux + (nearest.y - sweep.y) * sweep.uy;
      const double tip = sweep.is_arc || !(sweep.length > 0.0) ? std::min(sweep.z, sweep.z_end)
                                                               : sweep.z + along * sweep.slope;
      for (const double z : levels(sweep, tip)) {
        ++computed_;
        if (distance_to(sweep, tool.distance, {x, y, z}) < kCovered)
          examine_point(sweep, {nearest.x, nearest.y, tip}, {x, y, z});
      }
    }
}

void GrazeFinder::examine_point(const Sweep& sweep, Point3 tip, Point3 point) {
  if (!is_in_block(point)) return;
  const bool rapid = (sweep.passes & kPassRapid) != 0;
  const ToolPart part = tools_[sweep.tool].part_at(point.z - tip.z);
  if (!rapid && part == ToolPart::cutting) return;
  const HazardKind kind = rapid ? HazardKind::rapid_in_stock : kind_of(part);
  if (known_.count({sweep.step, kind}) > 0) return;
  if (!rapid && distance_to(sweep, tools_[sweep.tool].flutes, point) < kCovered) return;
  if (is_material(point)) add(sweep, kind, point, tools_[sweep.tool].bottoms[static_cast<std::size_t>(part)]);
}

/// The latest sweeps are examined first: a point beside the path was most likely removed just before.
bool GrazeFinder::is_material(Point3 point) {
  const std::vector<std::uint32_t>& numbers = of_tile_[tile_of(point)];
  for (std::size_t n = numbers.size(); n-- > 0;) {
    const PastSweep& past = past_[numbers[n]];
    const Box3& box = past.box;
    if (point.x < box.low.x || point.x > box.high.x || point.y < box.low.y || point.y > box.high.y ||
        point.z < box.low.z)
      continue;
    ++computed_;
    if (distance_to(past.sweep, tools_[past.sweep.tool].distance, point) < kCovered) return false;
  }
  return true;
}

/// Height of the material above a point in it.
double GrazeFinder::height_of_material(Point3 point) {
  double low = point.z, high = size_.z;
  if (is_material({point.x, point.y, high - kCovered})) return high - low;
  for (int n = 0; n < kHalvings; ++n) {
    const double midpoint = 0.5 * (low + high);
    (is_material({point.x, point.y, midpoint}) ? low : high) = midpoint;
  }
  return low - point.z;
}

/// Both ends of a sweep, the lower one of a plunge.
std::vector<Point3> ends_of(const Sweep& s) {
  if (!s.is_arc && !(s.length > 0.0)) return {{s.x, s.y, std::min(s.z, s.z_end)}};
  if (!s.is_arc) return {{s.x, s.y, s.z}, {s.x + s.length * s.ux, s.y + s.length * s.uy, s.z_end}};
  std::vector<Point3> ends;
  for (const double t : {0.0, 1.0}) {
    const double angle = std::atan2(s.uy, s.ux) + t * s.turn;
    ends.push_back({s.x + s.radius * std::cos(angle), s.y + s.radius * std::sin(angle), s.z});
  }
  return ends;
}

/// `lowest`: the height of the part's lower end above the tip. The query points of a pointed tool are not at
/// its tip, so that the depth is also measured there.
void GrazeFinder::add(const Sweep& sweep, HazardKind kind, Point3 point, double lowest) {
  known_.emplace(sweep.step, kind);
  Hazard hazard;
  hazard.kind = kind;
  hazard.step = sweep.step;
  hazard.at = body_.bounds.low + point;
  double deepest = height_of_material(point);
  for (const Point3 end : ends_of(sweep)) {
    const Point3 below{end.x, end.y, std::max(end.z + lowest, 0.0) - kCovered};
    if (is_in_block(below) && is_material(below))
      deepest = std::max(deepest, height_of_material(below) - kCovered);
  }
  hazard.depth = mm(deepest);
  found_.push_back(hazard);
}

/// Calls visit(batch) for all batches, those that the simulation has kept or planned again, until it returns
/// false.
template <class Visit>
void GrazeFinder::visit_batches(const Visit& visit) {
  const Simulation::Plan& plan = *simulation_.plan;
  if (plan.batches.complete()) {
    for (const auto& batch : plan.batches.batches())
      if (!visit(*batch)) return;
    return;
  }
  const Toolpath& path = *simulation_.job.path;
  BatchSource source(body_, path, plan.survey,
                     {.plan = {.margin = body_.pitch},
                      .steps = {StepRange{0, path.size()}},
                      .hazard_depth = simulation_.job.options.hazard_depth});
  for (bool more = true; more;) {
    const auto batch = source.next();
    more = visit(*batch) && !batch->is_last;
  }
}

std::vector<Hazard> GrazeFinder::run() {
  if (progress_ != nullptr) progress_->phase("checking walls");
  bool any = false;  // most programs have no motion to be examined
  visit_batches([&](const Batch& batch) {
    any = std::any_of(batch.sweeps.begin(), batch.sweeps.end(), [&](const Sweep& s) { return can_touch(s); });
    return !any && !stop_requested(progress_);
  });
  if (any) visit_batches([&](const Batch& batch) { return take(batch); });
  return std::move(found_);
}

}  // namespace
}  // namespace sim

std::vector<Hazard> find_grazes(const Simulation& simulation, const GrazeOptions& options,
                                Progress* progress) {
  if (simulation.job.stock.body || simulation.workpiece.body().start || simulation.stopped) return {};
  return sim::GrazeFinder(simulation, options, progress).run();
}

}  // namespace kerf
