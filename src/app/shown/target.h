// What a milled part has left of its target, or taken from it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "job/record/record.h"

#include "kerf/job/live_job.h"
#include "kerf/sim/compare.h"

namespace kerf::app::view {

/// The mesh that the part is compared with.
struct Target {
  std::string file;
  std::shared_ptr<const StockBody> body;
  Length tolerance = default_tolerance::kComparison;
};

struct TargetResult {
  Record figures;    // "target" of /model
  std::string body;  // of /target
};
/// Nothing if the job is not a milled one, is stopped, or cannot be compared; then with an error.
std::optional<TargetResult> compare_with_target(const LiveJob& live, const Target& target,
                                                std::uint32_t revision, Diagnostics& diagnostics,
                                                Progress* progress);

}  // namespace kerf::app::view
