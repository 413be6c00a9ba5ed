// Reading, cutting and meshing after each save; what changed is published as a new revision.
#include "app/view/session.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "app/report/terminal_progress.h"
#include "app/shown/stage_times.h"
#include "app/shown/viewable.h"
#include "base/codes/files.h"
#include "job/record/record.h"

namespace kerf::app::view {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPoll{20};            // between checks of the files
constexpr milliseconds kLook{15};            // between checks after a change
constexpr milliseconds kSettle{15};          // an editor that writes in several steps is done by then
constexpr milliseconds kStill{250};          // files unchanged for so long are written in full
constexpr milliseconds kMaxSettling{600};    // a file that never rests is read all the same
constexpr milliseconds kMaxHeld{2000};       // errors of a file that never rests are shown all the same
constexpr milliseconds kRest{1500};          // without a change, then edges are made exact
constexpr int kMaxCancelled = 3;             // then a load runs to its end although the file changes
constexpr milliseconds kProgressEvery{100};  // events of progress

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
    session_.publish_progress(phase_, record_of(std::clamp(fraction, 0.0, 1.0)));
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

/// Progress of a function on a thread of its own, which the session's thread passes on to its work.
class Session::Relay : public Progress {
 public:
  void phase(std::string_view what) override {
    const std::lock_guard lock(mutex_);
    phase_ = what;
    fraction_.reset();
  }
  void report(double fraction) override {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction;
  }
  bool stop_requested() override { return stopped_; }

  void stop() { stopped_ = true; }
  void pass_on(Work& work) {
    const std::lock_guard lock(mutex_);
    if (phase_ != shown_phase_) work.phase(shown_phase_ = phase_);
    if (fraction_) work.report(*fraction_);
  }

 private:
  std::mutex mutex_;
  std::string phase_, shown_phase_;
  std::optional<double> fraction_;
  std::atomic<bool> stopped_{false};
};

Session::Session(SessionOptions options, Events& events)
    : options_(std::move(options)),
      events_(events),
      part_({.resolution = options_.resolution, .threads = options_.threads}) {}

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

void Session::use_unit(Length unit) {
  {
    const std::lock_guard lock(mutex_);
    wanted_unit_ = unit;
  }
  wake_.notify_all();
}

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

std::optional<Length> Session::take_wanted_unit() {
  const std::lock_guard lock(mutex_);
  return std::exchange(wanted_unit_, std::nullopt);
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
  announce();
  load(Errors::at_once);
}

void Session::follow() {
  load_once();
  while (sleep(kPoll)) {
    const std::optional<Length> unit = take_wanted_unit();
    if (unit) unit_ = unit;
    std::optional<std::string> file = take_wanted();
    if (file || unit) {
      if (file) options_.file = std::move(*file);
      load_once();
      continue;
    }
    if (!watch_.has_changed()) {
      if (held_ && is_still()) show_errors(*std::exchange(held_, std::nullopt));
      if (!exact_tried_ && Clock::now() > loaded_at_ + kRest) make_exact();
      continue;
    }
    announce();
    settle();
    load(Errors::once_still);
  }
}

/// Pages know at once that what they show is no longer that of the files.
void Session::announce() {
  {
    const std::lock_guard lock(mutex_);
    ++input_;
  }
  publish_progress("reading", nullptr);
}

void Session::publish_progress(std::string_view phase, Record fraction) {
  std::string text;
  {
    const std::lock_guard lock(mutex_);
    work_ = Record{{"phase", phase}, {"fraction", std::move(fraction)}, {"input", input_}}.text(Layout::line);
    text = work_;
  }
  events_.publish("progress", text);
}

std::string Session::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

/// Waits until the files have not changed for a moment: editors write in several steps. Files that an editor
/// has emptied, and not written yet, need not be read.
void Session::settle() {
  const Clock::time_point first = Clock::now();
  watch_.take();
  while (sleep(kLook)) {
    const Clock::time_point now = Clock::now();
    if (watch_.has_changed())
      watch_.take();
    else if (now - watch_.changed_at() >= (watch_.is_cut_short() ? kStill : kSettle))
      return;
    if (now - first > kMaxSettling) return;
  }
}

/// Whether the files have not changed for so long that an editor has written all of them.
bool Session::is_still() const { return Clock::now() - watch_.changed_at() >= kStill; }

void Session::load(Errors errors) {
  held_.reset();
  watch_.take_as_read();
  stop_work_ = false;
  printed_.clear();
  Work work(*this);
  Diagnostics diagnostics;
  bool loaded = false;
  try {
    loaded = load_part(work, diagnostics);
  } catch (const std::bad_alloc&) {
    diagnostics.error(codes::stopped, TextLocation{options_.file, 0, 0}, "out of memory");
  }
  {
    const std::lock_guard lock(mutex_);
    last_diagnostics_ = diagnostics;
  }
  exact_tried_ = false;
  loaded_at_ = Clock::now();
  cancelled_ = work.stop() == Work::Stop::by_change ? cancelled_ + 1 : 0;
  if (loaded) failing_since_.reset();
  if (loaded || work.stop() == Work::Stop::by_change || work.stop() == Work::Stop::by_end) return;
  const TextLocation whole{options_.file, 0, 0};
  if (work.stop() == Work::Stop::by_user) diagnostics.error(codes::stopped, whole, "stopped");
  if (work.stop() == Work::Stop::by_limit)
    diagnostics.error(codes::stopped, whole,
                      fmt::format("the program was not read within {} s and has been stopped",
                                  options_.reading_limit.count() / 1000));
  // A file that is being written has errors where its text ends so far.
  if (!failing_since_) failing_since_ = Clock::now();
  const bool can_wait = errors == Errors::once_still && work.stop() == Work::Stop::none;
  if (can_wait && !is_still() && Clock::now() - *failing_since_ < kMaxHeld)
    held_ = std::move(diagnostics);
  else
    show_errors(diagnostics);
}

void Session::show_errors(const Diagnostics& diagnostics) {
  failing_since_.reset();
  publish_errors(diagnostics);
  const std::lock_guard lock(mutex_);
  failure_ = diagnostics;
}

std::optional<Diagnostics> Session::take_failure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, std::nullopt);
}

Diagnostics Session::last_diagnostics() const {
  const std::lock_guard lock(mutex_);
  return last_diagnostics_;
}

/// Calls a function on a thread of its own, as some of its steps (the joining of a layer, a font) cannot be
/// stopped. Nothing if the work is stopped meanwhile: the function is asked to stop, and its result is not
/// waited for. The next such call does so first, so that there is only one at a time.
std::optional<Session::Read> Session::read_apart(Work& work, std::function<Read(Progress&)> read) {
  const auto relay = std::make_shared<Relay>();
  const auto is_there = [&](std::future<Read>& result) {
    while (result.wait_for(kPoll) != std::future_status::ready) {
      if (work.stop_requested()) return false;
      relay->pass_on(work);
    }
    return true;
  };
  if (abandoned_.valid() && !is_there(abandoned_)) return std::nullopt;
  abandoned_ = {};
  std::future<Read> result =
      std::async(std::launch::async, [relay, read = std::move(read)] { return read(*relay); });
  if (is_there(result)) return result.get();
  relay->stop();
  abandoned_ = std::move(result);
  return std::nullopt;
}

std::optional<Job> Session::read_job(Work& work, const Inputs& inputs, Diagnostics& diagnostics) {
  std::optional<Read> plain =
      read_apart(work, [file = options_.file, unit = inputs.unit, diagnostics](Progress& progress) {
        Read made{std::nullopt, diagnostics};
        made.job = load_drawing_or_mesh(file, unit, made.diagnostics, &progress);
        return made;
      });
  if (!plain) return std::nullopt;
  diagnostics = std::move(plain->diagnostics);
  if (plain->job || diagnostics.has_errors()) return std::move(plain->job);
  std::vector<std::string> used;
  ProgramOptions how = inputs.program;
  how.printed = [this](std::string_view line) { printed_.add(line); };
  std::optional<Program> program = is_script(options_.file)
                                       ? script_.load(options_.file, how, used, diagnostics, &work)
                                       : load_program(options_.file, how, diagnostics, &work);
  if (work.stop() == Work::Stop::none && (!program || diagnostics.has_errors())) {
    plain = read_apart(work, [file = options_.file, unit = inputs.unit, diagnostics](Progress& progress) {
      Read made{std::nullopt, diagnostics};
      made.job = load_plain_dxf(file, unit, made.diagnostics, &progress);
      return made;
    });
    if (plain) diagnostics = std::move(plain->diagnostics);
    if (plain && plain->job) return std::move(plain->job);
  }
  if (program && used.empty()) used = program->files;
  watch_.add(used);
  if (!program || work.stop() != Work::Stop::none || diagnostics.has_errors()) return std::nullopt;
  return make_job_or_print(std::move(*program), inputs.job, UnknownTool::assume, diagnostics);
}

/// False if it could not be loaded, or was stopped.
bool Session::load_part(Work& work, Diagnostics& diagnostics) {
  work.limit(options_.reading_limit);
  Inputs inputs = options_.read_inputs(diagnostics, &work);
  if (unit_) inputs.unit = unit_;
  if (diagnostics.has_errors()) return false;
  StageTimes times;
  std::optional<Job> read = read_job(work, inputs, diagnostics);
  work.no_limit();
  times.note("read");
  if (!read || diagnostics.has_errors()) return false;
  std::optional<LivePart::Update> made;
  {
    const std::lock_guard lock(live_mutex_);
    made = part_.update(std::move(*read), inputs, *shown(), diagnostics, &work);
  }
  if (!made) return false;
  made->shown.timing = times.text() + ", " + made->shown.timing;
  publish_result("model", std::move(made->shown),
                 [&](const Shown& next) { return model_event(next, made->changed_tiles); });
  return true;
}

/// The surfaces of the tools instead of interpolated columns, once nothing changes any more.
void Session::make_exact() {
  exact_tried_ = true;
  if (options_.edges != IdleEdges::exact) return;
  stop_work_ = false;
  Work work(*this, Work::Reports::none);
  std::optional<Shown> next = part_.exact(*shown(), &work);
  if (!next) return;
  const std::string event = exact_event(*next);
  publish(std::move(*next));
  events_.publish("exact", event);
}

void Session::publish_errors(const Diagnostics& diagnostics) {
  publish_result("errors", with_errors(*shown(), options_.file, diagnostics), errors_event);
}

/// What a load has made ends its work.
void Session::publish_result(const std::string& name, Shown next,
                             const std::function<std::string(const Shown&)>& event_of) {
  std::string event;
  {
    const std::lock_guard lock(mutex_);
    next.input = input_;
    next.console = is_script(options_.file) ? script_.output() : printed_.text();
    event = event_of(next);
    shown_ = std::make_shared<const Shown>(std::move(next));
    work_.clear();
  }
  events_.publish(name, event);
}

void Session::publish(Shown next) {
  auto kept = std::make_shared<const Shown>(std::move(next));
  const std::lock_guard lock(mutex_);
  shown_ = std::move(kept);
}

std::optional<std::string> Session::at(std::uint32_t step, std::uint32_t from) {
  const std::unique_lock lock(live_mutex_, std::try_to_lock);
  return lock.owns_lock() ? part_.at(step, from, shown()->revision) : std::string();
}

}  // namespace kerf::app::view
