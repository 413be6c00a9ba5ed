// Balls over columns that start at the floor and lie one pitch apart, sixteen sweeps at a time: the finishing
// passes of reliefs. All pairs of a sweep and a micro are listed first, so that one loop without branches
// does the rest.
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

inline constexpr int kGroup = kLanes;  // sweeps, one bit of a mask each

/// Steeper paths use the general code, as their heights would be differences of numbers that grow with the
/// slope.
inline constexpr double kSteepest = 4;

/// The sweep of a ball relative to its start point: u runs along the path in plan, v across, z is the height
/// of the ball's centre. The supers of a tile, the micros of a super and the columns of a micro form the same
/// 4 x 4 pattern, four times as large each time.
struct BallSweep {
  Lanes u, v;              // columns of a micro, from its centre
  Lanes super_u, super_v;  // centres of the supers of the tile
  Lanes micro_u, micro_v;  // centres of the micros of a super
  Lanes taken;             // length of column
  Real length = 0, slope = 0;
  Real z_start = 0, z_end = 0;
  Real slant2 = 1;  // length along the path per mm in plan, squared
  Real lead2 = 0;   // Sweep::ball_lead squared, with the sign of ball_lead
  Real lowest = 0;  // minimum height of the centre
  Real behind = 0;  // everything before this u was cut by the previous sweep
  Real reach = 0;   // half extent of a square along u and v, per mm of half its side
  std::uint32_t step = 0;
  bool follows = false;
  bool to_floor = false;  // it may cut through to the floor
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

/// Data of a tile that all sweeps of a group use.
struct BallTile {
  HWY_INLINE BallTile(const TileJob& job, const LaneCap& cap)
      : centre_x(job.x + 31.5 * job.field->pitch),
        centre_y(job.y + 31.5 * job.field->pitch),
        radius(std::sqrt(cap.radius2)),
        range(kTileColumns * job.field->pitch + static_cast<double>(radius)),
        centre_z(static_cast<double>(cap.centre_z)),
        floor(radius + 2 * job.field->same_height),
        x((load(kColumn) - 1.5f) * job.field->step[1]),
        y((load(kRow) - 1.5f) * job.field->step[1]) {}

  double centre_x, centre_y;
  Real radius;
  double range;     // farther path ends reach no column
  double centre_z;  // of the ball, above the tip
  Real floor;       // below this height of its centre a ball may cut through
  Vector x, y;      // the pattern of a micro
};

/// Selects the sweeps of a tool that this code can cut in a tile. Only such sweeps form a group, so that the
/// result of a sweep does not depend on the others.
struct BallFilter {
  HWY_INLINE BallFilter(const TileJob& job, const LaneSolid& solid)
      : is_ball(solid.is_ball),
        lowest(static_cast<double>(job.field->height) - static_cast<double>(solid.top)) {}
  HWY_INLINE bool accepts(const Sweep& sweep) const {
    return is_ball && std::abs(sweep.slope) <= kSteepest && std::min(sweep.z, sweep.z_end) >= lowest;
  }
  bool is_ball;
  double lowest;  // minimum tip height at which the solid reaches above the block
};

/// Whether the columns of a tile are one pitch apart and have only ever had an interval at the floor.
HWY_INLINE bool is_plain(const TileJob& job) {
  return job.points == nullptr && job.position_x == nullptr && !job.tile->was_undercut;
}

/// Rotates the pattern of the tile into the frame of the sweep.
HWY_INLINE void rotate_pattern(BallSweep& ball, const Sweep& sweep, const BallTile& tile, double along,
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
  const double x = tile.centre_x - sweep.x, y = tile.centre_y - sweep.y;
  const double across = y * sweep.ux - x * sweep.uy;
  double along = x * sweep.ux + y * sweep.uy, skipped = 0, length = sweep.length;
  if (HWY_UNLIKELY(length > tile.range)) {  // keeps numbers small
    skipped = std::clamp(along - tile.range, 0.0, length);
    along -= skipped;
    length = std::clamp(along + tile.range, 0.0, length - skipped);
  }
  const double z = sweep.z + sweep.slope * skipped + tile.centre_z;
  ball.length = static_cast<Real>(length);
  ball.slope = static_cast<Real>(sweep.slope);
  ball.z_start = static_cast<Real>(z);
  ball.z_end = static_cast<Real>(z + sweep.slope * length);
  ball.follows = sweep.follows;
  if (HWY_UNLIKELY(sweep.length == 0)) {  // vertical: nothing was cut before
    ball.z_start = ball.z_end = static_cast<Real>(std::min(sweep.z, sweep.z_end) + tile.centre_z);
    ball.follows = false;
  }
  ball.lowest = lower_real(ball.z_start, ball.z_end);
  ball.slant2 = 1 + ball.slope * ball.slope;
  ball.lead2 = sweep.ball_lead * std::abs(sweep.ball_lead);
  ball.step = sweep.step;
  ball.to_floor = ball.lowest < tile.floor;
  // Columns farther back are lowest above the start point, where the previous sweep ended.
  const Real lead = lower_real(sweep.ball_lead, 0) * tile.radius;
  ball.behind = ball.follows ? lead - static_cast<Real>(skipped) : -kFar;
  rotate_pattern(ball, sweep, tile, along, across);
  store(0, ball.taken);
}

/// Cuts one micro with one sweep. The ball is lowest above a column where its centre is ahead of it by the
/// lead, clamped to the path. Squares decide which of start, path and end applies, as a root accepts as long
/// as ten other operations. What a following sweep touches at its start has been cut already.
HWY_INLINE void cut_with_ball(BallSweep& ball, int inner, Real radius2, Real same, Lanes& tops,
                              std::uint32_t* steps, Lanes& taken) {
  const Vector u = load(ball.u) + ball.micro_u[inner], v = load(ball.v) + ball.micro_v[inner];
  const Vector across = radius2 - v * v, beyond = u - ball.length;
  const Vector lead2 = ball.lead2 * across;
  const Vector u2 = u * absolute(u), beyond2 = beyond * absolute(beyond);
  const Mask at_end = beyond2 > lead2;
  Vector down2 = select(at_end, across - absolute(beyond2), ball.slant2 * across);
  Vector centre = select(at_end, ball.z_end, ball.z_start + ball.slope * u);
  if (!ball.follows) {
    const Mask at_start = u2 < lead2;
    down2 = select(at_start, across - absolute(u2), down2);
    centre = select(at_start, ball.z_start, centre);
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

/// Square blocks of columns, 2 `half` wide and centred at (u, v), that a ball can touch, given their highest
/// material.
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

/// Lists the micros of a super that the given sweeps (bits) can touch. Returns the micros touched by any.
HWY_INLINE Mask list_pairs(BallGroup& group, const TileJob& job, int super, unsigned sweeps) {
  const Vector top = load(job.tile->micro_top + super * kSupers);
  const Real half = 1.5f * job.field->step[1];
  Mask touched = no_lane();
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
    touched = touched | micros;
  }
  return touched;
}

/// Cuts one super with the given sweeps (bits) of the group.
HWY_NOINLINE void balls_over_super(BallGroup& group, const TileJob& job, int super, unsigned sweeps) {
  Tile& tile = *job.tile;
  const int first = super * kSupers;
  const Mask touched = list_pairs(group, job, super, sweeps);
  const Real same = job.field->same_height, radius2 = group.radius2;
  for (int n = 0, count = group.pairs.count; n < count; ++n) {
    const std::uint32_t pair = group.pairs.pair[n];
    const auto inner = static_cast<int>(pair % kSupers);
    BallSweep& ball = group.ball[pair / kSupers];
    cut_with_ball(ball, inner, radius2, same, tile.top[first + inner], tile.top_step[first + inner],
                  ball.taken);
  }
  for (unsigned rest = bits_of(touched); rest != 0; rest &= rest - 1) {
    const int micro = first + __builtin_ctz(rest);
    tile.micro_top[micro] = highest_of(load(tile.top[micro]));
  }
  tile.super_top[super] = highest_of(load(tile.micro_top + first));
}

/// Cuts with `count` sweeps of the job's list, starting at number `first`.
HWY_NOINLINE void cut_balls(BallGroup& group, const TileJob& job, const LaneCap& cap, std::size_t first,
                            int count) {
  Tile& tile = *job.tile;
  const Field& field = *job.field;
  group.radius2 = cap.radius2;
  const BallTile around(job, cap);
  alignas(64) std::uint32_t supers[kGroup] = {};
  unsigned touched = 0;
  for (int k = 0; k < count; ++k) {
    BallSweep& ball = group.ball[k];
    prepare_ball(ball, around, job.sweeps[job.list[first + static_cast<std::size_t>(k)]]);
    supers[k] = bits_of(cull_ball(ball, load(ball.super_u), load(ball.super_v), 7.5f * field.step[1],
                                  load(tile.super_top), group.radius2));
    touched |= supers[k];
  }
  for (; touched != 0; touched &= touched - 1) {
    const int super = __builtin_ctz(touched);
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
