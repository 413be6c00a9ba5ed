// gcmc programs as a way in.
#include <optional>
#include <string>
#include <utility>

#include "job/front_ends.h"

#include "kerf/gcmc.h"

namespace kerf {
namespace {

/// Drops the texts of message(); warnings and errors are in the diagnostics.
class NoOutput final : public GcmcOutput {
 public:
  void message(const Diagnostic&) override {}
  void text(std::string_view) override {}
};

/// Statements such as include("..."), goto([...]) or feedrate(...) at the start of a line.
bool looks_like_gcmc(std::string_view text) {
  for (const std::string_view word : {"include(\"", "goto([", "move([", "feedrate("})
    if (text.substr(0, word.size()) == word || text.find("\n" + std::string(word)) != std::string_view::npos)
      return true;
  return false;
}

/// The stock that the program's comments describe, as those of G-code do.
std::optional<Stock> stock_of(const Toolpath& path, Diagnostics& diagnostics) {
  StockComments comments;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::note) comments.read(path.text(i), 1.0, path.origin_of(i), diagnostics);
  return comments.stock();
}

/// The files among the texts of a run: not the defines, nor Kerf's own library.
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
  if (std::string folder = folder_of(file.path()); !folder.empty()) options.include_paths.push_back(folder);
  options.include_paths.insert(options.include_paths.end(), input.include_paths.begin(),
                               input.include_paths.end());
  NoOutput output;
  GcmcRun run = run_gcmc(file.bytes(), options, output, diagnostics, progress);
  Program program;
  program.stock = stock_of(run.path, diagnostics);
  program.files = files_of(run, options.file_name);
  program.path = std::move(run.path);
  return program;
}

}  // namespace

FrontEnd gcmc_front_end() { return {"gcmc", {".gcmc"}, looks_like_gcmc, read}; }

}  // namespace kerf
