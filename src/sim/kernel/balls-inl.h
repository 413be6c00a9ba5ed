// Balls over columns that stand on the floor a pitch apart, sixteen sweeps at a time: what reliefs are made
// of. All pairs of a sweep and a micro are listed first, so that one loop without branches does the rest.
#if defined(KERF_SIM_BALLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_BALLS_INL_H
#undef KERF_SIM_BALLS_INL_H
#else
#define KERF_SIM_BALLS_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "sim/kernel/cull-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

inline constexpr int kGroup = kLanes;  // sweeps: one bit of a mask each

/// Steeper paths go another way: along them heights are differences of numbers that grow with the slope.
inline constexpr double kSteepest = 4;

/// A ball's sweep, seen from its begin: u runs along the path in plan, v across, z is the ball's centre. A
/// tile's supers, a super's micros and a micro's columns are one pattern of 4 x 4 places, four times as large
/// each time.
struct BallSweep {
  Lanes u, v;              // of a micro's columns from its middle
  Lanes super_u, super_v;  // of the middles of the tile's supers
  Lanes micro_u, micro_v;  // of the middles of a super's micros
  Lanes taken;             // length of column
  Real length = 0, slope = 0;
  Real z_begin = 0, z_end = 0;
  Real slant2 = 1;  // length along the path a mm in plan, squared
  Real lead2 = 0;   // Sweep::ball_lead squared, with its sign
  Real lowest = 0;  // of the centre
  Real behind = 0;  // all before this was cut by the sweep before
  Real reach = 0;   // from a square's middle to its border along u and v, a mm of half its side
  std::uint32_t step = 0;
  bool follows = false;
  bool to_floor = false;  // it may cut through
};

/// Pairs of a sweep and a micro of one super, in order of time.
struct BallPairs {
  alignas(64) std::uint32_t pair[kGroup * kSupers + kLanes];
  int count = 0;
};

struct BallGroup {
  BallSweep ball[kGroup];
  BallPairs pairs;
  Real radius2 = 0;
};

/// What all sweeps of a group share.
struct BallTile {
  HWY_INLINE BallTile(const TileJob& job, const LaneCap& cap)
      : middle_x(job.x + 31.5 * job.field->pitch),
        middle_y(job.y + 31.5 * job.field->pitch),
        radius(std::sqrt(cap.radius2)),
        sight(kTileColumns * job.field->pitch + static_cast<double>(radius)),
        centre_z(static_cast<double>(cap.centre_z)),
        floor(radius + 2 * job.field->same_height),
        x((load(kColumn) - 1.5f) * job.field->step[1]),
        y((load(kRow) - 1.5f) * job.field->step[1]) {}

  double middle_x, middle_y;
  Real radius;
  double sight;     // ends of paths that are further away along the path are seen by no column
  double centre_z;  // of the ball, above the tip
  Real floor;       // a ball with its centre below this may cut through
  Vector x, y;      // the places of the pattern, the least ones
};

/// Which sweeps of a tool go this way where the tile allows it. Only such sweeps share a group, so that how a
/// sweep is cut does not depend on the others.
struct BallWay {
  HWY_INLINE BallWay(const TileJob& job, const LaneSolid& solid)
      : is_ball(solid.is_ball),
        lowest(static_cast<double>(job.field->height) - static_cast<double>(solid.top)) {}
  HWY_INLINE bool takes(const Sweep& sweep) const {
    return is_ball && std::abs(sweep.slope) <= kSteepest && std::min(sweep.z, sweep.z_end) >= lowest;
  }
  bool is_ball;
  double lowest;  // of a tip whose solid reaches above the block
};

/// Whether the columns of a tile are a pitch apart and have always stood on the floor.
HWY_INLINE bool is_plain(const TileJob& job) {
  return job.points == nullptr && job.place_x == nullptr && !job.tile->was_undercut;
}

/// Where the tile is: the pattern of its places turned to the sweep's path.
HWY_INLINE void place_tile(BallSweep& ball, const Sweep& sweep, const BallTile& tile, double along,
                           double across) {
  const Real cx = static_cast<Real>(sweep.ux), cy = static_cast<Real>(sweep.uy);
  const Vector u = tile.x * cx + tile.y * cy, v = tile.y * cx - tile.x * cy;
  store(u, ball.u);
  store(v, ball.v);
  store(u * 16.0f + static_cast<Real>(along), ball.super_u);
  store(v * 16.0f + static_cast<Real>(across), ball.super_v);
  ball.reach = std::abs(cx) + std::abs(cy);
}

HWY_INLINE void prepare_ball(BallSweep& ball, const BallTile& tile, const Sweep& sweep) {
  const double x = tile.middle_x - sweep.x, y = tile.middle_y - sweep.y;
  const double across = y * sweep.ux - x * sweep.uy;
  double along = x * sweep.ux + y * sweep.uy, left_out = 0, length = sweep.length;
  if (HWY_UNLIKELY(length > tile.sight)) {  // so that numbers stay small
    left_out = std::clamp(along - tile.sight, 0.0, length);
    along -= left_out;
    length = std::clamp(along + tile.sight, 0.0, length - left_out);
  }
  const double z = sweep.z + sweep.slope * left_out + tile.centre_z;
  ball.length = static_cast<Real>(length);
  ball.slope = static_cast<Real>(sweep.slope);
  ball.z_begin = static_cast<Real>(z);
  ball.z_end = static_cast<Real>(z + sweep.slope * length);
  ball.follows = sweep.follows;
  if (HWY_UNLIKELY(sweep.length == 0)) {  // straight up or down: what follows is all new
    ball.z_begin = ball.z_end = static_cast<Real>(std::min(sweep.z, sweep.z_end) + tile.centre_z);
    ball.follows = false;
  }
  ball.lowest = lower_real(ball.z_begin, ball.z_end);
  ball.slant2 = 1 + ball.slope * ball.slope;
  ball.lead2 = sweep.ball_lead * std::abs(sweep.ball_lead);
  ball.step = sweep.step;
  ball.to_floor = ball.lowest < tile.floor;
  // The lowest point above what lies further back is the begin, where the sweep before has ended.
  const Real lead = lower_real(sweep.ball_lead, 0) * tile.radius;
  ball.behind = ball.follows ? lead - static_cast<Real>(left_out) : -kFar;
  place_tile(ball, sweep, tile, along, across);
  store(0, ball.taken);
}

/// Cuts one micro with one sweep. The ball touches a column deepest where it is ahead of it by its lead, but
/// not before its begin or beyond its end; which of the three is told by squares, since a root takes as long
/// as ten other operations. What a sweep that follows another touches at its begin is cut already.
HWY_INLINE void cut_with_ball(BallSweep& ball, int inner, Real radius2, Real same, Lanes& tops,
                              std::uint32_t* steps, Lanes& taken) {
  const Vector u = load(ball.u) + ball.micro_u[inner], v = load(ball.v) + ball.micro_v[inner];
  const Vector across = radius2 - v * v, beyond = u - ball.length;
  const Vector lead2 = ball.lead2 * across;
  const Vector u2 = u * absolute(u), beyond2 = beyond * absolute(beyond);
  const Mask at_end = beyond2 > lead2;
  Vector down2 = select(at_end, across - absolute(beyond2), ball.slant2 * across);
  Vector centre = select(at_end, ball.z_end, ball.z_begin + ball.slope * u);
  if (!ball.follows) {
    const Mask at_begin = u2 < lead2;
    down2 = select(at_begin, across - absolute(u2), down2);
    centre = select(at_begin, ball.z_begin, centre);
  }
  Vector low = centre - root_or_nan(down2);
  if (ball.to_floor) low = select(low < same, 0, low);
  const Vector top = load(tops), depth = top - low;
  Mask cut = depth > same;
  if (ball.follows) cut = cut & (u2 >= lead2);
  store(select(cut, low, top), tops);
  store_where(cut, ball.step, steps);
  const Vector sum = load(taken);
  store(select(cut, sum + depth, sum), taken);
}

/// Square blocks of columns, 2 `half` wide with their middles at (u, v), that a ball can meet, given their
/// highest material.
HWY_INLINE Mask cull_ball(const BallSweep& ball, Vector u, Vector v, Real half, Vector top, Real radius2) {
  const Real reach = half * ball.reach;
  const Vector du = u - clamped(u, -reach, ball.length + reach);
  const Vector dv = higher_of(absolute(v) - reach, 0);
  const Vector over = higher_of(ball.lowest - top, 0);
  return (radius2 - du * du - dv * dv > over * over) & (u > ball.behind - reach);
}

HWY_INLINE void add_pairs(BallPairs& pairs, int sweep, Mask micros) {
  alignas(64) static constexpr std::uint32_t kNumbers[kSupers] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                                  8, 9, 10, 11, 12, 13, 14, 15};
  const auto first = hn::Set(IdTag(), static_cast<std::uint32_t>(sweep * kSupers));
  for (int p = 0; p < kParts; ++p) {
    const auto mask = hn::RebindMask(IdTag(), micros.part[p]);
    const auto numbers = hn::Add(first, hn::Load(IdTag(), kNumbers + p * kWidth));
    hn::StoreU(hn::Compress(numbers, mask), IdTag(), pairs.pair + pairs.count);
    pairs.count += static_cast<int>(hn::CountTrue(IdTag(), mask));
  }
}

/// Lists which micros of a super the sweeps whose bits are set can meet. Returns those that any can.
HWY_INLINE Mask list_pairs(BallGroup& group, const TileJob& job, int super, unsigned sweeps) {
  const Vector top = load(job.tile->micro_top + super * kSupers);
  const Real half = 1.5f * job.field->step[1];
  Mask met = no_lane();
  group.pairs.count = 0;
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    BallSweep& ball = group.ball[k];
    const Vector u = load(ball.u) * 4.0f + ball.super_u[super];
    const Vector v = load(ball.v) * 4.0f + ball.super_v[super];
    store(u, ball.micro_u);
    store(v, ball.micro_v);
    const Mask micros = cull_ball(ball, u, v, half, top, group.radius2);
    add_pairs(group.pairs, k, micros);
    met = met | micros;
  }
  return met;
}

/// Cuts one super with those sweeps of the group whose bits are set.
HWY_NOINLINE void balls_over_super(BallGroup& group, const TileJob& job, int super, unsigned sweeps) {
  Tile& tile = *job.tile;
  const int first = super * kSupers;
  const Mask met = list_pairs(group, job, super, sweeps);
  const Real same = job.field->same_height, radius2 = group.radius2;
  for (int n = 0, count = group.pairs.count; n < count; ++n) {
    const std::uint32_t pair = group.pairs.pair[n];
    const auto inner = static_cast<int>(pair % kSupers);
    BallSweep& ball = group.ball[pair / kSupers];
    cut_with_ball(ball, inner, radius2, same, tile.top[first + inner], tile.top_step[first + inner],
                  ball.taken);
  }
  for (unsigned rest = bits_of(met); rest != 0; rest &= rest - 1) {
    const int micro = first + __builtin_ctz(rest);
    tile.micro_top[micro] = highest_of(load(tile.top[micro]));
  }
  tile.super_top[super] = highest_of(load(tile.micro_top + first));
}

/// Cuts with `count` sweeps of the job's list from number `first` on.
HWY_NOINLINE void cut_balls(BallGroup& group, const TileJob& job, const LaneCap& cap, std::size_t first,
                            int count) {
  Tile& tile = *job.tile;
  const Field& field = *job.field;
  group.radius2 = cap.radius2;
  const BallTile around(job, cap);
  alignas(64) std::uint32_t supers[kGroup] = {};
  unsigned met = 0;
  for (int k = 0; k < count; ++k) {
    BallSweep& ball = group.ball[k];
    prepare_ball(ball, around, job.sweeps[job.list[first + static_cast<std::size_t>(k)]]);
    supers[k] = bits_of(cull_ball(ball, load(ball.super_u), load(ball.super_v), 7.5f * field.step[1],
                                  load(tile.super_top), group.radius2));
    met |= supers[k];
  }
  for (; met != 0; met &= met - 1) {
    const int super = __builtin_ctz(met);
    balls_over_super(group, job, super, lanes_with(supers, 1u << super));
  }
  for (int k = 0; k < count; ++k) {
    const BallSweep& ball = group.ball[k];
    job.removed[first + static_cast<std::size_t>(k)] = static_cast<double>(sum_of(load(ball.taken)));
  }
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
