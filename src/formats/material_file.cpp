// The table of materials: chip loads from TOML.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/toml.h"
#include "embedded_material_files.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

constexpr double kMaxFraction = 5.0;
constexpr double kMaxDiameter = 1000.0;  // mm

class MaterialReader {
 public:
  MaterialReader(std::string_view file_name, Diagnostics& diagnostics)
      : file_(file_name), diagnostics_(diagnostics) {}

  std::vector<Material> read(std::string_view text) {
    if (text.size() > limits::kMaxProfileBytes) {
      diagnostics_.error(codes::material_file, TextLocation{file_, 0, 0},
                         "a material file is limited to 1 MB");
      return {};
    }
    const toml::parse_result parsed = toml::parse(text, std::string_view(file_));
    if (!parsed) {
      diagnostics_.error(codes::material_file, location(parsed.error().source()),
                         std::string(parsed.error().description()));
      return {};
    }
    std::vector<Material> materials;
    for (const auto& [key, node] : parsed.table()) {
      const toml::array* list = key.str() == "material" ? node.as_array() : nullptr;
      if (list == nullptr) {
        diagnostics_.error(codes::machine_key_unknown, location(key.source()),
                           "expected only [[material]] here");
        continue;
      }
      for (const toml::node& entry : *list)
        if (auto material = read_material(entry)) materials.push_back(std::move(*material));
    }
    return materials;
  }

 private:
  Origin location(const toml::source_region& at) const {
    return TextLocation{file_, at.begin.line, at.begin.column};
  }

  void wrong(const toml::node& node, std::string message) {
    diagnostics_.error(codes::machine_value, location(node.source()), std::move(message));
  }

  std::optional<Material> read_material(const toml::node& node) {
    const toml::table* table = node.as_table();
    const auto name = table != nullptr ? (*table)["name"].value<std::string>() : std::nullopt;
    const toml::array* loads = table != nullptr ? (*table)["chip_loads"].as_array() : nullptr;
    if (!name || loads == nullptr || loads->empty()) {
      wrong(node, "a material requires a name and chip_loads = [[diameter, mm per tooth], ...]");
      return std::nullopt;
    }
    Material material{*name, {}, {}};
    if (!check_keys(*table) || !read_names(*table, material)) return std::nullopt;
    if (!read_fraction(*table, "pass_depth", material.pass_depth) ||
        !read_fraction(*table, "plunge", material.plunge))
      return std::nullopt;
    Length widest;
    for (const toml::node& pair : *loads) {
      const auto load = read_load(pair);
      if (!load || load->diameter <= widest) {
        wrong(pair, "expected [diameter, mm per tooth], both above 0, by increasing diameter");
        return std::nullopt;
      }
      widest = load->diameter;
      material.chip_loads.push_back(*load);
    }
    return material;
  }

  bool check_keys(const toml::table& table) {
    const std::vector<std::string> known{"name", "names", "pass_depth", "plunge", "chip_loads"};
    bool good = true;
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      good = false;
      const std::string_view name = key.str();
      diagnostics_
          .error(codes::machine_key_unknown, location(key.source()),
                 fmt::format("unknown key \"{}\"", clipped(std::string(name), 60)))
          .hint = guess(name, known, "keys of a material: " + joined(known, ", "));
    }
    return good;
  }

  bool read_names(const toml::table& table, Material& material) {
    const toml::node* const node = table.get("names");
    if (node == nullptr) return true;
    const toml::array* const others = node->as_array();
    for (std::size_t i = 0; others != nullptr && i < others->size(); ++i)
      if (const auto text = others->get(i)->value_exact<std::string>()) material.other_names.push_back(*text);
    if (others != nullptr && material.other_names.size() == others->size()) return true;
    wrong(*node, "names must be a list of texts");
    return false;
  }

  /// A number above 0 and at most 5, if the table has it.
  bool read_fraction(const toml::table& table, std::string_view key, double& fraction) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return true;
    const double value = node->is_number() ? node->value<double>().value_or(0.0) : 0.0;
    if (value > 0.0 && value <= kMaxFraction) {
      fraction = value;
      return true;
    }
    wrong(*node, fmt::format("{} must be above 0 and at most {:g}", key, kMaxFraction));
    return false;
  }

  static std::optional<ChipLoad> read_load(const toml::node& node) {
    const toml::array* pair = node.as_array();
    if (pair == nullptr || pair->size() != 2) return std::nullopt;
    double values[2] = {0.0, 0.0};
    for (std::size_t i = 0; i < 2; ++i) {
      const toml::node& value = *pair->get(i);
      values[i] = value.is_number() ? value.value<double>().value_or(0.0) : 0.0;
      if (!(values[i] > 0.0 && values[i] <= kMaxDiameter)) return std::nullopt;
    }
    return ChipLoad{mm(values[0]), mm(values[1])};
  }

  std::string file_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::vector<Material> read_material_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics) {
  return MaterialReader(file_name, diagnostics).read(text);
}

const std::vector<Material>& built_in_materials() {
  static const std::vector<Material> all = [] {
    Diagnostics diagnostics;
    std::vector<Material> read =
        read_material_file(embedded::material_files[0].bytes, "data/materials.toml", diagnostics);
    assert(diagnostics.list().empty());  // a test reports the fault
    return read;
  }();
  return all;
}

std::optional<Material> material_named(std::string_view name, Diagnostics& diagnostics) {
  const std::string asked = fold_name(name);
  std::vector<std::string> known;
  for (const Material& material : built_in_materials()) {
    known.push_back(material.name);
    if (fold_name(material.name) == asked) return material;
    for (const std::string& other : material.other_names)
      if (fold_name(other) == asked) return material;
  }
  Diagnostic& error = diagnostics.error(codes::material_unknown, CallLocation{"", 0, "--material"},
                                        fmt::format("unknown material \"{}\"", name.substr(0, 40)));
  error.hint = guess(name, known, "known: " + list_text(known));
  return std::nullopt;
}

}  // namespace kerf
