// The rules of the planner and the sorting of sweeps by tiles.
#include "sim/sweep/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/sweep/survey.h"

namespace kerf::sim {
namespace {

/// A batch is full with this many: enough for all threads, and bounded memory.
constexpr std::size_t kBatchSweeps = 1 << 14;
constexpr std::size_t kBatchPairs = 1 << 20;
/// Maximum number of chords per arc; only a radius of kilometres or thousands of turns would need more.
constexpr int kMaxChords = 1 << 20;
/// A straight motion shorter than this in plan is vertical, mm.
constexpr double kNoLength = 1e-6;
/// A level arc whose radii differ by less than this is a circular arc about its centre, mm.
constexpr double kSameRadius = 1e-4;
/// Level arcs with a larger radius become chords, as single precision about the centre does not suffice, mm.
constexpr double kLargestRadius = 1000.0;
constexpr double kSameLevel = 1e-9;  // mm
/// A line up to this many times the tool's reach is paired with all tiles of its bounds, hardly more than it
/// touches.
constexpr double kShort = 2.0;

double distance_to_interval(double v, double low, double high) { return std::max({low - v, v - high, 0.0}); }

/// The x range of a line where low <= y <= high; empty if there is none.
struct RangeInX {
  double low = 1.0, high = 0.0;
  bool empty() const { return low > high; }
};
RangeInX range_between(double x0, double y0, double x1, double y1, double y_low, double y_high) {
  double t0 = 0.0, t1 = 1.0;
  const double dy = y1 - y0;
  if (dy == 0.0) {
    if (y0 < y_low || y0 > y_high) return {};
  } else {
    const double a = (y_low - y0) / dy, b = (y_high - y0) / dy;
    t0 = std::max(0.0, std::min(a, b));
    t1 = std::min(1.0, std::max(a, b));
    if (t0 > t1) return {};
  }
  const double xa = x0 + t0 * (x1 - x0), xb = x0 + t1 * (x1 - x0);
  return {std::min(xa, xb), std::max(xa, xb)};
}

/// Tiles along one axis with column centres between two positions; clipped to the workpiece.
struct TileRange {
  int first = 0, last = -1;
};
TileRange tiles_between(double low, double high, double pitch, int columns, int tiles) {
  const double first_column = std::max(std::ceil(low / pitch - 0.5), 0.0);
  const double last_column = std::min(std::floor(high / pitch - 0.5), columns - 1.0);
  if (!(first_column <= last_column)) return {};
  return {static_cast<int>(first_column) / kTileColumns,
          std::min(static_cast<int>(last_column) / kTileColumns, tiles - 1)};
}

/// Sets the line of a sweep.
void set_line(Sweep& sweep, const Point3& from, const Point3& to) {
  sweep.x = from.x;
  sweep.y = from.y;
  sweep.z = from.z;
  sweep.z_end = to.z;
  const double dx = to.x - from.x, dy = to.y - from.y;
  const double dz = to.z - from.z, plan2 = dx * dx + dy * dy;
  const double length = std::sqrt(plan2);
  if (length < kNoLength) return;
  const double per_length = 1.0 / length;
  sweep.length = length;
  sweep.ux = dx * per_length;
  sweep.uy = dy * per_length;
  sweep.slope = dz * per_length;
  sweep.ball_lead = static_cast<float>(dz) / std::sqrt(static_cast<float>(plan2 + dz * dz));
}

/// Whether an arc becomes one sweep instead of chords.
bool is_level(const ArcWalk& walk) {
  if (walk.plane != Plane::xy || std::abs(walk.start_w - walk.end_w) > kSameLevel) return false;
  const double radius = 0.5 * (walk.start_radius + walk.end_radius);
  if (std::abs(walk.start_radius - walk.end_radius) > kSameRadius) return false;
  return radius <= kLargestRadius && radius >= kSameRadius;
}

/// Sets the level arc of a sweep.
void set_arc(Sweep& sweep, const ArcWalk& walk) {
  sweep.is_arc = true;
  sweep.x = walk.u;
  sweep.y = walk.v;
  sweep.z = sweep.z_end = walk.start_w;
  sweep.ux = std::cos(walk.start_angle);
  sweep.uy = std::sin(walk.start_angle);
  sweep.radius = 0.5 * (walk.start_radius + walk.end_radius);
  sweep.turn = walk.sweep;
  sweep.length = sweep.radius * std::abs(walk.sweep);
}

/// The largest radius of all parts.
double widest(const ToolSolids& tool) {
  double rim = std::max(tool.cutting.rim, tool.over_flute.rim);
  for (const Solid& part : tool.touching) rim = std::max(rim, part.rim);
  return rim;
}

}  // namespace

bool Batch::full() const { return sweeps.size() >= kBatchSweeps || pairs.size() >= kBatchPairs; }

void Batch::clear() {
  sweeps.clear();
  pairs.clear();
  beside.clear();
  contacts.clear();
}

void Batch::sort(std::size_t tiles) {
  count_.resize(tiles, 0);
  busy.clear();
  for (const Pair& pair : pairs)
    if (count_[pair.tile]++ == 0) busy.push_back(pair.tile);
  std::sort(busy.begin(), busy.end());
  start.assign(1, 0);
  for (const std::uint32_t tile : busy) {
    start.push_back(start.back() + count_[tile]);
    count_[tile] = static_cast<std::uint32_t>(start[start.size() - 2]);  // now where the next one goes
  }
  list.resize(pairs.size());
  for (const Pair& pair : pairs) list[count_[pair.tile]++] = pair.sweep;
  for (const std::uint32_t tile : busy) count_[tile] = 0;
  order.resize(busy.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const std::size_t na = start[a + 1] - start[a], nb = start[b + 1] - start[b];
    return na != nb ? na > nb : a < b;
  });
}

double bottom_of_others(const ToolSolids& tool) {
  double bottom = kAboveAll;
  for (const Solid* part : {&tool.over_flute, &tool.touching[1], &tool.touching[2], &tool.touching[3]})
    if (!part->empty()) bottom = std::min(bottom, part->bottom);
  return bottom;
}

ToolSolids make_tool_solids(const Silhouette& tool, Length side_clearance) {
  ToolSolids solids;
  solids.cutting = make_solid(tool.cutting, mm(kProfileChord), Length());
  const Silhouette whole = held(tool);
  const Profile* parts[] = {&whole.cutting, &whole.neck, &whole.shank, &whole.holder};
  for (int i = 0; i < 4; ++i) solids.touching[i] = make_solid(*parts[i], mm(kProfileChord), side_clearance);
  const double rim = radius_above_flutes(tool) - side_clearance.mm();
  if (rim > 0.0) solids.over_flute = make_cylinder(rim, solids.cutting.top, solids.cutting.top + kAboveAll);
  return solids;
}

ChordCount chord_count(const ArcWalk& walk) {
  const int count = walk.chords(mm(kPathChord), kMaxChords);
  return {count, count >= kMaxChords};
}

Planner::Planner(const Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth,
                 PlanScope scope, const Surroundings& surroundings)
    : body_(body),
      tools_(tools),
      hazard_depth_(hazard_depth.mm()),
      scope_(scope),
      rapid_rates_(surroundings.rapid_rates),
      floor_(-hazard_depth.mm() - surroundings.spoilboard.mm()),
      per_tile_(1.0 / (kTileColumns * body.pitch)),
      size_(body.bounds.size()) {
  for (const ToolSolids& tool : tools) extents_.push_back({widest(tool), bottom_of_others(tool)});
  const double side = kTileColumns * body.pitch;
  for (std::size_t tile = 0; scope_.tiles != nullptr && tile < scope_.tiles->size(); ++tile) {
    if (!(*scope_.tiles)[tile]) continue;
    const auto across = static_cast<std::size_t>(body.tiles_x);
    const Point3 corner{static_cast<double>(tile % across) * side, static_cast<double>(tile / across) * side,
                        0.0};
    wanted_.add(corner);
    wanted_.add(corner + Point3{side, side, 0.0});
  }
}

Planner::Motion Planner::motion_of(const Step& step, const MotionContext& context) const {
  Motion motion;
  motion.from = context.from - body_.bounds.low;
  motion.to = step.to() - body_.bounds.low;
  const unsigned start = context.unknown_from, end = step.unknown_axes();
  constexpr unsigned kZ = 4;
  if (!step.is_cutting()) {
    motion.is_swept = end == 0;
    if (start != 0) motion.from = motion.to;
    if ((start & kZ) != 0) motion.from.z = std::max(motion.to.z, size_.z);
    return motion;
  }
  if ((end & kZ) != 0) motion.is_swept = false;
  if ((start & kZ) != 0) motion.from.z = std::max(motion.to.z, size_.z);
  if (step.kind() == StepKind::arc) {
    if (!is_walked(context)) motion.from = motion.to;
    return motion;
  }
  if ((start & 1u) != 0) motion.from.x = motion.to.x;
  if ((start & 2u) != 0) motion.from.y = motion.to.y;
  return motion;
}

bool Planner::can_meet(const ArcWalk& walk, std::uint32_t tool) const {
  const double rim = extents_[tool].widest;
  const Box3 box = walk.bounds();
  return box.low.x < size_.x + rim && box.high.x > -rim && box.low.y < size_.y + rim && box.high.y > -rim &&
         box.low.z < size_.z;
}

/// Whether a straight motion neither reaches the wanted tiles nor cuts below the floor.
bool Planner::is_far(const Motion& motion, std::uint32_t tool) const {
  if (std::min(motion.from.z, motion.to.z) < -hazard_depth_) return false;
  const double reach = extents_[tool].widest + scope_.margin;
  return std::max(motion.from.x, motion.to.x) + reach < wanted_.low.x ||
         std::min(motion.from.x, motion.to.x) - reach > wanted_.high.x ||
         std::max(motion.from.y, motion.to.y) + reach < wanted_.low.y ||
         std::min(motion.from.y, motion.to.y) - reach > wanted_.high.y;
}

void Planner::skip(const Step& step, const MotionContext& context, std::uint32_t tool) {
  const Motion motion = motion_of(step, context);
  if (!motion.is_swept) return interrupt();
  remember(step, tool, motion.to);
}

void Planner::add(const Step& step, const MotionContext& context, std::uint32_t tool, bool spindle_off,
                  Batch& batch) {
  // Kept in locals: storing and loading a point per motion would cost a tenth of the time.
  Point3 from = context.from - body_.bounds.low, to = step.to() - body_.bounds.low;
  if ((context.unknown_from | step.unknown_axes()) != 0) {
    const Motion motion = motion_of(step, context);
    if (!motion.is_swept) return interrupt();
    from = motion.from;
    to = motion.to;
  }
  const bool cuts = step.is_cutting();
  const bool follows = cuts && cutting_tool_ == tool && end_ == from;
  const bool is_arc = step.kind() == StepKind::arc && is_walked(context);
  remember(step, tool, to);
  if (!is_arc && scope_.tiles != nullptr && is_far({from, to}, tool)) return;
  constexpr int kParts = kPassNeck | kPassShank | kPassHolder;
  static constexpr Sweep kNew;
  Sweep& sweep =
      batch.sweeps.emplace_back(kNew);  // constructed in place: copying what was just written would stall
  sweep.passes = static_cast<std::uint8_t>(
      cuts ? kPassCut | kPassOverFlute | kParts | (spindle_off ? kPassSpindleOff : 0) : kPassRapid | kParts);
  sweep.step = static_cast<std::uint32_t>(context.index);
  sweep.tool = tool;
  sweep.follows = follows;
  if (is_arc) return add_arc(step, context, batch);
  if (!cuts && rapid_rates_) return add_by_axis(from, to, batch);
  set_line(sweep, from, to);
  emit(to, batch);
}

/// A rapid whose axes move each at its own rate. The last sweep of the batch has all data but the geometry.
void Planner::add_by_axis(const Point3& from, const Point3& to, Batch& batch) {
  const Sweep like = batch.sweeps.back();
  batch.sweeps.pop_back();
  std::vector<RapidCorner> ends = corners_of_rapid(from, to, *rapid_rates_);
  ends.push_back({to, 1.0});
  RapidCorner last{from, 0.0};
  for (const RapidCorner& end : ends) {
    Sweep& part = batch.sweeps.emplace_back(like);
    part.start_fraction = static_cast<float>(last.fraction);
    part.end_fraction = static_cast<float>(end.fraction);
    set_line(part, last.at, end.at);
    emit(end.at, batch);
    last = end;
  }
}

/// The last sweep of the batch has all data but the geometry.
void Planner::add_arc(const Step& step, const MotionContext& context, Batch& batch) {
  ArcWalk walk = walk_of(step, context.from);
  const PlaneAxes axes = axes_of(walk.plane);
  walk.u -= body_.bounds.low[axes.u];
  walk.v -= body_.bounds.low[axes.v];
  walk.start_w -= body_.bounds.low[axes.w];
  walk.end_w -= body_.bounds.low[axes.w];
  const Sweep like = batch.sweeps.back();
  const bool meets = can_meet(walk, like.tool);
  if (meets && is_level(walk)) {
    batch.sweeps.back().follows = false;
    set_arc(batch.sweeps.back(), walk);
    return emit({}, batch);
  }
  batch.sweeps.pop_back();
  if (!meets) return;
  chords_ = {walk, like, 0, chord_count(walk).count, like.follows, step.is_cutting(), walk.at(0.0)};
  resume(batch);
}

void Planner::resume(Batch& batch) {
  Chords& c = chords_;
  for (; c.next < c.count && !batch.full(); ++c.next) {
    const auto fraction_at = [&](int k) { return static_cast<float>(k) / static_cast<float>(c.count); };
    const Point3 to = c.walk.at((c.next + 1.0) / c.count);
    Sweep& chord = batch.sweeps.emplace_back(c.like);
    chord.follows = c.next > 0 ? c.others_follow : c.first_follows;
    chord.start_fraction = fraction_at(c.next);
    chord.end_fraction = fraction_at(c.next + 1);
    set_line(chord, c.from, to);
    emit(to, batch);
    c.from = to;
  }
}

std::uint8_t Planner::passes_that_meet(const Sweep& sweep, double& reach) const {
  const ToolSolids& tool = tools_[sweep.tool];
  const int wanted = sweep.passes;
  const double low = std::min(sweep.z, sweep.z_end), high = std::max(sweep.z, sweep.z_end);
  int passes = wanted & kPassSpindleOff;
  const auto check = [&](int bit, const Solid& solid, double ignore) {
    if ((wanted & bit) == 0 || solid.empty()) return;
    if (low + solid.bottom >= size_.z - ignore || high + solid.top <= 0.0) return;
    passes |= bit;
    reach = std::max(reach, solid.rim);
  };
  check(kPassCut, tool.cutting, 0.0);
  check(kPassRapid, tool.touching[0], hazard_depth_);
  if (low + extents_[sweep.tool].other_bottom < size_.z - hazard_depth_) {
    check(kPassOverFlute, tool.over_flute, hazard_depth_);
    check(kPassNeck, tool.touching[1], hazard_depth_);
    check(kPassShank, tool.touching[2], hazard_depth_);
    check(kPassHolder, tool.touching[3], hazard_depth_);
  }
  // A rapid is marked as such even where the cutting part itself is clear.
  const int any = passes & ~kPassSpindleOff;
  if (any != 0 && (wanted & kPassRapid) != 0) passes |= kPassRapid;
  return any == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(passes);
}

void Planner::add(const Sweep& planned, Batch& batch) {
  batch.sweeps.push_back(planned);
  batch.sweeps.back().is_repeat = false;  // the earlier one may be in another batch
  const Point3 to{planned.x + planned.length * planned.ux, planned.y + planned.length * planned.uy,
                  planned.z_end};
  double reach = 0.0;
  passes_that_meet(planned, reach);
  if (!find_tiles(planned, to, reach + scope_.margin, batch)) batch.sweeps.pop_back();
}

/// Pairs the last sweep of the batch with its tiles, and removes it if there are none. `to`: end of a line.
void Planner::emit(const Point3& to, Batch& batch) {
  if (!find_pairs(batch.sweeps.back(), to, batch)) batch.sweeps.pop_back();
}

/// False if the sweep touches no tile.
bool Planner::find_pairs(Sweep& sweep, const Point3& to, Batch& batch) const {
  if ((sweep.passes & kPassCut) != 0 && std::min(sweep.z, sweep.z_end) < floor_)
    note_below_floor(sweep, batch);
  double reach = 0.0;
  sweep.passes = passes_that_meet(sweep, reach);
  if (sweep.passes == 0) return false;
  if (find_tiles(sweep, to, reach + scope_.margin, batch)) return true;
  const std::size_t pairs = batch.pairs.size();
  if (scope_.beside <= 0.0 || !find_tiles(sweep, to, reach + scope_.beside, batch)) return false;
  batch.pairs.resize(pairs);
  batch.beside.push_back({sweep, batch.sweeps.size() - 1});
  return false;
}

/// Pairs the last sweep of the batch with the tiles within `reach`; false if there are none.
bool Planner::find_tiles(const Sweep& sweep, const Point3& to, double reach, Batch& batch) const {
  const std::size_t before = batch.pairs.size();
  const auto number = static_cast<std::uint32_t>(batch.sweeps.size() - 1);
  if (sweep.is_arc) {
    pair_arc(sweep, reach, number, batch);
  } else {
    pair_line(sweep, to, reach, number, batch);
  }
  return batch.pairs.size() != before;
}

/// All tiles within `reach` of the bounds of a line.
void Planner::pair_box(const Sweep& s, const Point3& to, double reach, std::uint32_t number,
                       Batch& batch) const {
  const int left = std::max(tile_at(std::min(s.x, to.x) - reach), 0);
  const int right = std::min(tile_at(std::max(s.x, to.x) + reach), body_.tiles_x - 1);
  const int low = std::max(tile_at(std::min(s.y, to.y) - reach), 0);
  const int high = std::min(tile_at(std::max(s.y, to.y) + reach), body_.tiles_y - 1);
  for (int row = low; row <= high; ++row)
    for (int column = left; column <= right; ++column) pair(column, row, number, batch);
}

void Planner::pair_line(const Sweep& s, const Point3& to, double reach, std::uint32_t number,
                        Batch& batch) const {
  if (s.length <= kShort * reach) return pair_box(s, to, reach, number, batch);
  const TileRange rows = tiles_between(std::min(s.y, to.y) - reach, std::max(s.y, to.y) + reach, body_.pitch,
                                       body_.ny, body_.tiles_y);
  for (int row = rows.first; row <= rows.last; ++row) {
    const double low = (row * kTileColumns + 0.5) * body_.pitch - reach;
    const double high = ((row + 1) * kTileColumns - 0.5) * body_.pitch + reach;
    const RangeInX range = range_between(s.x, s.y, to.x, to.y, low, high);
    if (range.empty()) continue;
    const TileRange columns =
        tiles_between(range.low - reach, range.high + reach, body_.pitch, body_.nx, body_.tiles_x);
    for (int column = columns.first; column <= columns.last; ++column) pair(column, row, number, batch);
  }
}

void Planner::pair_arc(const Sweep& s, double reach, std::uint32_t number, Batch& batch) const {
  ArcWalk walk;
  walk.u = s.x;
  walk.v = s.y;
  walk.start_radius = walk.end_radius = s.radius;
  walk.start_angle = std::atan2(s.uy, s.ux);
  walk.sweep = s.turn;
  const Box3 box = walk.bounds();
  const TileRange rows =
      tiles_between(box.low.y - reach, box.high.y + reach, body_.pitch, body_.ny, body_.tiles_y);
  const TileRange columns =
      tiles_between(box.low.x - reach, box.high.x + reach, body_.pitch, body_.nx, body_.tiles_x);
  const double tile = kTileColumns * body_.pitch;
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const double x0 = column * tile, y0 = row * tile;
      const double near_to =
          std::hypot(distance_to_interval(s.x, x0, x0 + tile), distance_to_interval(s.y, y0, y0 + tile));
      const double far_from = std::hypot(std::max(std::abs(s.x - x0), std::abs(s.x - x0 - tile)),
                                         std::max(std::abs(s.y - y0), std::abs(s.y - y0 - tile)));
      if (near_to > s.radius + reach || far_from < s.radius - reach) continue;
      pair(column, row, number, batch);
    }
  }
}

void Planner::note_below_floor(const Sweep& s, Batch& batch) const {
  const Solid& solid = tools_[s.tool].cutting;
  const double deepest = std::min(s.z, s.z_end);
  const double reach = solid.reach_below(-deepest);
  // The fraction of the path below the floor, sampled in steps that are small against the tool.
  constexpr double kStep = 0.1;  // mm
  constexpr double kMaxSteps = 4096;
  const double slope = s.length > 0.0 ? (s.z_end - s.z) : 0.0;
  double start = 0.0, end = 1.0;
  if (slope < 0.0) start = std::clamp((floor_ - s.z) / slope, 0.0, 1.0);
  if (slope > 0.0) end = std::clamp((floor_ - s.z) / slope, 0.0, 1.0);
  const int steps = static_cast<int>(std::clamp(std::ceil((end - start) * s.length / kStep), 1.0, kMaxSteps));
  Contact contact;
  contact.step = s.step;
  contact.kind = HazardKind::below_floor;
  for (int k = 0; k <= steps; ++k) {
    const double t = start + (end - start) * k / steps;
    double x = s.x + t * s.length * s.ux, y = s.y + t * s.length * s.uy;
    if (s.is_arc) {
      const double c = std::cos(t * s.turn), d = std::sin(t * s.turn);
      x = s.x + s.radius * (s.ux * c - s.uy * d);
      y = s.y + s.radius * (s.ux * d + s.uy * c);
    }
    if (std::hypot(distance_to_interval(x, 0.0, size_.x), distance_to_interval(y, 0.0, size_.y)) >= reach)
      continue;
    const double z = s.length > 0.0 ? s.z + t * (s.z_end - s.z) : deepest;
    contact.depth = std::max(contact.depth, -z);
    if (contact.fraction <= 1.0) continue;
    contact.fraction =
        static_cast<double>(s.start_fraction) + t * static_cast<double>(s.end_fraction - s.start_fraction);
    contact.at = {std::clamp(x, 0.0, size_.x), std::clamp(y, 0.0, size_.y), z};
  }
  if (contact.fraction <= 1.0) batch.contacts.push_back(contact);
}

}  // namespace kerf::sim
