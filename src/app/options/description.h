// What the tables of options say of the commands, for manual pages and completion.
#pragma once

#include <string>
#include <vector>

namespace kerf::app {

struct OptionDescription {
  std::vector<std::string> names;  // {"-o", "--output"}; of a positional argument its name alone, {"FILE"}
  std::string value;               // name of the value, "PATH"; empty: a flag, or a positional argument
  std::string summary;
  std::vector<std::string> choices;  // all valid values; none: not a fixed list
  bool positional = false, required = false, repeated = false;
};

struct CommandDescription {
  std::string name;  // "tools list"; empty: kerf itself
  std::string summary;
  std::string footer;  // examples and notes, below the options in the help
  std::vector<OptionDescription> options;
  std::vector<CommandDescription> commands;
};

}  // namespace kerf::app
