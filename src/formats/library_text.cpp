// Tool libraries as lines of text: LinuxCNC's tool table and Carbide Create's CSV.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "base/codes/tools.h"
#include "base/names.h"
#include "base/number.h"
#include "formats/library.h"
#include "tool/tool_description.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"

namespace kerf::detail {
namespace {

constexpr double kDrillPoint = 118.0;                        // degrees
constexpr std::size_t kMaxComment = std::size_t{64} * 1024;  // bytes, of a line of a tool.tbl
constexpr std::size_t kMaxFields = 200;                      // of a line; the rest is read as one

/// Calls visit(line, number) for each line without its end.
template <class Visit>
void for_each_line(std::string_view text, Visit&& visit) {
  for (std::size_t start = 0, number = 1; start < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    visit(trim(text.substr(start, end - start)), number);
    start = end + 1;
  }
}

std::optional<int> whole(std::string_view text) {
  const auto value = parse_number(trim(text));
  if (!value || *value < 0.0 || *value > 99'999'999.0 || *value != std::floor(*value)) return std::nullopt;
  return static_cast<int>(*value);
}

/// A comma-separated line's fields; "" in quotes is one quote.
std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool quote = line[i] == '"';
    if (quote && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (quote) {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted && fields.size() < kMaxFields) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

/// A row of the CSV, accessed by the names of its header.
class Row {
 public:
  Row(const std::vector<std::string>& header, const std::vector<std::string>& fields)
      : header_(header), fields_(fields) {}
  std::string text(std::string_view name) const {
    for (std::size_t i = 0; i < header_.size() && i < fields_.size(); ++i)
      if (fold_name(header_[i]) == name)
        return std::string(trim(fields_[i]).substr(0, limits::kMaxNameBytes));
    return {};
  }
  double number(std::string_view name) const { return parse_number(text(name)).value_or(0.0); }

 private:
  const std::vector<std::string>& header_;
  const std::vector<std::string>& fields_;
};

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// The shape of the types "end", "ball", "vee", "engraver" etc. A V whose corner radius is half its diameter
/// is a ball, as in vendors' libraries.
std::string carbide_shape(const Row& row) {
  const std::string type = fold_name(row.text("type"));
  const double corner = row.number("cornerradius"), diameter = row.number("diameter");
  const bool round = diameter > 0.0 && corner >= 0.5 * diameter;
  if (has(type, "taper")) return round || corner <= 0.0 ? "ball" : "tapered ball";
  if (has(type, "ball")) return "ball";
  if (has(type, "vee") || has(type, "vbit") || has(type, "engrav")) return round ? "ball" : "V";
  if (has(type, "drill")) return "drill";
  if (has(type, "end") || has(type, "flat") || has(type, "bull") || has(type, "corn") || type.empty())
    return corner > 0.0 ? (round ? "ball" : "bull nose") : "square";
  return type;
}

void read_carbide_row(const Row& row, const Origin& where, LibraryWriter& out) {
  const std::string metric = fold_name(row.text("metric"));
  const double scale = metric == "1" || metric == "true" ? 1.0 : kMmPerInch;
  LibraryTool tool;
  tool.where = where;
  tool.number = whole(row.text("number"));
  tool.shape = carbide_shape(row);
  tool.diameter = scale * row.number("diameter");
  tool.flute = scale * row.number("flutelength");
  tool.shank_diameter = scale * row.number("shaftdiameter");
  const double stick_out = scale * row.number("stickout");
  if (stick_out > tool.flute && tool.flute > 0.0) tool.shank_length = stick_out - tool.flute;
  if (tool.shape == "bull nose") tool.corner_radius = scale * row.number("cornerradius");
  if (tool.shape == "tapered ball") tool.tip_diameter = 2.0 * scale * row.number("cornerradius");
  if (tool.shape == "V") tool.angle = row.number("angle");
  if (tool.shape == "drill") tool.angle = row.number("angle") > 0.0 ? row.number("angle") : kDrillPoint;
  tool.teeth = whole(row.text("numflutes")).value_or(0);
  const std::string vendor = row.text("vendor"), model = row.text("model");
  tool.name = vendor.empty() || model.empty() ? vendor + model : vendor + " " + model;
  tool.description = row.text("name");
  out.add(tool);
}

}  // namespace

void read_carbide_csv(std::string_view text, LibraryWriter& out) {
  std::vector<std::string> header;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    if (line.empty()) return;
    const std::vector<std::string> fields = fields_of(line);
    if (header.empty()) {
      header = fields;
      return;
    }
    read_carbide_row(Row(header, fields), out.location(number), out);
  });
}

/// The shape that the comment of a tool table names, without blanks and in lower case; "" for what is not a
/// rotating cutter. A drill has its usual point, a V needs an angle.
std::string_view shape_of_comment(const std::string& comment, double& angle) {
  for (const std::string_view other : {"probe", "edgefinder", "toolsetter", "dragknife"})
    if (has(comment, other)) return {};
  if (has(comment, "ball")) return "ball";
  if (has(comment, "drill") && !has(comment, "mill")) {
    angle = kDrillPoint;
    return "drill";
  }
  for (const std::string_view vee : {"vbit", "vcarve", "vgroove", "vee", "engrav", "chamfer"}) {
    if (!has(comment, vee)) continue;
    const std::size_t degrees = comment.find("deg");
    std::size_t start = std::min(degrees, comment.size());
    while (start > 0 && std::isdigit(static_cast<unsigned char>(comment[start - 1])) != 0) --start;
    angle = parse_number(std::string_view(comment).substr(start, degrees - start)).value_or(0.0);
    if (degrees != std::string::npos && angle > 0.0 && angle < 180.0) return "V";
  }
  angle = 0.0;
  return "square";
}

/// The tool of a comment that Kerf has written: its sizes, and its description. Nothing for other comments,
/// and, with a warning, where the line has another diameter.
std::optional<Tool> tool_of_own_comment(const LibraryTool& line, Diagnostics& diagnostics) {
  constexpr double kSame = 0.02;  // mm
  const std::string_view comment = line.description;
  const std::size_t end = std::min(comment.find(kBeforeDescription), comment.size());
  auto tool = read_tool_description(comment.substr(0, end), line.number.value_or(0), line.where, diagnostics);
  if (!tool) return std::nullopt;
  if (std::abs(tool->diameter.mm() - line.diameter) > kSame) {
    diagnostics.warning(
        codes::tool_library_value, line.where,
        fmt::format("the tool has a diameter of {} mm by its D, but of {} mm by its comment; its "
                    "D is used",
                    number_text(line.diameter, 4), number_text(tool->diameter.mm(), 4)));
    return std::nullopt;
  }
  tool->description = end == comment.size() ? "" : comment.substr(end + kBeforeDescription.size());
  return tool;
}

/// "T1 P17 Z0 D6 I45 J45 Q0 ;comment". The table has no shapes: a comment may name one, else a tool becomes a
/// square mill.
void read_linuxcnc_table(std::string_view text, LibraryWriter& out) {
  bool any = false;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    const std::size_t comment = std::min(line.find(';'), line.size());
    LibraryTool tool;
    tool.where = out.location(number);
    if (comment < line.size())
      tool.description = std::string(trim(line.substr(comment + 1)).substr(0, kMaxComment));
    std::string_view words = trim(line.substr(0, comment));
    if (words.empty()) return;
    while (!words.empty()) {
      const std::size_t end = std::min(words.find_first_of(" \t"), words.size());
      const std::string_view word = words.substr(0, end);
      words = trim(words.substr(end));
      const auto value = parse_number(word.substr(1));
      if (!value)
        out.diagnostics().warning(codes::tool_library_value, tool.where,
                                  fmt::format("\"{}\" is not a letter with a number", word.substr(0, 40)));
      if (!value) continue;
      if (word[0] == 'T' || word[0] == 't') tool.number = whole(word.substr(1));
      if (word[0] == 'D' || word[0] == 'd') tool.diameter = out.options().unit_mm * *value;
    }
    if (auto own = tool_of_own_comment(tool, out.diagnostics())) return out.add(std::move(*own), tool);
    tool.description.resize(std::min(tool.description.size(), limits::kMaxNameBytes));
    any = true;
    tool.shape = shape_of_comment(fold_name(tool.description), tool.angle);
    if (tool.shape.empty())
      return out.skip(tool.where, fmt::format("T{}", tool.number.value_or(0)), "it is not a rotating cutter");
    if (tool.diameter == 0.0)
      return out.skip(tool.where, fmt::format("T{}", tool.number.value_or(0)), "it has no D");
    out.add(tool);
  });
  if (any)
    out.diagnostics().note(
        codes::tool_library_assumed, out.location(0),
        fmt::format("a tool.tbl has neither shapes nor units: read as square mills, unless a comment "
                    "names another shape, in {}",
                    out.options().unit_mm == 1.0 ? "mm" : "inches"));
}

}  // namespace kerf::detail
