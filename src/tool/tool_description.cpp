// Kerf's own descriptions of tools: one writer and one reader, by the table of the shapes' parameters.
#include "tool/tool_description.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "base/ending.h"
#include "base/names.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr int kDecimals = 6;              // of mm and degrees
constexpr std::size_t kMaxPoints = 2000;  // of a drawn profile
constexpr std::string_view kTeeth = " teeth", kPlunges = "plunges", kDoesNot = "does not plunge",
                           kCone = "conical shank";
constexpr int kMaxTeeth = 100;

struct BodyField {
  std::string_view name;
  Length ToolBody::*member;
};
constexpr std::array kBodyFields{
    BodyField{"neck_diameter", &ToolBody::neck_diameter},
    BodyField{"neck_length", &ToolBody::neck_length},
    BodyField{"shank_diameter", &ToolBody::shank_diameter},
    BodyField{"shank_length", &ToolBody::shank_length},
    BodyField{"holder_diameter", &ToolBody::holder_diameter},
    BodyField{"holder_length", &ToolBody::holder_length},
};

std::string spaced(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

bool has_parameter(const ToolShape& shape, std::string_view name) {
  const auto& all = parameters_of(shape);
  return std::any_of(all.begin(), all.end(), [&](const ShapeParameter& p) { return p.name == name; });
}

/// With few decimals where these are exact: a size that make_tool has computed must be met exactly.
std::string size_text(double value) {
  constexpr double kSame = 1e-12;
  const std::string rounded = number_text(value, kDecimals);
  const auto read = parse_number(rounded);
  return read && std::abs(*read - value) < kSame ? rounded : exact_text(value);
}

void put(std::string& out, std::string_view name, double value, std::string_view unit) {
  if (value > 0.0) out += fmt::format(", {} {} {}", spaced(name), size_text(value), unit);
}

void put_part(std::string& out, std::string_view name, const ToolShape& shape, const Profile& part) {
  if (part.empty()) return;
  const std::string diameter = fmt::format("{}_diameter", name);
  if (!has_parameter(shape, diameter)) put(out, diameter, 2.0 * part.max_radius(), "mm");
  put(out, fmt::format("{}_length", name), part.top() - part.bottom(), "mm");
}

/// A shank with a conical instead of a flat lower end.
bool starts_with_cone(const Profile& shank) {
  return shank.knots.size() > 2 && shank.knots[1].r > shank.knots[0].r && shank.knots[1].z > shank.knots[0].z;
}

/// A tool as a text describes it.
struct Described {
  ToolShape shape;
  ToolBody body;
  std::optional<int> teeth;
  std::optional<bool> plunges;
  std::size_t sizes = 0;
};

/// "point 3 10 0.4142": a corner of a drawn profile.
bool read_point(std::string_view text, Described& out) {
  auto* drawn = std::get_if<shape::Drawn>(&out.shape);
  constexpr std::string_view kPoint = "point ";
  if (drawn == nullptr || text.substr(0, kPoint.size()) != kPoint) return false;
  std::array<double, 3> values{};
  std::size_t count = 0;
  text = trim(text.substr(kPoint.size()));
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const auto value = parse_number(text.substr(0, end));
    if (!value || count == values.size()) return false;
    values[count++] = *value;
    text = trim(text.substr(end));
  }
  if (count < 2 || drawn->cutting.knots.size() == kMaxPoints) return false;
  drawn->cutting.knots.push_back({values[0], values[1], values[2]});
  ++out.sizes;
  return true;
}

/// "neck diameter 6.35 mm" or "angle 60 deg".
bool read_size(std::string_view text, Described& out) {
  const std::size_t unit_at = text.rfind(' ');
  if (unit_at == std::string_view::npos) return false;
  const std::string_view unit = text.substr(unit_at + 1);
  const std::size_t value_at = text.substr(0, unit_at).rfind(' ');
  if (value_at == std::string_view::npos) return false;
  const auto value = parse_number(text.substr(value_at + 1, unit_at - value_at - 1));
  if (!value) return false;
  std::string name(text.substr(0, value_at));
  std::replace(name.begin(), name.end(), ' ', '_');
  ++out.sizes;
  for (const ShapeParameter& p : parameters_of(out.shape)) {
    if (p.name != name) continue;
    if (unit != (p.kind == ShapeParameter::Kind::length ? "mm" : "deg")) return false;
    p.set(out.shape, *value);
    return true;
  }
  for (const BodyField& field : kBodyFields) {
    if (field.name != name || unit != "mm") continue;
    out.body.*field.member = mm(*value);
    return true;
  }
  return false;
}

bool read_field(std::string_view text, Described& out) {
  if (text == kPlunges || text == kDoesNot) {
    out.plunges = text == kPlunges;
    return true;
  }
  if (text == kCone) {
    out.body.transition = Transition::cone;
    return true;
  }
  if (text.size() > kTeeth.size() && text.substr(text.size() - kTeeth.size()) == kTeeth) {
    const auto count = parse_number(text.substr(0, text.size() - kTeeth.size()));
    if (!count || *count < 1.0 || *count > kMaxTeeth || *count != std::floor(*count)) return false;
    out.teeth = static_cast<int>(*count);
    return true;
  }
  return read_point(text, out) || read_size(text, out);
}

/// Removes and returns the text before the next comma.
std::string_view next_field(std::string_view& text) {
  const std::size_t comma = text.find(',');
  const std::string_view field = trim(text.substr(0, comma));
  text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
  return field;
}

/// The shape of exactly this name, no synonym; in small letters too, as in a comment that had capitals only.
std::optional<ToolShape> shape_called(std::string_view name) {
  auto shape = shape_named(name);
  if (!shape) return std::nullopt;
  std::string small(name_of(*shape));
  std::transform(small.begin(), small.end(), small.begin(), small_letter);
  return name_of(*shape) == name || small == name ? shape : std::nullopt;
}

std::optional<Described> parse(std::string_view text) {
  const auto shape = shape_called(next_field(text));
  if (!shape || trim(text).empty()) return std::nullopt;
  Described out{*shape, {}, {}, {}};
  while (!trim(text).empty())
    if (!read_field(next_field(text), out)) return std::nullopt;
  return out.sizes > 0 ? std::optional(out) : std::nullopt;
}

}  // namespace

Profile neck_of_body(const Tool& tool) {
  const Profile& neck = tool.silhouette.neck;
  const auto* thread = std::get_if<shape::ThreadMill>(&tool.shape);
  if (thread == nullptr || neck.empty()) return neck;
  const double end = std::max(thread->length.mm(), tool.silhouette.cutting.top()), r = neck.knots.back().r;
  return neck.top() > end ? Profile{{{r, end, 0.0}, {r, neck.top(), 0.0}}} : Profile{};
}

std::string write_tool_description(const Tool& tool) {
  std::string out(name_of(tool.shape));
  for (const ShapeParameter& p : parameters_of(tool.shape)) {
    if (tool.flute_assumed && p.name == "flute") continue;
    put(out, p.name, p.get(tool.shape), p.kind == ShapeParameter::Kind::length ? "mm" : "deg");
  }
  if (const auto* drawn = std::get_if<shape::Drawn>(&tool.shape))
    for (const Knot& knot : drawn->cutting.knots)
      out += fmt::format(", point {} {}{}", exact_text(knot.r), exact_text(knot.z),
                         knot.bulge == 0.0 ? "" : " " + exact_text(knot.bulge));
  put_part(out, "neck", tool.shape, neck_of_body(tool));
  put_part(out, "shank", tool.shape, tool.silhouette.shank);
  if (starts_with_cone(tool.silhouette.shank)) out += fmt::format(", {}", kCone);
  put_part(out, "holder", tool.shape, tool.silhouette.holder);
  if (!tool.teeth_assumed) out += fmt::format(", {}{}", tool.teeth, kTeeth);
  Diagnostics ignored;  // the tool has been made of this shape
  const auto plain = make_tool(tool.number, tool.shape, {}, {}, ignored);
  if (plain && plain->plunges != tool.plunges) out += fmt::format(", {}", tool.plunges ? kPlunges : kDoesNot);
  return out;
}

bool starts_tool_description(std::string_view text) {
  const std::size_t comma = text.find(',');
  return comma != std::string_view::npos && shape_called(trim(text.substr(0, comma))).has_value();
}

std::optional<Tool> read_tool_description(std::string_view text, int number, const Origin& where,
                                          Diagnostics& diagnostics) {
  const auto described = parse(text);
  if (!described) return std::nullopt;
  auto tool = make_tool(number, described->shape, described->body, where, diagnostics);
  if (!tool) return std::nullopt;
  tool->description = std::string(text);
  tool->teeth = described->teeth.value_or(tool->teeth);
  tool->teeth_assumed = !described->teeth;
  tool->plunges = described->plunges.value_or(tool->plunges);
  return tool;
}

bool is_from_description(const Tool& tool) { return parse(tool.description).has_value(); }

}  // namespace kerf
