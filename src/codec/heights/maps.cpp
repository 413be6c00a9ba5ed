// Height maps of senders and firmware: Candle, OpenCNCPilot and its kin, gSender, Duet, Klipper, Marlin.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/sink.h"

#include "kerf/base/units.h"

namespace kerf::heights_detail {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxLines = 2000;  // rows or columns of a map
constexpr std::string_view kMark = "\xef\xbb\xbf";
constexpr std::string_view kGridTitles[] = {"Bilinear Leveling Grid:", "Mesh Leveling Probed Z positions:"};

std::string_view without_mark(std::string_view bytes) {
  if (bytes.substr(0, kMark.size()) == kMark) bytes.remove_prefix(kMark.size());
  return trim(bytes);
}

/// A map of rows at equal distances over an area.
struct Rows {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  std::size_t columns = 0, rows = 0;

  double x(std::size_t i) const {
    return columns < 2 ? x0 : x0 + (x1 - x0) * double(i) / double(columns - 1);
  }
  double y(std::size_t j) const { return rows < 2 ? y0 : y0 + (y1 - y0) * double(j) / double(rows - 1); }
};

/// A number of rows or columns; 0 if it is none.
std::size_t count_of(std::optional<double> number) {
  if (!number || !(*number >= 1.0 && *number <= double(kMaxLines)) || *number != std::floor(*number))
    return 0;
  return static_cast<std::size_t>(*number);
}

double unit_of(const HeightsSink& sink, double own = 1.0) { return sink.options.mm_per_unit.value_or(own); }

/// The rows of a map whose size is known, from the lowest Y upwards.
class RowReader {
 public:
  RowReader(const Rows& at, const HeightsSink& sink, double unit) : at_(at), sink_(sink), unit_(unit) {}

  bool take(std::size_t line, const std::vector<double>& numbers) {
    if (next_ == at_.rows) {
      sink_.error(codes::heights_format, line,
                  fmt::format("the map has more rows than the {} that it states", at_.rows));
      return false;
    }
    if (numbers.size() != at_.columns) {
      sink_.error(codes::heights_format, line,
                  fmt::format("expected {} heights in this row, found {}", at_.columns, numbers.size()));
      return false;
    }
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (!std::isnan(numbers[i]) && !sink_.add(line, at_.x(i), at_.y(next_), numbers[i], unit_))
        return false;
    ++next_;
    return true;
  }
  void finish() const {
    if (next_ < at_.rows)
      sink_.error(codes::heights_format, 0,
                  fmt::format("the map states {} rows and has {}", at_.rows, next_));
  }

 private:
  Rows at_;
  const HeightsSink& sink_;
  double unit_;
  std::size_t next_ = 0;
};

// -------------------------------------------------------------------------------------------------- Candle

/// "x;y;width;height", "columns;rows;bottom;top", "interpolation;...", then the rows.
void read_candle(std::string_view bytes, const HeightsSink& sink) {
  Rows at;
  std::size_t header = 0;
  std::optional<RowReader> rows;
  bool good = true;
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    const auto numbers = numbers_of(text, ";", kMaxLines);
    good = numbers.has_value();
    if (!good) {
      sink.error(codes::heights_format, line, "expected numbers separated by semicolons");
    } else if (header == 0) {
      at.x0 = (*numbers)[0], at.y0 = (*numbers)[1];
      at.x1 = at.x0 + (*numbers)[2], at.y1 = at.y0 + (*numbers)[3];
    } else if (header == 1) {
      at.columns = count_of((*numbers)[0]), at.rows = count_of((*numbers)[1]);
      rows.emplace(at, sink, unit_of(sink));
    } else if (header > 2) {
      good = rows->take(line, *numbers);
    }
    ++header;
    return good;
  });
  if (good && rows) rows->finish();
}

bool is_candle(std::string_view bytes) {
  std::size_t seen = 0;
  bool matches = true;
  for_each_line(bytes, [&](std::size_t, std::string_view text) {
    const auto numbers = numbers_of(text, ";", kMaxLines);
    matches = numbers && text.find(';') != std::string_view::npos;
    if (matches && seen < 2) matches = numbers->size() == 4;
    if (matches && seen == 1) matches = count_of((*numbers)[0]) > 0 && count_of((*numbers)[1]) > 0;
    return ++seen < 3 && matches;
  });
  return matches && seen == 3;
}

// ----------------------------------------------------------------------------------------------------- XML

std::optional<double> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t equals = at + name.size();
    if (at == 0 || !(tag[at - 1] == ' ' || tag[at - 1] == '\t' || tag[at - 1] == '\n')) continue;
    if (tag.substr(equals, 1) != "=" || equals + 2 >= tag.size()) continue;
    const std::size_t end = tag.find(tag[equals + 1], equals + 2);
    if (end != std::string_view::npos) return parse_number(trim(tag.substr(equals + 2, end - equals - 2)));
  }
  return std::nullopt;
}

/// <heightmap MinX= ... SizeX= ...> with <point X="column" Y="row">height</point>.
void read_xml(std::string_view bytes, const HeightsSink& sink) {
  const auto line_at = [&](std::size_t at) {
    return 1 + static_cast<std::size_t>(std::count(bytes.begin(), bytes.begin() + std::ptrdiff_t(at), '\n'));
  };
  const std::size_t start = bytes.find("<heightmap");
  const std::string_view head = bytes.substr(start, bytes.find('>', start) - start);
  const auto x0 = attribute(head, "MinX"), y0 = attribute(head, "MinY"), x1 = attribute(head, "MaxX"),
             y1 = attribute(head, "MaxY"), columns = attribute(head, "SizeX"),
             rows = attribute(head, "SizeY");
  const std::size_t nx = count_of(columns), ny = count_of(rows);
  if (!x0 || !y0 || !x1 || !y1 || nx == 0 || ny == 0) {
    sink.error(codes::heights_format, line_at(start),
               "expected MinX, MinY, MaxX, MaxY, SizeX and SizeY of the height map");
    return;
  }
  const Rows at{*x0, *y0, *x1, *y1, nx, ny};
  std::size_t line = 1, counted = 0;
  for (std::size_t i = bytes.find("<point", start); i != std::string_view::npos;
       i = bytes.find("<point", i + 1)) {
    line += static_cast<std::size_t>(
        std::count(bytes.begin() + std::ptrdiff_t(counted), bytes.begin() + std::ptrdiff_t(i), '\n'));
    counted = i;
    const std::size_t close = std::min(bytes.find('>', i), bytes.size());
    const std::string_view tag = bytes.substr(i, close - i);
    const auto column = attribute(tag, "X"), row = attribute(tag, "Y");
    const std::size_t end = std::min(bytes.find('<', close), bytes.size());
    const auto height =
        close < end ? parse_number(trim(bytes.substr(close + 1, end - close - 1))) : std::nullopt;
    const bool is_inside = column && row && *column >= 0.0 && *row >= 0.0 && *column < double(nx) &&
                           *row < double(ny) && *column == std::floor(*column) && *row == std::floor(*row);
    if (!is_inside || !height) {
      sink.error(codes::heights_format, line,
                 fmt::format("expected <point X=\"0 to {}\" Y=\"0 to {}\">height</point>", nx - 1, ny - 1));
      return;
    }
    if (!sink.add(line, at.x(static_cast<std::size_t>(*column)), at.y(static_cast<std::size_t>(*row)),
                  *height, unit_of(sink)))
      return;
  }
}

// ---------------------------------------------------------------------------------------------------- JSON

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

/// Klipper's state of a mesh: "mesh_min": [x, y], "mesh_max": [x, y], "probed_matrix": [[z, ...], ...].
bool is_mesh(const Json& j) {
  const auto is_pair = [&](const char* key) {
    const auto found = j.find(key);
    return found != j.end() && found->is_array() && found->size() == 2 && (*found)[0].is_number() &&
           (*found)[1].is_number();
  };
  if (!j.is_object() || !is_pair("mesh_min") || !is_pair("mesh_max")) return false;
  const auto matrix = j.find("probed_matrix");
  return matrix != j.end() && matrix->is_array() && !matrix->empty() && (*matrix)[0].is_array() &&
         !(*matrix)[0].empty();
}

void read_mesh(const Json& mesh, const HeightsSink& sink) {
  const Json& matrix = mesh["probed_matrix"];
  const Rows at{mesh["mesh_min"][0].get<double>(),
                mesh["mesh_min"][1].get<double>(),
                mesh["mesh_max"][0].get<double>(),
                mesh["mesh_max"][1].get<double>(),
                matrix[0].size(),
                matrix.size()};
  RowReader rows(at, sink, unit_of(sink));
  for (const Json& row : matrix) {
    std::vector<double> numbers;
    for (const Json& z : row)
      if (z.is_number()) numbers.push_back(z.get<double>());
    if (!rows.take(0, numbers)) return;
  }
}

void read_json(std::string_view bytes, const HeightsSink& sink) {
  const Json tree = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (tree.is_discarded()) {
    sink.error(codes::heights_format, 0, "the file is no valid JSON");
    return;
  }
  if (const Json* mesh = find_in(tree, is_mesh)) return read_mesh(*mesh, sink);
  const Json* points =
      find_in(tree, [](const Json& j) { return j.is_array() && !j.empty() && is_point(j[0]); });
  if (points == nullptr) {
    sink.error(codes::heights_format, 0, "expected \"points\": a list of objects with x, y and z");
    return;
  }
  double own = 1.0;
  if (const auto units = tree.is_object() ? tree.find("units") : tree.end();
      units != tree.end() && units->is_string())
    own = fold_name(units->get<std::string>()) == "imperial"
              ? kMmPerInch
              : mm_per_unit(units->get<std::string>()).value_or(1.0);
  for (const Json& p : *points) {
    if (!is_point(p)) {
      sink.error(codes::heights_format, 0, "a point has no number for x, y or z");
      return;
    }
    if (!sink.add(0, *number_at(p, "x"), *number_at(p, "y"), *number_at(p, "z"), unit_of(sink, own))) return;
  }
}

// ------------------------------------------------------------------------------------------ Duet, Klipper

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t i = 0; i <= line.size();) {
    const std::size_t end = std::min(line.find(',', i), line.size());
    fields.push_back(trim(line.substr(i, end - i)));
    i = end + 1;
  }
  return fields;
}

std::optional<double> field(const std::vector<std::string_view>& names,
                            const std::vector<std::string_view>& values, std::string_view old_name,
                            std::string_view new_name) {
  for (std::size_t i = 0; i < names.size() && i < values.size(); ++i)
    if (names[i] == old_name || names[i] == new_name) return parse_number(values[i]);
  return std::nullopt;
}

/// A title, the names of the grid's values, the values, then the rows. "0" is a point that was not probed.
void read_duet(std::string_view bytes, const HeightsSink& sink) {
  std::vector<std::string_view> names;
  std::optional<RowReader> rows;
  std::size_t header = 0;
  bool good = true;
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    const auto fields = fields_of(text);
    if (header == 1) names = fields;
    if (header == 2) {
      const auto of = [&](std::string_view a, std::string_view b) { return field(names, fields, a, b); };
      const auto x0 = of("xmin", "min0"), y0 = of("ymin", "min1"), dx = of("xspacing", "spacing0"),
                 dy = of("yspacing", "spacing1"), columns = of("xnum", "num0"), lines = of("ynum", "num1");
      const std::size_t nx = count_of(columns), ny = count_of(lines);
      good = x0 && y0 && (dx || of("spacing", "spacing")) && nx > 0 && ny > 0;
      if (!good) {
        sink.error(codes::heights_format, line, "expected the minimum, spacing and number of both axes");
        return false;
      }
      const double step_x = dx ? *dx : *of("spacing", "spacing"), step_y = dy ? *dy : step_x;
      rows.emplace(Rows{*x0, *y0, *x0 + step_x * double(nx - 1), *y0 + step_y * double(ny - 1), nx, ny}, sink,
                   unit_of(sink));
    }
    if (header++ < 3) return true;
    std::vector<double> numbers;
    for (const std::string_view f : fields) {
      const auto number = parse_number(f);
      if (number) numbers.push_back(f == "0" ? NAN : *number);
    }
    good = rows->take(line, numbers);
    return good;
  });
  if (good && rows) rows->finish();
  if (good && !rows) sink.error(codes::heights_format, 0, "the height map has no values of its grid");
}

/// The section [bed_mesh NAME] of printer.cfg: "points =", rows, and "min_x = 10".
void read_klipper(std::string_view bytes, const HeightsSink& sink) {
  std::vector<std::pair<std::size_t, std::vector<double>>> rows;
  std::optional<double> x0, y0, x1, y1;
  bool in_section = false, in_points = false, is_done = false;
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    if (text.substr(0, 3) == "#*#") text = trim(text.substr(3));
    if (text.substr(0, 1) == "[") {
      is_done = is_done || !rows.empty();
      in_section = !is_done && text.substr(0, 10) == "[bed_mesh ";
      in_points = false;
      return true;
    }
    if (!in_section || text.empty()) return true;
    const std::size_t sign = text.find_first_of("=:");
    if (sign == std::string_view::npos) {
      if (const auto numbers = in_points ? numbers_of(text, ", \t", kMaxLines) : std::nullopt)
        rows.emplace_back(line, *numbers);
      return true;
    }
    const std::string_view key = trim(text.substr(0, sign));
    in_points = key == "points";
    const auto value = parse_number(trim(text.substr(sign + 1)));
    if (key == "min_x") x0 = value;
    if (key == "max_x") x1 = value;
    if (key == "min_y") y0 = value;
    if (key == "max_y") y1 = value;
    return true;
  });
  if (rows.empty() || !x0 || !y0 || !x1 || !y1) {
    sink.error(codes::heights_format, 0,
               "expected a section [bed_mesh NAME] with points, min_x, max_x, min_y and max_y");
    return;
  }
  RowReader reader({*x0, *y0, *x1, *y1, rows[0].second.size(), rows.size()}, sink, unit_of(sink));
  for (const auto& [line, numbers] : rows)
    if (!reader.take(line, numbers)) return;
}

/// A grid as firmware prints it: rows of heights, in Marlin after a row of numbers and with a number first.
void read_printed_grid(std::string_view bytes, const HeightsSink& sink) {
  std::vector<std::pair<std::size_t, std::vector<double>>> rows;
  bool in_grid = false, is_marlin = false, is_done = false, has_header = false;
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    if (text.substr(0, 2) == "//") text = trim(text.substr(2));
    for (const std::string_view title : kGridTitles)
      if (text.find(title) != std::string_view::npos) {
        rows.clear();  // the last grid counts
        in_grid = true, has_header = false, is_done = false;
        is_marlin = title == kGridTitles[0];
        return true;
      }
    if (!in_grid || is_done) return true;
    std::string plain(text);
    std::replace(plain.begin(), plain.end(), '=', ' ');
    auto numbers = numbers_of(plain, " \t,", kMaxLines);
    is_done = !numbers || numbers->empty();
    if (is_done) return true;
    if (is_marlin && !has_header) return has_header = true;
    if (is_marlin) numbers->erase(numbers->begin());
    rows.emplace_back(line, std::move(*numbers));
    return true;
  });
  if (rows.empty()) {
    sink.error(codes::heights_format, 0, "expected rows of heights below the title of the grid");
    return;
  }
  if (!sink.options.area) {
    sink.error(codes::heights_missing, rows[0].first, "the heights of this grid have no positions").hint =
        "specify the area of the grid: --map-area X0,Y0,X1,Y1";
    return;
  }
  const double unit = unit_of(sink);
  const std::array<double, 4>& a = *sink.options.area;
  RowReader reader({a[0] / unit, a[1] / unit, a[2] / unit, a[3] / unit, rows[0].second.size(), rows.size()},
                   sink, unit);
  for (const auto& [line, numbers] : rows)
    if (!reader.take(line, numbers)) return;
}

}  // namespace

std::optional<HeightsFormat> map_format(std::string_view bytes) {
  const std::string_view text = without_mark(bytes);
  const auto has = [&](std::string_view words) { return text.find(words) != std::string_view::npos; };
  const std::string_view first = text.substr(0, text.find('\n'));
  if (text.empty()) return std::nullopt;
  if (text[0] == '<' && has("<heightmap")) return HeightsFormat::xml;
  if (text[0] == '{' || (text[0] == '[' && text.find('{') != std::string_view::npos && text.find('{') < 8))
    return HeightsFormat::json;
  if (first.find("height map file") != std::string_view::npos) return HeightsFormat::duet;
  if (has("[bed_mesh ") && has("points")) return HeightsFormat::klipper;
  for (const std::string_view title : kGridTitles)
    if (has(title)) return HeightsFormat::printed_grid;
  if (is_candle(text)) return HeightsFormat::candle;
  return std::nullopt;
}

void read_map(HeightsFormat format, std::string_view bytes, const HeightsSink& sink) {
  if (format == HeightsFormat::xml) return read_xml(bytes, sink);
  if (format == HeightsFormat::json) return read_json(without_mark(bytes), sink);
  if (format == HeightsFormat::duet) return read_duet(bytes, sink);
  if (format == HeightsFormat::klipper) return read_klipper(bytes, sink);
  if (format == HeightsFormat::candle) return read_candle(bytes, sink);
  read_printed_grid(bytes, sink);
}

}  // namespace kerf::heights_detail
