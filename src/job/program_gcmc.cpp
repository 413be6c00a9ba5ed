// gcmc programs as a way in.
#include <optional>
#include <string>
#include <utility>

#include "kerf/gcmc.h"
#include "kerf/program.h"

namespace kerf {
namespace {

/// What a program says with message() has no place in a report; warnings and errors are in the diagnostics.
class Unheard final : public GcmcOutput {
 public:
  void message(const GcmcMessage&) override {}
  void text(std::string_view) override {}
};

/// Statements such as include("..."), goto([...]) or feedrate(...) at the begin of a line.
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

LoadedProgram read(const InputFile& file, const InputOptions&, Diagnostics& diagnostics, Progress* progress) {
  GcmcOptions options;
  options.file_name = file.path();
  if (std::string folder = folder_of(file.path()); !folder.empty()) options.include_paths.push_back(folder);
  Unheard output;
  GcmcRun run = run_gcmc(file.bytes(), options, output, diagnostics, progress);
  LoadedProgram loaded;
  loaded.stock = stock_of(run.path, diagnostics);
  loaded.path = std::move(run.path);
  return loaded;
}

}  // namespace

FrontEnd gcmc_front_end() { return {"gcmc", {".gcmc"}, looks_like_gcmc, read}; }

}  // namespace kerf
