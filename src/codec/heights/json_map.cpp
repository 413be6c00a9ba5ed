// Height maps in JSON: gSender's, lists of points, and Klipper's state of a mesh.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/grid.h"

#include "kerf/base/units.h"

namespace kerf::heights_detail {
namespace {

using Json = nlohmann::json;

constexpr double kSameLimit = 0.01;  // in the map's unit: gSender rounds positions to three decimals

std::optional<double> number_at(const Json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

/// The first object or array of a tree, from its root, that `matches`.
const Json* find_in(const Json& tree, const std::function<bool(const Json&)>& matches, int depth = 0) {
  constexpr int kDeepest = 12;
  if (matches(tree)) return &tree;
  if (!tree.is_structured() || depth > kDeepest) return nullptr;
  for (const Json& child : tree)
    if (const Json* found = find_in(child, matches, depth + 1)) return found;
  return nullptr;
}

bool is_point(const Json& j) { return number_at(j, "x") && number_at(j, "y") && number_at(j, "z"); }
bool has_axis(const Json& j) {
  return j.is_object() && (j.contains("x") || j.contains("y") || j.contains("z"));
}

/// Klipper's state of a mesh: "mesh_min": [x, y], "mesh_max": [x, y], "probed_matrix": [[z, ...], ...].
bool is_mesh(const Json& j) { return j.is_object() && j.contains("mesh_min") && j.contains("mesh_max"); }

std::optional<std::pair<double, double>> pair_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != 2 || !(*found)[0].is_number() ||
      !(*found)[1].is_number())
    return std::nullopt;
  return std::pair((*found)[0].get<double>(), (*found)[1].get<double>());
}

/// The line where each element of the array after `key` starts; of the first array of all without a key.
/// `bytes` is valid JSON.
std::vector<std::size_t> lines_of_elements(std::string_view bytes, std::string_view key) {
  std::vector<std::size_t> out;
  std::size_t i = key.empty() ? 0 : bytes.find('"' + std::string(key) + '"');
  i = bytes.find('[', std::min(i, bytes.size()));
  if (i == std::string_view::npos) return out;
  auto line =
      1 + static_cast<std::size_t>(std::count(bytes.begin(), bytes.begin() + std::ptrdiff_t(i), '\n'));
  int depth = 0;
  bool in_text = false;
  for (; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (c == '\n') ++line;
    if (in_text && c == '\\') ++i;
    if (c == '"') in_text = !in_text;
    if (in_text) continue;
    if ((c == '{' || c == '[') && ++depth == 2) out.push_back(line);
    if ((c == '}' || c == ']') && --depth == 0) break;
  }
  return out;
}

class JsonMapReader {
 public:
  JsonMapReader(std::string_view bytes, const HeightsSink& sink) : bytes_(bytes), sink_(sink) {}

  void read() {
    try {
      tree_ = Json::parse(bytes_.begin(), bytes_.end());
    } catch (const Json::parse_error& problem) {
      const auto at = std::min(problem.byte, bytes_.size());
      const auto line = std::count(bytes_.begin(), bytes_.begin() + std::ptrdiff_t(at), '\n');
      sink_.error(
          codes::heights_format, static_cast<std::size_t>(line) + 1,
          at == bytes_.size() ? "the JSON ends too early: the file is cut off" : "expected valid JSON here");
      return;
    } catch (const Json::exception&) {  // a number beyond those of the computer
      sink_.error(codes::heights_format, 1, "the JSON has a number that is too large");
      return;
    }
    if (const Json* mesh = find_in(tree_, is_mesh)) return read_mesh(*mesh);
    const Json* points =
        find_in(tree_, [](const Json& j) { return j.is_array() && !j.empty() && has_axis(j[0]); });
    if (points == nullptr)
      fail(0, "expected \"points\": a list of objects with x, y and z");
    else
      read_points(*points);
  }

 private:
  void fail(std::size_t line, std::string message) {
    sink_.error(codes::heights_format, line, std::move(message));
  }
  void read_mesh(const Json& mesh);
  bool matches_profile(const Json& mesh, std::size_t columns, std::size_t rows);
  void read_points(const Json& points);
  double own_unit() const;
  void check_grid(const Json& points);

  std::string_view bytes_;
  const HeightsSink& sink_;
  Json tree_;
};

/// Whether the numbers of columns and rows are those of the profile that the mesh names.
bool JsonMapReader::matches_profile(const Json& mesh, std::size_t columns, std::size_t rows) {
  const auto name = mesh.find("profile_name"), profiles = mesh.find("profiles");
  if (name == mesh.end() || !name->is_string() || profiles == mesh.end() || !profiles->is_object())
    return true;
  const auto profile = profiles->find(name->get<std::string>());
  if (profile == profiles->end() || !profile->is_object() || !profile->contains("mesh_params")) return true;
  const Json& parameters = (*profile)["mesh_params"];
  const auto x = number_at(parameters, "x_count"), y = number_at(parameters, "y_count");
  return (!x || count_of(x) == columns) && (!y || count_of(y) == rows);
}

void JsonMapReader::read_mesh(const Json& mesh) {
  const auto low = pair_at(mesh, "mesh_min"), high = pair_at(mesh, "mesh_max");
  const auto matrix = mesh.find("probed_matrix");
  const bool has_rows = matrix != mesh.end() && matrix->is_array() && !matrix->empty() &&
                        (*matrix)[0].is_array() && !(*matrix)[0].empty();
  if (!low || !high || !(low->first < high->first && low->second < high->second) || !has_rows)
    return fail(0,
                "expected \"mesh_min\": [x, y], \"mesh_max\": [x, y] above it, and rows in "
                "\"probed_matrix\"");
  const Rows at{low->first, low->second, high->first, high->second, (*matrix)[0].size(), matrix->size()};
  const std::vector<std::size_t> lines = lines_of_elements(bytes_, "probed_matrix");
  const auto line_of = [&](std::size_t row) { return row < lines.size() ? lines[row] : std::size_t{0}; };
  if (!matches_profile(mesh, at.columns, at.rows))
    return fail(line_of(0), fmt::format("the mesh has {} x {} heights, its profile states other numbers",
                                        at.columns, at.rows));
  RowReader rows(at, sink_, sink_.unit());
  for (std::size_t j = 0; j < matrix->size(); ++j) {
    const Json& row = (*matrix)[j];
    std::vector<double> numbers;
    for (const Json& z : row) {
      if (!z.is_number()) return fail(line_of(j), "expected numbers alone in a row of \"probed_matrix\"");
      numbers.push_back(z.get<double>());
    }
    if (!rows.take(line_of(j), numbers)) return;
  }
}

double JsonMapReader::own_unit() const {
  const auto units = tree_.is_object() ? tree_.find("units") : tree_.end();
  if (units == tree_.end() || !units->is_string()) return 1.0;
  const std::string name = units->get<std::string>();
  return fold_name(name) == "imperial" ? kMmPerInch : mm_per_unit(name).value_or(1.0);
}

/// gSender states the limits and the distances; the points make a whole grid between the limits.
void JsonMapReader::check_grid(const Json& points) {
  const auto bounds = tree_.is_object() ? tree_.find("bounds") : tree_.end();
  if (bounds == tree_.end()) return;
  const auto check = [&](const char* axis, const char* low_name, const char* high_name) -> std::size_t {
    std::vector<double> all, lines;
    for (const Json& p : points) all.push_back(*number_at(p, axis));
    std::sort(all.begin(), all.end());
    for (const double v : all)
      if (lines.empty() || v - lines.back() > kSameLimit) lines.push_back(v);
    const auto differs = [&](const char* name, double value) {
      const auto stated = number_at(*bounds, name);
      return bounds->contains(name) && (!stated || std::abs(*stated - value) > kSameLimit);
    };
    if (differs(low_name, lines.front()) || differs(high_name, lines.back())) {
      fail(0, fmt::format("the points reach from {0} {1} to {2}; \"bounds\" states other limits", axis,
                          number_text(lines.front(), 4), number_text(lines.back(), 4)));
      return 0;
    }
    // The distance of the first two columns; maps of older versions have the number of columns.
    const auto stated = tree_.contains("resolution") ? number_at(tree_["resolution"], axis) : std::nullopt;
    if (stated && lines.size() > 1 && std::abs(*stated - (lines[1] - lines[0])) > kSameLimit &&
        *stated != double(lines.size())) {
      fail(0, fmt::format("the points are {} apart along {}; \"resolution\" states {}",
                          number_text(lines[1] - lines[0], 4), axis, number_text(*stated, 4)));
      return 0;
    }
    return lines.size();
  };
  const std::size_t columns = check("x", "minX", "maxX");
  const std::size_t rows = columns == 0 ? 0 : check("y", "minY", "maxY");
  if (rows != 0 && columns * rows != points.size())
    fail(0, fmt::format("the points are no complete grid: {} at {} different X and {} different Y",
                        points.size(), columns, rows));
}

void JsonMapReader::read_points(const Json& points) {
  const auto lines = lines_of_elements(bytes_, tree_.is_object() ? "points" : "");
  const auto line_of = [&](std::size_t k) { return k < lines.size() ? lines[k] : std::size_t{0}; };
  for (std::size_t k = 0; k < points.size(); ++k)
    if (!is_point(points[k]))
      return fail(line_of(k), fmt::format("expected numbers for x, y and z of point {}", k + 1));
  const std::size_t errors = sink_.diagnostics.errors();
  check_grid(points);
  if (sink_.diagnostics.errors() != errors) return;
  const double unit = sink_.unit(own_unit());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Json& p = points[k];
    if (!sink_.add(line_of(k), *number_at(p, "x"), *number_at(p, "y"), *number_at(p, "z"), unit)) return;
  }
}

}  // namespace

void read_json(std::string_view bytes, const HeightsSink& sink) { JsonMapReader(bytes, sink).read(); }

}  // namespace kerf::heights_detail
