// Live jobs: what of the previous run can be kept, and the findings of the new one.
#include "kerf/job/live_job.h"

#include <algorithm>
#include <utility>

#include "job/job_findings.h"

namespace kerf {
namespace {

bool same_tool(const Tool& a, const Tool& b) {
  const Silhouette &s = a.silhouette, &t = b.silhouette;
  return a.number == b.number && s.cutting == t.cutting && s.neck == t.neck && s.shank == t.shank &&
         s.holder == t.holder && a.plunges == b.plunges;
}

bool same_tools(const ToolTable& a, const ToolTable& b) {
  return std::equal(
      a.tools().begin(), a.tools().end(), b.tools().begin(), b.tools().end(),
      [](const auto& x, const auto& y) { return x.first == y.first && same_tool(x.second, y.second); });
}

bool same_corner(Point3 a, Point3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

bool same_stock(const Stock& a, const Stock& b) {
  return a.body == b.body && same_corner(a.block.low, b.block.low) && same_corner(a.block.high, b.block.high);
}

LiveKind kind_of(const Job& job) {
  if (job.kind == JobKind::print) return LiveKind::print;
  if (job.kind == JobKind::rotary) return LiveKind::rotary;
  return job.stock ? LiveKind::milling : LiveKind::path_only;
}

}  // namespace

struct LiveJob::State {
  RunOptions options;      // of the last update
  Length live_resolution;  // as given for `live`
  std::shared_ptr<const Job> job;
  LiveKind kind = LiveKind::path_only;
  std::optional<LiveSimulation> live;
  std::optional<JobRun> run;
  std::vector<Finding> findings;

  SimulationOptions how(const Job& of) const {
    SimulationOptions out = simulation_of(of);
    out.resolution = options.resolution;
    out.threads = options.threads;
    return out;
  }
  bool can_continue(const Job& next) const {
    return live && live_resolution == options.resolution && job && job->stock &&
           same_stock(*job->stock, *next.stock) && same_tools(job->tools, next.tools) &&
           job->rapid_rates == next.rapid_rates && job->spoilboard == next.spoilboard;
  }
  std::optional<LiveJobChange> cut(const std::shared_ptr<const Job>& next, Diagnostics& diagnostics,
                                   Progress* progress);
  std::optional<LiveJobChange> run_whole(const std::shared_ptr<const Job>& next, Diagnostics& diagnostics,
                                         Progress* progress);
};

/// Cuts a milling job.
std::optional<LiveJobChange> LiveJob::State::cut(const std::shared_ptr<const Job>& next,
                                                 Diagnostics& diagnostics, Progress* progress) {
  LiveJobChange change;
  change.is_new = !can_continue(*next);
  std::optional<LiveSimulation> fresh;
  if (change.is_new) fresh.emplace(next->tools, *next->stock, LiveOptions{.simulation = how(*next)});
  LiveSimulation& used = fresh ? *fresh : *live;
  const auto update =
      used.update(std::shared_ptr<const Toolpath>(next, &next->program.path), diagnostics, progress);
  if (!update || update->stopped) return std::nullopt;  // half cut, the next update starts over
  if (fresh) live = std::move(fresh);
  live_resolution = options.resolution;
  change.columns = update->redone;
  change.shifts = update->shifts;
  warn_units(*next, diagnostics);
  warn_untouched(*next, live->removed(), diagnostics);
  findings = findings_of_milling(*next, live->hazards(), how(*next), diagnostics, progress);
  return change;
}

std::optional<LiveJobChange> LiveJob::State::run_whole(const std::shared_ptr<const Job>& next,
                                                       Diagnostics& diagnostics, Progress* progress) {
  auto done = run_job(*next, options, diagnostics, progress);
  if (!done) return std::nullopt;
  findings = done->findings;
  run = std::move(done);
  return LiveJobChange{.is_new = true, .columns = {}, .shifts = {}};
}

LiveJob::LiveJob() : state_(std::make_unique<State>()) {}
LiveJob::LiveJob(LiveJob&&) noexcept = default;
LiveJob& LiveJob::operator=(LiveJob&&) noexcept = default;
LiveJob::~LiveJob() = default;

std::optional<LiveJobChange> LiveJob::update(std::shared_ptr<const Job> job, const RunOptions& options,
                                             const JobCheckOptions& check, Diagnostics& diagnostics,
                                             Progress* progress) {
  State& s = *state_;
  if (diagnostics.has_errors()) return std::nullopt;
  s.options = options;
  const LiveKind kind = kind_of(*job);
  std::optional<LiveJobChange> change = LiveJobChange{.is_new = true, .columns = {}, .shifts = {}};
  std::vector<Finding> before = std::exchange(s.findings, {});
  if (kind == LiveKind::milling) change = s.cut(job, diagnostics, progress);
  if (kind == LiveKind::rotary || kind == LiveKind::print) change = s.run_whole(job, diagnostics, progress);
  if (!change || stop_requested(progress)) {
    s.findings = std::move(before);
    return std::nullopt;
  }
  if (kind != LiveKind::milling) s.live.reset();
  if (kind == LiveKind::milling || kind == LiveKind::path_only) s.run.reset();
  s.kind = kind;
  s.job = std::move(job);
  // Z that counts downwards is found in the path too.
  if (s.job->z_downwards) s.findings.clear();
  s.findings = check_with_material(*s.job, check, std::move(s.findings), diagnostics);
  return change;
}

LiveKind LiveJob::kind() const { return state_->kind; }
const std::shared_ptr<const Job>& LiveJob::job() const { return state_->job; }
const LiveSimulation* LiveJob::cut() const { return state_->live ? &*state_->live : nullptr; }
const JobRun* LiveJob::run() const { return state_->run ? &*state_->run : nullptr; }
const std::vector<Finding>& LiveJob::findings() const { return state_->findings; }

}  // namespace kerf
