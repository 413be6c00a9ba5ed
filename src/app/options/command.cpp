// What the subcommands share in setting up their options.
#include "app/options/command.h"

#include <fmt/format.h>

#include "app/report/json.h"

#include "kerf/number.h"
#include "kerf/program.h"

namespace kerf::app {

CLI::App* new_command(CLI::App& parent, const std::string& name, const std::string& summary,
                      const std::string& examples, OutputOptions& output) {
  CLI::App* app = parent.add_subcommand(name, summary);
  app->footer("\nExamples:\n" + examples);
  app->add_flag("--json", output.json, "Print one JSON object (messages included) instead of text");
  app->add_flag("-q,--quiet", output.quiet,
                "No progress bar, notes or summary; warnings, errors and hazards stay");
  return app;
}

Status fail(Console& console, const Diagnostics& diagnostics, Status status) {
  console.show(diagnostics);
  if (console.json())
    console.print_json(text_of(Json{{"diagnostics", json_of(diagnostics)}}, Layout::indented));
  return status;
}

Status tell_stopped(Console& console) {
  Diagnostics diagnostics;
  diagnostics.error(Code::stopped, {}, "interrupted; nothing was written");
  console.show(diagnostics, Console::Channel::always_text);
  return Status::interrupted;
}

namespace {

/// An option whose text `parse` makes a number; what is expected is told as "a `kind` from .. to ..".
template <class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, double& value, double low, double high,
                        const std::string& kind, const std::string& summary, Parse parse) {
  const auto read = [&value, name, low, high, kind, parse](const std::string& text) {
    const std::optional<double> number = parse(text);
    if (!number || *number < low || *number > high)
      throw CLI::ValidationError(name, fmt::format("\"{}\" is not {} from {} to {}", text.substr(0, 40), kind,
                                                   exact_text(low), exact_text(high)));
    value = *number;
  };
  return app.add_option_function<std::string>(name, read, summary);
}

}  // namespace

CLI::Option* add_number(CLI::App& app, const std::string& name, double& value, double low, double high,
                        const std::string& unit, const std::string& summary) {
  return add_parsed(app, name, value, low, high, "a number", summary, parse_number)->type_name(unit);
}

CLI::Option* add_length(CLI::App& app, const std::string& name, double& mm, double low, double high,
                        const std::string& summary) {
  const auto parse = [](const std::string& text) { return parse_length(text, 1.0); };
  return add_parsed(app, name, mm, low, high, "a length in mm, or with \"in\",", summary, parse)
      ->type_name("MM");
}

CLI::Option* add_threads(CLI::App& app, double& threads) {
  constexpr double kMost = 1024;
  return add_number(app, "--threads", threads, 0, kMost, "N", "Threads to use (default: all; same result)");
}

CLI::Option* add_program(CLI::App& app, std::string& file) {
  return app
      .add_option("FILE", file, "The program: " + known_endings() + "; - reads G-code from standard input")
      ->required()
      ->type_name("");
}

CLI::Option* add_repeated(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                          const std::string& kind, const std::string& summary) {
  CLI::Option* option = app.add_option(name, values, summary);
  return option->type_size(1)->expected(1)->take_all()->allow_extra_args(false)->type_name(kind);
}

}  // namespace kerf::app
