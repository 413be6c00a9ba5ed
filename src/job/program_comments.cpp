// Tools and stock from the notes of a program.
#include "job/program_comments.h"

#include <cmath>
#include <optional>

#include "base/names.h"
#include "base/number.h"
#include "tool/tool_comments.h"
#include "tool/tool_description.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

/// "tool 3: ball, diameter 6 mm" and "tool 3 at the start: ...", as Kerf's posts write them.
std::optional<Tool> own_tool(std::string_view text, const Origin& where, Diagnostics& diagnostics) {
  constexpr std::string_view kTool = "tool ", kStart = " at the start";
  const std::size_t colon = text.find(": ");
  if (text.substr(0, kTool.size()) != kTool || colon == std::string_view::npos) return std::nullopt;
  std::string_view digits = text.substr(kTool.size(), colon - kTool.size());
  if (digits.size() > kStart.size() && digits.substr(digits.size() - kStart.size()) == kStart)
    digits.remove_suffix(kStart.size());
  const auto number = parse_number(digits);
  if (!number || *number < 0.0 || *number > limits::kMaxToolNumber || *number != std::floor(*number))
    return std::nullopt;
  return read_tool_description(trim(text.substr(colon + 1)), static_cast<int>(*number), where, diagnostics);
}

}  // namespace

void read_comments(Program& program, Diagnostics& diagnostics) {
  StockComments stock;
  ToolComments tools(program.tools);
  const Toolpath& path = program.path;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].is_motion()) tools.motion();
    if (path[i].kind() == StepKind::tool_change) tools.tool_change(path[i].tool_change().tool, diagnostics);
    if (path[i].kind() != StepKind::note) continue;
    if (stock.read(path.text(i), 1.0, path.origin_of(i), diagnostics)) continue;
    if (auto own = own_tool(path.text(i), path.origin_of(i), diagnostics))
      tools.describe(std::move(*own), ToolComments::Kind::own, path.origin_of(i), diagnostics);
    else
      tools.read(path.text(i), 1.0, path.origin_of(i), diagnostics);
  }
  tools.finish(diagnostics);
  program.stock = stock.stock();
}

}  // namespace kerf
