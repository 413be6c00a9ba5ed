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

std::string single_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

/// -a with the known words and their meanings; empty: there are none.
std::string words_text(const KnownValues& values) {
  std::string list;
  for (const KnownWord& word : values.words) {
    std::string entry = word.word + (word.meaning.empty() ? "" : "\\t" + word.meaning);
    std::erase_if(entry, [](char c) { return c == '\'' || c == '"' || c == '%' || c == '$'; });
    list += (list.empty() ? "" : "\\n") + entry;
  }
  return list.empty() ? "" : fmt::format(" -a \"(printf '{}\\n')\"", list);
}

/// -a with the files that have one of the endings, or -F for all.
std::string files_text(const KnownValues& values) {
  if (values.folders) return " -a '(__fish_complete_directories)'";
  if (!values.files) return "";
  if (values.endings.empty()) return " -F";
  std::string endings;
  for (const std::string& ending : values.endings) endings += " " + ending;
  return fmt::format(" -k -a '(__fish_complete_suffix{})'", endings);
}

/// One line, or two where words and files are possible: fish takes one list per line.
std::string option_lines(const CommandDescription& command, const OptionDescription& option) {
  const KnownValues values = known_values(command.name, option);
  std::string start = "complete -c kerf -n " + single_quoted("__kerf_at " + command.name);
  for (const std::string& name : option.names) {
    if (name.starts_with("--"))
      start += " -l " + name.substr(2);
    else if (name.starts_with("-"))
      start += " -s " + name.substr(1);
  }
  const std::string end = option.positional ? "\n" : " -d " + single_quoted(option.summary) + "\n";
  if (!option.positional && option.value.empty()) return start + end;
  if (!option.positional) start += " -r";
  const std::string words = words_text(values), files = files_text(values);
  if (words.empty() && files.empty()) return option.positional ? "" : start + end;
  std::string lines;
  for (const std::string& list : {words, files})
    if (!list.empty()) lines += start + list + end;
  return lines;
}

}  // namespace

std::string fish_completion(const CommandDescription& root) {
  std::string text = kHead;
  for (const CommandDescription* command : all_commands(root)) {
    const std::string where = command->name.empty() ? "" : " " + command->name;
    for (const CommandDescription& below : command->commands)
      text += fmt::format("complete -c kerf -n {} -a {} -d {}\n", single_quoted("__kerf_exactly" + where),
                          last_word(below.name), single_quoted(below.summary));
    for (const OptionDescription& option : command->options)
      if (!command->name.empty() || command->commands.empty()) text += option_lines(*command, option);
  }
  return text +
         "complete -c kerf -n '__kerf_exactly' -a help -d 'The options of a command'\n"
         "complete -c kerf -n '__kerf_exactly' -l version -d 'Print the version'\n"
         "complete -c kerf -n '__kerf_exactly' -s h -l help -d 'List the commands'\n";
}

}  // namespace kerf::app
