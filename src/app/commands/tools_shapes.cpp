// kerf tools shapes: the shapes of tools and the keys that describe them.
#include <fmt/format.h>
#include <memory>

#include "app/commands/commands.h"
#include "app/options/common.h"
#include "base/names.h"
#include "job/record/record.h"

#include "kerf/formats/workshop_files.h"

namespace kerf::app {
namespace {

/// "diameter (d, dia)"
std::string key_text(std::string_view key, const ToolShape& shape) {
  const auto shorter = short_names_of(key, shape);
  return shorter.empty() ? std::string(key) : fmt::format("{} ({})", key, joined(shorter, ", "));
}

std::string measures_text(const ToolShape& shape) {
  std::vector<std::string> texts;
  for (const ShapeParameter& p : parameters_of(shape)) {
    const std::string key = key_text(p.name, shape);
    texts.push_back(p.need == ShapeParameter::Need::optional ? "[" + key + "]" : key);
  }
  if (texts.empty()) texts.emplace_back("profile (only in tool files: a list of points)");
  return joined(texts, " ");
}

Record shape_record(const std::string& name, const ToolShape& shape) {
  Record measures = Record::array();
  for (const ShapeParameter& p : parameters_of(shape))
    measures.push_back({{"key", p.name},
                        {"short", short_names_of(p.name, shape)},
                        {"unit", p.kind == ShapeParameter::Kind::length ? "mm" : "degrees"},
                        {"needed", p.need == ShapeParameter::Need::required}});
  return {{"shape", name}, {"measures", measures}};
}

Record shapes_record() {
  Record shapes = Record::array(), keys = Record::array();
  for (const std::string& name : shape_names()) shapes.push_back(shape_record(name, *shape_named(name)));
  for (const ToolKey& key : tool_keys()) keys.push_back({{"key", key.name}, {"meaning", key.meaning}});
  return {{"shapes", shapes}, {"keys", keys}};
}

void print_shapes(Console& console) {
  console.print("shape            dimensions; those in square brackets are optional\n");
  for (const std::string& name : shape_names())
    console.print(fmt::format("{:<16} {}\n", name, measures_text(*shape_named(name))));
  console.print("\nkeys of every shape\n");
  const ToolShape any = *shape_named(shape_names().front());
  for (const ToolKey& key : tool_keys())
    console.print(fmt::format("{:<32} {}\n", key_text(key.name, any), key.meaning));
  console.print(
      "\nLengths are in mm or have a unit (d=1/4in), angles are in degrees. A flute length that is not given "
      "is assumed.\n");
}

const char* const kExamples = R"(  kerf tools shapes
  kerf tools show "bull nose d=6 r=1 flute=20 shank=6 shank_length=30"
  kerf simulate part.nc --tool "T-slot d=20 thickness=3 neck=8 neck_length=12"
)";

}  // namespace

Command add_tools_shapes(CommandParser& tools) {
  auto output = std::make_shared<OutputOptions>();
  CommandParser parser =
      new_command(tools, "shapes", "List the shapes of tools and their keys", kExamples, *output);
  return {parser, output.get(), [output](Console& console) {
            if (console.json())
              console.print_json(text_of(shapes_record(), Layout::indented));
            else
              print_shapes(console);
            return Status::done;
          }};
}

}  // namespace kerf::app
