// The live simulation: finds what an edit changes and the tiles that it touches, and keeps states along the
// job.
//
// Tiles store a number for each step that stays with a motion while the program changes around it; a table
// has the step of the newest toolpath for each number. So tiles that an edit does not touch remain as they
// are.
#include "kerf/sim/live.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "sim/cut/cutter.h"
#include "sim/cut/motion_keys.h"
#include "sim/dexel/initial_columns.h"

namespace kerf {
namespace sim {
namespace {

/// The results of cutting a tile, by the numbers of motions.
struct TileLog {
  struct Removed {
    std::uint32_t number;
    float length;  // of column, mm
  };
  std::size_t first = SIZE_MAX, last = 0;  // indices of the motions that can touch the tile
  std::vector<Removed> removed;
  std::vector<Contact> contacts;

  void move(const MotionChange& change) {
    if (first > last) return;
    first = change.moved(first);
    last = change.moved(last);
  }
};

using TileCopy = std::shared_ptr<const Tile>;

/// The tiles before a motion; null where a tile is in its initial state.
struct Keyframe {
  std::size_t motion = 0;
  std::vector<TileCopy> tiles;
};

ColumnBlock block_of(const Workpiece::Body& body, std::size_t tile) {
  const auto tiles_x = static_cast<std::size_t>(body.tiles_x);
  return {static_cast<int>(tile % tiles_x) * kTileColumns, static_cast<int>(tile / tiles_x) * kTileColumns,
          body.columns_x_of(tile), body.columns_y_of(tile)};
}

std::vector<ColumnBlock> blocks_of(const Workpiece::Body& body, const std::vector<bool>& tiles) {
  std::vector<ColumnBlock> blocks;
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    if (tiles[tile]) blocks.push_back(block_of(body, tile));
  return blocks;
}

/// Cuts all batches of a source; done(batch) is called after each batch, with the tiles at rest. False if
/// stopped.
template <class Done>
bool cut_tiles(Workpiece::Body& body, BatchSource& source, const Cutter& cutter, unsigned threads,
               Progress* progress, const Done& done) {
  bool stopped = false;
  const auto cut = [&](CutBatch& batch, std::size_t k) {
    TileJob job = cutter.job(batch, k);
    job.tile = &body.touch(batch.plan->busy[k]);
    cut_tile(job);
  };
  cut_batches([&] { return source.next(); }, thread_count(threads), cut, [](const CutBatch&) {}, done,
              [&] { return stopped = stopped || stop_requested(progress); });
  return !stopped;
}

}  // namespace
}  // namespace sim

struct LiveSimulation::State {
  ToolTable tools;
  Stock from;
  LiveOptions options;

  std::shared_ptr<const Toolpath> path = std::make_shared<const Toolpath>();
  std::optional<Workpiece> workpiece;
  Volume stock;
  sim::Survey survey;
  std::vector<sim::MotionKey> motions;
  std::vector<std::uint32_t> numbers;       // one per motion
  std::vector<std::uint32_t> step_numbers;  // one per step: that of its motion
  std::uint32_t next_number = 0;
  std::vector<sim::TileLog> logs;        // one per tile
  std::vector<sim::Contact> floor;       // found by the planner: cuts below the floor, by number
  std::vector<sim::Keyframe> keyframes;  // sorted by motion, the first at the start
  std::size_t laid_out_for = 0;          // number of motions when the keyframes were added
  bool is_whole = false;                 // all motions are cut

  bool must_restart(std::size_t new_motions) const;
  bool restart(Length pitch, Diagnostics& diagnostics, Progress* progress);
  void add_keyframes();
  std::vector<bool> deleted_numbers(const sim::MotionChange& change) const;
  std::vector<bool> tiles_of_old(const sim::MotionChange& change) const;
  void adopt(std::shared_ptr<const Toolpath> new_path, sim::Survey&& new_survey,
             std::vector<sim::MotionKey>&& keys, const sim::MotionChange& change);
  void add_tiles_of_new(const sim::MotionChange& change, std::vector<bool>& tiles) const;
  std::vector<sim::StepRange> steps_for(const std::vector<bool>& tiles,
                                        const sim::MotionChange& change) const;
  void clear(const std::vector<bool>& tiles);
  /// A workpiece with copies of the tiles; null tiles are in their initial state.
  template <class Tiles>
  Workpiece with_tiles(const Tiles& tiles) const {
    const Workpiece::Body& now = workpiece->body();
    Workpiece part(from, workpiece->pitch());
    Workpiece::Body& body = part.body();
    body.start = now.start;
    body.step_of = now.step_of;
    for (std::size_t tile = 0; tile < tiles.size(); ++tile)
      if (tiles[tile]) body.tiles[tile] = body.store.make(std::as_const(*tiles[tile]));
    return part;
  }

  std::uint32_t step_of(std::uint32_t number) const { return workpiece->body().step(number); }
  /// The first motion at or after a step.
  std::size_t motion_at(std::size_t step) const {
    const auto before = [](const sim::MotionKey& motion, std::size_t s) { return motion.step < s; };
    const auto at = std::lower_bound(motions.begin(), motions.end(), step, before);
    return static_cast<std::size_t>(at - motions.begin());
  }
  /// The step of a motion; the end of the toolpath for the one after the last.
  std::size_t step_at(std::size_t motion) const {
    return motion < motions.size() ? motions[motion].step : path->size();
  }
};

/// Restarts before numbers run out or the states are spread too unevenly.
bool LiveSimulation::State::must_restart(std::size_t new_motions) const {
  constexpr std::size_t kSmall = 10'000;  // a job that is quickly cut in any case
  return !is_whole || new_motions > 2 * laid_out_for + kSmall || next_number > 8 * laid_out_for + 8 * kSmall;
}

/// Restarts with the uncut stock and no motions. False, with an error appended unless stopped, if that is not
/// possible.
bool LiveSimulation::State::restart(Length pitch, Diagnostics& diagnostics, Progress* progress) {
  Workpiece uncut(from, pitch);
  const Point3 size = from.block.size();
  stock = mm3(size.x * size.y * size.z);
  if (from.body) {
    if (!sim::fill_from_body(uncut.body(), *from.body, diagnostics, progress)) return false;
    stock = uncut.volume();
  }
  const std::size_t tiles = uncut.body().tiles.size();
  motions.clear();
  numbers.clear();
  next_number = 0;
  logs.assign(tiles, {});
  floor.clear();
  keyframes.assign(1, {0, std::vector<sim::TileCopy>(tiles)});
  for (std::size_t tile = 0; tile < tiles; ++tile)
    if (uncut.body().tiles[tile])
      keyframes[0].tiles[tile] = std::make_shared<const sim::Tile>(*uncut.body().tiles[tile]);
  workpiece = std::move(uncut);
  return true;
}

void LiveSimulation::State::add_keyframes() {
  laid_out_for = motions.size();
  for (std::size_t k = 1; k <= options.states; ++k)
    keyframes.push_back({motions.size() * k / (options.states + 1), keyframes[0].tiles});
}

/// The numbers of the deleted motions.
std::vector<bool> LiveSimulation::State::deleted_numbers(const sim::MotionChange& change) const {
  std::vector<bool> deleted(next_number, false);
  for (std::size_t m = change.first; m < change.old_end; ++m) deleted[numbers[m]] = true;
  return deleted;
}

/// The tiles that the deleted motions have cut or touched.
std::vector<bool> LiveSimulation::State::tiles_of_old(const sim::MotionChange& change) const {
  const std::vector<bool> deleted = deleted_numbers(change);
  std::vector<bool> tiles(logs.size(), false);
  for (std::size_t tile = 0; tile < logs.size(); ++tile) {
    const sim::TileLog& log = logs[tile];
    tiles[tile] = std::any_of(log.removed.begin(), log.removed.end(),
                              [&](const auto& removed) { return deleted[removed.number]; }) ||
                  std::any_of(log.contacts.begin(), log.contacts.end(),
                              [&](const sim::Contact& contact) { return deleted[contact.step]; });
  }
  return tiles;
}

/// Replaces the toolpath of the state; the tiles stay as they are.
void LiveSimulation::State::adopt(std::shared_ptr<const Toolpath> new_path, sim::Survey&& new_survey,
                                  std::vector<sim::MotionKey>&& keys, const sim::MotionChange& change) {
  const std::vector<bool> deleted = deleted_numbers(change);
  std::erase_if(floor, [&](const sim::Contact& contact) { return deleted[contact.step]; });
  std::vector<std::uint32_t> now(numbers.begin(),
                                 numbers.begin() + static_cast<std::ptrdiff_t>(change.first));
  for (std::size_t m = change.first; m < change.new_end; ++m) now.push_back(next_number++);
  now.insert(now.end(), numbers.begin() + static_cast<std::ptrdiff_t>(change.old_end), numbers.end());
  numbers = std::move(now);
  path = std::move(new_path);
  survey = std::move(new_survey);
  motions = std::move(keys);
  step_numbers.assign(path->size(), 0);
  auto step_of = std::make_shared<std::vector<std::uint32_t>>(next_number, kStockSurface);
  for (std::size_t m = 0; m < motions.size(); ++m) {
    step_numbers[motions[m].step] = numbers[m];
    (*step_of)[numbers[m]] = motions[m].step;
  }
  workpiece->body().step_of = std::move(step_of);
  for (sim::TileLog& log : logs) log.move(change);
  for (std::size_t k = 1; k < keyframes.size(); ++k) keyframes[k].motion = change.moved(keyframes[k].motion);
}

/// Adds the tiles that the new motions can touch.
void LiveSimulation::State::add_tiles_of_new(const sim::MotionChange& change,
                                             std::vector<bool>& tiles) const {
  if (change.first == change.new_end) return;
  const sim::StepRange steps{motions[change.first].step, motions[change.new_end - 1].step};
  sim::BatchSource source(workpiece->body(), *path, survey,
                          {.plan = {.margin = workpiece->pitch().mm(), .tiles = nullptr},
                           .steps = {steps},
                           .hazard_depth = options.simulation.hazard_depth});
  for (bool more = true; more;) {
    const auto batch = source.next();
    for (const std::uint32_t tile : batch->busy) tiles[tile] = true;
    more = !batch->is_last;
  }
}

/// All steps that can touch the tiles, and the new ones.
std::vector<sim::StepRange> LiveSimulation::State::steps_for(const std::vector<bool>& tiles,
                                                             const sim::MotionChange& change) const {
  std::vector<sim::StepRange> steps;
  const auto add = [&](std::size_t first, std::size_t last) {
    if (first <= last && first < motions.size())
      steps.push_back({motions[first].step, motions[std::min(last, motions.size() - 1)].step});
  };
  if (change.first < change.new_end) add(change.first, change.new_end - 1);
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    if (tiles[tile]) add(logs[tile].first, logs[tile].last);
  return sim::merge_ranges(std::move(steps));
}

void LiveSimulation::State::clear(const std::vector<bool>& tiles) {
  for (std::size_t tile = 0; tile < tiles.size(); ++tile) {
    if (!tiles[tile]) continue;
    if (workpiece->body().tiles[tile]) workpiece->body().restore(tile);
    logs[tile] = {};
  }
}

namespace sim {
namespace {

/// Cuts motions of a live simulation and records the results.
class LiveRun {
 public:
  using State = LiveSimulation::State;
  /// Cuts all marked tiles. Motions with numbers from `fresh_number` on are new.
  LiveRun(State& state, const std::vector<bool>& tiles, std::uint32_t fresh_number, Progress* progress,
          const LiveProgress& chunk)
      : state_(state),
        tiles_(tiles),
        fresh_number_(fresh_number),
        progress_(progress),
        chunk_(chunk),
        body_(state.workpiece->body()),
        cutter_(body_, state.survey.solids, state.options.simulation.hazard_depth),
        cut_since_(tiles.size(), false) {}

  /// False if stopped.
  bool cut(std::vector<StepRange> steps);

 private:
  void add_results(const CutBatch& batch);
  void log_tile(const CutBatch& batch, std::size_t k);
  void keep_tiles(Keyframe& keyframe, const Keyframe& before);

  State& state_;
  const std::vector<bool>& tiles_;
  std::uint32_t fresh_number_;
  Progress* progress_;
  const LiveProgress& chunk_;
  Workpiece::Body& body_;
  Cutter cutter_;
  std::vector<bool> cut_since_;  // tiles cut since the previous keyframe
  std::size_t next_keyframe_ = 1;
};

bool LiveRun::cut(std::vector<StepRange> steps) {
  if (progress_ != nullptr) progress_->phase("cutting");
  BatchScope scope{.plan = {.margin = body_.pitch, .tiles = &tiles_},
                   .steps = std::move(steps),
                   .hazard_depth = state_.options.simulation.hazard_depth};
  scope.numbers = &state_.step_numbers;
  for (std::size_t k = 1; k < state_.keyframes.size(); ++k)
    scope.pauses.push_back(state_.step_at(state_.keyframes[k].motion));
  BatchSource source(body_, *state_.path, state_.survey, std::move(scope));
  const bool whole = cut_tiles(body_, source, cutter_, state_.options.simulation.threads, progress_,
                               [&](const CutBatch& batch) { add_results(batch); });
  report(progress_, 1.0);
  return whole;
}

void LiveRun::add_results(const CutBatch& batch) {
  const Batch& plan = *batch.plan;
  LiveChunk chunk{.steps_done = plan.steps_done, .changed = {}};
  for (std::size_t k = 0; k < plan.busy.size(); ++k) {
    log_tile(batch, k);
    cut_since_[plan.busy[k]] = true;
    if (chunk_) chunk.changed.push_back(block_of(body_, plan.busy[k]));
  }
  for (const Contact& contact : plan.contacts)
    if (contact.step >= fresh_number_) state_.floor.push_back(contact);
  std::vector<Keyframe>& keyframes = state_.keyframes;
  for (; next_keyframe_ < keyframes.size() &&
         state_.step_at(keyframes[next_keyframe_].motion) <= plan.steps_done;
       ++next_keyframe_)
    keep_tiles(keyframes[next_keyframe_], keyframes[next_keyframe_ - 1]);
  const auto all = static_cast<double>(std::max<std::size_t>(state_.path->size(), 1));
  report(progress_, static_cast<double>(plan.steps_done) / all);
  if (chunk_ && !chunk.changed.empty()) chunk_(chunk);
}

void LiveRun::log_tile(const CutBatch& batch, std::size_t k) {
  const Batch& plan = *batch.plan;
  TileLog& log = state_.logs[plan.busy[k]];
  for (std::size_t at = plan.start[k]; at < plan.start[k + 1]; ++at) {
    const std::uint32_t number = plan.sweeps[plan.list[at]].step;
    if (batch.removed[at] == 0.0) continue;
    const auto length = static_cast<float>(batch.removed[at]);
    if (!log.removed.empty() && log.removed.back().number == number) {
      log.removed.back().length += length;
    } else {
      log.removed.push_back({number, length});
    }
  }
  const auto motion = [&](std::size_t at) {
    return state_.motion_at(body_.step(plan.sweeps[plan.list[at]].step));
  };
  log.first = std::min(log.first, motion(plan.start[k]));
  log.last = std::max(log.last, motion(plan.start[k + 1] - 1));
  log.contacts.insert(log.contacts.end(), batch.contacts_of[k].begin(), batch.contacts_of[k].end());
}

/// A keyframe references the tiles of the previous one that were not cut between them.
void LiveRun::keep_tiles(Keyframe& keyframe, const Keyframe& before) {
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    if (!tiles_[tile]) continue;
    keyframe.tiles[tile] =
        cut_since_[tile] ? std::make_shared<const Tile>(*body_.tiles[tile]) : before.tiles[tile];
    cut_since_[tile] = false;
  }
}

}  // namespace
}  // namespace sim

LiveSimulation::LiveSimulation(ToolTable tools, Stock stock, LiveOptions options)
    : state_(std::make_unique<State>()) {
  state_->tools = std::move(tools);
  state_->from = std::move(stock);
  state_->options = options;
}
LiveSimulation::LiveSimulation(LiveSimulation&&) noexcept = default;
LiveSimulation& LiveSimulation::operator=(LiveSimulation&&) noexcept = default;
LiveSimulation::~LiveSimulation() = default;

std::optional<LiveUpdate> LiveSimulation::update(Toolpath path, Diagnostics& diagnostics, Progress* progress,
                                                 const LiveProgress& chunk) {
  return update(std::make_shared<const Toolpath>(std::move(path)), diagnostics, progress, chunk);
}

std::optional<LiveUpdate> LiveSimulation::update(std::shared_ptr<const Toolpath> path,
                                                 Diagnostics& diagnostics, Progress* progress,
                                                 const LiveProgress& chunk) {
  const auto start = std::chrono::steady_clock::now();
  State& s = *state_;
  auto setup = sim::set_up(*path, s.tools, s.from, s.options.simulation, diagnostics);
  if (!setup) return std::nullopt;
  std::vector<sim::MotionKey> keys = sim::motion_keys(*path, setup->survey);
  const bool has_other_pitch = s.workpiece && s.workpiece->pitch() != setup->pitch;
  const bool restarts = has_other_pitch || s.must_restart(keys.size());
  if (restarts && !s.restart(setup->pitch, diagnostics, progress)) return std::nullopt;
  const sim::MotionChange change = sim::change_of(s.motions, keys);
  std::vector<bool> tiles = restarts ? std::vector<bool>(s.logs.size(), true) : s.tiles_of_old(change);
  const std::uint32_t fresh_number = s.next_number;
  LiveUpdate done;
  if (!restarts) done.shifts = sim::step_shifts(s.motions, keys, change);
  s.is_whole = false;
  s.adopt(std::move(path), std::move(setup->survey), std::move(keys), change);
  if (restarts) {
    s.add_keyframes();
  } else {
    s.add_tiles_of_new(change, tiles);
  }
  std::vector<sim::StepRange> steps = s.steps_for(tiles, change);
  if (!restarts) s.clear(tiles);
  s.is_whole = change.none() || sim::LiveRun(s, tiles, fresh_number, progress, chunk).cut(std::move(steps));
  done.motions_kept = s.motions.size() - (change.new_end - change.first);
  done.redone = sim::blocks_of(s.workpiece->body(), tiles);
  done.stopped = !s.is_whole;
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return done;
}

const Toolpath& LiveSimulation::path() const { return *state_->path; }
const Workpiece* LiveSimulation::workpiece() const {
  return state_->workpiece ? &*state_->workpiece : nullptr;
}
Volume LiveSimulation::stock() const { return state_->stock; }

Volume LiveSimulation::removed() const {
  double length = 0.0;
  for (const sim::TileLog& log : state_->logs)
    for (const auto& removed : log.removed) length += static_cast<double>(removed.length);
  const double pitch = state_->workpiece ? state_->workpiece->pitch().mm() : 0.0;
  return mm3(length * pitch * pitch);
}

std::vector<float> LiveSimulation::removed_by_step() const {
  std::vector<double> length(state_->path->size(), 0.0);
  for (const sim::TileLog& log : state_->logs)
    for (const auto& removed : log.removed)
      length[state_->step_of(removed.number)] += static_cast<double>(removed.length);
  std::vector<float> volumes;
  volumes.reserve(length.size());
  const double pitch = state_->workpiece ? state_->workpiece->pitch().mm() : 0.0;
  for (const double l : length) volumes.push_back(static_cast<float>(l * pitch * pitch));
  return volumes;
}

std::vector<Hazard> LiveSimulation::hazards() const {
  if (!state_->workpiece) return {};
  sim::ContactList list;
  const auto add = [&](sim::Contact contact) {
    contact.step = state_->step_of(contact.step);
    list.add(contact);
  };
  for (const sim::Contact& contact : state_->floor) add(contact);
  for (const sim::TileLog& log : state_->logs)
    for (const sim::Contact& contact : log.contacts) add(contact);
  return list.hazards(state_->workpiece->bounds().low);
}

std::optional<Workpiece> LiveSimulation::at(std::size_t steps, Progress* progress) const {
  const State& s = *state_;
  if (!s.workpiece) return std::nullopt;
  const Workpiece::Body& now = s.workpiece->body();
  const std::size_t motion = s.motion_at(steps);
  if (motion >= s.motions.size()) return s.with_tiles(now.tiles);
  const auto after =
      std::upper_bound(s.keyframes.begin(), s.keyframes.end(), motion,
                       [](std::size_t m, const sim::Keyframe& keyframe) { return m < keyframe.motion; });
  const sim::Keyframe& keyframe = *(after - 1);
  Workpiece part = s.with_tiles(keyframe.tiles);
  if (keyframe.motion == motion) return part;
  Workpiece::Body& body = part.body();
  sim::BatchScope scope{.plan = {.margin = body.pitch, .tiles = nullptr},
                        .steps = {{s.motions[keyframe.motion].step, s.motions[motion - 1].step}},
                        .hazard_depth = s.options.simulation.hazard_depth};
  scope.numbers = &s.step_numbers;
  sim::BatchSource source(body, *s.path, s.survey, std::move(scope));
  sim::Cutter cutter(body, s.survey.solids, s.options.simulation.hazard_depth);
  const bool whole = sim::cut_tiles(body, source, cutter, s.options.simulation.threads, progress,
                                    [](const sim::CutBatch&) {});
  return whole ? std::optional(std::move(part)) : std::nullopt;
}

}  // namespace kerf
