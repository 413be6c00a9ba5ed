// The completion script of fish.
#include <fmt/format.h>
#include <string_view>

#include "app/help/help_texts.h"
#include "app/help/values.h"

namespace kerf::app {
namespace {

constexpr const char* kHead = R"(# Completion of kerf for fish, made by: kerf completion fish

# Whether the words so far are those of a command: __kerf_at tools show
function __kerf_at
    set -l words (commandline -opc)
    set -e words[1]
    if test (count $words) -gt 0; and test "$words[1]" = help
        set -e words[1]
    end
    test (count $words) -ge (count $argv); or return 1
    for i in (seq (count $argv))
        test "$words[$i]" = "$argv[$i]"; or return 1
    end
end

# Whether they are those of a command that has commands below it, and nothing else yet.
function __kerf_exactly
    set -l words (commandline -opc)
    set -e words[1]
    if test (count $words) -gt 0; and test "$words[1]" = help
        set -e words[1]
    end
    test (count $words) -eq (count $argv); and __kerf_at $argv
end

complete -c kerf -f
)";

std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

/// The options of `complete` for a value: known words, and files with endings.
std::string value_text(const KnownValues& values) {
  std::string list;
  for (const KnownWord& word : values.words) {
    if (!list.empty()) list += "\\n";
    list += word.word + (word.meaning.empty() ? "" : "\\t" + word.meaning);
  }
  std::string text;
  if (!list.empty()) {
    std::string escaped;
    for (const char c : list)
      escaped += c == '\'' ? "\\'" : c == '"' || c == '%' ? std::string() : std::string(1, c);
    text += fmt::format(" -a \"(printf '{}\\n')\"", escaped);
  }
  if (values.folders) text += " -a '(__fish_complete_directories)'";
  if (!values.files) return text;
  if (values.endings.empty()) return text + " -F";
  std::string endings;
  for (const std::string& ending : values.endings) endings += " " + ending;
  return text + fmt::format(" -k -a '(__fish_complete_suffix{})'", endings);
}

std::string option_line(const CommandDescription& command, const OptionDescription& option) {
  std::string text = "complete -c kerf -n " + quoted("__kerf_at " + command.name);
  if (option.positional) {
    const std::string values = value_text(known_values(command.name, option));
    return values.empty() ? "" : text + values + "\n";
  }
  for (const std::string& name : option.names) {
    if (name.starts_with("--"))
      text += " -l " + name.substr(2);
    else if (name.starts_with("-"))
      text += " -s " + name.substr(1);
  }
  if (!option.value.empty()) text += " -r" + value_text(known_values(command.name, option));
  return text + " -d " + quoted(option.summary) + "\n";
}

}  // namespace

std::string fish_completion(const CommandDescription& root) {
  std::string text = kHead;
  for (const CommandDescription* command : all_commands(root)) {
    const std::string where = command->name.empty() ? "" : " " + command->name;
    for (const CommandDescription& below : command->commands)
      text += fmt::format("complete -c kerf -n {} -a {} -d {}\n", quoted("__kerf_exactly" + where),
                          last_word(below.name), quoted(below.summary));
    for (const OptionDescription& option : command->options)
      if (!command->name.empty() || command->commands.empty()) text += option_line(*command, option);
  }
  return text +
         "complete -c kerf -n '__kerf_exactly' -a help -d 'The options of a command'\n"
         "complete -c kerf -n '__kerf_exactly' -l version -d 'Print the version'\n"
         "complete -c kerf -n '__kerf_exactly' -s h -l help -d 'List the commands'\n";
}

}  // namespace kerf::app
