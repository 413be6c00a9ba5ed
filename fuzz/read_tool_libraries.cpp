// Fuzz target: tool libraries of other programs (read, and written in every form), machine files and material
// files. The first byte selects the kind.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "formats/tool_libraries.h"

#include "kerf/formats/workshop_files.h"

namespace {

/// Tools that were read can be written and read again.
void round_trip(const kerf::ToolTable& table) {
  kerf::Diagnostics diagnostics;
  (void)kerf::write_linuxcnc_table(table, 25.4, diagnostics);
  for (const kerf::LibraryForm& form : kerf::library_forms()) {
    kerf::Diagnostics writing;
    (void)kerf::write_tool_library(table, form, "tools" + std::string(form.endings.front()), 1.0, writing);
  }
  for (const auto& [number, tool] : table.tools())
    if (!(tool.diameter.mm() > 0.0)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  kerf::Diagnostics diagnostics;
  switch (data[0]) {
    case 'm': {
      const auto machine = kerf::read_machine_file(text, "m", diagnostics);
      if (machine && !(machine->rates[0].mm_per_min() > 0.0)) std::abort();
      break;
    }
    case 'c': (void)kerf::read_material_file(text, "c", diagnostics); break;
    default: {
      kerf::ToolTable table;
      kerf::read_tool_library(text, "l", {}, table, diagnostics);
      round_trip(table);
    }
  }
  return 0;
}
