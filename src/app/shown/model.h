// What /model says about a part: an object without the keys that change between revisions of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "job/record/record.h"

#include "kerf/job/live_job.h"
#include "kerf/path/machine.h"

namespace kerf::app::view {

struct ModelInputs {
  const LiveJob& live;
  const Diagnostics& diagnostics;
  const std::optional<Machine>& machine;
  std::size_t motions = 0;
  std::size_t tiles = 0;
  const Record* target = nullptr;  // null: none
};
Record model_record(const ModelInputs& inputs);

}  // namespace kerf::app::view
