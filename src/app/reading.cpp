// The options of reading.
#include "app/reading.h"

#include <fmt/format.h>

#include "app/text.h"

namespace kerf::app {

void add_reading_options(CLI::App& app, ReadingOptions& options) {
  const auto known = [](const std::string& name) {
    if (dialect_named(name)) return std::string();
    return fmt::format("\"{}\" is no controller that is known; expected {}", name,
                       joined(dialect_names(), ", "));
  };
  app.add_option("--dialect", options.dialect,
                 "The controller a G-code program is for (default: told by its text): " +
                     joined(dialect_names(), ", "))
      ->type_name("NAME")
      ->check(CLI::Validator(known, ""));
  app.add_flag("--strict", options.strict, "Take what is unusual in a G-code program as an error");
}

void apply(const ReadingOptions& options, InputOptions& input) {
  input.dialect = dialect_named(options.dialect);
  input.strict = options.strict;
}

}  // namespace kerf::app
