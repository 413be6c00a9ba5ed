// What a design writes, and what it needs of the program around it.
//
// The machine neither simulates nor writes or reads G-code: what commands need of that is in MachineOptions,
// and programs to be written are results. A command that needs an option that is not set is an error.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// A drawing or another text of a design.
struct DesignFile {
  std::string name, bytes;
};
/// A G-code file of a design.
struct DesignProgram {
  std::string name;
  std::string post;  // the name of a built-in post, or a post file
  Toolpath path;
  Feed missing_feed;  // of cuts without one
};

namespace design {

/// The result of reading a program for previewgcodefile().
struct ReadProgram {
  Toolpath path;
  std::map<int, Tool> tools;
  std::optional<Stock> stock;
};

/// The cuts of the first side of a part, for flipstock().
struct CutSide {
  const Toolpath& path;
  const Stock& stock;
  const ToolTable& tools;
  Length resolution;  // 0: by the size of the stock
};

/// Moments at which a caller may add lines of G-code.
enum class Moment : unsigned char { file_opened, tool_changed, file_closed };

struct MachineOptions {
  const ToolTable* tools = nullptr;  // the built-in ones
  std::function<std::optional<Stock>(const std::string& file, Diagnostics&)> load_stock = {};
  std::function<std::optional<ReadProgram>(const std::string& file, Diagnostics&)> read_program = {};
  std::function<std::optional<Stock>(const CutSide& side, Diagnostics&)> left_stock = {};
  /// Further lines of G-code at a moment; the number is that of the tool.
  std::function<std::vector<std::string>(Moment moment, int tool)> further_lines = {};
  /// Reports a file that cannot be written, when it is opened.
  std::function<void(const std::string& name, Diagnostics&)> check_output = {};
  /// Why a post does not write a line of G-code; nothing if it does.
  std::function<std::optional<std::string>(const std::string& line, const std::string& post)> check_line = {};
  Progress* progress = nullptr;
};

/// What is left at the end of a design.
struct Results {
  Toolpath path;
  std::map<int, Tool> tools;  // the program's own
  std::optional<Stock> stock;
  Length resolution;   // of a simulation; 0: by the size of the stock
  bool shown = false;  // the program asked for the part: stockandtoolpaths()
  std::vector<DesignFile> files;
  std::vector<DesignProgram> programs;
};

}  // namespace design
}  // namespace kerf
