// The rotary simulator: motions become pieces, which slabs of the bar are cut with in time order, several
// slabs in parallel; then the cells at walls are measured.
#include "kerf/sim/rotary.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/sim.h"
#include "base/number.h"
#include "base/parallel.h"
#include "sim/rotary/rotary_motions.h"
#include "sim/rotary/rotary_slab.h"
#include "sim/rotary/rotary_walls.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace sim {
namespace {

/// Number of rays at the default distance: a motion along a small bar takes hundredths of a second. Bars that
/// need more at the coarsest usual distance have at most kMaxUsualRays, whose mesh takes 2 GB of memory.
constexpr double kUsualRays = 1e5, kMaxUsualRays = 4e6;
constexpr double kMaxRays = 5e7;                   // at any distance; they take 3 GB of memory
constexpr double kFinest = 0.02, kCoarsest = 1.0;  // mm, of the default distance of rays
constexpr double kMinSpacing = 1e-3;               // mm, of any distance
constexpr int kSlabRows = 8;                       // rays along the bar per slab

/// The bar before the first cut; nothing, with an error appended, if it is invalid.
std::optional<RotaryWorkpiece> make_bar(const RoundBar& bar, const SimulationOptions& options,
                                        Diagnostics& diagnostics) {
  const double size = bar.x_high - bar.x_low, girth = std::numbers::pi * bar.diameter;
  if (!(bar.diameter > 0.0) || !(size > 0.0) || !(bar.diameter <= limits::kMaxBarSize) ||
      !(size <= limits::kMaxBarSize) ||
      !(std::abs(bar.x_low) + std::abs(bar.axis_y) + std::abs(bar.axis_z) < kMaxReach)) {
    diagnostics.error(codes::stock_empty, {}, "the bar has no volume, or is larger than 10 m");
    return std::nullopt;
  }
  double pitch = options.resolution.mm();
  if (pitch == 0.0)
    pitch = std::max(std::clamp(std::sqrt(size * girth / kUsualRays), kFinest, kCoarsest),
                     std::sqrt(size * girth / kMaxUsualRays));
  if (!std::isfinite(pitch) || pitch < kMinSpacing) {
    diagnostics.error(codes::bad_resolution, {},
                      fmt::format("the resolution is {} mm; expected at least {} mm", number_text(pitch, 9),
                                  number_text(kMinSpacing, 4)));
    return std::nullopt;
  }
  constexpr double kMinAround = 16.0;
  const double along = std::ceil(size / pitch), around = std::max(std::ceil(girth / pitch), kMinAround);
  const double limit = std::min(static_cast<double>(options.max_columns), kMaxRays);
  if (along * around > limit) {
    // Rounded up, as both numbers of rays are.
    const double possible = 1.01 * std::sqrt(size * girth / limit);
    diagnostics
        .error(codes::rotary_limit, {},
               fmt::format("a resolution of {} mm needs {:.0f} rays; at most {:.0f} are allowed",
                           number_text(pitch, 4), along * around, limit))
        .hint = fmt::format("try a resolution of {} mm", number_text(std::ceil(possible * 1e4) / 1e4, 4));
    return std::nullopt;
  }
  RotaryWorkpiece work;
  work.bar = bar;
  work.along = static_cast<int>(along);
  work.around = static_cast<int>(around);
  work.dx = size / along;
  work.rays.assign(static_cast<std::size_t>(along * around),
                   {Interval{0.0f, static_cast<float>(0.5 * bar.diameter), kStockSurface, kStockSurface}});
  return work;
}

/// Cuts the rays of a workpiece and measures its walls.
class RotaryCutter {
 public:
  RotaryCutter(RotaryWorkpiece& work, const RotaryMotionReader& reader, const SimulationOptions& options,
               Progress* progress)
      : work_(work), reader_(reader), options_(options), progress_(progress) {}

  void run();
  std::vector<SlabResult> rays, walls;  // by slab
  bool stopped = false;

 private:
  std::size_t slabs() const { return static_cast<std::size_t>((work_.along + kSlabRows - 1) / kSlabRows); }
  int first(std::size_t n) const { return static_cast<int>(n) * kSlabRows; }
  int last(std::size_t n) const { return std::min(first(n) + kSlabRows, work_.along) - 1; }
  std::vector<std::vector<SlabRay>> rows_of(std::size_t n);
  template <class Cut>
  void for_each_slab(const Cut& cut);

  RotaryWorkpiece& work_;
  const RotaryMotionReader& reader_;
  const SimulationOptions& options_;
  Progress* progress_;
  std::size_t started_ = 0;
};

std::vector<std::vector<SlabRay>> RotaryCutter::rows_of(std::size_t n) {
  std::vector<std::vector<SlabRay>> rows(static_cast<std::size_t>(work_.around));
  const double width = kTurn / work_.around;
  for (int j = 0; j < work_.around; ++j)
    for (int i = first(n); i <= last(n); ++i)
      rows[static_cast<std::size_t>(j)].push_back(
          {work_.bar.x_low + (i + 0.5) * work_.dx, RayAngle((j + 0.5) * width), work_.dx * width,
           &work_.rays[static_cast<std::size_t>(j) * static_cast<std::size_t>(work_.along) +
                       static_cast<std::size_t>(i)]});
  return rows;
}

template <class Cut>
void RotaryCutter::for_each_slab(const Cut& cut) {
  parallel_for(thread_count(options_.threads), slabs(), cut, [&] {
    const auto all = 2.0 * static_cast<double>(slabs());
    report(progress_, std::min(1.0, static_cast<double>(++started_) / all));
    return stopped = stopped || stop_requested(progress_);
  });
}

void RotaryCutter::run() {
  const double hazard_depth = options_.hazard_depth.mm();
  rays.resize(slabs());
  walls.resize(slabs());
  for_each_slab([&](std::size_t n) {
    Slab slab(work_.bar, rows_of(n), hazard_depth);
    for (const RotaryMotion& motion : reader_.motions) slab.cut(motion, reader_.tools[motion.tool]);
    rays[n] = std::move(slab.result);
  });
  if (stopped) return;
  const RotaryWalls cells(work_);
  std::vector<double> lacking(slabs(), 0.0);
  if (!cells.empty())
    for_each_slab([&](std::size_t n) {
      lacking[n] = cells.cut(first(n), last(n), reader_.motions, reader_.tools, hazard_depth, walls[n]);
    });
  for (const double volume : lacking) work_.wall_volume += volume;
}

void merge(const RotaryContacts& from, RotaryContacts& into) {
  for (const auto& [key, contact] : from) {
    const auto [it, is_new] = into.try_emplace(key, contact);
    if (is_new) continue;
    if (contact.fraction < it->second.fraction) {
      it->second.fraction = contact.fraction;
      it->second.at = contact.at;
    }
    it->second.depth = std::max(it->second.depth, contact.depth);
    it->second.volume += contact.volume;
  }
}

}  // namespace
}  // namespace sim

Volume RotaryWorkpiece::volume() const {
  double sum = 0.0;
  for (const std::vector<Interval>& ray : rays) sum += sim::sector(ray);
  return mm3(sum * dx * sim::kTurn / around + wall_volume);
}

std::optional<RotarySimulation> simulate_rotary(const Toolpath& path, const ToolTable& tools,
                                                const RoundBar& bar, const SimulationOptions& options,
                                                Diagnostics& diagnostics, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  auto work = sim::make_bar(bar, options, diagnostics);
  if (!work) return std::nullopt;
  const double girth_pitch = std::numbers::pi * bar.diameter / work->around;
  sim::RotaryMotionReader reader(path, tools, bar, std::min(work->dx, girth_pitch), diagnostics);
  if (!reader.run()) return std::nullopt;
  RotarySimulation result{
      .workpiece = std::move(*work), .stock = {}, .removed = {}, .hazards = {}, .removed_by_step = {}};
  result.stock = result.workpiece.volume();
  if (progress != nullptr) progress->phase("cutting");
  sim::RotaryCutter cutter(result.workpiece, reader, options, progress);
  cutter.run();
  result.stopped = cutter.stopped;
  std::vector<double> by_step(path.size(), 0.0);
  sim::RotaryContacts contacts;
  for (const auto* slabs : {&cutter.rays, &cutter.walls})
    for (const sim::SlabResult& slab : *slabs)
      for (const auto& [step, volume] : slab.removed) by_step[step] += volume;
  for (const sim::SlabResult& slab : cutter.rays) sim::merge(slab.contacts, contacts);
  for (const sim::SlabResult& slab : cutter.walls)
    for (const auto& [key, contact] : slab.contacts)
      if (const auto known = contacts.find(key); known != contacts.end())
        known->second.volume += contact.volume;
  double removed = 0.0;
  for (const double volume : by_step) {
    removed += volume;
    result.removed_by_step.push_back(static_cast<float>(volume));
  }
  result.removed = mm3(removed);
  for (const auto& [key, c] : contacts)
    result.hazards.push_back({key.second, key.first, c.at, mm(c.depth), mm3(c.volume)});
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace kerf
