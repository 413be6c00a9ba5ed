// The command line: its commands, their options and their help. Commands see the types of this header only;
// the library that does the parsing is included in parser.cpp alone, because it is slow to compile.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options/description.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace kerf::app {

/// An option or a positional argument: a handle, valid as long as its CommandLine.
class Option {
 public:
  /// Name of the value in the help; empty: none.
  Option& value_name(const std::string& name);
  Option& description(const std::string& text);
  Option& required();
  Option& optional();
  Option& excludes(const Option& other);
  Option& needs(const Option& other);
  /// A configuration does not set its value: the command asks for that itself.
  Option& without_default();
  Option& one_of(const std::vector<std::string>& values);
  /// One of the values, or several with commas between them.
  Option& list_of(const std::vector<std::string>& values);
  /// `problem_of` returns the error of a value; empty: valid.
  Option& check(std::function<std::string(const std::string&)> problem_of);

  /// Whether the command line has it; after CommandLine::parse.
  bool is_given() const;
  /// "--resolution"
  std::string name() const;

 private:
  friend class CommandParser;
  explicit Option(CLI::Option* option) : option_(option) {}
  CLI::Option* option_;
};

/// A command or subcommand: a handle, valid as long as its CommandLine. Variables passed by reference get the
/// values during CommandLine::parse.
class CommandParser {
 public:
  CommandParser add_command(const std::string& name, const std::string& summary);
  /// Text below the options in the help.
  void set_footer(const std::string& text);
  void require_command();

  Option add_text(const std::string& name, std::string& value, const std::string& summary);
  Option add_text(const std::string& name, std::optional<std::string>& value, const std::string& summary);
  /// A positional argument of one or more words.
  Option add_texts(const std::string& name, std::vector<std::string>& values, const std::string& summary);
  /// May be given several times, one value each time.
  Option add_repeated(const std::string& name, std::vector<std::string>& values, const std::string& summary);
  Option add_flag(const std::string& name, bool& value, const std::string& summary);
  /// `read` parses the value and returns its error; empty: valid.
  Option add_parsed(const std::string& name, std::function<std::string(const std::string&)> read,
                    const std::string& summary);

  /// The option of this name, which must have been added.
  Option option(const std::string& name) const;
  std::optional<Option> find_option(const std::string& name) const;
  /// Whether the command line has this command; after CommandLine::parse.
  bool is_given() const;
  /// The command with its options, and the commands below it.
  CommandDescription description() const;

 protected:
  explicit CommandParser(CLI::App* app) : app_(app) {}
  CLI::App* app_;
};

/// A value of an option that the command line does not give.
struct OptionDefault {
  std::string option;              // "--machine"
  std::vector<std::string> texts;  // of a flag "true"
  std::string origin;              // "kerf.toml:3", for messages
};

/// The whole command line.
class CommandLine : public CommandParser {
 public:
  CommandLine(const std::string& name, const std::string& summary, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  enum class Outcome {
    parsed,
    answered,  // help or version has been printed
    wrong
  };
  struct Result {
    Outcome outcome = Outcome::parsed;
    std::string problem;  // "unknown option --resolutoin; did you mean --resolution?"
    std::string command;  // the last valid one of the command line: "tools list"; empty: none
  };
  /// Parses the arguments after the program's name. `help simulate` is `simulate --help`; no argument is
  /// --help.
  /// Options of the given command that are not given take their default, unless an option is given that
  /// excludes it. Option::is_given() does not count them.
  Result parse(const std::vector<std::string>& words, const std::vector<OptionDefault>& defaults = {});

 private:
  std::unique_ptr<CLI::App> owned_;
};

}  // namespace kerf::app
