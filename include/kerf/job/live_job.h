// The run of a job whose program is edited: after an edit only the columns that it touches are cut again.
//
//   LiveJob live;
//   while (auto program = next_version()) {
//     auto job = std::make_shared<const Job>(
//         make_job_or_print(std::move(*program), settings, UnknownTool::assume, diagnostics));
//     auto change = live.update(job, {.resolution = mm(0.1)}, {}, diagnostics);
//     if (change) draw(*live.cut(), change->columns);
//   }
//
// Prints and jobs on a fourth axis are run as a whole each time.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/job/findings.h"
#include "kerf/job/job.h"
#include "kerf/sim/live.h"

namespace kerf {

/// How a job was run. `path_only`: nothing is removed or added, or there is no stock.
enum class LiveKind : std::uint8_t { path_only, milling, rotary, print };

struct LiveJobChange {
  bool is_new = false;               // other stock, tools or kind: nothing of the previous part remains
  std::vector<ColumnBlock> columns;  // of a milling job: all that may differ from the previous part
  std::vector<StepShift> shifts;     // of the steps that made the surfaces of all other columns
};

class LiveJob {
 public:
  LiveJob();
  LiveJob(LiveJob&&) noexcept;
  LiveJob& operator=(LiveJob&&) noexcept;
  ~LiveJob();

  /// Makes this the run of `job`. `check` is used for the findings; its resolution is ignored. Nothing, and
  /// the previous run stays, with an error if the job cannot be run, or if stopped.
  std::optional<LiveJobChange> update(std::shared_ptr<const Job> job, const RunOptions& options,
                                      const JobCheckOptions& check, Diagnostics& diagnostics,
                                      Progress* progress = nullptr);

  LiveKind kind() const;
  /// The job of the last update; null before the first.
  const std::shared_ptr<const Job>& job() const;
  /// Of a milling job; else null.
  const LiveSimulation* cut() const;
  /// Of a job on a fourth axis and of a print; else null.
  const JobRun* run() const;
  /// The findings of check_job(), in the order of steps.
  const std::vector<Finding>& findings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kerf
