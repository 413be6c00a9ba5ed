// The subcommands of `kerf`, one file each. A new one is a function declared here and a line in main.cpp.
#pragma once

#include <functional>

#include "app/options/parser.h"
#include "app/report/console.h"
#include "app/report/status.h"

namespace kerf::app {

struct Command {
  CommandParser parser;
  OutputOptions* output = nullptr;
  std::function<Status(Console&)> run;
};

Command add_simulate(CommandParser& root);
Command add_info(CommandParser& root);
Command add_check(CommandParser& root);
Command add_compare(CommandParser& root);
Command add_steps(CommandParser& root);
Command add_outline(CommandParser& root);
Command add_post(CommandParser& root);
Command add_cut(CommandParser& root);
Command add_run(CommandParser& root);
/// The words of a command line in the order that the parser of `kerf run` requires: what follows the name of
/// a Python script, but for the options -o, -q and --json, is an argument of the script.
std::vector<std::string> with_script_arguments(const std::vector<std::string>& words);
Command add_view(CommandParser& root);
Command add_level(CommandParser& root);
Command add_lsp(CommandParser& root);
Command add_config(CommandParser& root);
Command add_tools_list(CommandParser& tools);
Command add_tools_show(CommandParser& tools);
Command add_tools_shapes(CommandParser& tools);
Command add_tools_import(CommandParser& tools);
Command add_tools_export(CommandParser& tools);
Command add_printer_list(CommandParser& printer);
Command add_printer_import(CommandParser& printer);
Command add_completion(CommandParser& root);
Command add_man(CommandParser& root);

}  // namespace kerf::app
