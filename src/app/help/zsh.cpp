// The completion script of zsh, for its function _arguments.
#include <fmt/format.h>
#include <string_view>

#include "app/help/help_texts.h"
#include "app/help/values.h"

namespace kerf::app {
namespace {

constexpr const char* kHead = R"(#compdef kerf
# Completion of kerf for zsh, made by: kerf completion zsh

# _kerf_words_and_files PATTERN WORD...
_kerf_words_and_files() {
  local pattern=$1
  shift
  compadd -- "$@"
  _files -g "$pattern"
}

)";

/// For a text within single quotes, with a backslash before what _arguments and _describe would interpret.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out;
}

/// A meaning within the double quotes of a list: letters, digits and what needs no quoting.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::string_view("\"\\'$`()").find(c) == std::string_view::npos) out += c == ':' ? ' ' : c;
  return out;
}

/// "*.(nc|ngc)"; in small and capital letters.
std::string file_pattern(const std::vector<std::string>& endings) {
  std::string text;
  for (const std::string& ending : endings) text += (text.empty() ? "" : "|") + ending.substr(1);
  return endings.size() > 1 ? fmt::format("(#i)*.({})", text) : fmt::format("(#i)*.{}", text);
}

/// The action of a value: a list of words, shown with their meanings, or a call.
std::string action(const KnownValues& values) {
  const std::string pattern = values.endings.empty() ? "*" : file_pattern(values.endings);
  std::string words, described;
  for (const KnownWord& word : values.words) {
    words += " " + word.word;
    described += fmt::format("{}{}\\:\"{}\"", described.empty() ? "" : " ", word.word, plain(word.meaning));
  }
  if (!words.empty() && values.files) return fmt::format(" _kerf_words_and_files \"{}\"{}", pattern, words);
  if (!words.empty())
    return values.words.front().meaning.empty() ? fmt::format("({})", words.substr(1))
                                                : "((" + described + "))";
  if (values.folders) return "_files -/";
  return values.files ? fmt::format("_files -g \"{}\"", pattern) : " ";
}

/// The specification of an option for _arguments.
std::string option_line(const CommandDescription& command, const OptionDescription& option) {
  std::string text;
  const std::string value = option.value.empty() ? ""
                                                 : fmt::format(":{}:{}", escaped(option.value),
                                                               action(known_values(command.name, option)));
  for (const std::string& name : option.names) {
    if (!name.starts_with("-")) continue;
    const bool is_long = name.starts_with("--");
    const std::string form = value.empty() ? name : name + (is_long ? "=" : "+");
    text += fmt::format("    '{}{}[{}]{}' \\\n", option.repeated ? "*" : "", form, escaped(option.summary),
                        value);
  }
  return text;
}

std::string argument_line(const CommandDescription& command, const OptionDescription& option) {
  return fmt::format("    '{}:{}:{}' \\\n",
                     option.repeated   ? "*"
                     : option.required ? ""
                                       : ":",
                     escaped(option.names.front()), action(known_values(command.name, option)));
}

std::string function_name(const std::string& command) {
  std::string name = command.empty() ? "_kerf" : "_kerf_" + command;
  for (char& c : name)
    if (c == ' ') c = '_';
  return name;
}

/// A command with commands below it: their names, and then what the named one completes.
std::string group_function(const CommandDescription& command) {
  std::string text =
      function_name(command.name) + "() {\n  local -a commands\n  local state line ret=1\n  commands=(\n";
  for (const CommandDescription& below : command.commands)
    text += fmt::format("    '{}:{}'\n", last_word(below.name), escaped(below.summary));
  if (command.name.empty()) text += "    'help:The options of a command'\n";
  text += "  )\n  _arguments -C '(-h --help)'{-h,--help}'[Print the help]' ";
  if (command.name.empty()) text += "'--version[Print the version]' ";
  text +=
      "\\\n    '1:command:->command' '*::argument:->argument' && ret=0\n  case $state in\n"
      "    command) _describe command commands && ret=0 ;;\n    argument)\n      case $words[1] in\n";
  for (const CommandDescription& below : command.commands)
    text += fmt::format("        {}) {} && ret=0 ;;\n", last_word(below.name), function_name(below.name));
  if (command.name.empty()) text += "        help) _kerf && ret=0 ;;\n";
  return text + "      esac ;;\n  esac\n  return ret\n}\n\n";
}

std::string command_function(const CommandDescription& command) {
  if (!command.commands.empty()) return group_function(command);
  std::string text = function_name(command.name) + "() {\n  _arguments -s \\\n";
  for (const OptionDescription& option : command.options)
    text += option.positional ? argument_line(command, option) : option_line(command, option);
  return text + "    && return\n  return 1\n}\n\n";
}

}  // namespace

std::string zsh_completion(const CommandDescription& root) {
  std::string text = kHead;
  for (const CommandDescription* command : all_commands(root)) text += command_function(*command);
  return text + "if [ \"$funcstack[1]\" = _kerf ]; then\n  _kerf \"$@\"\nelse\n  compdef _kerf kerf\nfi\n";
}

}  // namespace kerf::app
