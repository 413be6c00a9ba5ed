// Reading, cutting and meshing after each save; what changed is published as a new revision.
#include "app/view/session.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "app/report/json.h"
#include "app/report/terminal_progress.h"
#include "app/view/changed_tiles.h"
#include "app/view/model.h"
#include "app/view/motions.h"
#include "app/view/viewable.h"

#include "kerf/outputs.h"

namespace kerf::app::view {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPoll{20};                // between checks of the files
constexpr milliseconds kSettle{15};              // an editor that writes in several steps is done by then
constexpr int kMaxSettling = 40;                 // times; a file that never rests is read all the same
constexpr milliseconds kRest{1500};              // without a change, then edges are made exact
constexpr std::size_t kMaxExactSteps = 200'000;  // of longer programs it would take minutes
constexpr std::size_t kMaxExactTriangles = 3'000'000;  // that pages can draw
constexpr int kMaxCancelled = 3;             // then a load runs to its end although the file changes
constexpr milliseconds kProgressEvery{100};  // events of progress
constexpr double kColumns = 600'000;         // by default, of a milled part
constexpr double kFinestDefault = 0.02;      // mm
constexpr double kCoarsestDefault = 1.0;     // mm

/// The stock's pitch if none is given: coarser than for files, for speed.
Length resolution_for(const Job& job, Length given) {
  if (given > Length() || !job.stock || (job.stock->body && job.stock->body->pitch())) return given;
  const Point3 size = job.stock->block.size();
  return mm(std::clamp(std::sqrt(size.x * size.y / kColumns), kFinestDefault, kCoarsestDefault));
}

std::string_view name_of(State state) {
  switch (state) {
    case State::ready: return "ready";
    case State::failed: return "failed";
    case State::loading: break;
  }
  return "loading";
}

}  // namespace

/// Progress of a load: reported as events, stopped by the user, by a further save, or by its time limit.
class Session::Work : public Progress {
 public:
  enum class Stop : std::uint8_t { none, by_user, by_change, by_limit, by_end };

  enum class Reports : std::uint8_t { all, none };
  explicit Work(Session& session, Reports reports = Reports::all) : session_(session), reports_(reports) {}
  void phase(std::string_view what) override {
    phase_ = what;
    next_event_ = Clock::now() + kProgressEvery;
  }
  void report(double fraction) override {
    if (reports_ == Reports::none || Clock::now() < next_event_) return;
    next_event_ = Clock::now() + kProgressEvery;
    const Json data{{"phase", phase_}, {"fraction", json_of(std::clamp(fraction, 0.0, 1.0))}};
    session_.events_.publish("progress", data.text(Layout::line));
  }
  bool stop_requested() override {
    if (stop_ != Stop::none) return true;
    if (session_.stop_work_) stop_ = Stop::by_user;
    if (interrupted()) stop_ = Stop::by_end;
    if (limit_ && Clock::now() > *limit_) stop_ = Stop::by_limit;
    if (Clock::now() < next_look_) return stop_ != Stop::none;
    next_look_ = Clock::now() + kPoll;
    if (session_.cancelled_ < kMaxCancelled && session_.watch_.has_changed()) stop_ = Stop::by_change;
    const std::lock_guard lock(session_.mutex_);
    if (session_.wanted_) stop_ = Stop::by_change;
    if (session_.ended_) stop_ = Stop::by_end;
    return stop_ != Stop::none;
  }
  void limit(milliseconds time) { limit_ = Clock::now() + time; }
  void no_limit() { limit_.reset(); }
  Stop stop() const { return stop_; }

 private:
  Session& session_;
  Reports reports_;
  std::string phase_ = "reading";
  std::optional<Clock::time_point> limit_;
  Clock::time_point next_event_ = Clock::now() + kProgressEvery, next_look_ = Clock::now();
  Stop stop_ = Stop::none;
};

std::string model_body(const Shown& shown) {
  std::string out = fmt::format(R"({{"protocol":1,"revision":{},"state":"{}","errors":{})", shown.revision,
                                name_of(shown.state), shown.errors);
  if (!shown.model.empty()) out += "," + shown.model;
  return out + "}";
}

std::string model_event(const Shown& shown, std::size_t tiles) {
  return fmt::format(R"({{"revision":{},"tiles":{},"path":true}})", shown.revision, tiles);
}

std::string exact_event(const Shown& shown) { return fmt::format(R"({{"revision":{}}})", shown.revision); }

std::string errors_event(const Shown& shown) {
  return fmt::format(R"({{"revision":{},"diagnostics":{}}})", shown.revision, shown.errors);
}

Session::Session(SessionOptions options, Events& events) : options_(std::move(options)), events_(events) {}

Session::~Session() { end(); }

std::shared_ptr<const Shown> Session::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

void Session::start() {
  thread_ = std::thread([this] { follow(); });
}

void Session::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Session::stop_work() { stop_work_ = true; }

void Session::open(std::string file) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = std::move(file);
  }
  wake_.notify_all();
}

std::optional<std::string> Session::take_wanted() {
  const std::lock_guard lock(mutex_);
  return std::exchange(wanted_, std::nullopt);
}

/// False if the session has ended.
bool Session::sleep(milliseconds time) {
  std::unique_lock lock(mutex_);
  return !wake_.wait_for(lock, time, [&] { return ended_; });
}

void Session::load_once() {
  std::vector<std::string> files = options_.other_files;
  files.push_back(options_.file);
  watch_.set(std::move(files));
  load();
}

void Session::follow() {
  load_once();
  while (sleep(kPoll)) {
    if (std::optional<std::string> file = take_wanted()) {
      options_.file = std::move(*file);
      load_once();
      continue;
    }
    if (!watch_.has_changed()) {
      if (!exact_tried_ && Clock::now() > loaded_at_ + kRest) make_exact();
      continue;
    }
    settle();
    load();
  }
}

/// Waits until the files have not changed for a moment: editors write in several steps.
void Session::settle() {
  for (int k = 0; k < kMaxSettling; ++k) {
    watch_.take();
    if (!sleep(kSettle) || !watch_.has_changed()) return;
  }
}

void Session::load() {
  watch_.take();
  stop_work_ = false;
  Work work(*this);
  Diagnostics diagnostics;
  bool loaded = false;
  try {
    loaded = load_part(work, diagnostics);
  } catch (const std::bad_alloc&) {
    diagnostics.error(Code::stopped, TextLocation{options_.file, 0, 0}, "out of memory");
  }
  {
    const std::lock_guard lock(mutex_);
    last_diagnostics_ = diagnostics;
  }
  exact_tried_ = false;
  loaded_at_ = Clock::now();
  cancelled_ = work.stop() == Work::Stop::by_change ? cancelled_ + 1 : 0;
  if (loaded || work.stop() == Work::Stop::by_change || work.stop() == Work::Stop::by_end) return;
  const TextLocation whole{options_.file, 0, 0};
  if (work.stop() == Work::Stop::by_user) diagnostics.error(Code::stopped, whole, "stopped");
  if (work.stop() == Work::Stop::by_limit)
    diagnostics.error(Code::stopped, whole,
                      fmt::format("the program was not read within {} s and has been stopped",
                                  options_.reading_limit.count() / 1000));
  publish_errors(diagnostics);
}

Diagnostics Session::last_diagnostics() const {
  const std::lock_guard lock(mutex_);
  return last_diagnostics_;
}

std::optional<Job> Session::read_job(Work& work, const Inputs& inputs, Diagnostics& diagnostics) {
  if (std::optional<Job> job = load_drawing_or_mesh(options_.file, diagnostics)) return job;
  if (diagnostics.has_errors()) return std::nullopt;
  work.limit(options_.reading_limit);
  std::vector<std::string> used;
  std::optional<Program> program = is_script(options_.file)
                                       ? script_.load(options_.file, inputs.program, used, diagnostics, &work)
                                       : load_program(options_.file, inputs.program, diagnostics, &work);
  work.no_limit();
  if (program && used.empty()) used = program->files;
  watch_.add(used);
  if (!program || work.stop() != Work::Stop::none || diagnostics.has_errors()) return std::nullopt;
  return make_job_or_print(std::move(*program), inputs.job, UnknownTool::assume, diagnostics);
}

/// False if it could not be loaded, or was stopped.
bool Session::load_part(Work& work, Diagnostics& diagnostics) {
  const Inputs inputs = options_.read_inputs(diagnostics);
  if (diagnostics.has_errors()) return false;
  std::optional<Job> read = read_job(work, inputs, diagnostics);
  if (!read || diagnostics.has_errors()) return false;
  const auto job = std::make_shared<const Job>(std::move(*read));
  JobCheckOptions check;
  check.machine = inputs.program.machine ? &*inputs.program.machine : nullptr;
  const std::lock_guard lock(live_mutex_);
  const RunOptions how{.resolution = resolution_for(*job, options_.resolution), .threads = options_.threads};
  const auto change = live_.update(job, how, check, diagnostics, &work);
  if (!change) return false;
  if (!diagnostics.has_errors() && !work.stop_requested() && publish_part(*change, inputs, diagnostics, work))
    return true;
  tiling_ = {};  // the tiles do not have this change: the next update makes all of them
  return false;
}

/// False, with nothing published, if it was stopped or could not be compared with its target.
bool Session::publish_part(const LiveJobChange& change, const Inputs& inputs, Diagnostics& diagnostics,
                           Work& work) {
  const std::shared_ptr<const Shown> before = shown();
  auto next = std::make_shared<Shown>();
  next->state = State::ready;
  next->revision = before->revision + 1;
  next->tiles = before->tiles;
  next->job = live_.job();
  next->inputs = inputs;
  const std::size_t changed =
      update_tiles(live_, change, {next->revision, options_.threads}, tiling_, next->tiles, &work);
  const std::vector<std::string>& files = next->job->program.files;
  const std::vector<SourceText> sources = read_sources(files);
  std::optional<TargetResult> compared;
  if (inputs.target)
    compared = compare_with_target(live_, *inputs.target, next->revision, diagnostics, &work);
  if (diagnostics.has_errors() || work.stop_requested()) return false;
  if (compared) next->target = std::make_shared<const std::string>(std::move(compared->body));
  std::size_t motions = 0;
  next->path = std::make_shared<const std::string>(
      path_body(next->job->program.path, next->revision, files, inputs.program.machine, motions));
  const Json model = model_json({.live = live_,
                                 .diagnostics = diagnostics,
                                 .machine = inputs.program.machine,
                                 .sources = sources,
                                 .motions = motions,
                                 .tiles = next->tiles.tiles().size(),
                                 .target = compared ? &compared->figures : nullptr});
  const std::string text = model.text(Layout::line);
  next->model = text.substr(1, text.size() - 2);
  {
    const std::lock_guard lock(mutex_);
    shown_ = next;
  }
  events_.publish("model", model_event(*next, changed));
  return true;
}

/// The surfaces of the tools instead of interpolated columns, once nothing changes any more.
void Session::make_exact() {
  exact_tried_ = true;
  const std::shared_ptr<const Shown> before = shown();
  if (options_.edges != IdleEdges::exact || before->state != State::ready || live_.cut() == nullptr ||
      before->job->program.path.size() > kMaxExactSteps || !is_program(*before->job))
    return;
  stop_work_ = false;
  Work work(*this, Work::Reports::none);
  Diagnostics ignored;
  const RunOptions how{.resolution = live_.cut()->workpiece()->pitch(), .threads = options_.threads};
  const auto run = run_job(*before->job, how, ignored, &work);
  if (!run || work.stop_requested()) return;
  const auto surface = make_surface(*before->job, *run, {}, ignored, &work);
  if (!surface || surface->mesh.step.size() > kMaxExactTriangles || work.stop_requested()) return;
  const std::string tile = tile_bytes(0, 0, surface->mesh);
  auto next = std::make_shared<Shown>(*before);
  MeshBody body{.revision = next->revision, .forget_others = true};
  body.tiles.push_back(&tile);
  next->exact = std::make_shared<const std::string>(bytes_of(body));
  {
    const std::lock_guard lock(mutex_);
    shown_ = next;
  }
  events_.publish("exact", exact_event(*next));
}

void Session::publish_errors(const Diagnostics& diagnostics) {
  auto next = std::make_shared<Shown>(*shown());
  next->state = State::failed;
  next->errors = json_of(diagnostics).text(Layout::line);
  {
    const std::lock_guard lock(mutex_);
    shown_ = next;
  }
  events_.publish("errors", errors_event(*next));
}

std::optional<std::string> Session::at(std::uint32_t step, std::uint32_t from) {
  const std::unique_lock lock(live_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return std::string();
  const LiveSimulation* cut = live_.cut();
  if (cut == nullptr || cut->workpiece() == nullptr || tiling_.size() == 0) return std::nullopt;
  const auto steps = static_cast<std::uint32_t>(cut->path().size());
  const std::uint32_t now = std::min(step, steps), then = std::min(from, steps);
  const std::optional<Workpiece> part = cut->at(now);
  if (!part) return std::nullopt;
  const std::vector<std::uint32_t> numbers =
      tiles_between(*cut, live_.job()->tools, tiling_, std::min(now, then), std::max(now, then));
  std::vector<std::string> made;
  for (const MeshTile& tile : extract_mesh_tiles(*part, tiling_, numbers, mesh_options(options_.threads)))
    made.push_back(tile_bytes(tile.number, 0, tile.mesh));
  MeshBody body{.revision = shown()->revision, .at_step = now == steps ? kWholeJob : now};
  for (const std::string& tile : made) body.tiles.push_back(&tile);
  return bytes_of(body);
}

}  // namespace kerf::app::view
