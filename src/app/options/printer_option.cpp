// The option --printer.
#include "app/options/printer_option.h"

#include "kerf/files.h"

namespace kerf::app {

Option add_printer_option(CommandParser& parser, std::string& text) {
  return parser
      .add_text("--printer", text,
                "The printer of a print: a name of kerf printer list, or a file (.toml); with :FILAMENT")
      .value_name("PRINTER");
}

std::optional<PrinterChoice> read_printer_option(const std::string& text, Diagnostics& diagnostics) {
  constexpr std::string_view kEnding = ".toml";
  const std::size_t ending = text.find(kEnding);
  if (ending == std::string::npos) return printer_named(text, {}, diagnostics);
  const std::string name = text.substr(0, ending + kEnding.size());
  const auto file = InputFile::open(name, diagnostics);
  if (!file) return std::nullopt;
  const std::size_t errors = diagnostics.errors();
  const PrinterTable table = read_printer_file(file->bytes(), name, diagnostics);
  if (diagnostics.errors() > errors) return std::nullopt;
  return printer_named(std::string_view(text).substr(name.size()), table, diagnostics);
}

}  // namespace kerf::app
