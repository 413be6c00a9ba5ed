// An example of a job file, and the JSON schema of job files, from the rows of operations.
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kerf/program/cut_job.h"

namespace kerf {
namespace {

using Json = nlohmann::ordered_json;
using Type = CutKeyText::Type;

/// Without the digits that conversions of units add.
double rounded(double value) { return std::stod(fmt::format("{:.12g}", value)); }

Json json_of(const CutValue& value) {
  if (const double* number = std::get_if<double>(&value)) return rounded(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return *numbers;
  return std::get<std::vector<std::string>>(value);
}

Json schema_of(const CutKeyText& key, const std::string& meaning) {
  Json schema{{"description", meaning}};
  switch (key.type) {
    case Type::number: schema["type"] = Json::array({"number", "string"}); break;
    case Type::whole:
    case Type::tool: schema["type"] = "integer"; break;
    case Type::text:
    case Type::choice: schema["type"] = "string"; break;
    case Type::list: schema["type"] = "array", schema["items"] = Json{{"type", "string"}}; break;
    case Type::point:
      schema["type"] = "array", schema["items"] = Json{{"type", Json::array({"number", "string"})}};
      break;
  }
  if (!key.unit.empty()) schema["$comment"] = key.unit;
  if (!key.choices.empty()) schema["enum"] = key.choices;
  return schema;
}

/// With range and default, of one operation.
Json schema_of(const CutRow& row, const CutKey& key) {
  Json schema = schema_of(key, std::string(key.meaning));
  if (std::isfinite(key.range.low)) schema[key.range.above ? "exclusiveMinimum" : "minimum"] = key.range.low;
  if (std::isfinite(key.range.high)) schema["maximum"] = key.range.high;
  if (key.type == Type::tool) schema["x-tool"] = true;
  if (key.required) schema["x-required"] = true;
  if (!key.otherwise.empty()) schema["x-otherwise"] = key.otherwise;
  const auto value = key.required || !key.otherwise.empty() ? std::nullopt : key.get(row.operation());
  if (value && json_of(*value) != "") schema["default"] = json_of(*value);
  return schema;
}

std::string_view text_of(CutInput input) {
  switch (input) {
    case CutInput::region:
    case CutInput::region_or_stock: return "region";  // Python states no stock
    case CutInput::outlines: return "outlines";
    case CutInput::circles: return "circles";
    case CutInput::points: return "points";
    case CutInput::mesh: return "mesh";
    case CutInput::mesh_in_region: return "mesh in a region";
    case CutInput::mesh_along_outlines: return "mesh along outlines";
    case CutInput::picture: return "picture";
    case CutInput::shapes: return "shapes";
    case CutInput::nothing: break;
  }
  return "";
}

/// One operation: what [[operation]] with this `op` has.
Json schema_of(const CutRow& row) {
  Json schema{{"description", row.sentence}, {"x-input", text_of(row.input)}, {"x-cuts", row.cuts}};
  if (row.laser) schema["x-laser"] = true;
  schema["properties"]["op"] = Json{{"const", row.name}};
  for (const CutKey& key : row.keys) schema["properties"][std::string(key.name)] = schema_of(row, key);
  return schema;
}

template <class Shape>
void add_schema(Json& properties, const std::vector<CutKeyOf<Shape>>& keys) {
  for (const CutKeyOf<Shape>& key : keys)
    properties[std::string(key.name)] = schema_of(key, std::string(key.meaning));
}

Json schema_of_shape() {
  const Json numbers{{"type", "array"}, {"items", Json{{"type", Json::array({"number", "string"})}}}};
  const Json points{{"type", "array"}, {"items", numbers}};
  Json shape{{"type", "object"}, {"additionalProperties", false}};
  for (const char* name : {"name", "layer"}) shape["properties"][name] = Json{{"type", "string"}};
  for (const char* name : {"rectangle", "circle", "point"}) shape["properties"][name] = numbers;
  for (const char* name : {"polygon", "line"}) shape["properties"][name] = points;
  add_schema(shape["properties"], cut_text_keys());
  add_schema(shape["properties"], cut_picture_keys());
  shape["properties"]["corner"] = Json{{"type", "number"}, {"minimum", 0}};
  return shape;
}

Json schema_of_surface() {
  const Json numbers{{"type", "array"}, {"items", Json{{"type", Json::array({"number", "string"})}}}};
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
  const CutRow* row = cut_row(name);
  if (row == nullptr) return std::nullopt;
  const CutExample& example = row->example;
  std::string text =
      "# A job for kerf cut. Lengths in mm, feeds in mm/min, angles in degrees.\n"
      "# art = \"part.dxf\"        # a drawing (.dxf, .svg) or an outline file (.json) with the shapes\n"
      "# unit = \"mm\"             # of a drawing that specifies none: mm or inch\n";
  text += example.stock.empty() ? "# stock = \"100x60x12\"     # as for --stock\n\n"
                                : fmt::format("stock = \"{}\"   # as for --stock\n\n", example.stock);
  text += example.shapes;
  if (!row->laser)
    text += fmt::format("[tools]                   # number = shape, as for --tool\n1 = \"{}\"\n{}\n",
                        example.tool,
                        example.second_tool.empty() ? "" : fmt::format("2 = \"{}\"\n", example.second_tool));
  text += example.before;
  text +=
      fmt::format("[[operation]]             # operations are cut in this order\nop = \"{}\"\n", row->name);
  const CutOperation usual = row->operation();
  for (const CutKey& key : row->keys) {
    const auto value = key.example.empty() ? key.get(usual) : std::nullopt;
    const std::string shown = value ? json_of(*value).dump() : std::string(key.example);
    std::string unit(key.unit);
    for (const std::string_view choice : key.choices)
      unit += (unit.empty() ? "" : ", ") + std::string(choice);
    text +=
        fmt::format("{:<26}# {}{}\n", fmt::format("{}{} = {}", key.as_comment ? "# " : "", key.name, shown),
                    unit.empty() ? "" : unit + ": ", key.meaning);
  }
  return text;
}

std::string cut_job_schema() {
  Json operation{{"type", "object"}, {"additionalProperties", false}};
  Json defaults = operation;
  operation["properties"]["op"] = Json{{"type", "string"}, {"enum", cut_operation_names()}};
  for (const CutOption& option : cut_options()) {
    const Json key = schema_of(*option.key, option.meaning);
    operation["properties"][std::string(option.key->name)] = key;
    defaults["properties"][std::string(option.key->name)] = key;
  }
  operation["required"] = Json::array({"op"});
  Json operations;
  for (const CutRow& row : cut_rows()) {
    operations[std::string(row.name)] = schema_of(row);
    operation["allOf"].push_back(Json{{"if", Json{{"properties", Json{{"op", Json{{"const", row.name}}}}}}},
                                      {"then", Json{{"$ref", fmt::format("#/$defs/{}", row.name)}}}});
  }
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
  schema["properties"]["texts"] = Json{{"type", "string"}};
  schema["properties"]["strokes"] =
      Json{{"anyOf", Json::array({Json{{"enum", Json::array({"lines", "areas"})}},
                                  Json{{"type", "array"}, {"items", Json{{"type", "string"}}}}})}};
  schema["properties"]["stock"] = Json{{"type", "string"}};
  add_schema(schema["properties"], cut_layout_keys());
  for (const CutLayoutKey& key : cut_layout_keys())
    schema["properties"][std::string(key.name)]["x-layout"] = true;
  schema["properties"]["surface"] = schema_of_surface();
  schema["properties"]["tools"] = tools;
  schema["properties"]["shape"] = Json{{"type", "array"}, {"items", schema_of_shape()}};
  schema["properties"]["defaults"] = defaults;
  schema["properties"]["operation"] = Json{{"type", "array"}, {"minItems", 1}, {"items", operation}};
  schema["$defs"] = operations;
  return schema.dump(2) + "\n";
}

}  // namespace kerf
