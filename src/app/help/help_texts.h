// Manual pages and completion scripts of the command, as text.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/options/description.h"

namespace kerf::app {

/// The pages by their file names, "kerf.1" and "kerf-tools-show.1".
std::vector<std::pair<std::string, std::string>> manual_pages(const CommandDescription& root,
                                                              const std::string& version);

std::string bash_completion(const CommandDescription& root);
std::string zsh_completion(const CommandDescription& root);
std::string fish_completion(const CommandDescription& root);

/// kerf itself, and all commands below it.
std::vector<const CommandDescription*> all_commands(const CommandDescription& root);
/// The last word of a command's name: "show" of "tools show".
std::string last_word(const std::string& name);

}  // namespace kerf::app
