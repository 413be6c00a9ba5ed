// The command line by CLI11, and the messages for arguments that it rejects.
#include "app/options/parser.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/split.h"

namespace kerf::app {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

/// An argument that was not consumed: an unknown option, an unknown command, or one argument too many.
std::string about_extra(const CLI::App& app, const std::string& word) {
  const std::string shown = word.substr(0, 80);
  if (word.size() > 1 && word[0] == '-') {
    const std::string name = word.substr(0, word.find('='));
    const std::vector<std::string> known = option_names(app);
    if (std::find(known.begin(), known.end(), name) != known.end())  // given to the command before it
      return fmt::format("the option {} belongs after the command: kerf {} {}", shown, app.get_name(), shown);
    return fmt::format("unknown option {}{}", shown, guess_at_end(name, known));
  }
  const std::vector<std::string> commands = command_names(app);
  if (!commands.empty()) return fmt::format("unknown command \"{}\"{}", shown, guess_at_end(word, commands));
  return fmt::format("unexpected argument \"{}\"", shown);
}

/// The last subcommand that was parsed before the error.
const CLI::App& reached(const CLI::App& root) {
  const std::vector<CLI::App*> parsed = root.get_subcommands();
  return parsed.empty() ? root : reached(*parsed.front());
}

std::string usage_message(const CLI::App& root, const CLI::ParseError& error) {
  const CLI::App& app = reached(root);
  const std::vector<std::string> left = root.remaining(true);
  if (!left.empty()) return about_extra(app, left.front());
  const std::vector<std::string> commands = command_names(app);
  if (!commands.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    return "a command is required: " + joined(commands, ", ");
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return error.what();
  const std::string what = error.what();  // "--output: 1 required PATH missing", and the like
  return what.substr(0, what.find(':')) + " needs one value";
}

/// "tools list" of the command `list` of `tools`; empty for the root.
std::string full_name(const CLI::App& root, const CLI::App& app) {
  if (&app == &root) return {};
  const std::string parent = full_name(root, *app.get_parent());
  return parent.empty() ? app.get_name() : parent + " " + app.get_name();
}

/// The arguments of `kerf help simulate`: `simulate --help`. Stops at a word that is not a command, without
/// --help, so that the parser reports it; words after a complete command are ignored.
std::vector<std::string> help_words(const CLI::App& root, const std::vector<std::string>& asked) {
  std::vector<std::string> words;
  const CLI::App* app = &root;
  for (const std::string& word : asked) {
    if (app->get_subcommands([](const CLI::App*) { return true; }).empty()) break;
    const auto named = app->get_subcommands([&](const CLI::App* c) { return c->get_name() == word; });
    words.push_back(word);
    if (named.empty()) return words;
    app = named.front();
  }
  words.push_back("--help");
  return words;
}

/// The values of one_of(): CLI11 describes the check as "{auto,part}" after the name of the value.
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t start = type.find('{'), end = type.rfind('}');
  std::vector<std::string> choices;
  if (start == std::string::npos || end == std::string::npos) return choices;
  for (std::size_t at = start + 1; at < end;) {
    const std::size_t comma = std::min(type.find(',', at), end);
    choices.push_back(type.substr(at, comma - at));
    at = comma + 1;
  }
  return choices;
}

OptionDescription described(const CLI::Option& option) {
  OptionDescription out;
  for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  out.positional = option.get_positional();
  if (out.positional) out.names = {option.get_name(true)};
  const std::string type = option.get_type_name();
  if (!out.positional && option.get_expected_max() > 0) {
    out.value = type.substr(0, type.find_first_of(":{"));
    if (out.value.empty()) out.value = "VALUE";
  }
  out.summary = option.get_description();
  out.choices = choices_of(type);
  out.required = option.get_required();
  out.repeated = option.get_expected_max() > 1;
  return out;
}

CommandDescription described(const CLI::App& root, const CLI::App& app) {
  CommandDescription out{full_name(root, app), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options()) out.options.push_back(described(*option));
  for (const CLI::App* command : app.get_subcommands(nullptr))
    out.commands.push_back(described(root, *command));
  return out;
}

}  // namespace

Option& Option::value_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option& Option::description(const std::string& text) {
  option_->description(text);
  return *this;
}

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::optional() {
  option_->required(false);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::without_default() {
  option_->configurable(false);
  return *this;
}

namespace {

/// What is wrong with a value that must be one of some; empty: nothing.
std::string problem_of_choice(const std::string& text, const std::vector<std::string>& values) {
  if (std::find(values.begin(), values.end(), text) != values.end()) return {};
  return fmt::format("\"{}\" is not one of {}{}", clipped(text, 60), joined(values, ", "),
                     guess_at_end(text, values));
}

}  // namespace

Option& Option::list_of(const std::vector<std::string>& values) {
  const auto problem = [values](const std::string& text) {
    for (const std::string& word : words_of_list(text))
      if (std::string fault = problem_of_choice(word, values); !fault.empty()) return fault;
    return std::string();
  };
  option_->check(CLI::Validator(problem, "{" + joined(values, ",") + "}"));
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& values) {
  const auto problem = [values](const std::string& text) { return problem_of_choice(text, values); };
  // choices_of() reads the description.
  option_->check(CLI::Validator(problem, "{" + joined(values, ",") + "}"));
  return *this;
}

Option& Option::check(std::function<std::string(const std::string&)> problem_of) {
  option_->check(
      CLI::Validator([problem = std::move(problem_of)](std::string& text) { return problem(text); }, ""));
  return *this;
}

bool Option::is_given() const { return option_->count() > 0; }

std::string Option::name() const { return option_->get_name(); }

CommandParser CommandParser::add_command(const std::string& name, const std::string& summary) {
  return CommandParser(app_->add_subcommand(name, summary));
}

void CommandParser::set_footer(const std::string& text) { app_->footer(text); }

void CommandParser::require_command() { app_->require_subcommand(1); }

Option CommandParser::add_text(const std::string& name, std::string& value, const std::string& summary) {
  return Option(app_->add_option(name, value, summary));
}

Option CommandParser::add_text(const std::string& name, std::optional<std::string>& value,
                               const std::string& summary) {
  return Option(app_->add_option(name, value, summary));
}

Option CommandParser::add_texts(const std::string& name, std::vector<std::string>& values,
                                const std::string& summary) {
  return Option(app_->add_option(name, values, summary));
}

Option CommandParser::add_repeated(const std::string& name, std::vector<std::string>& values,
                                   const std::string& summary) {
  CLI::Option* option = app_->add_option(name, values, summary);
  return Option(option->type_size(1)->expected(1)->take_all()->allow_extra_args(false));
}

Option CommandParser::add_flag(const std::string& name, bool& value, const std::string& summary) {
  return Option(app_->add_flag(name, value, summary));
}

Option CommandParser::add_parsed(const std::string& name, std::function<std::string(const std::string&)> read,
                                 const std::string& summary) {
  const auto take = [name, read = std::move(read)](const std::string& text) {
    if (const std::string problem = read(text); !problem.empty()) throw CLI::ValidationError(name, problem);
  };
  return Option(app_->add_option_function<std::string>(name, take, summary));
}

Option CommandParser::option(const std::string& name) const { return Option(app_->get_option(name)); }

std::optional<Option> CommandParser::find_option(const std::string& name) const {
  CLI::Option* option = app_->get_option_no_throw(name);
  return option == nullptr ? std::nullopt : std::optional(Option(option));
}

bool CommandParser::is_given() const { return app_->parsed(); }

CommandDescription CommandParser::description() const {
  const CLI::App* root = app_;
  while (root->get_parent() != nullptr) root = root->get_parent();
  return described(*root, *app_);
}

CommandLine::CommandLine(const std::string& name, const std::string& summary, const std::string& version)
    : CommandParser(nullptr), owned_(std::make_unique<CLI::App>(summary, name)) {
  app_ = owned_.get();
  app_->set_version_flag("--version", version, "Print the version");
}

CommandLine::~CommandLine() = default;

namespace {

bool is_excluded(const CLI::Option& option) {
  const auto& others = option.get_excludes();
  return std::any_of(others.begin(), others.end(),
                     [](const CLI::Option* other) { return other->count() > 0; });
}

/// The error of the first default whose value is wrong; empty: none.
std::string take_defaults(const CLI::App& command, const std::vector<OptionDefault>& defaults) {
  for (const OptionDefault& value : defaults) {
    CLI::Option* const option = const_cast<CLI::App&>(command).get_option_no_throw(value.option);
    if (option == nullptr || option->count() > 0 || !option->get_configurable() || is_excluded(*option))
      continue;
    try {
      option->add_result(value.texts);
      option->run_callback();
    } catch (const CLI::ParseError& error) {
      return fmt::format("{}: {}", value.origin, error.what());
    }
    option->clear();  // is not counted as given
  }
  return {};
}

}  // namespace

CommandLine::Result CommandLine::parse(const std::vector<std::string>& words,
                                       const std::vector<OptionDefault>& defaults) {
  const std::vector<std::string> asked = words.empty() ? std::vector<std::string>{"help"} : words;
  std::vector<std::string> all =
      asked.front() == "help" ? help_words(*app_, {asked.begin() + 1, asked.end()}) : asked;
  try {
    app_->parse(std::vector<std::string>(all.rbegin(), all.rend()));  // the order in which CLI11 takes them
  } catch (const CLI::Success& answer) {                              // --help, --version
    app_->exit(answer);
    return {Outcome::answered, {}, {}};
  } catch (const CLI::ParseError& error) {
    return {Outcome::wrong, usage_message(*app_, error), full_name(*app_, reached(*app_))};
  }
  if (std::string problem = take_defaults(reached(*app_), defaults); !problem.empty())
    return {Outcome::wrong, std::move(problem), full_name(*app_, reached(*app_))};
  return {};
}

}  // namespace kerf::app
