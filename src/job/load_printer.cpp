// Printers by name or from files.
#include "job/load_printer.h"

#include <string_view>

#include "kerf/base/files.h"

namespace kerf {

std::optional<PrinterChoice> load_printer(const std::string& text, Diagnostics& diagnostics) {
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

}  // namespace kerf
