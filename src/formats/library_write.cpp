// Writing tools as Kerf's tool file and as LinuxCNC's tool table.
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/number.h"
#include "formats/library.h"
#include "formats/settings.h"
#include "formats/tool_libraries.h"
#include "tool/tool_description.h"

namespace kerf {
namespace {

constexpr int kDecimals = 6;               // of mm
constexpr std::size_t kLongestLine = 250;  // bytes, that LinuxCNC reads

/// A text as TOML's basic string.
std::string quoted_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (code < 0x20 || code == 0x7f)
      out += fmt::format("\\u{:04x}", code);
    else
      out += c;
  }
  return out + "\"";
}

void write_key(std::string& out, std::string_view key, double value) {
  if (value > 0.0) out += fmt::format("{} = {}\n", key, exact_text(value));
}

/// A size that is the shape's own too, as the neck of a lollipop, has been written with the shape.
void write_part(std::string& out, std::string_view name, const ToolShape& shape, const Profile& part) {
  if (part.empty()) return;
  const std::string diameter = fmt::format("{}_diameter", name);
  if (!detail::has_measure(shape, diameter)) write_key(out, diameter, 2.0 * part.max_radius());
  write_key(out, fmt::format("{}_length", name), part.top() - part.bottom());
}

void write_profile(std::string& out, const Profile& profile) {
  out += "profile = [";
  for (const Knot& knot : profile.knots)
    out += fmt::format("[{}, {}, {}], ", exact_text(knot.r), exact_text(knot.z), exact_text(knot.bulge));
  out += "]\n";
}

/// A shank with a conical instead of a flat lower end.
bool starts_with_cone(const Profile& shank) {
  return shank.knots.size() > 2 && shank.knots[1].r > shank.knots[0].r && shank.knots[1].z > shank.knots[0].z;
}

void write_tool(std::string& out, int number, const Tool& tool) {
  out += fmt::format("\n[[tool]]\nnumber = {}\n", number);
  std::string names;  // the reader adds the number itself
  for (const std::string& name : tool.names)
    if (name != std::to_string(number)) names += (names.empty() ? "" : ", ") + quoted_text(name);
  if (!names.empty()) out += fmt::format("names = [{}]\n", names);
  if (!tool.description.empty()) out += fmt::format("description = {}\n", quoted_text(tool.description));
  out += fmt::format("shape = {}\n", quoted_text(name_of(tool.shape)));
  for (const ShapeParameter& parameter : parameters_of(tool.shape))
    write_key(out, parameter.name, parameter.get(tool.shape));
  if (const auto* drawn = std::get_if<shape::Drawn>(&tool.shape)) write_profile(out, drawn->cutting);
  write_part(out, "neck", tool.shape, neck_of_body(tool));
  write_part(out, "shank", tool.shape, tool.silhouette.shank);
  write_part(out, "holder", tool.shape, tool.silhouette.holder);
  if (starts_with_cone(tool.silhouette.shank)) out += "transition = \"cone\"\n";
  if (!tool.teeth_assumed) out += fmt::format("teeth = {}\n", tool.teeth);
  out += fmt::format("plunges = {}\n", tool.plunges);
}

}  // namespace

std::string write_tool_file(const ToolTable& table) {
  std::string out = "unit = \"mm\"\n";
  for (const auto& [number, tool] : table.tools()) write_tool(out, number, tool);
  return out;
}

std::string write_linuxcnc_table(const ToolTable& table, double unit_mm, Diagnostics& diagnostics) {
  std::string out;
  std::size_t pocket = 0;
  for (const auto& [number, tool] : table.tools()) {
    std::string line = fmt::format("T{} P{} Z0 D{} ;", number, ++pocket,
                                   number_text(tool.diameter.mm() / unit_mm, kDecimals));
    const std::string sizes = write_tool_description(tool);
    std::string text = tool.description.empty() || tool.description == sizes ? "" : tool.description;
    if (!text.empty()) text.insert(0, detail::kBeforeDescription);
    for (char& c : text)
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    const bool fits = line.size() + sizes.size() <= kLongestLine;
    const bool all_fits = line.size() + sizes.size() + text.size() <= kLongestLine;
    line += fits ? sizes : fmt::format("{} {} mm", name_of(tool.shape), number_text(tool.diameter.mm(), 4));
    if (all_fits) line += text;
    out += line + "\n";
    if (!all_fits)
      diagnostics.note(
          codes::tool_not_written, {},
          fmt::format("a line of a tool.tbl has at most {} bytes; that of tool {} is without its {}",
                      kLongestLine, number, fits ? "description" : "sizes"));
  }
  return out;
}

}  // namespace kerf
