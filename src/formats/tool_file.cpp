// Kerf's tool files: tools from TOML; every error has its line and column.
#include <algorithm>
#include <cassert>
#include <fmt/format.h>
#include <map>

#include "base/codes/files.h"
#include "base/codes/tools.h"
#include "base/names.h"
#include "base/number.h"
#include "base/toml.h"
#include "embedded_tool_files.h"
#include "formats/settings.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

class FileReader {
 public:
  FileReader(std::string_view file_name, ToolTable& table, Diagnostics& diagnostics)
      : file_(file_name), table_(table), diagnostics_(diagnostics) {}

  void read(std::string_view text);

 private:
  Origin location(const toml::source_position& at) const { return TextLocation{file_, at.line, at.column}; }
  Origin location(const toml::node& node) const { return location(node.source().begin); }
  void error(Code code, const Origin& where, const std::string& message) {
    diagnostics_.error(code, where, message);
  }

  void read_root(const toml::table& root);
  void read_tool(const toml::table& tool);
  /// The scale of the key "unit", `otherwise` without that key; nothing after an error.
  std::optional<double> read_unit(const toml::table& table, double otherwise);
  std::vector<int> read_numbers(const toml::table& tool);
  void read_number(const toml::node& node, std::vector<int>& numbers);
  std::vector<std::string> read_names(const toml::table& tool);
  std::optional<detail::Setting> read_setting(const toml::key& key, const toml::node& node);
  std::optional<Profile> read_profile(const toml::array& points);
  std::optional<Knot> read_knot(const toml::node& point);
  void keep(const Tool& tool, const std::vector<int>& numbers, const Origin& where);

  std::string file_;
  ToolTable& table_;
  Diagnostics& diagnostics_;
  double scale_ = 1.0;
  std::map<int, Origin> given_;  // numbers of this file
};

bool is_one_of(std::string_view key, std::initializer_list<std::string_view> keys) {
  for (const std::string_view known : keys) {
    if (key == known) return true;
  }
  return false;
}

std::optional<double> FileReader::read_unit(const toml::table& table, double otherwise) {
  const toml::node* node = table.get("unit");
  if (node == nullptr) return otherwise;
  const auto name = node->value_exact<std::string_view>();
  const auto scale = name ? mm_per_unit(*name) : std::nullopt;
  if (!scale) error(codes::tool_value_type, location(*node), "unit must be \"mm\" or \"inch\"");
  return scale;
}

void FileReader::read_number(const toml::node& node, std::vector<int>& numbers) {
  const auto value = node.value_exact<std::int64_t>();
  if (!value || *value < 0 || *value > limits::kMaxTableToolNumber ||
      numbers.size() >= limits::kMaxToolAliases) {
    return error(codes::tool_value_type, location(node),
                 "a tool number must be a whole number from 0 to 99999999; a tool has at most 100 numbers");
  }
  numbers.push_back(static_cast<int>(*value));
}

std::vector<int> FileReader::read_numbers(const toml::table& tool) {
  std::vector<int> numbers;
  for (const char* key : {"number", "numbers"}) {
    const toml::node* node = tool.get(key);
    if (node == nullptr) continue;
    if (const toml::array* list = node->as_array()) {
      for (const toml::node& element : *list) read_number(element, numbers);
    } else {
      read_number(*node, numbers);
    }
  }
  if (tool.get("number") == nullptr && tool.get("numbers") == nullptr) {
    error(codes::tool_key_missing, location(tool), "a tool requires a number, such as number = 102");
  }
  return numbers;
}

std::vector<std::string> FileReader::read_names(const toml::table& tool) {
  std::vector<std::string> names;
  const toml::node* node = tool.get("names");
  if (node == nullptr) return names;
  const toml::array* list = node->as_array();
  if (list == nullptr) error(codes::tool_value_type, location(*node), "names must be a list of texts");
  if (list == nullptr) return names;
  for (const toml::node& element : *list) {
    if (const auto name = element.value_exact<std::string>())
      names.push_back(*name);
    else
      error(codes::tool_value_type, location(element), "a name must be a text in quotes");
  }
  return names;
}

std::optional<Knot> FileReader::read_knot(const toml::node& point) {
  const toml::array* values = point.as_array();
  if (values == nullptr || values->size() < 2 || values->size() > 3) return std::nullopt;
  double numbers[3] = {0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < values->size(); ++i) {
    const toml::node& element = *values->get(i);
    const auto value = element.is_number() ? element.value<double>() : std::nullopt;
    if (!value) return std::nullopt;
    numbers[i] = *value;
  }
  return Knot{numbers[0], numbers[1], numbers[2]};
}

std::optional<Profile> FileReader::read_profile(const toml::array& points) {
  Profile profile;
  for (const toml::node& point : points) {
    const auto knot = read_knot(point);
    if (!knot) {
      error(codes::tool_value_type, location(point), "a point of a profile must be [r, z] or [r, z, bulge]");
      return std::nullopt;
    }
    profile.knots.push_back(*knot);
  }
  return profile;
}

std::optional<detail::Setting> FileReader::read_setting(const toml::key& key, const toml::node& node) {
  detail::Setting setting{std::string(key.str()), location(key.source().begin), 0.0};
  if (node.is_number()) {
    setting.value = node.value<double>().value_or(0.0);
  } else if (const auto text = node.value_exact<std::string>()) {
    setting.value = *text;
  } else if (const auto truth = node.value_exact<bool>()) {
    setting.value = *truth;
  } else if (const toml::array* points = node.as_array()) {
    auto profile = read_profile(*points);
    if (!profile) return std::nullopt;
    setting.value = std::move(*profile);
  } else {
    error(codes::tool_value_type, location(node),
          fmt::format("{} must be a number or a text", setting.key.substr(0, 40)));
    return std::nullopt;
  }
  return setting;
}

void FileReader::read_tool(const toml::table& table) {
  const std::size_t errors = diagnostics_.errors();
  const Origin where = location(table);
  const std::vector<int> numbers = read_numbers(table);
  const std::vector<std::string> names = read_names(table);
  const auto scale = read_unit(table, scale_);
  std::vector<detail::Setting> settings;
  for (const auto& [key, node] : table) {
    if (is_one_of(key.str(), {"number", "numbers", "names", "shape", "unit"})) continue;
    if (auto setting = read_setting(key, node)) settings.push_back(std::move(*setting));
  }
  const toml::node* shape = table.get("shape");
  if (shape == nullptr)
    return error(codes::tool_key_missing, where, "a tool requires a shape, such as shape = \"square\"");
  const auto shape_name = shape->value_exact<std::string_view>();
  if (!shape_name) return error(codes::tool_value_type, location(*shape), "shape must be a text in quotes");
  const auto blank = detail::blank_shape(*shape_name, location(*shape), diagnostics_);
  if (!blank) return;
  auto tool = detail::tool_of(*blank, settings, scale.value_or(1.0), where, diagnostics_);
  if (!tool || diagnostics_.errors() != errors) return;
  tool->names.insert(tool->names.begin(), names.begin(), names.end());
  keep(*tool, numbers, where);
}

/// Adds a tool under each of its numbers; the other numbers are also names of it.
void FileReader::keep(const Tool& made, const std::vector<int>& numbers, const Origin& where) {
  Tool tool = made;
  for (const int number : numbers) {
    const std::string name = std::to_string(number);
    if (std::find(tool.names.begin(), tool.names.end(), name) == tool.names.end()) tool.names.push_back(name);
  }
  for (const int number : numbers) {
    const auto [first, is_new] = given_.emplace(number, where);
    if (is_new) {
      table_.set(number, tool);
      continue;
    }
    Diagnostic& twice = diagnostics_.error(codes::tool_number_twice, where,
                                           fmt::format("two tools have the number {}", number));
    twice.notes.push_back({first->second, "the first one"});
  }
}

void FileReader::read_root(const toml::table& root) {
  scale_ = read_unit(root, 1.0).value_or(1.0);
  for (const auto& [key, node] : root) {
    if (key.str() == "unit") continue;
    if (key.str() != "tool") {
      Diagnostic& unknown =
          diagnostics_.error(codes::tool_key_unknown, location(key.source().begin),
                             fmt::format("unknown key \"{}\" of a tool file", key.str().substr(0, 40)));
      const auto meant = did_you_mean(key.str(), {"tool", "unit"});
      unknown.hint = meant ? fmt::format("did you mean {}?", *meant == "tool" ? "[[tool]]" : *meant)
                           : "a tool file has unit = \"mm\" and [[tool]] tables";
      continue;
    }
    const toml::array* tools = node.as_array();
    if (tools == nullptr)
      error(codes::tool_value_type, location(node), "tool must be written [[tool]], one table per tool");
    if (tools == nullptr) continue;
    for (const toml::node& tool : *tools) {
      if (const toml::table* table = tool.as_table())
        read_tool(*table);
      else
        error(codes::tool_value_type, location(tool), "tool must be written [[tool]], one table per tool");
    }
  }
}

void FileReader::read(std::string_view text) {
  if (text.size() > limits::kMaxToolFileBytes) {
    return error(codes::file_too_large, TextLocation{file_, 0, 0}, "a tool file is limited to 16 MB");
  }
  const toml::parse_result parsed = toml::parse(text, std::string_view(file_));
  if (parsed) return read_root(parsed.table());
  const toml::parse_error& fault = parsed.error();
  error(codes::tool_file_syntax, location(fault.source().begin), std::string(fault.description()));
}

}  // namespace

void read_tool_file(std::string_view text, std::string_view file_name, ToolTable& table,
                    Diagnostics& diagnostics) {
  FileReader(file_name, table, diagnostics).read(text);
}

const ToolTable& built_in_tools() {
  static const ToolTable table = [] {
    ToolTable tools;
    Diagnostics diagnostics;
    read_tool_file(embedded::tool_files[0].bytes, "data/tools.toml", tools, diagnostics);
    assert(diagnostics.list().empty());  // a test reports the fault
    return tools;
  }();
  return table;
}

}  // namespace kerf
