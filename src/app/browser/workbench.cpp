// Files are read by the same functions as in the command; only their folder is in memory.
#include "app/browser/workbench.h"

#include <new>
#include <utility>

#include "app/shown/file_name.h"
#include "app/shown/viewable.h"
#include "base/codes/files.h"
#include "base/ending.h"

#include "kerf/base/files.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kEditedText = std::size_t{4} << 20;  // bytes; larger ones are not edited in the page
constexpr std::size_t kMaxFile = std::size_t{64} << 20;    // bytes, as for uploads to the server

bool needs_python(const std::string& name) { return ending_of(name) == ".py"; }

Inputs usual_inputs() {
  Inputs inputs;
  inputs.program.unknown_diameter = UnknownDiameter::assume;
  return inputs;
}

}  // namespace

Workbench::Workbench(std::string folder)
    : folder_(std::move(folder)), part_({.threads = 1, .whole_text = kEditedText}) {}

bool Workbench::put(std::string_view name, std::string_view bytes) {
  problem_.clear();
  if (bytes.size() > kMaxFile) {
    problem_ = "the file has more than 64 MB";
    return false;
  }
  Diagnostics ignored;
  OutputSet files;
  if (!files.write(folder_ + download_name(name), bytes, ignored) || !files.commit(ignored))
    problem_ = "the file cannot be stored";
  return problem_.empty();
}

std::optional<Job> Workbench::read(const std::string& file, const Inputs& inputs, Printed& printed,
                                   Diagnostics& diagnostics, Progress* progress) const {
  if (needs_python(file)) {
    diagnostics.error(codes::script_failed, TextLocation{file, 0, 0}, "a page cannot run Python scripts")
        .hint = "kerf view shows what they make";
    return std::nullopt;
  }
  if (std::optional<Job> job = load_drawing_or_mesh(file, inputs.unit, diagnostics, progress)) return job;
  if (diagnostics.has_errors()) return std::nullopt;
  ProgramOptions how = inputs.program;
  how.printed = [&printed](std::string_view line) { printed.add(line); };
  std::optional<Program> program = load_program(file, how, diagnostics, progress);
  if (!program || diagnostics.has_errors())
    if (auto drawing = load_plain_dxf(file, inputs.unit, diagnostics, progress)) return drawing;
  if (!program || diagnostics.has_errors() || stop_requested(progress)) return std::nullopt;
  return make_job_or_print(std::move(*program), inputs.job, UnknownTool::assume, diagnostics);
}

bool Workbench::load(std::string_view name, Progress* progress) {
  const std::string file = folder_ + download_name(name);
  const Inputs inputs = usual_inputs();
  Diagnostics diagnostics;
  Printed printed;
  std::optional<LivePart::Update> made;
  try {
    std::optional<Job> job = read(file, inputs, printed, diagnostics, progress);
    if (job && !diagnostics.has_errors())
      made = part_.update(std::move(*job), inputs, shown_, diagnostics, progress);
  } catch (const std::bad_alloc&) {
    diagnostics.error(codes::stopped, TextLocation{file, 0, 0}, "out of memory");
  }
  if (made) {
    shown_ = std::move(made->shown);
    shown_.console = printed.text();
    event_ = model_event(shown_, made->changed_tiles);
    return true;
  }
  if (stop_requested(progress))
    diagnostics.error(codes::stopped, TextLocation{file, 0, 0},
                      "the program took too long and has been stopped");
  shown_ = with_errors(shown_, file, diagnostics, kEditedText);
  shown_.console = printed.text();
  event_ = errors_event(shown_);
  return false;
}

bool Workbench::make_exact(Progress* progress) {
  std::optional<Shown> next;
  try {
    next = part_.exact(shown_, progress);
  } catch (const std::bad_alloc&) {
    return false;  // the part stays as the columns show it
  }
  if (next) shown_ = std::move(*next);
  return next.has_value();
}

std::optional<std::string> Workbench::at(std::uint32_t step, std::uint32_t from) const {
  return part_.at(step, from, shown_.revision);
}

Download Workbench::download(const DownloadRequest& request) const {
  return make_download(shown_, request, 1);
}

}  // namespace kerf::app::view
