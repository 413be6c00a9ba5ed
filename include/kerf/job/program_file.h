// Programs, toolpaths, tools and stock as bytes, without loss: .kerf files, and copies for other processes.
//
//   std::string bytes = write_program(program);
//   std::optional<Program> again = read_program(bytes, "part.kerf", diagnostics);
//
// What is read equals what was written, member by member, and writes the same bytes again.
// docs/decisions/0049-program-file.md describes the format. A newer version, another content and damage are
// one error each. What a file can make of memory is in proportion to its size: about 400 bytes per byte.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/job/program_data.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// Whether bytes start as all files of this format do.
bool is_program_file(std::string_view bytes);

// Each reader returns nothing, with an error under the file's name, for other bytes than those of its writer.
std::string write_program(const Program& program);
std::optional<Program> read_program(std::string_view bytes, const std::string& name,
                                    Diagnostics& diagnostics);
std::string write_toolpath(const Toolpath& path);
std::optional<Toolpath> read_toolpath(std::string_view bytes, const std::string& name,
                                      Diagnostics& diagnostics);
std::string write_tool(const Tool& tool);
std::optional<Tool> read_tool(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);
std::string write_stock(const Stock& stock);
std::optional<Stock> read_stock(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);

}  // namespace kerf
