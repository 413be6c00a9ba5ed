// kerf completion, kerf man: what shells and man(1) know of the commands.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/help/help_texts.h"
#include "app/options/adjustz_options.h"
#include "app/options/gcmc_options.h"
#include "app/options/pathdxf_options.h"
#include "base/codes/files.h"
#include "base/file_names.h"

#include "kerf/base/files.h"

namespace kerf::app {
namespace {

/// The drop-in commands have options of their own, which the command line does not parse.
CommandDescription with_drop_ins(CommandDescription root) {
  const auto file = [](const char* summary) {
    return OptionDescription{{"FILE"}, "", summary, {}, true, false, true};
  };
  for (CommandDescription& command : root.commands) {
    if (command.name == "gcmc") {
      command.options = gcmc_option_descriptions();
      command.options.push_back(file("The gcmc program; standard input without it"));
    } else if (command.name == "pathdxf") {
      command.options = pathdxf_option_descriptions();
      command.options.push_back(file("The path drawings (.dxf)"));
    } else if (command.name == "adjustz") {
      command.options = adjustz_option_descriptions();
      command.options.push_back(file("The drawings or programs with measured heights"));
    }
  }
  return root;
}

struct Options {
  OutputOptions output;
  std::string shell, folder;
};

Status print_completion(Console& console, const CommandDescription& commands, const std::string& shell) {
  console.print(shell == "bash"  ? bash_completion(commands)
                : shell == "zsh" ? zsh_completion(commands)
                                 : fish_completion(commands));
  return Status::done;
}

Status write_pages(Console& console, const CommandDescription& commands, const std::string& folder) {
  Diagnostics diagnostics;
  make_folders(folder);
  OutputSet files;
  bool good = true;
  for (const auto& [name, text] : manual_pages(commands, KERF_VERSION))
    good = good && files.write(path_in(folder, name), text, diagnostics);
  return good && files.commit(diagnostics) ? Status::done : fail(console, diagnostics, Status::input_errors);
}

const char* const kCompletionFooter = R"(
Examples:
  source <(kerf completion bash)                                  in this shell
  kerf completion bash > ~/.local/share/bash-completion/completions/kerf
  kerf completion zsh > ~/.zfunc/_kerf                            in a folder of $fpath
  kerf completion fish > ~/.config/fish/completions/kerf.fish
)";

const char* const kManFooter = R"(
Examples:
  kerf man ~/.local/share/man/man1       then: man kerf-simulate
)";

}  // namespace

Command add_completion(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = root.add_command("completion", "Print the completion script of a shell");
  parser.set_footer(kCompletionFooter);
  parser.add_text("SHELL", options->shell, "bash, zsh or fish").required().one_of({"bash", "zsh", "fish"});
  return {parser, &options->output, [options, root](Console& console) {
            return print_completion(console, with_drop_ins(root.description()), options->shell);
          }};
}

Command add_man(CommandParser& root) {
  auto options = std::make_shared<Options>();
  CommandParser parser = root.add_command("man", "Write the manual pages of all commands");
  parser.set_footer(kManFooter);
  parser.add_text("FOLDER", options->folder, "Where to write them; it is created").required().value_name("");
  return {parser, &options->output, [options, root](Console& console) {
            return write_pages(console, with_drop_ins(root.description()), options->folder);
          }};
}

}  // namespace kerf::app
