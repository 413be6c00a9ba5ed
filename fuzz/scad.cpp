// Fuzz target: any text as an OpenSCAD program without commands, with limits that keep a run short.
#include "front/scad/scad.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kerf::ScadOptions options;
  options.file_name = "/nowhere/fuzz.scad";  // no file is beside it
  options.max_memory = std::size_t{16} << 20;
  options.max_steps = 20'000;
  options.max_range = 2'000;
  options.max_stack = std::size_t{256} << 10;
  options.max_output = std::size_t{1} << 16;
  kerf::Diagnostics diagnostics;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)kerf::run_scad(text, options, diagnostics);
  return 0;
}
