// Sixteen sweeps at a time on one tile, for sweeps that only cut. The columns of a micro stay in registers
// while the sweeps that can touch it are applied in time order, so that the result is that of one sweep after
// another.
#if defined(KERF_SIM_GROUPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_GROUPS_INL_H
#undef KERF_SIM_GROUPS_INL_H
#else
#define KERF_SIM_GROUPS_INL_H
#endif

#include <algorithm>

#include "sim/kernel/balls-inl.h"
#include "sim/kernel/passes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

struct GroupWork {
  explicit GroupWork(const TileJob& tile_job) : job(tile_job) {}

  const TileJob& job;
  const LaneSolid* solid = nullptr;
  int count = 0;
  bool all_open = true;  // the solid reaches above the block in all sweeps
  LocalSweep view[kGroup];
  bool open[kGroup];
  std::uint32_t step[kGroup];
  Lanes taken[kGroup];                       // length of column, weighted
  alignas(64) std::uint32_t micros[kGroup];  // of one super, one bit each
  BallGroup balls;
};

HWY_INLINE void add_taken(GroupWork& work, int k, Vector weighted) {
  store(load(work.taken[k]) + weighted, work.taken[k]);
}

/// A ball over columns that start at the floor, for the cases that balls-inl.h excludes: steep paths, uneven
/// columns.
HWY_NOINLINE void ball_micro(GroupWork& work, int micro, unsigned sweeps) {
  const TileJob& job = work.job;
  Tile& tile = *job.tile;
  const LaneCap& ball = work.solid->pieces[0].lower;
  const Real same = job.field->same_height;
  const MicroPositions positions = positions_of(job, micro);
  const Vector weight = weights_of(job, micro);
  Vector top = load(tile.top[micro]);
  Ids ids = load_ids(tile.top_step[micro]);
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    const LocalSweep& w = work.view[k];
    const Vector x = w.x + positions.x, y = w.y + positions.y;
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

/// Any solid over any columns.
HWY_NOINLINE void any_micro(GroupWork& work, int micro, unsigned sweeps) {
  const TileJob& job = work.job;
  const Field& field = *job.field;
  const MicroPositions positions = positions_of(job, micro);
  const Vector weight = weights_of(job, micro);
  const std::size_t groups = work.solid->one_envelope ? 1 : work.solid->pieces.size();
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    const LocalSweep& w = work.view[k];
    const MicroView m = view_micro(w, positions);
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
  unsigned touched = 0;
  std::fill_n(work.micros, kGroup, 0u);
  for (; sweeps != 0; sweeps &= sweeps - 1) {
    const int k = __builtin_ctz(sweeps);
    work.micros[k] =
        cull(work.view[k], *work.solid, blocks, tile.micro_top + first, tile.micro_bottom + first);
    touched |= work.micros[k];
  }
  if (touched == 0) return;
  for (; touched != 0; touched &= touched - 1) {
    const int inner = __builtin_ctz(touched), micro = first + inner;
    const unsigned which = lanes_with(work.micros, 1u << inner);
    if (work.solid->is_ball && work.all_open && tile.chain[micro] < 0) {
      ball_micro(work, micro, which);
    } else {
      any_micro(work, micro, which);
    }
  }
  update_super(tile, super);
}

HWY_INLINE void add_sweep(GroupWork& work, const Sweep& sweep) {
  const int k = work.count++;
  LocalSweep& view = work.view[k];
  set_local_sweep(sweep, work.job, view);
  work.open[k] = view.z_low + work.solid->top >= work.job.field->height;
  prepare_for(view, sweep, *work.solid, Follow::yes, work.open[k]);
  work.step[k] = sweep.step;
  work.all_open = work.all_open && work.open[k];
  store(0, work.taken[k]);
}

/// Prefetches the next group while this one is cut: the sweeps of one tile are scattered in memory.
HWY_INLINE void fetch_ahead(const TileJob& job, std::size_t next) {
  const std::size_t end = std::min(job.count, next + kGroup);
  for (; next < end; ++next) {
    const auto* sweep = reinterpret_cast<const char*>(job.sweeps + job.list[next]);
    __builtin_prefetch(sweep);
    __builtin_prefetch(sweep + sizeof(Sweep) - 1);
  }
}

/// Cuts with sweeps `first` to `first + count - 1` of the job's list.
HWY_NOINLINE void cut_group(GroupWork& work, std::size_t first, int count) {
  const TileJob& job = work.job;
  fetch_ahead(job, first + static_cast<std::size_t>(count));
  work.solid = &(*job.tools)[job.sweeps[job.list[first]].tool].cutting;
  if (is_plain(job) && BallFilter(job, *work.solid).accepts(job.sweeps[job.list[first]]))
    return cut_balls(work.balls, job, work.solid->pieces[0].lower, first, count);
  work.count = 0;
  work.all_open = true;
  for (int k = 0; k < count; ++k) add_sweep(work, job.sweeps[job.list[first + static_cast<std::size_t>(k)]]);
  Tile& tile = *job.tile;
  alignas(64) std::uint32_t supers[kGroup] = {};
  unsigned touched = 0;
  const Blocks blocks = supers_of(job);
  for (int k = 0; k < count; ++k) {
    supers[k] = cull(work.view[k], *work.solid, blocks, tile.super_top, tile.super_bottom);
    touched |= supers[k];
  }
  for (; touched != 0; touched &= touched - 1) {
    const int super = __builtin_ctz(touched);
    group_super(work, super, lanes_with(supers, 1u << super));
  }
  for (int k = 0; k < count; ++k)
    job.removed[first + static_cast<std::size_t>(k)] = static_cast<double>(sum_of(load(work.taken[k])));
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
