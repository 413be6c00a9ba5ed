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

/// The text of a source; nothing for binary and unreadable files.
struct SourceText {
  std::string path;
  std::optional<std::string> text;
  bool is_complete = false;
};
/// The texts of a program's files, each up to a maximum that a page can show.
std::vector<SourceText> read_sources(const std::vector<std::string>& files);
Record files_record(const std::vector<SourceText>& sources);

struct ModelInputs {
  const LiveJob& live;
  const Diagnostics& diagnostics;
  const std::optional<Machine>& machine;
  const std::vector<SourceText>& sources;
  std::size_t motions = 0;
  std::size_t tiles = 0;
  const Record* target = nullptr;  // null: none
};
Record model_record(const ModelInputs& inputs);

}  // namespace kerf::app::view
