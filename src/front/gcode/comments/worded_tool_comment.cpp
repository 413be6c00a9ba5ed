// Tool comments in words: the forms of the programs that write them. Anything else is prose.
#include "front/gcode/comments/worded_tool_comment.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "front/gcode/comments/comment_forms.h"

namespace kerf::gcode {
namespace {

using Tokens = std::vector<CommentToken>;

constexpr double kMaxDiameter = 500.0;    // mm
constexpr double kPointAngle = 118.0;     // degrees, of a drill
constexpr double kVeeDiameter = 12.7;     // mm, if a comment has only the angle
constexpr double kEngraverShank = 3.175;  // mm, of a V with a tip but without a diameter
constexpr double kMaxTip = 1.0;           // mm: "30 degree 0.3 mm" is the tip, "60 degree 6 mm" the diameter

struct Form {
  std::string_view form;
  std::optional<ToolKind> kind = {};  // that the form states
};

/// Of any line.
const Form kForms[] = {
    {"TOOL # @number @quoted / DIAMETER @size", ToolKind::square},  // CopperCAM
    {"@adjectives , ?@count ?- ?FLUTE @kind , @length"},            // Estlcam
    {"?@number ?= @kind { ?@angle @length }"},                      // VCarve, Aspire
    {"?@number ?= @kind ( ?@angle @length )"},                      // Easel
    {"TOOL : @length @adjectives @kind"},                           // Carbide Motion
    {"@length @adjectives @kind ?@count"},                          // FreeCAD
    {"@angle @adjectives @kind ?@count"},                           // FreeCAD
    {"END MILL @length", ToolKind::square},
    {"@length CRB @count FL ?@count ?LOC", ToolKind::square},
    {"COMPENSATED TOOL PATH . DIAMETER : @size", ToolKind::square},    // FreeCAD
    {"CHANGE TOOL BIT TO CUTTER DIAMETER @length", ToolKind::square},  // pcb2gcode
    {"CHANGE TOOL BIT TO MILL DIAMETER @length", ToolKind::square},
    {"CHANGE TOOL BIT TO DRILL SIZE @length", ToolKind::drill},
    {"BIT SIZES : [ @length ]", ToolKind::square},
    {"TOOL : @number - > DIA : @length", ToolKind::square},  // FlatCAM
    {"TOOL DIAMETER : @size", ToolKind::square},
    {"TOOL DIAMETER = @size", ToolKind::square},                             // Mach3's wizards
    {"TOOL @number : @kind @count FLUTES , DIAM = @length , LEN = @count"},  // OpenBuilds
    {"TOOL @number : @kind @count FLUTES , DIAM = @length , LEN = @tip"},
    {"BIT DIAMETER : @length", ToolKind::square},            // SketchUcam
    {"TOOL : @length", ToolKind::square},                    // Universal G-code Sender
    {"CHANGE TOOL : DIAMETER : @length", ToolKind::square},  // Kiri:Moto
    {"CHANGE TOOL TO ' END @length '", ToolKind::square},    // gEDA
    {"TOOL @number - DIA @size", ToolKind::square},
    {"TOOL : T @number = @size DIA . @kind ?@count ?: ?REG"},
    {"@count @kind DIA . @size"},
    {"TOOLS : T @number @length @kind , @rest"},
    {"T @number | @length @adjectives @kind | @rest"},  // Mastercam
    {"TOOL # @number @size DIA @kind ?@count ?FLUTE"},
    {"DIA @size @kind"},
    {"TOOL - @number DIA . OFF . - @count LEN . - @count DIA . - @size", ToolKind::square},
    // Mastercam
    {"@nominal @adjectives @kind TOOL - @number DIA . OFF . - @count LEN . - @count DIA . - @size"},
    {"DESCRIPTION : @angle . @kind WITH @tip TIP RAD ."},  // VCarve's tool database
};

/// Of the line of a tool change.
const Form kFormsAtChange[] = {{"FREZA D @size", ToolKind::square}, {"D @size", ToolKind::square}};

double mm_of(const CommentToken& t, double scale) {
  return t.unit == CommentUnit::none ? t.value * scale : t.value;
}

std::optional<ToolShape> vee(const FormMatch& m, std::optional<double> diameter, double scale) {
  if (!m.angle) return std::nullopt;
  shape::Vee shape{mm(kVeeDiameter), {}, degrees(*m.angle), {}, {}};
  std::optional<double> tip = m.tip ? std::optional(mm_of(*m.tip, scale)) : std::nullopt;
  if (!tip && diameter && *diameter <= kMaxTip) std::swap(tip, diameter);
  if (tip && (*tip > kMaxTip || (diameter && *tip >= *diameter))) tip.reset();
  if (tip) shape.tip_diameter = mm(*tip);
  if (diameter || tip) shape.diameter = mm(diameter.value_or(kEngraverShank));
  return shape;
}

std::optional<ToolShape> shape_of(const FormMatch& m, std::optional<ToolKind> stated, double scale) {
  std::optional<double> diameter;
  if (!m.lengths.empty()) diameter = mm_of(m.lengths[0], scale);
  if (diameter && (!(*diameter > 0.0) || *diameter > kMaxDiameter)) return std::nullopt;
  const auto kind = m.angle && m.kind != ToolKind::drill ? ToolKind::vee : m.kind ? m.kind : stated;
  if (kind == ToolKind::vee) return vee(m, diameter, scale);
  if (!kind || !diameter || kind == ToolKind::bull_nose) return std::nullopt;  // no corner radius is given
  if (kind == ToolKind::ball) return shape::Ball{mm(*diameter), {}};
  if (kind == ToolKind::drill) return shape::Drill{mm(*diameter), {}, degrees(m.angle.value_or(kPointAngle))};
  return shape::Square{mm(*diameter), {}};
}

template <std::size_t N>
std::optional<CamTool> read_forms(const Form (&forms)[N], const Tokens& tokens, double scale) {
  for (const Form& f : forms)
    if (const auto m = match_form(tokens, f.form))
      if (const auto shape = shape_of(*m, f.kind, scale)) return CamTool{m->number, *shape};
  return std::nullopt;
}

}  // namespace

std::optional<CamTool> read_worded_tool_comment(std::string_view text, double scale, bool at_tool_change) {
  const Tokens tokens = comment_tokens(text);
  std::optional<CamTool> tool = read_forms(kForms, tokens, scale);
  if (!tool && at_tool_change) tool = read_forms(kFormsAtChange, tokens, scale);
  if (!tool) return std::nullopt;
  std::string capitals(text);
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  tool->assumed = assumed_profile(capitals);
  return tool;
}

}  // namespace kerf::gcode
