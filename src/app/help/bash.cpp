// The completion script of bash. It needs no package: bash-completion loads it, and `source` does.
#include <fmt/format.h>

#include "app/help/help_texts.h"
#include "app/help/values.h"

namespace kerf::app {
namespace {

constexpr const char* kHead = R"(# Completion of kerf for bash, made by: kerf completion bash

# _kerf_files ENDING...: folders, and files with these endings in small and capital letters; none: all files.
_kerf_files() {
  local ending IFS=$'\n'
  compopt -o filenames 2>/dev/null
  COMPREPLY+=($(compgen -d -- "$word"))
  [ $# -gt 0 ] || COMPREPLY=($(compgen -f -- "$word"))
  for ending in "$@"; do
    COMPREPLY+=($(compgen -f -X "!*$ending" -- "$word") $(compgen -f -X "!*${ending^^}" -- "$word"))
  done
}

_kerf_folders() {
  local IFS=$'\n'
  compopt -o filenames 2>/dev/null
  COMPREPLY+=($(compgen -d -- "$word"))
}

_kerf_words() {
  COMPREPLY+=($(compgen -W "$*" -- "$word"))
}

)";

constexpr const char* kTail = R"(
_kerf() {
  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD-1]} command="" next i
  COMPREPLY=()
  if [ "$word" = "=" ]; then
    word=""
  elif [ "$option" = "=" ]; then
    option=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    next=${COMP_WORDS[i]}
    [ "$next" != help ] || [ -n "$command" ] || continue
    _kerf_is_command "${command:+$command }$next" || break
    command=${command:+$command }$next
  done
  case $word in
    -*) _kerf_options "$command" ;;
    *) _kerf_value "$command" "$option" || _kerf_argument "$command" ;;
  esac
}
complete -F _kerf kerf
)";

/// What completes a value: calls of the functions above.
std::string action(const KnownValues& values) {
  std::string text;
  if (!values.words.empty()) {
    text += "_kerf_words";
    for (const KnownWord& word : values.words) text += " " + word.word;
    text += "; ";
  }
  if (values.files) {
    text += "_kerf_files";
    for (const std::string& ending : values.endings) text += " " + ending;
    text += "; ";
  }
  if (values.folders) text += "_kerf_folders; ";
  return text;
}

std::string options_function(const std::vector<const CommandDescription*>& commands) {
  std::string text = "_kerf_options() {\n  case $1 in\n";
  for (const CommandDescription* command : commands) {
    std::string words;
    for (const OptionDescription& option : command->options)
      for (const std::string& name : option.names)
        if (name.starts_with("-")) words += " " + name;
    text += fmt::format("    \"{}\") _kerf_words{} ;;\n", command->name, words);
  }
  return text + "  esac\n}\n\n";
}

/// Status 1: the option takes no value.
std::string value_function(const std::vector<const CommandDescription*>& commands) {
  std::string text = "_kerf_value() {\n  case \"$1 $2\" in\n";
  for (const CommandDescription* command : commands)
    for (const OptionDescription& option : command->options) {
      if (option.positional || option.value.empty()) continue;
      std::string patterns;
      for (const std::string& name : option.names)
        patterns += fmt::format("{}\"{} {}\"", patterns.empty() ? "" : " | ", command->name, name);
      text += fmt::format("    {}) {};;\n", patterns, action(known_values(command->name, option)));
    }
  return text + "    *) return 1 ;;\n  esac\n  return 0\n}\n\n";
}

std::string argument_function(const std::vector<const CommandDescription*>& commands) {
  std::string text = "_kerf_argument() {\n  case $1 in\n";
  for (const CommandDescription* command : commands) {
    std::string actions;
    for (const CommandDescription& below : command->commands) actions += " " + last_word(below.name);
    if (!actions.empty()) actions = "_kerf_words" + actions + (command->name.empty() ? " help; " : "; ");
    for (const OptionDescription& option : command->options)
      if (option.positional) actions += action(known_values(command->name, option));
    text += fmt::format("    \"{}\") {};;\n", command->name, actions);
  }
  return text + "  esac\n}\n\n";
}

std::string is_command_function(const std::vector<const CommandDescription*>& commands) {
  std::string patterns;
  for (const CommandDescription* command : commands)
    if (!command->name.empty())
      patterns += fmt::format("{}\"{}\"", patterns.empty() ? "" : " | ", command->name);
  return fmt::format("_kerf_is_command() {{\n  case $1 in\n    {}) ;;\n    *) return 1 ;;\n  esac\n}}\n",
                     patterns);
}

}  // namespace

std::string bash_completion(const CommandDescription& root) {
  const std::vector<const CommandDescription*> commands = all_commands(root);
  return kHead + options_function(commands) + value_function(commands) + argument_function(commands) +
         is_command_function(commands) + kTail;
}

}  // namespace kerf::app
