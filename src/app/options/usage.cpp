// Messages of wrong usage.
#include "app/options/usage.h"

#include <fmt/format.h>
#include <vector>

#include "kerf/names.h"
#include "kerf/number.h"

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

std::string with_guess(std::string message, const std::string& word, const std::vector<std::string>& known) {
  if (const auto close = did_you_mean(word, known)) message += fmt::format("; did you mean {}?", *close);
  return message;
}

/// A word that was left over: an option that does not exist, a command that does not, or a file too many.
std::string about_extra(const CLI::App& app, const std::string& word) {
  const std::string shown = word.substr(0, 80);
  if (word.size() > 1 && word[0] == '-') {
    const std::string name = word.substr(0, word.find('='));
    return with_guess(fmt::format("unknown option {}", shown), name, option_names(app));
  }
  const std::vector<std::string> commands = command_names(app);
  if (!commands.empty()) return with_guess(fmt::format("unknown command \"{}\"", shown), word, commands);
  return fmt::format("\"{}\" is one argument too many", shown);
}

}  // namespace

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
    return "a command is needed: " + joined(commands, ", ");
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return error.what();
  const std::string what = error.what();  // "--output: 1 required PATH missing", and the like
  return what.substr(0, what.find(':')) + " needs one value";
}

}  // namespace kerf::app
