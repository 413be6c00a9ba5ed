// Sixteen sweeps at a time on one tile: the cuts that only cut. What each micro keeps stays in registers
// while the sweeps that can meet it pass, in order of time, so that the result is that of one sweep after the
// other.
#if defined(KERF_SIM_GROUPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_GROUPS_INL_H
#undef KERF_SIM_GROUPS_INL_H
#else
#define KERF_SIM_GROUPS_INL_H
#endif

#include <algorithm>

#include "sim/balls-inl.h"
#include "sim/passes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

struct GroupWork {
  explicit GroupWork(const TileJob& tile_job) : job(tile_job) {}

  const TileJob& job;
  const LaneSolid* solid = nullptr;
  int count = 0;
  bool all_open = true;   // the solid reaches above the block in all sweeps
  bool one_level = true;  // all are level at one height
  View view[kGroup];
  bool open[kGroup];
  std::uint32_t step[kGroup];
  Lanes taken[kGroup];                       // length of column, weighted
  alignas(64) std::uint32_t micros[kGroup];  // of one super, one bit each
  BallGroup balls;
};

HWY_INLINE void add_taken(GroupWork& work, int k, Vector weighted) {
  store(load(work.taken[k]) + weighted, work.taken[k]);
}

/// A ball over columns that stand on the floor, where balls-inl.h will not do: steep paths, uneven columns.
HWY_NOINLINE void ball_micro(GroupWork& work, int micro, unsigned sweeps) {
  const TileJob& job = work.job;
  Tile& tile = *job.tile;
  const LaneCap& ball = work.solid->pieces[0].lower;
  const Real same = job.field->same_height;
  const MicroPlaces places = places_of(job, micro);
  const Vector weight = weights_of(job, micro);
  Vector top = load(tile.top[micro]);
  Ids ids = load_ids(tile.top_step[micro]);
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    const View& w = work.view[k];
    const Vector x = w.x + places.x, y = w.y + places.y;
    const Vector u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
    const Vector across = ball.radius2 - v * v;
    Vector t = u;
    if (w.slope != 0) t = u - w.ball_lead * root(across);
    t = clamped(t, w.t_low, w.t_high);
    const Vector rest = across - square(u - t);
    const Vector centre = w.slope * t + (w.z + ball.centre_z);
    const Vector low = centre - root(rest);
    const Vector left = only(low >= same, low);
    const Mask cut = (rest > 0) & (left + same < top);
    const Vector now = select(cut, left, top);
    ids = select(cut, all_ids(work.step[k]), ids);
    add_taken(work, k, (top - now) * weight);
    top = now;
  }
  store(top, tile.top[micro]);
  store_ids(ids, tile.top_step[micro]);
  tile.micro_top[micro] = highest_of(top);
}

/// Columns that a cylinder of the first of the sweeps covers at its begin, where the sweep before has been.
HWY_INLINE Mask covered_before(const View& w, const MicroPlaces& places, Real rim2) {
  if (!w.level_follow) return no_lane();
  const Vector x = w.x + places.x - w.t_low * w.cx, y = w.y + places.y - w.t_low * w.cy;
  return x * x + y * y < rim2;
}

/// Of one cylinder of a tool: the number of the sweep of a group that is the first over each column; kGroup
/// where none is, or where the sweep before all of them has been.
struct Cover {
  HWY_INLINE Cover() {}  // the one that the compiler makes would be for no level of processor
  Ids first;
};

/// Finds which sweep is the first over each column, for all cylinders of a tool at once: the latest sweep
/// first, so that the others only have to take columns over.
template <int kPieces>
HWY_INLINE void cover_columns(const GroupWork& work, const MicroPlaces& places, unsigned sweeps,
                              Cover* covers) {
  const LanePiece* pieces = work.solid->pieces.data();
  const View& earliest = work.view[__builtin_ctz(sweeps)];
  Ids first[kPieces];
  Real rim2[kPieces];
  for (int p = 0; p < kPieces; ++p) {
    first[p] = all_ids(kGroup);
    rim2[p] = pieces[p].rim2;
  }
  while (sweeps != 0) {
    const unsigned k = 31u - static_cast<unsigned>(__builtin_clz(sweeps));
    sweeps ^= 1u << k;
    const View& w = work.view[k];
    const Vector distance2 = line_distance2(w, w.x + places.x, w.y + places.y);
    for (int p = 0; p < kPieces; ++p) first[p] = select(distance2 < rim2[p], all_ids(k), first[p]);
  }
  for (int p = 0; p < kPieces; ++p)
    covers[p].first = select(covered_before(earliest, places, rim2[p]), all_ids(kGroup), first[p]);
}
HWY_INLINE void cover_all_columns(const GroupWork& work, const MicroPlaces& places, unsigned sweeps,
                                  Cover* covers) {
  static_assert(kFewPieces == 4);
  switch (work.solid->pieces.size()) {
    case 1: return cover_columns<1>(work, places, sweeps, covers);
    case 2: return cover_columns<2>(work, places, sweeps, covers);
    case 3: return cover_columns<3>(work, places, sweeps, covers);
    default: return cover_columns<4>(work, places, sweeps, covers);
  }
}

/// Cylinders that move at one height: whichever sweep is the first over a column takes all that any of them
/// takes.
HWY_NOINLINE void cover_micro(GroupWork& work, int micro, unsigned sweeps) {
  const TileJob& job = work.job;
  const Field& field = *job.field;
  const Vector weight = weights_of(job, micro);
  const Real z = work.view[0].z_low;
  Cover covers[kFewPieces];
  cover_all_columns(work, places_of(job, micro), sweeps, covers);
  for (std::size_t p = 0; p < work.solid->pieces.size(); ++p) {
    const LanePiece& piece = work.solid->pieces[p];
    const Ids first = covers[p].first;
    const unsigned by = bits_named(first) & ~(1u << kGroup);
    if (by == 0) continue;
    Ids step = all_ids(0);
    for (unsigned rest = by; rest != 0; rest &= rest - 1) {
      const int k = __builtin_ctz(rest);
      step = select(first == all_ids(static_cast<unsigned>(k)), all_ids(work.step[k]), step);
    }
    const Real high = !work.solid->one_envelope ? z - piece.upper.height
                      : work.all_open           ? field.height + 1
                                                : z + work.solid->top;
    const Vector low = select(first == all_ids(kGroup), kFar, z + piece.lower.height);
    const Vector taken = take(*job.tile, micro, low, high, step, field.same_height) * weight;
    for (unsigned rest = by; rest != 0; rest &= rest - 1) {
      const int k = __builtin_ctz(rest);
      add_taken(work, k, only(first == all_ids(static_cast<unsigned>(k)), taken));
    }
  }
}

/// Any solid over any columns.
HWY_NOINLINE void any_micro(GroupWork& work, int micro, unsigned sweeps) {
  const TileJob& job = work.job;
  const Field& field = *job.field;
  const MicroPlaces places = places_of(job, micro);
  const Vector weight = weights_of(job, micro);
  const std::size_t groups = work.solid->one_envelope ? 1 : work.solid->pieces.size();
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    const View& w = work.view[k];
    const MicroView m = look_at(w, places);
    for (std::size_t g = 0; g < groups; ++g) {
      Swept swept;
      sweep_over(*work.solid, g, work.open[k], field.height + 1, w, m, swept);
      const Vector taken =
          take(*job.tile, micro, load(swept.low), load(swept.high), all_ids(work.step[k]), field.same_height);
      add_taken(work, k, taken * weight);
    }
  }
}

HWY_NOINLINE void group_super(GroupWork& work, int super, unsigned sweeps) {
  const TileJob& job = work.job;
  Tile& tile = *job.tile;
  const int first = super * kSupers;
  const Blocks blocks = micros_of(job, super);
  unsigned met = 0;
  std::fill_n(work.micros, kGroup, 0u);
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    work.micros[k] =
        cull(work.view[k], *work.solid, blocks, tile.micro_top + first, tile.micro_bottom + first);
    met |= work.micros[k];
  }
  if (met == 0) return;
  for (; met != 0; met &= met - 1) {
    const int inner = __builtin_ctz(met), micro = first + inner;
    const unsigned which = lanes_with(work.micros, 1u << inner);
    if (work.solid->is_ball && work.all_open && tile.chain[micro] < 0) {
      ball_micro(work, micro, which);
    } else if (work.solid->is_cylinders && work.one_level && work.solid->pieces.size() <= kFewPieces) {
      cover_micro(work, micro, which);
    } else {
      any_micro(work, micro, which);
    }
  }
  update_super(tile, super);
}

HWY_INLINE void add_sweep(GroupWork& work, const Sweep& sweep) {
  const int k = work.count++;
  View& view = work.view[k];
  set_view(sweep, work.job, view);
  work.open[k] = view.z_low + work.solid->top >= work.job.field->height;
  prepare_for(view, sweep, *work.solid, Follow::yes, work.open[k]);
  work.step[k] = sweep.step;
  work.all_open = work.all_open && work.open[k];
  work.one_level = work.one_level && view.z_low == work.view[0].z_low && view.z_high == view.z_low;
  store(0, work.taken[k]);
}

/// What comes after a group is fetched while the group is cut: the sweeps of one tile lie far apart.
HWY_INLINE void fetch_ahead(const TileJob& job, std::size_t next) {
  const std::size_t end = std::min(job.count, next + kGroup);
  for (; next < end; ++next) {
    const auto* sweep = reinterpret_cast<const char*>(job.sweeps + job.list[next]);
    __builtin_prefetch(sweep);
    __builtin_prefetch(sweep + sizeof(Sweep) - 1);
  }
}

/// Cuts with sweeps number `first` to `first + count - 1` of the job's list.
HWY_NOINLINE void cut_group(GroupWork& work, std::size_t first, int count) {
  const TileJob& job = work.job;
  fetch_ahead(job, first + static_cast<std::size_t>(count));
  work.solid = &(*job.tools)[job.sweeps[job.list[first]].tool].cutting;
  if (is_plain(job) && is_quick_ball(job, job.sweeps[job.list[first]]))
    return cut_balls(work.balls, job, work.solid->pieces[0].lower, first, count);
  work.count = 0;
  work.all_open = work.one_level = true;
  for (int k = 0; k < count; ++k) add_sweep(work, job.sweeps[job.list[first + static_cast<std::size_t>(k)]]);
  Tile& tile = *job.tile;
  alignas(64) std::uint32_t supers[kGroup] = {};
  unsigned met = 0;
  const Blocks blocks = supers_of(job);
  for (int k = 0; k < count; ++k) {
    supers[k] = cull(work.view[k], *work.solid, blocks, tile.super_top, tile.super_bottom);
    met |= supers[k];
  }
  for (; met != 0; met &= met - 1) {
    const int super = __builtin_ctz(met);
    group_super(work, super, lanes_with(supers, 1u << super));
  }
  for (int k = 0; k < count; ++k)
    job.removed[first + static_cast<std::size_t>(k)] = static_cast<double>(sum_of(load(work.taken[k])));
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
