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

#include "sim/cull-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

inline constexpr int kGroup = kLanes;  // sweeps: one bit of a mask each

/// Steeper paths go another way: along them heights are differences of numbers that grow with the slope.
inline constexpr double kSteepest = 4;

/// A ball's sweep, seen from its begin: u runs along the path in plan, v across, z is the ball's centre.
struct BallSweep {
  Lanes u, v;              // of a micro's columns from its middle
  Lanes micro_u, micro_v;  // of the middles of a super's micros
  Lanes taken;             // length of column
  Real begin = 0;          // along the path from the view's origin
  Real length = 0, slope = 0;
  Real z_begin = 0, z_end = 0;
  Real slant2 = 1;  // length along the path a mm in plan, squared
  Real lead2 = 0;   // View::ball_lead squared, with its sign
  Real behind = 0;
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

/// Whether a sweep goes this way where the tile allows it. Only such sweeps share a group, so that how a
/// sweep is cut does not depend on the others.
HWY_INLINE bool is_quick_ball(const TileJob& job, const Sweep& sweep) {
  const LaneSolid& solid = (*job.tools)[sweep.tool].cutting;
  return solid.is_ball && std::abs(sweep.slope) <= kSteepest &&
         std::min(sweep.z, sweep.z_end) + static_cast<double>(solid.top) >=
             static_cast<double>(job.field->height);
}

/// Whether the columns of a tile are a pitch apart and stand on the floor.
HWY_INLINE bool is_plain(const TileJob& job) {
  return job.points == nullptr && job.place_x == nullptr && job.tile->slots.size() == 0;
}

HWY_INLINE void prepare_ball(BallSweep& ball, const View& w, const LaneCap& cap, const Field& field,
                             const Sweep& sweep) {
  const Real pitch = field.step[1];
  const Real centre_z = cap.centre_z, radius = std::sqrt(cap.radius2);
  const Vector x = (load(kColumn) - 1.5f) * pitch, y = (load(kRow) - 1.5f) * pitch;
  store(x * w.cx + y * w.cy, ball.u);
  store(y * w.cx - x * w.cy, ball.v);
  store(0, ball.taken);
  // Ends that no column of the tile can see are brought nearer, so that numbers stay small.
  const Real sight = kTileColumns * pitch + 2 * radius;
  const Real begin = std::max(w.t_low, -sight), end = std::min(w.t_high, sight);
  ball.begin = begin;
  ball.length = end - begin;
  ball.slope = w.slope;
  ball.z_begin = w.z + w.slope * begin + centre_z;
  ball.z_end = w.z + w.slope * end + centre_z;
  ball.slant2 = 1 + w.slope * w.slope;
  ball.lead2 = w.ball_lead * std::abs(w.ball_lead);
  ball.behind = w.behind - begin;
  ball.step = sweep.step;
  ball.to_floor = w.z_low + centre_z - radius < 2 * field.same_height;
  ball.follows = sweep.follows && sweep.length > 0;  // straight down what follows is all new
}

/// Cuts one micro with one sweep. The ball touches a column deepest where it is ahead of it by its lead, but
/// not before its begin or beyond its end; which of the three is told by squares, since a root takes as long
/// as ten other operations. What a sweep that follows another touches at its begin is cut already.
HWY_INLINE void cut_with_ball(BallSweep& ball, int inner, Real radius2, Real same, Lanes& tops,
                              std::uint32_t* steps) {
  const Vector u = load(ball.u) + ball.micro_u[inner], v = load(ball.v) + ball.micro_v[inner];
  const Vector across = radius2 - v * v, beyond = u - ball.length;
  const Vector lead2 = ball.lead2 * across;
  const Vector u2 = u * absolute(u), beyond2 = beyond * absolute(beyond);
  const Mask at_begin = u2<lead2, at_end = beyond2> lead2;
  Vector down2 = select(at_end, across - absolute(beyond2), ball.slant2 * across);
  Vector centre = select(at_end, ball.z_end, ball.z_begin + ball.slope * u);
  if (!ball.follows) {
    down2 = select(at_begin, across - absolute(u2), down2);
    centre = select(at_begin, ball.z_begin, centre);
  }
  Vector low = centre - root_or_nan(down2);
  if (ball.to_floor) low = select(low < same, 0, low);
  const Vector top = load(tops);
  Mask cut = low + same < top;
  if (ball.follows) cut = cut & ~at_begin;
  const Vector now = select(cut, low, top);
  store(now, tops);
  store_ids(select(cut, all_ids(ball.step), load_ids(steps)), steps);
  store(load(ball.taken) + (top - now), ball.taken);
}

/// Square blocks of columns that a ball can meet, given their highest material, and where their middles are.
HWY_INLINE Mask cull_ball(const BallSweep& ball, const View& w, const Blocks& b, Vector top, Real radius2,
                          Vector& u, Vector& v) {
  const Vector reach = b.half_x * (std::abs(w.cx) + std::abs(w.cy));
  const Vector x = w.x + b.x, y = w.y + b.y;
  u = x * w.cx + y * w.cy - ball.begin;
  v = y * w.cx - x * w.cy;
  const Vector du = higher_of(outside(u, 0, ball.length) - reach, 0);
  const Vector dv = higher_of(absolute(v) - reach, 0);
  const Vector over = higher_of(std::min(ball.z_begin, ball.z_end) - top, 0);
  return (radius2 - du * du - dv * dv > over * over) & (u + reach > ball.behind);
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

/// Cuts one super with those sweeps of the group whose bits are set.
HWY_NOINLINE void balls_over_super(BallGroup& group, const View* view, const TileJob& job, int super,
                                   unsigned sweeps) {
  Tile& tile = *job.tile;
  const int first = super * kSupers;
  const Blocks blocks = micros_of(job, super);
  const Vector top = load(tile.micro_top + first);
  Mask met = no_lane();
  group.pairs.count = 0;
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    BallSweep& ball = group.ball[k];
    Vector u, v;
    const Mask micros = cull_ball(ball, view[k], blocks, top, group.radius2, u, v);
    store(u, ball.micro_u);
    store(v, ball.micro_v);
    add_pairs(group.pairs, k, micros);
    met = met | micros;
  }
  const Real same = job.field->same_height;
  for (int n = 0; n < group.pairs.count; ++n) {
    const std::uint32_t pair = group.pairs.pair[n];
    const auto inner = static_cast<int>(pair % kSupers);
    cut_with_ball(group.ball[pair / kSupers], inner, group.radius2, same, tile.top[first + inner],
                  tile.top_step[first + inner]);
  }
  for (unsigned rest = bits_of(met); rest != 0; rest &= rest - 1) {
    const int micro = first + __builtin_ctz(rest);
    tile.micro_top[micro] = highest_of(load(tile.top[micro]));
  }
  tile.super_top[super] = highest_of(load(tile.micro_top + first));
}

/// Cuts with `count` sweeps of the job's list from number `first` on, given their views.
HWY_NOINLINE void cut_balls(BallGroup& group, const View* view, const TileJob& job, const LaneCap& cap,
                            std::size_t first, int count) {
  Tile& tile = *job.tile;
  group.radius2 = cap.radius2;
  alignas(64) std::uint32_t supers[kGroup] = {};
  unsigned met = 0;
  const Blocks blocks = supers_of(job);
  for (int k = 0; k < count; ++k) {
    BallSweep& ball = group.ball[k];
    prepare_ball(ball, view[k], cap, *job.field, job.sweeps[job.list[first + static_cast<std::size_t>(k)]]);
    Vector u, v;
    supers[k] = bits_of(cull_ball(ball, view[k], blocks, load(tile.super_top), group.radius2, u, v));
    met |= supers[k];
  }
  for (; met != 0; met &= met - 1) {
    const int super = __builtin_ctz(met);
    balls_over_super(group, view, job, super, lanes_with(supers, 1u << super));
  }
  for (int k = 0; k < count; ++k)
    job.removed[first + static_cast<std::size_t>(k)] = static_cast<double>(sum_of(load(group.ball[k].taken)));
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
