// Printer files (TOML) and sliced programs that printers are imported from: any bytes; what is written of
// them is read back.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "kerf/formats/printer_files.h"
#include "kerf/path/check.h"
#include "kerf/program/gcode.h"

namespace {

void read_back(const kerf::PrinterChoice& choice) {
  kerf::Diagnostics diagnostics;
  const kerf::PrinterTable table =
      kerf::read_printer_file(kerf::write_printer_file(choice), "written", diagnostics);
  for (const kerf::Diagnostic& d : diagnostics.list()) std::fprintf(stderr, "%s\n", to_string(d).c_str());
  if (diagnostics.has_errors() || table.printers.size() != 1) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  kerf::Diagnostics diagnostics;
  const kerf::PrinterTable table = kerf::read_printer_file(text, "fuzz", diagnostics);
  if (!diagnostics.has_errors())
    for (const kerf::PrinterProfile& printer : table.printers)
      read_back({printer, table.filaments.empty() ? kerf::FilamentProfile{} : table.filaments.front()});
  kerf::GcodeReadOptions options;
  options.max_steps = 5000;
  kerf::Diagnostics unused;
  const kerf::GcodeProgram program = kerf::read_gcode(text, options, unused);
  const kerf::PrinterChoice imported = kerf::import_printer(text, program.path);
  read_back(imported);
  (void)kerf::check_print(program.path, kerf::limits_of(imported));
  return 0;
}
