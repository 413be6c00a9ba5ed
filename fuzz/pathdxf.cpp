// Any bytes as path drawings: the first part, up to a line of "----", is the main drawing, the rest is a
// drawing that is found for sub-paths.
#include "front/pathdxf/pathdxf.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "back/pathdxf/pathdxf_gcode.h"

namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

constexpr std::size_t kMaxSteps = 20'000;

/// All positions are finite, and the text has a line for each step.
void check(const kerf::Toolpath& path) {
  using namespace kerf;
  expect(path.size() <= kMaxSteps + 200'000);
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].is_motion()) expect(finite(path[i].to()));
  Diagnostics diagnostics;
  const std::string text = pathdxf_gcode(path, {}, diagnostics);
  expect(!diagnostics.has_errors() && text.size() >= path.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf;
  const std::string_view all{reinterpret_cast<const char*>(data), size};
  const std::size_t cut = all.find("\n----\n");
  const std::string main(all.substr(0, cut));
  const std::string other(cut == std::string_view::npos ? std::string_view() : all.substr(cut + 6));
  PathdxfOptions options;
  options.max_steps = kMaxSteps;
  options.comments = size % 2 == 0 ? PathdxfComments::brief : PathdxfComments::trace;
  options.selection = size % 3 == 0 ? PathdxfSelection::check_all : PathdxfSelection::only_path;
  options.shown_texts = "B.*";
  options.report = [](std::string_view) {};
  options.read_file = [&](const std::string& file) {
    return std::optional(file == "8998.dxf" ? other : main);
  };
  options.list_files = [](const std::string&) { return std::vector<std::string>{"8998.dxf", "x.txt"}; };
  Diagnostics diagnostics;
  const PathdxfRun run = compile_pathdxf("8999.1P.dxf", options, diagnostics);
  expect(!run.programs.empty() || diagnostics.has_errors());
  for (const Diagnostic& d : diagnostics.list()) expect(!pathdxf_line(d).empty());
  for (const PathdxfProgram& program : run.programs) {
    check(program.milling);
    if (program.probing) check(*program.probing);
    pathdxf_probe_list(program);
  }
  return 0;
}
