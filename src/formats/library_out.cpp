// Tools in the forms of other programs: Carbide Create's CSV, the JSON of Fusion, FreeCAD and CAMotics.
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/number.h"
#include "formats/library.h"

#include "kerf/base/units.h"

namespace kerf::detail {
namespace {

using Json = nlohmann::ordered_json;

double measure(const ToolShape& shape, std::string_view name) {
  for (const ShapeParameter& parameter : parameters_of(shape))
    if (parameter.name == name) return parameter.get(shape);
  return 0.0;
}

/// Shapes of other names in those that other programs know.
void rename_shape(const ToolShape& shape, LibraryTool& tool) {
  if (std::holds_alternative<shape::Bowl>(shape)) tool.shape = "bull nose";
  if (std::holds_alternative<shape::Chamfer>(shape)) tool.shape = "V";
  if (const auto* groove = std::get_if<shape::FlatGroove>(&shape)) {
    const double width = 0.5 * (groove->diameter.mm() - groove->tip_diameter.mm());
    tool.shape = "V";
    tool.angle = 2.0 * radians(std::atan2(width, groove->flute.mm())).deg();
  }
  const auto* vee = std::get_if<shape::Vee>(&shape);
  if (vee != nullptr && vee->tip_radius > Length()) {
    tool.shape = "tapered ball";
    tool.tip_diameter = 2.0 * vee->tip_radius.mm();
  }
  if (const auto* thread = std::get_if<shape::ThreadMill>(&shape)) {
    tool.diameter = thread->major_diameter.mm();
    tool.neck_diameter = thread->minor_diameter.mm();
    tool.flute = thread->length.mm();
  }
}

void describe_body(const Silhouette& parts, bool own_neck, LibraryTool& tool) {
  const auto length = [](const Profile& part) { return part.empty() ? 0.0 : part.top() - part.bottom(); };
  if (!own_neck && !parts.neck.empty()) {
    tool.neck_diameter = 2.0 * parts.neck.max_radius();
    tool.neck_length = length(parts.neck);
  }
  tool.shank_diameter = 2.0 * parts.shank.max_radius();
  tool.shank_length = length(parts.shank);
  tool.holder_diameter = 2.0 * parts.holder.max_radius();
  tool.holder_length = length(parts.holder);
}

/// On one line: control characters become blanks.
std::string line_of(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return out;
}

std::string dumped(const Json& json) {
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// An identifier that is the same in every run: programs ask for one per tool.
std::string guid_of(int number, int kind) {
  return fmt::format("{:08x}-0000-4000-8000-{:012x}", number, kind);
}

}  // namespace

LibraryTool described(int number, const Tool& tool) {
  LibraryTool out;
  out.number = number;
  out.shape = std::string(name_of(tool.shape));
  const auto get = [&](std::string_view name) { return measure(tool.shape, name); };
  out.diameter = get("diameter");
  out.flute = get("flute");
  out.corner_radius = get("corner_radius");
  out.tip_diameter = get("tip_diameter");
  out.neck_diameter = get("neck_diameter");
  out.cut_height = get("cut_height");
  out.angle = get("angle");
  rename_shape(tool.shape, out);
  describe_body(tool.silhouette, std::holds_alternative<shape::ThreadMill>(tool.shape), out);
  out.teeth = tool.teeth;
  for (const std::string& name : tool.names)
    if (out.name.empty() && name != std::to_string(number)) out.name = name;
  out.description = tool.description;
  return out;
}

std::string title_of(const LibraryTool& tool) {
  if (!tool.description.empty()) return tool.description;
  return tool.name.empty() ? short_name(tool) : tool.name;
}

std::string description_of(const LibraryTool& tool) {
  return tool.description.empty() ? short_name(tool) : tool.description;
}

// ---- Carbide Create

namespace {

constexpr std::string_view kCarbideColumns =
    "number,vendor,model,URL,name,type,diameter,cornerradius,flutelength,shaftdiameter,angle,numflutes,"
    "stickout,coating,metric,notes,machine,material,plungerate,feedrate,rpm,depth,cutpower,finishallowance,"
    "3dstepover,3dfeedrate,3drpm\n";

std::string csv_field(std::string_view text) {
  std::string out = line_of(text);
  if (out.find_first_of(",\"") == std::string::npos) return out;
  std::string quoted = "\"";
  for (const char c : out) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// The type and the corner radius of a shape; an empty type where there is none.
std::pair<std::string_view, double> carbide_type(const LibraryTool& tool) {
  if (tool.shape == "square") return {"end", 0.0};
  if (tool.shape == "bull nose") return {"end", tool.corner_radius};
  if (tool.shape == "ball") return {"ball", 0.5 * tool.diameter};
  if (tool.shape == "tapered ball") return {"tapered ball", 0.5 * tool.tip_diameter};
  if (tool.shape == "V") return {"vee", 0.0};
  if (tool.shape == "drill") return {"drill", 0.0};
  return {"", 0.0};
}

}  // namespace

std::string carbide_csv(const LibraryTools& tools) {
  std::string out(kCarbideColumns);
  for (const LibraryTool& tool : tools) {
    const auto [type, corner] = carbide_type(tool);
    if (type.empty()) continue;
    const double stick_out = tool.shank_length > 0.0 ? tool.flute + tool.shank_length : 0.0;
    const double angle = tool.shape == "tapered ball" ? 0.0 : tool.angle;
    out += fmt::format("{},,{},,{},{},{},{},{},{},{},{},{},,1,,,,,,,,,,,,\n", tool.number.value_or(0),
                       csv_field(tool.name), csv_field(description_of(tool)), type, exact_text(tool.diameter),
                       exact_text(corner), exact_text(tool.flute), exact_text(tool.shank_diameter),
                       exact_text(angle), tool.teeth, exact_text(stick_out));
  }
  return out;
}

// ---- Fusion

namespace {

std::string_view fusion_type(const LibraryTool& tool) {
  struct Type {
    std::string_view shape, type;
  };
  constexpr std::array kTypes{Type{"square", "flat end mill"},
                              Type{"ball", "ball end mill"},
                              Type{"bull nose", "bull nose end mill"},
                              Type{"tapered ball", "tapered mill"},
                              Type{"V", "chamfer mill"},
                              Type{"drill", "drill"},
                              Type{"dovetail", "dovetail mill"}};
  for (const Type& known : kTypes)
    if (known.shape == tool.shape) return known.type;
  return "";
}

Json fusion_geometry(const LibraryTool& tool) {
  const bool tapered = tool.shape == "tapered ball";
  const double shoulder = tool.flute + tool.neck_length, below = shoulder + tool.shank_length;
  const double diameter = tapered ? tool.tip_diameter : tool.diameter;
  // What is clamped is unknown; Fusion wants a length of the whole tool above that below the holder.
  const double whole = below + 2.0 * tool.diameter;
  Json out{{"CSP", false},      {"DC", diameter},    {"HAND", true}, {"LB", below},
           {"LCF", tool.flute}, {"NOF", tool.teeth}, {"OAL", whole}, {"shoulder-length", shoulder}};
  if (tool.shank_diameter > 0.0) out["SFDM"] = tool.shank_diameter;
  if (tool.neck_length > 0.0) out["shoulder-diameter"] = tool.neck_diameter;
  if (tool.shape == "bull nose") out["RE"] = tool.corner_radius;
  if (tapered) out["RE"] = 0.5 * tool.tip_diameter;
  if (tapered || tool.shape == "V") out["TA"] = 0.5 * tool.angle;
  if (tool.shape == "dovetail") out["TA"] = tool.angle;
  if (tool.shape == "V") out["tip-diameter"] = tool.tip_diameter;
  if (tool.shape == "drill") out["SIG"] = tool.angle;
  return out;
}

}  // namespace

std::string fusion_library(const LibraryTools& tools) {
  constexpr int kTool = 1, kHolder = 2;
  constexpr const char* kUnit = "millimeters";
  Json data = Json::array();
  for (const LibraryTool& tool : tools) {
    const std::string_view type = fusion_type(tool);
    if (type.empty()) continue;
    const int number = tool.number.value_or(0);
    Json entry{{"description", description_of(tool)},
               {"guid", guid_of(number, kTool)},
               {"type", type},
               {"unit", kUnit},
               {"vendor", ""},
               {"product-id", tool.name},
               {"geometry", fusion_geometry(tool)}};
    entry["post-process"] = Json{{"number", number}, {"diameter-offset", number}, {"length-offset", number}};
    entry["start-values"] = Json{{"presets", Json::array()}};
    if (tool.holder_length > 0.0) {
      const Json segment{{"height", tool.holder_length},
                         {"lower-diameter", tool.holder_diameter},
                         {"upper-diameter", tool.holder_diameter}};
      entry["holder"] = Json{{"type", "holder"},
                             {"unit", kUnit},
                             {"description", ""},
                             {"guid", guid_of(number, kHolder)},
                             {"gaugeLength", tool.holder_length},
                             {"segments", Json::array({segment})}};
    }
    data.push_back(std::move(entry));
  }
  return dumped(Json{{"data", std::move(data)}});
}

// ---- FreeCAD

namespace {

/// "6.35 mm"
std::string with_mm(double value) { return exact_text(value) + " mm"; }
std::string with_degrees(double value) { return exact_text(value) + " °"; }

/// Its shape's name in FreeCAD; empty where there is none. The parameters that are the shape's own are added.
std::string_view freecad_shape(const LibraryTool& tool, Json& parameters) {
  if (tool.shape == "square") return "Endmill";
  if (tool.shape == "ball") return "Ballend";
  if (tool.shape == "bull nose") {
    parameters["CornerRadius"] = with_mm(tool.corner_radius);
    return "Bullnose";
  }
  if (tool.shape == "tapered ball") {
    parameters["TipDiameter"] = with_mm(tool.tip_diameter);
    parameters["TaperAngle"] = with_degrees(tool.angle);
    return "TaperedBallNose";
  }
  if (tool.shape == "V") {
    parameters["CuttingEdgeAngle"] = with_degrees(tool.angle);
    parameters["TipDiameter"] = with_mm(tool.tip_diameter);
    return "VBit";
  }
  if (tool.shape == "drill") {
    parameters["TipAngle"] = with_degrees(tool.angle);
    return "Drill";
  }
  if (tool.shape == "dovetail") {
    parameters["CuttingEdgeAngle"] = with_degrees(90.0 - tool.angle);
    if (tool.neck_length > 0.0) {
      parameters["NeckDiameter"] = with_mm(tool.neck_diameter);
      parameters["NeckHeight"] = with_mm(tool.neck_length);
    }
    return "Dovetail";
  }
  if (tool.shape == "thread mill") {
    const double depth = 0.5 * (tool.diameter - tool.neck_diameter);
    parameters["NeckDiameter"] = with_mm(tool.neck_diameter);
    parameters["NeckLength"] = with_mm(tool.flute - tool.cut_height);
    parameters["Crest"] = with_mm(0.0);
    parameters["cuttingAngle"] = with_degrees(2.0 * radians(std::atan2(0.5 * tool.cut_height, depth)).deg());
    return "ThreadMill";
  }
  return "";
}

}  // namespace

std::string freecad_bit(const LibraryTool& tool) {
  Json parameters{{"Diameter", with_mm(tool.diameter)}, {"Flutes", std::to_string(tool.teeth)}};
  const std::string shape(freecad_shape(tool, parameters));
  if (shape.empty()) return "";
  parameters["CuttingEdgeHeight"] = with_mm(tool.flute);
  const double neck = shape == "Dovetail" ? tool.neck_length : 0.0;  // others have none
  parameters["Length"] = with_mm(tool.flute + neck + tool.shank_length);
  if (tool.shank_diameter > 0.0) parameters["ShankDiameter"] = with_mm(tool.shank_diameter);
  std::string file = shape;
  for (char& c : file) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return dumped(Json{{"version", 2},
                     {"name", title_of(tool)},
                     {"shape", file + ".fcstd"},
                     {"shape-type", shape},
                     {"parameter", parameters},
                     {"attribute", Json::object()}});
}

std::string freecad_library(const LibraryTools& tools, const std::vector<std::string>& files) {
  Json list = Json::array();
  for (std::size_t i = 0; i < tools.size(); ++i)
    list.push_back(Json{{"nr", tools[i].number.value_or(0)}, {"path", files[i]}});
  return dumped(Json{{"version", 1}, {"tools", std::move(list)}});
}

// ---- CAMotics

std::string camotics_project(const LibraryTools& tools) {
  Json list = Json::object();
  for (const LibraryTool& tool : tools) {
    std::string shape;
    if (tool.shape == "square") shape = "cylindrical";
    if (tool.shape == "ball") shape = "ballnose";
    if (tool.shape == "V") shape = tool.tip_diameter > 0.0 ? "snubnose" : "conical";
    if (shape.empty()) continue;
    Json entry{{"units", "metric"},
               {"shape", shape},
               {"length", tool.flute},
               {"diameter", tool.diameter},
               {"description", description_of(tool)}};
    if (shape == "snubnose") entry["snub_diameter"] = tool.tip_diameter;
    list[std::to_string(tool.number.value_or(0))] = std::move(entry);
  }
  return dumped(Json{{"units", "metric"}, {"tools", std::move(list)}});
}

}  // namespace kerf::detail
