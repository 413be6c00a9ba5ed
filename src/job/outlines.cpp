// Outlines from JSON files and from Python scripts.
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "base/codes/files.h"
#include "job/python_script.h"

#include "kerf/job/program.h"

namespace kerf {
namespace {

/// A new empty file in the folder for temporary files, removed by the destructor.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string name = (std::filesystem::temp_directory_path() / "kerf-outlines-XXXXXX").string();
    const int handle = mkstemp(name.data());
    if (handle < 0) return;
    close(handle);
    path_ = name;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Runs a script and returns the outlines that it cuts with cnc25d_api.
std::vector<NamedOutline> outlines_of_script(const std::string& script, Diagnostics& diagnostics) {
  const TemporaryFile noted;
  const auto fail = [&](const std::string& message) {
    diagnostics.error(codes::script_failed, TextLocation{script, 0, 0}, message);
    return std::vector<NamedOutline>();
  };
  if (noted.path().empty()) return fail("cannot create a temporary file");
  if (!InputFile::open(script, diagnostics)) return {};
  const int status = run_python(script, {.environment = {{"KERF_OUTLINES", noted.path()}}}, diagnostics);
  if (status < 0) return {};
  if (status != 0) return fail(fmt::format("the script ended with exit status {}", status));
  const auto file = InputFile::open(noted.path(), diagnostics);
  if (!file) return {};
  if (file->bytes().empty()) return fail("the script cut no outline with cnc25d_api.cnc_cut_outline()");
  return read_outline_file(file->bytes(), script, diagnostics);
}

}  // namespace

std::vector<NamedOutline> load_outlines(const std::string& name, Diagnostics& diagnostics) {
  if (name.ends_with(".py")) return outlines_of_script(name, diagnostics);
  const auto file = InputFile::open(name, diagnostics);
  return file ? read_outline_file(file->bytes(), name, diagnostics) : std::vector<NamedOutline>();
}

}  // namespace kerf
