// kerf lsp: the language server, which editors start.
#include <cstdio>
#include <memory>

#include "app/commands/commands.h"
#include "app/lsp/server.h"
#include "app/options/common.h"

namespace kerf::app {
namespace {

const char* const kExamples =
    R"(  kerf lsp                             is started by the editor

Serves an editor by the Language Server Protocol over standard input and output: messages while typing and
hazards after saving, what a line does and how long it takes, definitions of subroutines, functions and
variables, an outline, and completion, for G-code, gcmc, OpenSCAD and job files. The folder editors of the
source has an extension for Visual Studio Code; docs/manual/editors.md has settings for others.
)";

struct Options {
  OutputOptions output;
  bool stdio = false;  // which some editors pass
};

}  // namespace

Command add_lsp(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser =
      new_command(root, "lsp", "The language server for editors", kExamples, options->output);
  parser.option("--json").description("No effect");
  parser.option("--quiet").description("No effect");
  parser.add_flag("--stdio", options->stdio, "No effect: the streams are always standard input and output");
  return {parser, &options->output,
          [options](Console&) { return static_cast<Status>(lsp::serve(stdin, stdout)); }};
}

}  // namespace kerf::app
