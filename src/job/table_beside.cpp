// The tool table of LinuxCNC next to a program.
#include <cctype>
#include <fmt/format.h>

#include "job/front_ends.h"

#include "kerf/tool_libraries.h"

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

}  // namespace

ToolTable tool_table_beside(const InputFile& program, Diagnostics& diagnostics) {
  ToolTable table;
  Diagnostics ignored;  // most programs have no table
  const auto file = InputFile::open(folder_of(program.path()) + std::string(kTable), ignored, kMaxTable);
  if (!file || library_kind_of(file->bytes()) != ToolLibraryKind::linuxcnc) return table;
  Diagnostics found;
  read_tool_library(file->bytes(), file->path(), {.unit_mm = unit_of(program.bytes())}, table, found);
  for (const Diagnostic& d : found.list())
    if (d.code == Code::tool_library_assumed) diagnostics.add(d);
  return table;
}

}  // namespace kerf
