// An example of a job file, and the JSON schema of job files, from the table of keys.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/names.h"
#include "front/cut/keys.h"

namespace kerf {
namespace {

using namespace cut_detail;
using Json = nlohmann::ordered_json;

std::vector<std::string> words_of(std::string_view list) {
  std::vector<std::string> words;
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    words.emplace_back(trim(list.substr(0, comma)));
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return words;
}

Json schema_of(const CutKey& key) {
  Json schema{{"description", std::string(key.meaning)}};
  switch (key.type) {
    case CutKey::Type::number:
      schema["type"] = "number";
      if (!key.unit.empty()) schema["$comment"] = std::string(key.unit);
      break;
    case CutKey::Type::text:
      schema["type"] = "string";
      if (!key.unit.empty()) schema["enum"] = words_of(key.unit);
      break;
    case CutKey::Type::list:
      schema["type"] = "array";
      schema["items"] = Json{{"type", "string"}};
      break;
  }
  return schema;
}

constexpr std::string_view kStar =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"star\"\n"
    "polygon = [[0, 14], [18, 14], [24, 0], [30, 14], [48, 14], [34, 24], [39, 40], [24, 30], [9, 40], "
    "[14, 24]]\n\n";
constexpr std::string_view kPicture =
    "[[shape]]                 # or picture = \"photo.png\"\n"
    "pixels = [\"00000000\", \"03777300\", \"07999730\", \"03777370\", \"00037770\", \"00000000\"]\n"
    "picture-width = 40        # mm\n"
    "at = [0, 0]               # lower left corner\n\n";
constexpr std::string_view kCarveFirst =
    "[[operation]]             # the walls, and the corners up to their points\n"
    "op = \"vcarve\"\n"
    "tool = 2\n"
    "depth = 3\n"
    "rpm = 16000\n"
    "feed = 900\n\n";

constexpr std::string_view kHill =
    "[surface]                 # or file = \"part.stl\" (.3mf, .obj), with move = [x, y, z] and scale\n"
    "rectangle = [0, 0, 60, 40]\n"
    "heights = [               # Z in rows from low to high Y, at equal distances\n"
    "  [-6, -6, -5, -5, -6, -6, -6],\n"
    "  [-6, -4, -2, -2, -4, -5, -6],\n"
    "  [-5, -2,  0,  0, -3, -4, -5],\n"
    "  [-6, -4, -2, -1, -2, -4, -6],\n"
    "  [-6, -6, -5, -4, -5, -6, -6],\n"
    "]\n\n";

/// What a path is projected onto is cut first.
constexpr std::string_view kHillFirst =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"ring\"\n"
    "circle = [30, 20, 24]     # x, y, diameter\n\n"
    "[[operation]]             # the surface\n"
    "op = \"raster\"\n"
    "tool = 2\n"
    "rpm = 16000\n"
    "feed = 1200\n\n";

/// Shapes for an example of an operation, so that it can be simulated as it is.
std::string shapes_of(CutKind kind) {
  switch (kind) {
    case CutKind::thread:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"hole\"\n"
             "circle = [10, 20, 8.7]    # x, y, diameter\n\n"
             "[[shape]]\n"
             "name = \"thread\"\n"
             "circle = [10, 20, 10]     # the major diameter\n\n"
             "[[operation]]\n"
             "op = \"bore\"\n"
             "outlines = [\"hole\"]\n"
             "tool = 2\n"
             "depth = 7\n"
             "rpm = 12000\n"
             "feed = 600\n\n";
    case CutKind::vcarve:
    case CutKind::laser_fill:
    case CutKind::vcarve_floor: return std::string(kStar);
    case CutKind::laser_picture: return std::string(kPicture);
    case CutKind::laser_test: return "";
    case CutKind::slot:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"groove\"\n"
             "line = [[0, 20], [60, 20]]\n\n";
    case CutKind::trochoidal_slot:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"path\"\n"
             "line = [[0, 0], [40, 0], [60, 20]]\n\n";
    case CutKind::raster:
    case CutKind::waterline: return std::string(kHill);
    case CutKind::project: return std::string(kHill) + std::string(kHillFirst);
    case CutKind::laser:
    case CutKind::engrave:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"arrow\"\n"
             "line = [[0, 0], [40, 0], [30, 8]]\n\n"
             "[[shape]]\n"
             "text = \"KERF\"            # font, text-angle, align, letter-spacing\n"
             "height = 8                # of capital letters\n"
             "at = [0, 12]              # start of the baseline\n\n";
    case CutKind::face:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"frame\"\n"
             "rectangle = [0, 0, 60, 40]\n\n";
    case CutKind::drill:
    case CutKind::bore:
    case CutKind::keyhole:
    case CutKind::countersink:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"left\"\n"
             "circle = [10, 20, 10]     # x, y, diameter\n\n"
             "[[shape]]\n"
             "name = \"right\"\n"
             "circle = [50, 20, 10]\n\n";
    default:
      return "[[shape]]                 # shapes of the job itself, besides those of art\n"
             "name = \"frame\"\n"
             "rectangle = [0, 0, 60, 40]\n"
             "corner = 8                # radius\n\n"
             "[[shape]]\n"
             "name = \"hole\"\n"
             "circle = [30, 20, 16]     # x, y, diameter; polygon, line = [[x, y], ...]; point = [x, y]\n\n";
  }
}

std::string_view stock_of(CutKind kind) {
  if (cuts_mesh(kind)) return "stock = \"0,0,-12 to 60,40,0\"   # as for --stock\n\n";
  // A slot ends at the edges of the material.
  if (kind == CutKind::slot) return "stock = \"0,0,-12 to 60,40,0\"   # as for --stock\n\n";
  return "# stock = \"100x60x12\"     # as for --stock\n\n";
}

std::string_view tool_of(CutKind kind) {
  switch (kind) {
    case CutKind::drill: return "drill d=3 angle=118";
    case CutKind::keyhole: return "keyhole d=9.5 head=4 neck=4.8";
    case CutKind::slot: return "dovetail d=12.7 flute=9 angle=14";
    case CutKind::thread: return "thread mill minor_diameter=4.6 major_diameter=6 pitch=1.4 length=15";
    case CutKind::raster:
    case CutKind::waterline:
    case CutKind::countersink: return "ball d=6";
    case CutKind::project: return "V d=6 angle=60";
    case CutKind::vcarve: return "V d=20 angle=60";
    case CutKind::vcarve_floor: return "square d=3";
    default: return "square d=6";
  }
}

std::string_view second_tool_of(CutKind kind) {
  if (kind == CutKind::thread) return "2 = \"square d=6\"\n";
  if (kind == CutKind::project) return "2 = \"ball d=6\"\n";
  if (kind == CutKind::vcarve_floor) return "2 = \"V d=20 angle=60\"\n";
  return "";
}

/// The value of a key in the example of an operation.
std::string example_of(CutKind kind, const CutKey& key) {
  if (kind == CutKind::thread && key.name == "side") return "\"inside\"";
  if (kind == CutKind::thread && key.name == "outlines") return "[\"thread\"]";
  if (kind == CutKind::trochoidal_slot && key.name == "width") return "9";
  if (kind == CutKind::laser_frame && key.name == "power") return "0";
  if (is_laser(kind) && key.name == "lead") return "1";
  const bool carves = kind == CutKind::vcarve || kind == CutKind::vcarve_floor;
  if ((kind == CutKind::countersink || carves) && key.name == "depth") return "3";
  if (kind == CutKind::project && (key.name == "depth" || key.name == "stepdown")) return "0.4";
  if (kind == CutKind::raster && key.name == "stepover") return "0.1";
  if (kind == CutKind::vcarve && key.name == "entry") return "\"ramp\"";
  return std::string(key.example);
}

template <class Shape>
void add_schema(Json& properties, const std::vector<CutShapeKey<Shape>>& keys) {
  for (const CutShapeKey<Shape>& key : keys)
    if (key.name != "at")
      properties[std::string(key.name)] =
          schema_of({key.name, key.type, key.unit, key.meaning, key.example, nullptr});
}

Json schema_of_shape() {
  const Json numbers{{"type", "array"}, {"items", Json{{"type", "number"}}}};
  const Json points{{"type", "array"}, {"items", numbers}};
  Json shape{{"type", "object"}, {"additionalProperties", false}};
  for (const char* name : {"name", "layer"}) shape["properties"][name] = Json{{"type", "string"}};
  for (const char* name : {"rectangle", "circle", "point"}) shape["properties"][name] = numbers;
  for (const char* name : {"polygon", "line"}) shape["properties"][name] = points;
  shape["properties"]["at"] = numbers;
  add_schema(shape["properties"], cut_text_keys());
  add_schema(shape["properties"], cut_picture_keys());
  shape["properties"]["corner"] = Json{{"type", "number"}, {"minimum", 0}};
  return shape;
}

Json schema_of_surface() {
  const Json numbers{{"type", "array"}, {"items", Json{{"type", "number"}}}};
  Json surface{{"type", "object"}, {"additionalProperties", false}};
  surface["properties"]["file"] = Json{{"type", "string"}};
  surface["properties"]["heights"] = Json{{"type", "array"}, {"items", numbers}};
  surface["properties"]["rectangle"] = numbers;
  surface["properties"]["move"] = numbers;
  surface["properties"]["scale"] = Json{{"type", "number"}, {"exclusiveMinimum", 0}};
  return surface;
}

}  // namespace

std::optional<std::string> cut_job_example(std::string_view name) {
  const auto kind = kind_named(name);
  if (!kind) return std::nullopt;
  std::string text =
      "# A job for kerf cut. Lengths in mm, feeds in mm/min, angles in degrees.\n"
      "# art = \"part.dxf\"        # a drawing (.dxf, .svg) or an outline file (.json) with the shapes\n"
      "# unit = \"mm\"             # of a drawing that specifies none: mm or inch\n" +
      std::string(stock_of(*kind)) + shapes_of(*kind);
  if (!is_laser(*kind))
    text += fmt::format("[tools]                   # number = shape, as for --tool\n1 = \"{}\"\n{}\n",
                        tool_of(*kind), second_tool_of(*kind));
  if (*kind == CutKind::vcarve_floor) text += kCarveFirst;
  text += fmt::format("[[operation]]             # operations are cut in this order\nop = \"{}\"\n",
                      cut_kind_names()[static_cast<std::size_t>(*kind)]);
  for (const CutKey& key : cut_keys()) {
    if (!applies(*kind, key.name)) continue;
    const std::string example = example_of(*kind, key);
    const bool select = key.name == "layers" || key.name == "outlines" || key.name == "name" ||
                        key.name == "rest-tool" || key.name == "material" || key.name == "machine";
    // What selects shapes, and what replaces another key, is a comment, unless the example needs it.
    const bool used = !select || example != key.example;
    const std::string line = fmt::format("{}{} = {}", used ? "" : "# ", key.name, example);
    const std::string unit =
        key.type == CutKey::Type::number && !key.unit.empty() ? fmt::format("{}: ", key.unit)
        : key.type == CutKey::Type::text && !key.unit.empty() ? fmt::format("{}: ", key.unit)
                                                              : std::string();
    text += fmt::format("{:<26}# {}{}\n", line, unit, key.meaning);
  }
  return text;
}

std::string cut_job_schema() {
  Json operation{{"type", "object"}, {"additionalProperties", false}};
  Json defaults = operation;
  operation["properties"]["op"] = Json{{"type", "string"}, {"enum", cut_kind_names()}};
  Json required = Json::array({"op"});
  for (const CutKey& key : cut_keys()) {
    operation["properties"][std::string(key.name)] = schema_of(key);
    defaults["properties"][std::string(key.name)] = schema_of(key);
  }
  operation["required"] = required;
  const Json tools{{"type", "object"},
                   {"patternProperties", Json{{"^[0-9]+$", Json{{"type", "string"}}}}},
                   {"additionalProperties", false}};
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Job of kerf cut"},
              {"type", "object"},
              {"additionalProperties", false},
              {"required", Json::array({"operation"})}};
  schema["properties"]["art"] = Json{{"type", "string"}};
  schema["properties"]["unit"] = Json{{"enum", Json::array({"mm", "inch", "px", "pt"})}};
  schema["properties"]["strokes"] = Json{{"enum", Json::array({"lines", "areas"})}};
  schema["properties"]["stock"] = Json{{"type", "string"}};
  schema["properties"]["surface"] = schema_of_surface();
  schema["properties"]["tools"] = tools;
  schema["properties"]["shape"] = Json{{"type", "array"}, {"items", schema_of_shape()}};
  schema["properties"]["defaults"] = defaults;
  schema["properties"]["operation"] = Json{{"type", "array"}, {"minItems", 1}, {"items", operation}};
  return schema.dump(2) + "\n";
}

}  // namespace kerf
