// The driver: passes batches from the planner to the kernels and collects the results.
#include "kerf/sim/simulate.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "sim/cut/block_contact.h"
#include "sim/cut/cutter.h"
#include "sim/cut/simulation_plan.h"
#include "sim/cut/step_sums.h"
#include "sim/cut/walls.h"
#include "sim/dexel/initial_columns.h"
#include "sim/sweep/batch_source.h"
#include "sim/sweep/covered.h"

namespace kerf {

namespace sim {
namespace {

/// Walls that can change the volume by less than this fraction of what was removed are not measured.
constexpr double kNegligible = 1e-6;

class CutRun {
 public:
  CutRun(Workpiece& workpiece, const SimulationJob& job, Simulation::Plan& plan, Progress* progress)
      : body_(workpiece.body()),
        path_(*job.path),
        plan_(plan),
        hazard_depth_(job.options.hazard_depth),
        is_no_go_(job.options.role == SolidRole::no_go),
        threads_(thread_count(job.options.threads)),
        progress_(progress),
        removed_(body_.pitch * body_.pitch, path_.size()),
        cutter_(body_, plan.survey.solids, hazard_depth_) {}

  void cut_all() {
    if (progress_ != nullptr) progress_->phase("cutting");
    in_tile_.assign(body_.tiles.size(), {});
    sweeps_in_tile_.assign(body_.tiles.size(), 0);
    send_all(nullptr);
    report(progress_, 1.0);
  }

  /// Measures the columns at walls, see walls.h. Without relevant walls, or if stopped, volumes are those of
  /// the column centres.
  void refine_walls();

  bool stopped() const { return stopped_; }
  void set_removed(Simulation& result);
  std::vector<Hazard> hazards() const { return contacts_.hazards(body_.bounds.low); }

 private:
  std::vector<StepRange> steps_in(const std::vector<bool>& tiles) const;
  void send_all(const std::vector<bool>* tiles);
  template <class Next>
  void send(const Next& next);
  void cut_tile_number(CutBatch& batch, std::size_t k);
  void touch_tile(std::size_t tile, TileJob job);
  void note_block_contacts(const Batch& batch);
  void add_results(const CutBatch& batch);

  Workpiece::Body& body_;
  const Toolpath& path_;
  Simulation::Plan& plan_;
  Length hazard_depth_;
  bool is_no_go_;
  unsigned threads_;
  Progress* progress_;
  StepSums removed_;                // by the centres of columns
  std::optional<StepSums> more_;    // correction for walls
  WallGroup* walls_ = nullptr;      // cut instead of the workpiece, if any
  std::vector<StepRange> in_tile_;  // the steps of each tile
  std::vector<std::size_t> sweeps_in_tile_;
  bool stopped_ = false;
  Cutter cutter_;
  ContactList contacts_;
};

/// Cuts the batches that next() returns.
template <class Next>
void CutRun::send(const Next& next) {
  const auto stop = [&] { return stopped_ = stopped_ || stop_requested(progress_); };
  const double steps = static_cast<double>(std::max<std::size_t>(path_.size(), 1));
  const auto report_batch = [&](const CutBatch& batch) {
    report(progress_, static_cast<double>(batch.plan->steps_done) / steps);
  };
  cut_batches(
      next, threads_, [&](CutBatch& batch, std::size_t k) { cut_tile_number(batch, k); },
      [&](const CutBatch& batch) { add_results(batch); }, report_batch, stop);
}

/// Cuts all motions, or only those that touch the given tiles.
void CutRun::send_all(const std::vector<bool>* tiles) {
  if (tiles != nullptr && plan_.batches.complete()) {
    std::size_t next = 0;
    return send([&] { return plan_.batches.batches()[next++]; });
  }
  const bool is_kept = tiles == nullptr && !is_no_go_;
  BatchSource source(
      body_, path_, plan_.survey,
      {.plan = {.margin = body_.pitch, .beside = is_kept ? kKeptMargin * body_.pitch : 0.0, .tiles = tiles},
       .steps = tiles == nullptr ? std::vector{StepRange{0, path_.size()}} : steps_in(*tiles),
       .hazard_depth = hazard_depth_,
       .is_no_go = is_no_go_});
  send([&] {
    auto batch = source.next();
    if (is_kept) plan_.batches.add(batch);
    return batch;
  });
}

void CutRun::cut_tile_number(CutBatch& batch, std::size_t k) {
  const std::size_t tile = batch.plan->busy[k];
  if (walls_ != nullptr && !walls_->tiles()[tile]) return;
  TileJob job = cutter_.job(batch, k);
  if (walls_ != nullptr) return walls_->cut(tile, job);
  job.tile = &body_.touch(tile);
  if (is_no_go_) return touch_tile(tile, job);
  cut_tile(job);
}

/// A no-go solid is restored after each step, so that each step touches all of it.
void CutRun::touch_tile(std::size_t tile, TileJob job) {
  for (std::size_t rest = job.count; rest > 0; rest -= job.count) {
    const std::uint32_t step = job.sweeps[*job.list].step;
    for (job.count = 1; job.count < rest && job.sweeps[job.list[job.count]].step == step;) ++job.count;
    cut_tile(job);
    if (std::any_of(job.removed, job.removed + job.count, [](double length) { return length > 0.0; }))
      body_.restore(tile);
    job.list += job.count;
    job.removed += job.count;
  }
}

/// Adds contacts that are too narrow for the columns.
void CutRun::note_block_contacts(const Batch& batch) {
  if (body_.start) return;  // not a block
  std::vector<Contact> contacts;
  for (const Sweep& sweep : batch.sweeps)
    sim::note_block_contacts(sweep, plan_.survey.solids[sweep.tool], body_.bounds.size(), hazard_depth_.mm(),
                             contacts);
  for (const Contact& contact : contacts) contacts_.add(contact);
}

std::vector<StepRange> CutRun::steps_in(const std::vector<bool>& tiles) const {
  std::vector<StepRange> all;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    if (tiles[tile] && in_tile_[tile].first <= in_tile_[tile].last) all.push_back(in_tile_[tile]);
  return merge_ranges(std::move(all));
}

void CutRun::refine_walls() {
  if (stopped_) return;
  const std::vector<WallSquares> found = find_walls(body_, threads_);
  double max_error = 0.0;
  std::size_t squares = 0;
  for (const WallSquares& walls : found) {
    max_error += walls.max_error;
    squares += walls.squares.size();
  }
  if (found.empty() || max_error * body_.pitch * body_.pitch <= kNegligible * removed_.total()) return;
  if (progress_ != nullptr) progress_->phase("measuring walls");
  more_.emplace(body_.pitch * body_.pitch, path_.size());
  for (std::size_t next = 0; next < found.size() && !stopped_;) {
    WallGroup group(body_, cutter_, found, squares, next, sweeps_in_tile_);
    walls_ = &group;
    send_all(&group.tiles());
    walls_ = nullptr;
  }
  report(progress_, 1.0);
  if (stopped_) more_.reset();
}

void CutRun::set_removed(Simulation& result) {
  const double more = more_ ? more_->total() : 0.0;
  result.removed = mm3(removed_.total() + more);
  result.workpiece.body().wall_volume = -more;
  result.removed_by_step = removed_.take_volumes();
  if (!more_) return;
  const std::vector<float> walls = more_->take_volumes();
  std::transform(walls.begin(), walls.end(), result.removed_by_step.begin(), result.removed_by_step.begin(),
                 std::plus<>());
}

void CutRun::add_results(const CutBatch& batch) {
  if (walls_ != nullptr) return more_->add(batch);
  removed_.add(batch);
  const Batch& plan = *batch.plan;
  if (is_no_go_) note_block_contacts(plan);
  for (const Contact& contact : plan.contacts) contacts_.add(contact);
  for (const std::vector<Contact>& of_tile : batch.contacts_of)
    for (const Contact& contact : of_tile) contacts_.add(contact);
  for (std::size_t k = 0; k < plan.busy.size(); ++k) {
    sweeps_in_tile_[plan.busy[k]] += plan.start[k + 1] - plan.start[k];
    in_tile_[plan.busy[k]].add(
        {plan.sweeps[plan.list[plan.start[k]]].step, plan.sweeps[plan.list[plan.start[k + 1] - 1]].step});
  }
}

}  // namespace
}  // namespace sim

std::optional<Simulation> simulate(SimulationJob job, Diagnostics& diagnostics, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  const Stock& stock = job.stock;
  std::optional<sim::Setup> setup = sim::set_up(*job.path, job.tools, stock, job.options, diagnostics);
  if (!setup) return std::nullopt;
  const auto plan = std::make_shared<Simulation::Plan>();
  plan->survey = std::move(setup->survey);
  if (job.options.volumes_by_tool && job.options.role == SolidRole::stock)
    plan->survey.covered = sim::covered_arcs(*job.path, plan->survey, stock.block.size().z);
  Simulation result{.job = {},
                    .workpiece = Workpiece(stock, setup->pitch),
                    .stock = {},
                    .removed = {},
                    .hazards = {},
                    .removed_by_step = {},
                    .plan = plan};
  const Point3 size = stock.block.size();
  result.stock = mm3(size.x * size.y * size.z);
  if (stock.body) {
    if (!sim::fill_from_body(result.workpiece.body(), *stock.body, diagnostics, progress))
      return std::nullopt;
    result.stock = result.workpiece.volume();
  }
  sim::CutRun run(result.workpiece, job, *plan, progress);
  run.cut_all();
  if (job.options.role == SolidRole::stock) run.refine_walls();
  run.set_removed(result);
  result.hazards = run.hazards();
  result.stopped = run.stopped();
  result.job = std::move(job);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::optional<Simulation> simulate(Toolpath path, ToolTable tools, Stock stock,
                                   const SimulationOptions& options, Diagnostics& diagnostics,
                                   Progress* progress) {
  return simulate(
      {std::make_shared<const Toolpath>(std::move(path)), std::move(tools), std::move(stock), options},
      diagnostics, progress);
}

}  // namespace kerf
