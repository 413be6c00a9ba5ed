// gcmc programs as a way in.
#include <utility>

#include "app/input.h"

#include "kerf/gcmc.h"

namespace kerf::app {
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

LoadedProgram read(const InputFile& file, const InputOptions&, Diagnostics& diagnostics, Progress* progress) {
  GcmcOptions options;
  options.file_name = file.path();
  Unheard output;
  GcmcRun run = run_gcmc(file.bytes(), options, output, diagnostics, progress);
  LoadedProgram loaded;
  loaded.path = std::move(run.path);
  return loaded;
}

}  // namespace

FrontEnd gcmc_front_end() { return {"gcmc", {".gcmc"}, looks_like_gcmc, read}; }

}  // namespace kerf::app
