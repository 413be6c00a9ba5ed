// The tool table of LinuxCNC next to a program.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/file_names.h"
#include "formats/tool_libraries.h"
#include "job/front_ends.h"

namespace kerf {
namespace {

constexpr std::string_view kTable = "tool.tbl";
constexpr std::size_t kMaxSearched = 64 * 1024;  // bytes of the program, for its unit
constexpr std::size_t kMaxTable = 1 << 20;       // bytes

/// mm of a unit of the program: that of its first G20 or G21 outside of comments.
double unit_of(std::string_view text) {
  text = text.substr(0, kMaxSearched);
  int depth = 0;
  bool to_line_end = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') depth = 0, to_line_end = false;
    if (c == ';') to_line_end = true;
    if (c == '(') ++depth;
    if (c == ')' && depth > 0) --depth;
    if (depth > 0 || to_line_end || (c != 'G' && c != 'g')) continue;
    const std::string_view number = text.substr(i + 1, 2);
    const bool ends = i + 3 >= text.size() || std::isdigit(static_cast<unsigned char>(text[i + 3])) == 0;
    if (ends && number == "20") return kMmPerInch;
    if (ends && number == "21") return 1.0;
  }
  return 1.0;
}

/// A table has no unit. One in which every tool would be at most 1 mm thick, has the diameter of a fraction
/// of an inch, and one of them none of a mill in mm, is of a machine in inches.
bool seems_in_inches(const ToolTable& read_as_mm) {
  constexpr double kThickest = 1.0, kInchStep = 1.0 / 64.0, kMmStep = 0.1, kSame = 1e-9;
  const auto is_multiple = [](double value, double step) {
    return std::abs(value / step - std::round(value / step)) < kSame;
  };
  bool odd_in_mm = false;
  for (const auto& [number, tool] : read_as_mm.tools()) {
    const double diameter = tool.diameter.mm();
    if (diameter > kThickest || !is_multiple(diameter, kInchStep)) return false;
    odd_in_mm = odd_in_mm || !is_multiple(diameter, kMmStep);
  }
  return odd_in_mm;
}

}  // namespace

ToolTable tool_table_beside(const InputFile& program, Diagnostics& diagnostics) {
  ToolTable table;
  Diagnostics ignored;  // most programs have no table
  const auto file = InputFile::open(folder_of(program.path()) + std::string(kTable), ignored, kMaxTable);
  if (!file || library_kind_of(file->bytes()) != ToolLibraryKind::linuxcnc) return table;
  Diagnostics found;
  const auto read = [&](double unit_mm) {
    table = {};
    found = Diagnostics{};
    read_tool_library(file->bytes(), file->path(), {.unit_mm = unit_mm}, table, found);
  };
  read(unit_of(program.bytes()));
  if (seems_in_inches(table)) read(kMmPerInch);
  for (const Diagnostic& d : found.list())
    if (d.code == codes::tool_library_assumed) diagnostics.add(d);
  return table;
}

}  // namespace kerf
