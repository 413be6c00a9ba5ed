// Exit statuses and the messages that belong to them.
#include "app/report/status.h"

#include <fmt/format.h>

#include "base/codes/files.h"

namespace kerf::app {

void print_object(Console& console, const Record& object) {
  console.print_json(text_of(object, console.object_lines() ? Layout::line : Layout::indented));
}

Status fail(Console& console, const Diagnostics& diagnostics, Status status) {
  console.show(diagnostics);
  if (console.json()) print_object(console, Record{{"diagnostics", record_of(diagnostics)}});
  return status;
}

Status worse(Status a, Status b) {
  for (const Status status :
       {Status::interrupted, Status::wrong_usage, Status::input_errors, Status::hazards})
    if (a == status || b == status) return status;
  return Status::done;
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
  if (console.sends_output()) return;  // one of them is temporary
  for (const PartFile& file : files) console.summary(fmt::format("wrote    {}", file.path));
}

}  // namespace kerf::app
