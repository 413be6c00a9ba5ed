// Engraved and drawn text in fonts of single strokes.
#include <fmt/format.h>

#include "base/names.h"
#include "design/commands/entities.h"
#include "design/commands/rows.h"

#include "kerf/base/limits.h"
#include "kerf/geom/text.h"

namespace kerf::design {
namespace {

constexpr double kLinePitch = 2.0;         // of lines, as a multiple of the height
constexpr std::size_t kMaxText = 100'000;  // bytes

/// The fonts by the names of the commands, and by those of stroke_fonts.h.
struct NamedFont {
  const char *name, *strokes;
};
constexpr NamedFont kFonts[] = {{"sans", "sans"},
                                {"sans bold", "sans-2"},
                                {"script", "script"},
                                {"script bold", "script-2"},
                                {"times", "serif"},
                                {"times bold", "serif-bold"},
                                {"times italic", "serif-italic"}};

std::string_view font_named(std::string_view name) {
  std::vector<std::string> names;
  for (const NamedFont& font : kFonts) names.emplace_back(font.name);
  return kFonts[choice(name, names, "font")].strokes;
}

/// The arguments of a text by their indices: the text; the font, then spacing and width; x, then y; the
/// height.
struct TextArguments {
  std::size_t text, font, x, height;
};

/// The arguments of the strokes alone: x, y, string, height, font, spacing, width.
constexpr TextArguments kStrokes{2, 4, 0, 3};

/// The strokes, from the left end of the first base line. Letters are `width` times as wide, lines of one
/// letter height below the others apart by another.
std::vector<Outline> strokes_of(Machine& machine, Call& call, const TextArguments& at) {
  const std::string line = call.text(at.text);
  if (line.size() > kMaxText) refuse(fmt::format("string is longer than {} bytes", kMaxText));
  const Point2 corner = call.point2(at.x);
  TextOptions options;
  options.height = mm(positive(call.number(at.height), "height"));
  options.line_pitch = kLinePitch;
  options.where = machine.where();
  options.name = "string";
  const auto font = stroke_text_font(font_named(call.text(at.font)));
  const double spacing = coordinate(call.number(at.font + 1), "spacing");
  const double width = positive(call.number(at.font + 2), "width");
  options.spacing = mm(spacing / width);
  if (trim(line).empty()) return {};
  const auto set = set_text(line, *font, options, machine.diagnostics());
  if (!set) throw Reported{};
  std::vector<Outline> strokes;
  for (const Outline& stroke : *set)
    if (!stroke.segments.empty()) strokes.push_back(placed(stroke, Placement{corner, {width, 1.0}}));
  return strokes;
}

/// string, bx, by, height, bz, zdepth, font, spacing, width
void cuttext(Machine& machine, Call& call) {
  const std::vector<Outline> strokes = strokes_of(machine, call, {0, 6, 1, 3});
  const double top = call.number(4), depth = call.number(5);
  machine.cut_outlines(strokes, bottom_of(machine, top, depth));
}

/// tool_num, string, bx, by, height, font, spacing, width
void dxftext(Machine& machine, Call& call) {
  const int tool = tool_number(machine, call, 0);
  for (const Outline& stroke : strokes_of(machine, call, {1, 5, 2, 4})) draw_outline(machine, tool, stroke);
}

Value textstrokes(Machine& machine, Call& call) { return Outlines{strokes_of(machine, call, kStrokes)}; }

}  // namespace

void add_text_commands(Rows& rows) {
  rows.push_back(making<textstrokes>("textstrokes", "x, y, string, height, font=\"sans\", spacing=0, width=1",
                                     "The strokes of a text in a single-line font: open outlines."));
  rows.push_back(motion<cuttext>(
      "cuttext", "string, bx, by, height, bz, zdepth, font=\"sans\", spacing=0, width=1",
      "Engrave a text in a single-line font, `zdepth` mm below `bz`; (bx, by) is the left end of its base\n"
      "line, `height` that of capitals."));
  rows.push_back(tool_may_be_left_out(
      row<dxftext>("dxftext", "tool_num, string, bx, by, height, font=\"sans\", spacing=0, width=1",
                   "Draw a text in a single-line font as polylines."),
      0));
}

}  // namespace kerf::design
