// Stock from files, turned over and shifted, and fixtures: the options that tell them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/findings.h"
#include "app/options/command.h"

#include "kerf/fixtures.h"
#include "kerf/round_bar.h"
#include "kerf/stock_body.h"

namespace kerf::app {

/// The options as told.
struct BodyOptions {
  std::string mesh;                   // --stock-mesh FILE
  std::string left;                   // --stock-left FILE
  std::optional<std::string> flip;    // --flip SPEC
  std::optional<std::string> shift;   // --shift X,Y,Z
  std::vector<std::string> fixtures;  // --fixture SPEC or FILE
  std::optional<std::string> rotary;  // --rotary SPEC
};
void add_body_options(CommandParser& parser, BodyOptions& options);
/// --rotary, for the commands that know a fourth axis; after add_body_options.
void add_rotary_option(CommandParser& parser, BodyOptions& options);
extern const char* const kBodyHelp;
extern const char* const kRotaryHelp;

/// The options read.
struct BodySettings {
  std::optional<Stock> stock;  // from a file
  std::optional<StockMove> move;
  std::vector<Fixture> fixtures;
  std::optional<RoundBar> bar;
};
BodySettings read_body_options(const BodyOptions& options, Diagnostics& usage, Diagnostics& diagnostics);
/// A mesh or left-over stock; nothing with an error in `diagnostics`.
std::optional<Stock> load_stock(const std::string& path, Diagnostics& diagnostics);

/// Contacts with the fixtures, as hazards; none where they could not be looked for (`diagnostics` says why).
std::vector<Finding> findings_at_fixtures(const Toolpath& path, const ToolTable& tools,
                                          const std::vector<Fixture>& fixtures, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress& progress);

}  // namespace kerf::app
