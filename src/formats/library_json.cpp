// Tool libraries in JSON: Fusion's, FreeCAD's tool bits, CAMotics' projects.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/names.h"
#include "base/number.h"
#include "formats/library.h"
#include "formats/settings.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"

namespace kerf::detail {
namespace {

using Json = nlohmann::json;
constexpr double kDrillPoint = 118.0;  // degrees, by default
constexpr double kRounding = 1e-6;     // mm, of sums of lengths

const Json* member(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(std::string(key));
  return found == object.end() ? nullptr : &*found;
}

std::string text_of(const Json& object, std::string_view key) {
  const Json* value = member(object, key);
  if (value == nullptr || !value->is_string()) return {};
  return std::string(trim(value->get_ref<const std::string&>()).substr(0, limits::kMaxNameBytes));
}

double number_of(const Json& object, std::string_view key) {
  const Json* value = member(object, key);
  if (value == nullptr || !value->is_number()) return 0.0;
  const double number = value->get<double>();
  return std::isfinite(number) ? number : 0.0;
}

std::optional<int> whole(double value) {
  if (!(value >= 0.0 && value <= 99'999'999.0) || value != std::floor(value)) return std::nullopt;
  return static_cast<int>(value);
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

// ---- Fusion

/// The ball of a tapered mill ends in a cone, whose diameter at the end of the flutes is that of the tool.
void set_tapered_mill(double half_angle, LibraryTool& tool) {
  const double ball = 0.5 * tool.diameter, slope = std::tan(degrees(half_angle).rad());
  tool.angle = 2.0 * half_angle;
  tool.tip_diameter = tool.diameter;
  if (tool.corner_radius >= ball - kRounding) {
    tool.shape = "tapered ball";
    const double sine = std::sin(degrees(half_angle).rad()), cosine = std::cos(degrees(half_angle).rad());
    tool.diameter = 2.0 * (ball * cosine + (tool.flute - ball * (1.0 - sine)) * slope);
  } else {
    tool.shape = tool.corner_radius > 0.0 ? "tapered bull nose" : "V";
    tool.diameter += 2.0 * tool.flute * slope;
  }
}

/// Fusion's angles: TA is between side and axis, SIG the whole point angle.
void set_fusion_shape(const Json& geometry, const std::string& type, LibraryTool& tool) {
  const double taper = number_of(geometry, "TA");
  if (has(type, "ball")) {
    tool.shape = has(type, "taper") || taper > 0.0 ? "tapered ball" : "ball";
    if (tool.shape == "tapered ball") {
      tool.tip_diameter = tool.diameter;
      tool.diameter = tool.shank_diameter > tool.diameter ? tool.shank_diameter : tool.diameter;
      tool.angle = 2.0 * taper;
    }
  } else if (has(type, "chamfer") || has(type, "engrav")) {
    tool.shape = "V";
    tool.angle = 2.0 * taper;
  } else if (has(type, "drill")) {
    tool.shape = "drill";
    const double point = number_of(geometry, "SIG");
    tool.angle = point > 0.0 ? point : has(type, "spot") || has(type, "center") ? 90.0 : kDrillPoint;
    tool.tip_diameter = 0.0;
  } else if (has(type, "bull")) {
    tool.shape = "bull nose";
  } else if (has(type, "dovetail")) {
    tool.shape = "dovetail";
    tool.angle = taper;
  } else if (has(type, "taperedmill") && taper > 0.0) {
    set_tapered_mill(taper, tool);
  } else if (has(type, "flatendmill") || has(type, "facemill") || has(type, "reamer") ||
             has(type, "counterbore")) {
    tool.shape = tool.corner_radius > 0.0 ? "bull nose" : "square";
  } else {
    tool.shape = type;
  }
  if (tool.shape != "V" && tool.shape != "tapered ball") tool.tip_diameter = 0.0;
}

/// The parts above the flutes: a neck up to the shoulder, the shank up to the length below the holder, the
/// holder as the cylinder around its segments.
void read_fusion_body(const Json& entry, const Json& geometry, double scale, LibraryTool& tool) {
  double top = tool.flute;
  const double neck = scale * number_of(geometry, "shoulder-diameter");
  const double shoulder = scale * number_of(geometry, "shoulder-length");
  const double below = scale * number_of(geometry, "LB");
  if (neck > 0.0 && neck <= tool.diameter && shoulder > top + kRounding) {
    tool.neck_diameter = neck;
    tool.neck_length = shoulder - top;
    top = shoulder;
  }
  if (below > top + kRounding)
    tool.shank_length = below - top;
  else if (below >= top - kRounding && below > 0.0)
    tool.shank_diameter = 0.0;  // the holder starts there
  const Json* holder = member(entry, "holder");
  const Json* segments = holder == nullptr ? nullptr : member(*holder, "segments");
  if (segments == nullptr || !segments->is_array()) return;
  const std::string unit = fold_name(text_of(*holder, "unit"));
  const double holder_scale = unit.empty() ? scale : has(unit, "inch") ? kMmPerInch : 1.0;
  for (const Json& segment : *segments) {
    tool.holder_length += holder_scale * std::max(number_of(segment, "height"), 0.0);
    for (const char* key : {"lower-diameter", "upper-diameter"})
      tool.holder_diameter = std::max(tool.holder_diameter, holder_scale * number_of(segment, key));
  }
}

void read_fusion_tool(const Json& entry, std::size_t index, LibraryWriter& out) {
  const Json none = Json::object();
  const Json* given = member(entry, "geometry");
  const Json& geometry = given == nullptr ? none : *given;
  const Json* post = member(entry, "post-process");
  const std::string unit = fold_name(text_of(entry, "unit"));
  const double scale = has(unit, "inch") ? kMmPerInch : 1.0;
  const std::string type = fold_name(text_of(entry, "type"));
  LibraryTool tool;
  tool.where = out.location(0);
  tool.description = text_of(entry, "description");
  const std::string vendor = text_of(entry, "vendor"), product = text_of(entry, "product-id");
  tool.name = vendor.empty() || product.empty() ? product : vendor + " " + product;
  const bool nameless = tool.description.empty() && tool.name.empty();
  if (nameless) tool.description = fmt::format("{} {}", text_of(entry, "type"), index + 1);
  if (has(type, "holder") || has(type, "turning") || has(type, "probe"))
    return out.skip(tool.where, tool.description.empty() ? tool.name : tool.description,
                    "it is not a rotating cutter");
  if (post != nullptr && member(*post, "number") != nullptr) tool.number = whole(number_of(*post, "number"));
  tool.diameter = scale * number_of(geometry, "DC");
  tool.flute = scale * number_of(geometry, "LCF");
  tool.shank_diameter = scale * number_of(geometry, "SFDM");
  tool.corner_radius = scale * number_of(geometry, "RE");
  tool.tip_diameter = scale * number_of(geometry, "tip-diameter");
  tool.teeth = whole(number_of(geometry, "NOF")).value_or(0);
  set_fusion_shape(geometry, type, tool);
  read_fusion_body(entry, geometry, scale, tool);
  out.add(tool);
}

// ---- FreeCAD

/// "5.0000 mm", "60.00 °" or a plain number.
double freecad_value(const Json& parameters, std::string_view key) {
  const Json* value = member(parameters, key);
  if (value == nullptr) return 0.0;
  if (value->is_number()) return number_of(parameters, key);
  std::string text = text_of(parameters, key);
  if (text.find('.') == std::string::npos)
    std::replace(text.begin(), text.end(), ',', '.');  // as some locales
  if (const auto length = parse_length(text, 1.0)) return *length;
  return parse_number(trim(std::string_view(text).substr(0, text.find_first_not_of("+-.0123456789"))))
      .value_or(0.0);
}

/// FreeCAD's angle of a dovetail is between the bottom and the side.
void set_freecad_dovetail(const Json& p, double angle, LibraryTool& tool) {
  tool.shape = "dovetail";
  if (angle > 0.0) tool.angle = 90.0 - angle;
  tool.neck_diameter = freecad_value(p, "NeckDiameter");
  tool.neck_length = freecad_value(p, "NeckHeight");
}

/// One tooth with the angle of the thread and a flat crest, on a neck.
void set_freecad_thread_mill(const Json& p, LibraryTool& tool) {
  tool.shape = "thread mill";
  tool.neck_diameter = freecad_value(p, "NeckDiameter");
  const double half_angle = 0.5 * freecad_value(p, "cuttingAngle");
  const double depth = 0.5 * (tool.diameter - tool.neck_diameter);
  tool.cut_height = freecad_value(p, "Crest") + 2.0 * depth * std::tan(degrees(half_angle).rad());
  const double neck = freecad_value(p, "NeckLength");
  if (neck > 0.0) tool.flute = tool.cut_height + neck;  // the whole length
}

void read_freecad_bit(const Json& root, std::optional<int> number, LibraryWriter& out) {
  const Json none = Json::object();
  const Json* parameters = member(root, "parameter");
  const Json& p = parameters == nullptr ? none : *parameters;
  std::string type = fold_name(text_of(root, "shape-type"));
  if (type.empty()) type = fold_name(text_of(root, "shape"));
  LibraryTool tool;
  tool.number = number;
  tool.where = out.location(0);
  tool.description = text_of(root, "name");
  tool.diameter = freecad_value(p, "Diameter");
  tool.flute = freecad_value(p, "CuttingEdgeHeight");
  tool.shank_diameter = freecad_value(p, "ShankDiameter");
  tool.teeth = whole(freecad_value(p, "Flutes")).value_or(0);
  const double angle = freecad_value(p, "CuttingEdgeAngle");
  if (has(type, "taperedball")) {
    tool.shape = "tapered ball";
    tool.tip_diameter = freecad_value(p, "TipDiameter");
    tool.angle = freecad_value(p, "TaperAngle");
  } else if (has(type, "ball")) {
    tool.shape = "ball";
  } else if (has(type, "bull") || has(type, "torus") || has(type, "toroid")) {
    tool.shape = "bull nose";
    for (const char* key : {"CornerRadius", "TorusRadius"})
      if (tool.corner_radius == 0.0) tool.corner_radius = freecad_value(p, key);
    const double flat = freecad_value(p, "FlatRadius");  // of the flat part of the bottom
    if (tool.corner_radius == 0.0 && flat > 0.0) tool.corner_radius = 0.5 * tool.diameter - flat;
  } else if (has(type, "dovetail")) {
    set_freecad_dovetail(p, angle, tool);
  } else if (has(type, "threadmill")) {
    set_freecad_thread_mill(p, tool);
  } else if (has(type, "vbit") || has(type, "chamfer")) {
    tool.shape = "V";
    tool.angle = angle;
    tool.tip_diameter = freecad_value(p, "TipDiameter");
  } else if (has(type, "drill")) {
    tool.shape = "drill";
    tool.angle = freecad_value(p, "TipAngle");
    if (tool.angle == 0.0) tool.angle = kDrillPoint;
  } else {
    tool.shape = has(type, "endmill") ? "square" : type;
  }
  const double above = freecad_value(p, "Length") - tool.flute - tool.neck_length;
  if (tool.flute > 0.0 && above > kRounding) tool.shank_length = above;
  out.add(tool);
}

/// A library lists numbers and the files of its bits.
void read_freecad_library(const Json& root, LibraryWriter& out) {
  for (const Json& entry : *member(root, "tools")) {
    std::string name = text_of(entry, "path");
    if (name.empty() && !text_of(entry, "id").empty()) name = text_of(entry, "id") + ".fctb";
    const auto text = out.options().read_bit && !name.empty() ? out.options().read_bit(name) : std::nullopt;
    const Json bit = text ? Json::parse(*text, nullptr, false) : Json();
    if (bit.is_object())
      read_freecad_bit(bit, whole(number_of(entry, "nr")), out);
    else
      out.skip(out.location(0), name, text ? "its file is not JSON" : "its file is missing");
  }
}

// ---- CAMotics

void read_camotics_tool(const std::string& key, const Json& entry, const Json& project, LibraryWriter& out) {
  std::string units = text_of(entry, "units");
  if (units.empty()) units = text_of(project, "units");
  const double scale = has(fold_name(units), "inch") || has(fold_name(units), "imperial") ? kMmPerInch : 1.0;
  const std::string shape = fold_name(text_of(entry, "shape"));
  LibraryTool tool;
  tool.where = out.location(0);
  const auto number = parse_number(key);
  if (number) tool.number = whole(*number);
  tool.description = text_of(entry, "description");
  tool.diameter = scale * number_of(entry, "diameter");
  tool.flute = scale * number_of(entry, "length");
  const double tip = scale * number_of(entry, "snub_diameter");
  if (shape == "cylindrical" || shape.empty()) {
    tool.shape = "square";
  } else if (shape == "ballnose") {
    tool.shape = "ball";
  } else if (shape == "conical" || shape == "snubnose") {
    tool.shape = "V";  // a cone from the tip to the diameter over the whole length
    tool.tip_diameter = shape == "snubnose" ? tip : 0.0;
    if (tool.flute > 0.0)
      tool.angle = 2.0 * radians(std::atan2((tool.diameter - tool.tip_diameter) / 2.0, tool.flute)).deg();
  } else {
    tool.shape = shape;
  }
  out.add(tool);
}

}  // namespace

std::optional<ToolLibraryKind> json_library_kind(std::string_view text) {
  const Json root = Json::parse(text, nullptr, false);
  if (!root.is_object()) return std::nullopt;
  if (const Json* data = member(root, "data"); data != nullptr && data->is_array())
    return ToolLibraryKind::fusion;
  if (member(root, "parameter") != nullptr && member(root, "shape") != nullptr)
    return ToolLibraryKind::freecad;
  if (const Json* tools = member(root, "tools"); tools != nullptr && tools->is_object())
    return ToolLibraryKind::camotics;
  if (const Json* tools = member(root, "tools"); tools != nullptr && tools->is_array())
    return ToolLibraryKind::freecad_library;
  return std::nullopt;
}

void read_json_library(std::string_view text, ToolLibraryKind kind, LibraryWriter& out) {
  const Json root = Json::parse(text, nullptr, false);
  if (kind == ToolLibraryKind::freecad) return read_freecad_bit(root, std::nullopt, out);
  if (kind == ToolLibraryKind::freecad_library) return read_freecad_library(root, out);
  if (kind == ToolLibraryKind::camotics) {
    for (const auto& [key, entry] : member(root, "tools")->items()) read_camotics_tool(key, entry, root, out);
    return;
  }
  const Json& data = *member(root, "data");
  for (std::size_t i = 0; i < data.size(); ++i) read_fusion_tool(data[i], i, out);
}

}  // namespace kerf::detail
