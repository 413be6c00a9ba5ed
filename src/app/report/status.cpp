// Exit statuses and the messages that belong to them.
#include "app/report/status.h"

#include <fmt/format.h>

#include "base/codes/files.h"

namespace kerf::app {

Status fail(Console& console, const Diagnostics& diagnostics, Status status) {
  console.show(diagnostics);
  if (console.json())
    console.print_json(text_of(Record{{"diagnostics", record_of(diagnostics)}}, Layout::indented));
  return status;
}

Status report_stopped(Console& console) {
  Diagnostics diagnostics;
  diagnostics.error(codes::stopped, {}, "interrupted; nothing was written");
  console.show(diagnostics, Console::Channel::always_text);
  return Status::interrupted;
}

std::optional<Status> finish_outputs(Console& console, TerminalProgress& progress, bool written,
                                     OutputSet& set, Diagnostics& diagnostics) {
  progress.clear();
  if (interrupted()) return report_stopped(console);
  if (!written || !set.commit(diagnostics)) return fail(console, diagnostics, Status::input_errors);
  return std::nullopt;
}

void show_written(Console& console, const std::vector<PartFile>& files) {
  for (const PartFile& file : files) console.summary(fmt::format("wrote    {}", file.path));
}

}  // namespace kerf::app
