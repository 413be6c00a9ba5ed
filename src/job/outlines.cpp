// Outlines from JSON files and from Python scripts.
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/system.h"
#include "job/python_script.h"

#include "kerf/job/program.h"

namespace kerf {
namespace {

/// Runs a script and returns the outlines that it cuts with cnc25d_api.
std::vector<NamedOutline> outlines_of_script(const std::string& script, Diagnostics& diagnostics) {
  const TemporaryFolder folder("kerf-outlines");
  const auto fail = [&](const std::string& message) {
    diagnostics.error(codes::script_failed, TextLocation{script, 0, 0}, message);
    return std::vector<NamedOutline>();
  };
  if (folder.path().empty()) return fail("cannot create a temporary folder");
  const std::string noted = folder.path() + "/outlines.json";
  if (!InputFile::open(script, diagnostics)) return {};
  warn_of_hidden_module(script, diagnostics);
  const int status = run_python(script, {.environment = {{"KERF_OUTLINES", noted}}}, diagnostics);
  if (status < 0) return {};
  if (status != 0) return fail(fmt::format("the script ended with exit status {}", status));
  if (!exists(noted)) return fail("the script cut no outline with cnc25d_api.cnc_cut_outline()");
  const auto file = InputFile::open(noted, diagnostics);
  if (!file) return {};
  return read_outline_file(file->bytes(), script, diagnostics);
}

}  // namespace

std::vector<NamedOutline> load_outlines(const std::string& name, Diagnostics& diagnostics) {
  if (name.ends_with(".py")) return outlines_of_script(name, diagnostics);
  const auto file = InputFile::open(name, diagnostics);
  return file ? read_outline_file(file->bytes(), name, diagnostics) : std::vector<NamedOutline>();
}

}  // namespace kerf
