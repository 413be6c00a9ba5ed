// The completion script of zsh, for its function _arguments.
#include <fmt/format.h>
#include <string_view>

#include "app/help/help_texts.h"
#include "app/help/values.h"

namespace kerf::app {
namespace {

/// Within single quotes, and with a backslash before what _arguments and _describe would interpret.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\' || c == '(' || c == ')' || c == '{' || c == '}')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

/// "_files -g ..." of the endings in small and capital letters.
std::string files_action(const KnownValues& values) {
  if (values.endings.empty()) return "_files";
  std::string endings;
  for (const std::string& ending : values.endings) endings += (endings.empty() ? "" : "|") + ending.substr(1);
  return fmt::format("_files -g \"(#i)*.({})\"", endings);
}

/// The action of a value; known words with a meaning are shown with it.
std::string action(const KnownValues& values) {
  std::string words;
  for (const KnownWord& word : values.words) {
    if (!words.empty()) words += ' ';
    words += word.meaning.empty() ? escaped(word.word) : fmt::format("{}\\:\"{}\"", escaped(word.word), [&] {
      std::string meaning;
      for (const char c : word.meaning)
        if (c != '"' && c != '\\' && c != '\'' && c != '$' && c != '`' && c != '(' && c != ')')
          meaning += c == ':' ? ' ' : c;
      return meaning;
    }());
  }
  const bool described = !values.words.empty() && !values.words.front().meaning.empty();
  if (!words.empty()) words = described ? fmt::format("(({}))", words) : fmt::format("({})", words);
  const std::string files = values.files ? files_action(values) : values.folders ? "_files -/" : "";
  if (words.empty()) return files.empty() ? " " : files;
  if (files.empty()) return words;
  return fmt::format("_alternative \"words\\:word\\:{}\" \"files\\:file\\:{}\"", words, files);
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
  std::string text = "#compdef kerf\n# Completion of kerf for zsh, made by: kerf completion zsh\n\n";
  for (const CommandDescription* command : all_commands(root)) text += command_function(*command);
  return text + "if [ \"$funcstack[1]\" = _kerf ]; then\n  _kerf \"$@\"\nelse\n  compdef _kerf kerf\nfi\n";
}

}  // namespace kerf::app
