// One sweep on one tile with all its tests: level arcs, rapids, shanks and holders near material. All other
// sweeps use the faster groups-inl.h.
#if defined(KERF_SIM_PASSES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef KERF_SIM_PASSES_INL_H
#undef KERF_SIM_PASSES_INL_H
#else
#define KERF_SIM_PASSES_INL_H
#endif

#include "sim/kernel/cull-inl.h"
#include "sim/kernel/hazard_passes.h"
#include "sim/kernel/take-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {

/// Positions of the columns of a micro from the first column of the tile.
struct MicroPositions {
  Vector x, y;
};
HWY_INLINE MicroPositions positions_of(const TileJob& job, int micro) {
  if (job.points != nullptr) {
    const PointMicro& points = job.points->micros[static_cast<std::size_t>(micro)];
    return {load(points.x), load(points.y)};
  }
  const Field& field = *job.field;
  const int column = column_of(micro), row = row_of(micro);
  if (job.position_x == nullptr)
    return {field.step[column] + load(kColumn) * field.step[1], field.step[row] + load(kRow) * field.step[1]};
  Lanes x, y;
  for (int i = 0; i < kLanes; ++i) {
    x[i] = job.position_x[column + i % 4];
    y[i] = job.position_y[row + i / 4];
  }
  return {load(x), load(y)};
}

HWY_INLINE MicroView view_micro(const LocalSweep& w, const MicroPositions& positions) {
  MicroView m{w.x + positions.x, w.y + positions.y, {}, {}};
  if (w.slope == 0) {
    m.v2 = path_distance2(w, m.x, m.y);
  } else {
    m.u = m.x * w.cx + m.y * w.cy;
    m.v2 = square(m.y * w.cx - m.x * w.cy);
  }
  return m;
}

HWY_INLINE Vector weights_of(const TileJob& job, int micro) {
  if (job.points != nullptr) return load(job.points->micros[static_cast<std::size_t>(micro)].weight);
  if (job.fraction_x == nullptr) return 1;
  const int column = column_of(micro), row = row_of(micro);
  Lanes weight;
  for (int i = 0; i < kLanes; ++i) weight[i] = job.fraction_x[column + i % 4] * job.fraction_y[row + i / 4];
  return load(weight);
}

/// One pass of a sweep over a tile.
struct PassWork {
  const TileJob& job;
  const Sweep& sweep;
  const Pass& pass;
  LocalSweep view;
  bool open = false;  // the solid reaches above the block along the whole sweep
  double taken = 0.0;
  Contact contact = {};
};

/// Records contacts and leaves in `low` and `high` what is to be removed.
HWY_NOINLINE void note_micro(PassWork& work, int micro, const MicroView& m, Vector& low, Vector& high) {
  MicroContact columns;
  columns.micro = micro;
  store(m.x, columns.x);
  store(m.y, columns.y);
  store(weights_of(work.job, micro), columns.weight);
  store(low, columns.low);
  store(high, columns.high);
  note_contacts(work.job, work.sweep, work.view, work.pass, columns, work.contact);
  low = load(columns.low);
  high = load(columns.high);
}

HWY_NOINLINE void cut_micro(PassWork& work, int micro) {
  const TileJob& job = work.job;
  const Field& field = *job.field;
  const LaneSolid& solid = *work.pass.solid;
  const MicroView m = view_micro(work.view, positions_of(job, micro));
  const std::size_t groups = solid.one_envelope ? 1 : solid.pieces.size();
  for (std::size_t g = 0; g < groups; ++g) {
    Swept swept;
    sweep_over(solid, g, work.open, field.height + 1, work.view, m, swept);
    Vector low = load(swept.low), high = load(swept.high);
    if (work.pass.is_hazard) note_micro(work, micro, m, low, high);
    const Vector taken = take(*job.tile, micro, low, high, all_ids(work.sweep.step), field.same_height);
    work.taken += static_cast<double>(sum_of(taken * weights_of(job, micro)));
  }
}

/// Recomputes the highest and lowest material of a super.
HWY_INLINE void update_super(Tile& tile, int super) {
  tile.super_top[super] = highest_of(load(tile.micro_top + super * kSupers));
  tile.super_bottom[super] = lowest_of(load(tile.micro_bottom + super * kSupers));
}

HWY_NOINLINE void run_pass(PassWork& work) {
  const LaneSolid& solid = *work.pass.solid;
  if (solid.pieces.empty()) return;
  Tile& tile = *work.job.tile;
  prepare_for(work.view, work.sweep, solid, work.pass.is_hazard ? Follow::no : Follow::yes, work.open);
  unsigned supers = cull(work.view, solid, supers_of(work.job), tile.super_top, tile.super_bottom);
  for (; supers != 0; supers &= supers - 1) {
    const int super = __builtin_ctz(supers);
    const int first = super * kSupers;
    unsigned micros =
        cull(work.view, solid, micros_of(work.job, super), tile.micro_top + first, tile.micro_bottom + first);
    if (micros == 0) continue;
    for (; micros != 0; micros &= micros - 1) cut_micro(work, first + __builtin_ctz(micros));
    update_super(tile, super);
  }
}

/// All passes of a sweep. Returns the length of column removed.
HWY_NOINLINE double cut_sweep(const TileJob& job, const Sweep& sweep) {
  LocalSweep view;
  set_local_sweep(sweep, job, view);
  const PassList list = list_passes(sweep, (*job.tools)[sweep.tool], job.field->hazard_depth);
  double taken = 0.0;
  for (int k = 0; k < list.count; ++k) {
    const Pass& pass = list.pass[k];
    PassWork work{job, sweep, pass, view, view.z_low + pass.solid->top >= job.field->height};
    work.contact.step = sweep.step;
    work.contact.kind = pass.kind;
    run_pass(work);
    if (pass.is_hazard) keep_contact(job, pass, work.contact);
    taken += work.taken;
  }
  return taken;
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
