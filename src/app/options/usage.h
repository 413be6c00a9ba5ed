// What the command says when it is called wrongly: what was not understood, what may have been meant, where
// help is.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace kerf::app {

/// The subcommand that the words on the command line reached before something was wrong.
const CLI::App& reached(const CLI::App& root);
/// "unknown option --resolutoin; did you mean --resolution?" for what CLI11 did not understand.
std::string usage_message(const CLI::App& root, const CLI::ParseError& error);

}  // namespace kerf::app
