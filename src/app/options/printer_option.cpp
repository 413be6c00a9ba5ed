// The option --printer.
#include "app/options/printer_option.h"

namespace kerf::app {

Option add_printer_option(CommandParser& parser, std::string& text) {
  return parser
      .add_text("--printer", text,
                "The printer of a print: a name of kerf printer list, or a file (.toml); with :FILAMENT")
      .value_name("PRINTER");
}

}  // namespace kerf::app
