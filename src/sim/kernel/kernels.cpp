// Sweeps against columns, 16 at a time: `cut_tile` for each processor level, and the choice at run time.
#include <algorithm>

// Excluded: levels that are hardly faster than those below them, as each costs a compilation, and SVE, whose
// vectors have no size at compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/kernel/kernels.cpp"
#include <hwy/foreach_target.h>  // NOLINT: this file again, once per level
#include <hwy/highway.h>

#include "sim/kernel/cylinders-inl.h"
#include "sim/kernel/groups-inl.h"
#include "sim/kernel/kernels.h"
#include "sim/kernel/steps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kerf::sim::HWY_NAMESPACE {
namespace {

/// Whether a sweep can be part of a group.
HWY_INLINE bool only_cuts(const Sweep& sweep) { return sweep.passes == kPassCut && !sweep.is_arc; }

/// The number of sweeps from `first` on that form a group: they only cut, with one tool and the same code.
HWY_INLINE int group_size(const TileJob& job, std::size_t first) {
  const std::size_t limit = std::min(first + kGroup, job.count);
  const Sweep& sweep = job.sweeps[job.list[first]];
  const BallFilter ball(job, (*job.tools)[sweep.tool].cutting);
  const bool may_be_level = may_be_level_cylinders((*job.tools)[sweep.tool].cutting);
  const bool is_quick = ball.accepts(sweep);
  std::size_t end = first + 1;
  for (; end < limit; ++end) {
    const Sweep& next = job.sweeps[job.list[end]];
    if (!only_cuts(next) || next.tool != sweep.tool || (may_be_level && next.z == next.z_end) ||
        ball.accepts(next) != is_quick)
      break;
  }
  return static_cast<int>(end - first);
}

}  // namespace

void cut_tile(const TileJob& job) {
  GroupWork work(job);
  CylinderGroup cylinders;
  for (std::size_t q = 0; q < job.count;) {
    const Sweep& sweep = job.sweeps[job.list[q]];
    if (!only_cuts(sweep)) {
      job.removed[q++] = cut_sweep(job, sweep);
      continue;
    }
    if (is_level_cylinders(job, sweep)) {
      q += cut_cylinders(cylinders, job, q, job.count - q);
      continue;
    }
    const int count = group_size(job, q);
    cut_group(work, q, count);
    q += static_cast<std::size_t>(count);
  }
}

void find_steps(const StepRules& rules, const WindowLengths& lengths, std::vector<ColumnStep>& out) {
  // Along X the last examined column has no step; it would lead out of the examined columns.
  constexpr int kFirst = kRing - 1, kLast = kWindow - kRing;
  for (int y = kFirst; y <= kLast; ++y) {
    const Real* row = lengths[y];
    const auto at = [&](int x) { return load(row + x); };
    for (int x = kFirst; x < kLast; x += kLanes) {
      const int k = std::min(x, kLast - kLanes);
      add_steps(excess_of(rules, at(k - 1), at(k), at(k + 1), at(k + 2)), k, y, StepAxis::along_x, out);
    }
    if (y == kLast) break;
    const auto next = [&](int x, int rows) { return load(row + x + rows * kWindow); };
    for (int x = kFirst; x <= kLast; x += kLanes) {
      const int k = std::min(x, kLast + 1 - kLanes);
      add_steps(excess_of(rules, next(k, -1), next(k, 0), next(k, 1), next(k, 2)), k, y, StepAxis::along_y,
                out);
    }
  }
}

}  // namespace kerf::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kerf::sim {
namespace {

HWY_EXPORT(cut_tile);
HWY_EXPORT(find_steps);

LaneCap lane_cap(const Cap& cap) {
  const auto real = [](double v) { return static_cast<Real>(v); };
  return {cap.curve,       real(cap.flat),     real(cap.flat * cap.flat), real(cap.height),
          real(cap.slope), real(cap.centre_r), real(cap.centre_z),        real(cap.radius * cap.radius)};
}

/// The rim reaches the equator, so that it does not clip the ball.
bool is_half_ball(const LanePiece& piece) {
  return piece.lower.curve == CapCurve::ball && piece.lower.flat == 0 && piece.rim2 >= piece.lower.radius2;
}

}  // namespace

LaneSolid::LaneSolid(const Solid& solid)
    : one_envelope(solid.one_envelope),
      rim(static_cast<Real>(solid.rim)),
      bottom(static_cast<Real>(solid.bottom)),
      top(static_cast<Real>(solid.top)) {
  for (const ConvexPiece& piece : solid.pieces) {
    const auto r = static_cast<Real>(piece.rim);
    pieces.push_back(
        {r, static_cast<Real>(piece.rim * piece.rim), lane_cap(piece.lower), lane_cap(piece.upper)});
  }
  is_ball = one_envelope && pieces.size() == 1 && is_half_ball(pieces[0]);
  is_cylinders =
      std::all_of(pieces.begin(), pieces.end(), [](const LanePiece& p) { return p.is_cylinder(); });
  lid.rim = rim;
  lid.rim2 = rim * rim;
  lid.upper.height = -top;
  for (int i = 0; i < kCullLines; ++i) {
    offset[i] = static_cast<Real>(solid.lines[i].offset);
    slope[i] = static_cast<Real>(solid.lines[i].slope);
  }
  is_flat = is_cylinders && std::all_of(slope, slope + kCullLines, [](Real v) { return v == 0; });
}

LaneTool::LaneTool(const ToolSolids& tool) : cutting(tool.cutting), over_flute(tool.over_flute) {
  for (const Solid& solid : tool.touching) touching.emplace_back(solid);
}

namespace {

/// Cuts with the sweeps that do not repeat others.
void cut_without_repeats(TileJob job) {
  std::vector<std::uint32_t> list;
  std::vector<std::size_t> at;
  for (std::size_t k = 0; k < job.count; ++k) {
    job.removed[k] = 0.0;
    if (job.sweeps[job.list[k]].is_repeat) continue;
    list.push_back(job.list[k]);
    at.push_back(k);
  }
  if (list.empty()) return;
  std::vector<double> removed(list.size(), 0.0);
  double* const all = job.removed;
  job.list = list.data();
  job.count = list.size();
  job.removed = removed.data();
  HWY_DYNAMIC_DISPATCH(cut_tile)(job);
  for (std::size_t k = 0; k < at.size(); ++k) all[at[k]] = removed[k];
}

}  // namespace

void cut_tile(const TileJob& job) {
  const auto is_repeat = [&job](std::uint32_t sweep) { return job.sweeps[sweep].is_repeat; };
  if (std::any_of(job.list, job.list + job.count, is_repeat)) {
    cut_without_repeats(job);
  } else {
    HWY_DYNAMIC_DISPATCH(cut_tile)(job);
  }
  job.tile->pack_slots();
}

void find_steps(const StepRules& rules, const WindowLengths& lengths, std::vector<ColumnStep>& out) {
  HWY_DYNAMIC_DISPATCH(find_steps)(rules, lengths, out);
}

}  // namespace kerf::sim
#endif
