// The front end for gcmc programs.
#include <fmt/format.h>
#include <optional>
#include <string>
#include <utility>

#include "base/codes/gcmc.h"
#include "base/file_names.h"
#include "front/gcmc/gcmc.h"
#include "job/front_ends.h"
#include "job/gcmc_workshop.h"
#include "job/program_comments.h"

namespace kerf {
namespace {

/// Passes on what the program prints by message(), warning() and error(). The warnings and errors of the
/// language are in the diagnostics alone.
class PrintedMessages final : public GcmcOutput {
 public:
  explicit PrintedMessages(const ProgramOptions& options) : printed_(options.printed) {}
  void message(const Diagnostic& message) override {
    if (printed_ && message.code == codes::gcmc_script) printed_(gcmc_line(message));
  }
  void text(std::string_view) override {}

 private:
  const decltype(ProgramOptions::printed)& printed_;
};

/// Statements such as include("..."), goto([...]) or feedrate(...) at the start of a line.
bool looks_like_gcmc(std::string_view text) {
  for (const std::string_view word : {"include(\"", "goto([", "move([", "feedrate("})
    if (text.substr(0, word.size()) == word || text.find("\n" + std::string(word)) != std::string_view::npos)
      return true;
  return false;
}

/// The files among the sources of a run, without the defines and the built-in library.
std::vector<std::string> files_of(const GcmcRun& run, const std::string& program) {
  std::vector<std::string> files;
  for (const auto& [name, text] : run.sources)
    if (name != program && name != kGcmcDefinesName && name.rfind(kGcmcLibraryPrefix, 0) != 0)
      files.push_back(name);
  return files;
}

Program read(const InputFile& file, const ProgramOptions& input, Diagnostics& diagnostics,
             Progress* progress) {
  GcmcOptions options;
  options.file_name = file.path();
  options.defines = input.defines;
  if (!input.gcmc_version.empty()) {
    const auto version = gcmc_version_named(input.gcmc_version);
    if (!version) {
      diagnostics.error(codes::gcmc_arguments, TextLocation{file.path(), 0, 0},
                        fmt::format("unknown version {} of gcmc, expected 1.8 or 1.9", input.gcmc_version));
      return {};
    }
    options.version = *version;
  }
  if (std::string folder = folder_of(file.path()); !folder.empty()) options.include_paths.push_back(folder);
  options.include_paths.insert(options.include_paths.end(), input.include_paths.begin(),
                               input.include_paths.end());
  options.workshop = &gcmc_workshop();
  PrintedMessages output(input);
  GcmcRun run = run_gcmc(file.bytes(), options, output, diagnostics, progress);
  Program program;
  program.files = files_of(run, options.file_name);
  program.path = std::move(run.path);
  read_comments(program, diagnostics);
  return program;
}

}  // namespace

FrontEnd gcmc_front_end() {
  return {"gcmc", {".gcmc"}, looks_like_gcmc, read, {OptionGroup::define, OptionGroup::gcmc}};
}

}  // namespace kerf
