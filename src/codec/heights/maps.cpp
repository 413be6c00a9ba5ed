// Height maps of senders and firmware: which program wrote one, and those in lines: of Candle, Duet, Klipper
// and Marlin.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/grid.h"

namespace kerf::heights_detail {
namespace {

constexpr std::string_view kGridTitles[] = {"Bilinear Leveling Grid:", "Mesh Leveling Probed Z positions:"};

// -------------------------------------------------------------------------------------------------- Candle

/// "x;y;width;height", "columns;rows;bottom;top", "interpolation;...", then the rows.
void read_candle(std::string_view bytes, const HeightsSink& sink) {
  Rows at;
  std::size_t header = 0;
  std::optional<RowReader> rows;
  bool good = true;
  const auto expect = [&](bool holds, std::size_t line, const char* what) {
    if (!holds)
      sink.error(codes::heights_format, line, fmt::format("expected {}", what)).hint =
          "the file starts as a map of Candle; if it is a list of points, name its columns in the first "
          "line: "
          "x;y;z;comment";
    return holds;
  };
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    const auto numbers = sink.numbers(line, fields_of(text, ';'));
    good = numbers.has_value();
    if (!good) return false;
    const std::vector<double>& n = *numbers;
    if (header == 0) {
      good = expect(n.size() == 4 && n[2] > 0.0 && n[3] > 0.0, line,
                    "the corner, width and height of the area, such as 0;0;60;40");
      if (good) at.x0 = n[0], at.y0 = n[1], at.x1 = n[0] + n[2], at.y1 = n[1] + n[3];
    } else if (header == 1) {
      good = expect(n.size() == 4 && count_of(n[0]) > 0 && count_of(n[1]) > 0 && n[2] < n[3], line,
                    "the numbers of columns and rows, and the lowest and highest Z of probing, such as "
                    "5;4;-1;1");
      if (good) at.columns = count_of(n[0]), at.rows = count_of(n[1]), rows.emplace(at, sink, sink.unit());
    } else if (header > 2) {
      good = rows->take(line, n);
    }
    ++header;
    return good;
  });
  if (!good) return;
  if (rows)
    rows->finish();
  else
    expect(false, header, "a second line with the numbers of columns and rows");
}

/// Also of a damaged map: lists of points have no four numbers between semicolons, unless they name them.
bool is_candle(std::string_view bytes) {
  bool matches = false;
  for_each_line(bytes, [&](std::size_t, std::string_view text) {
    const auto fields = fields_of(text, ';');
    matches = fields.size() == 4 && std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
                return parse_number(field).has_value();
              });
    return false;
  });
  return matches;
}

// ------------------------------------------------------------------------------------------ Duet, Klipper

/// The values of a Duet map's grid by their names, those of the first and of the second version.
class DuetGrid {
 public:
  DuetGrid(std::vector<std::string_view> names, std::vector<std::string_view> values)
      : names_(std::move(names)), values_(std::move(values)) {}

  /// The grid; nothing if a value is missing or contradicts another one.
  std::optional<Rows> rows() const {
    if (names_.size() != values_.size() || !has_axes()) return std::nullopt;
    const auto x0 = number("xmin", "min0"), y0 = number("ymin", "min1"), x1 = number("xmax", "max0"),
               y1 = number("ymax", "max1"), both = number("spacing", "spacing");
    const auto dx = both ? both : number("xspacing", "spacing0"),
               dy = both ? both : number("yspacing", "spacing1");
    const std::size_t nx = count_of(number("xnum", "num0")), ny = count_of(number("ynum", "num1"));
    if (!x0 || !y0 || !x1 || !y1 || !dx || !dy || nx == 0 || ny == 0) return std::nullopt;
    if (!fits(*x0, *x1, *dx, nx) || !fits(*y0, *y1, *dy, ny)) return std::nullopt;
    return Rows{*x0, *y0, *x0 + *dx * double(nx - 1), *y0 + *dy * double(ny - 1), nx, ny};
  }

 private:
  std::optional<std::string_view> text(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return values_[static_cast<std::size_t>(found - names_.begin())];
  }
  std::optional<double> number(std::string_view old_name, std::string_view new_name) const {
    const auto value = text(old_name) ? text(old_name) : text(new_name);
    return value ? parse_number(*value) : std::nullopt;
  }
  bool has_axes() const {
    const auto first = text("axis0"), second = text("axis1");
    return (!first || *first == "X") && (!second || *second == "Y");
  }
  /// Whether `count` points at this distance are all of the axis. The file rounds to 0.01 mm.
  static bool fits(double low, double high, double distance, std::size_t count) {
    const double rounding = 0.01 * double(count + 1);
    const double last = low + distance * double(count - 1);
    return distance > 0.0 && low <= high && last <= high + rounding && last + distance > high - rounding;
  }

  std::vector<std::string_view> names_, values_;
};

/// A title, the names of the grid's values, the values, then the rows. "0" is a point that was not probed.
void read_duet(std::string_view bytes, const HeightsSink& sink) {
  std::vector<std::string_view> names;
  std::optional<RowReader> rows;
  std::size_t header = 0;
  bool good = true;
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    const auto fields = fields_of(text, ',');
    if (header == 1) names = fields;
    if (header == 2) {
      const auto grid = DuetGrid(names, fields).rows();
      good = grid.has_value();
      if (!good) {
        sink.error(
            codes::heights_format, line,
            "expected the minimum, maximum, spacing and number of both axes X and Y, as the line above "
            "names them and in accordance with each other");
        return false;
      }
      rows.emplace(*grid, sink, sink.unit());
    }
    if (header++ < 3) return true;
    auto numbers = sink.numbers(line, fields);
    for (std::size_t i = 0; numbers && i < fields.size(); ++i)
      if (fields[i] == "0") (*numbers)[i] = NAN;
    good = numbers && rows->take(line, *numbers);
    return good;
  });
  if (good && rows) rows->finish();
  if (good && !rows) sink.error(codes::heights_format, 0, "the height map has no values of its grid");
}

using NumberedRow = std::pair<std::size_t, std::vector<double>>;

/// The section [bed_mesh NAME] of printer.cfg: "points =", rows, and "min_x = 10".
class KlipperReader {
 public:
  explicit KlipperReader(const HeightsSink& sink) : sink_(sink) {}

  void read(std::string_view bytes) {
    for_each_line(bytes, [&](std::size_t line, std::string_view text) { return good_ = take(line, text); });
    if (good_) finish();
  }

 private:
  bool take(std::size_t line, std::string_view text) {
    if (text.substr(0, 3) == "#*#") text = trim(text.substr(3));
    if (text.substr(0, 1) == "[") {
      is_done_ = is_done_ || !rows_.empty();
      in_section_ = !is_done_ && text.substr(0, 10) == "[bed_mesh ";
      in_points_ = false;
      return true;
    }
    if (!in_section_ || text.empty() || text[0] == '#' || text[0] == ';') return true;
    const std::size_t sign = text.find_first_of("=:");
    if (sign == std::string_view::npos) {
      if (!in_points_) return true;
      auto numbers = sink_.numbers(line, fields_of(text, ','));
      if (numbers) rows_.emplace_back(line, std::move(*numbers));
      return numbers.has_value();
    }
    const std::string_view key = trim(text.substr(0, sign));
    in_points_ = key == "points";
    for (auto& [name, value] : values_)
      if (name == key) value = sink_.number(line, trim(text.substr(sign + 1)));
    return true;
  }
  std::optional<double> value(std::string_view name) const {
    for (const auto& [known, number] : values_)
      if (known == name) return number;
    return std::nullopt;
  }
  void finish() const {
    const auto x0 = value("min_x"), y0 = value("min_y"), x1 = value("max_x"), y1 = value("max_y");
    if (rows_.empty() || !x0 || !y0 || !x1 || !y1 || !(*x0 < *x1 && *y0 < *y1)) {
      sink_.error(
          codes::heights_format, 0,
          "expected a section [bed_mesh NAME] with points, min_x, min_y, and max_x, max_y above them");
      return;
    }
    const auto columns = value("x_count"), rows = value("y_count");
    RowReader reader({*x0, *y0, *x1, *y1, columns ? count_of(columns) : rows_[0].second.size(),
                      rows ? count_of(rows) : rows_.size()},
                     sink_, sink_.unit());
    for (const auto& [line, numbers] : rows_)
      if (!reader.take(line, numbers)) return;
    reader.finish();
  }

  const HeightsSink& sink_;
  std::vector<NumberedRow> rows_;
  std::vector<std::pair<std::string_view, std::optional<double>>> values_{
      {"min_x", {}}, {"min_y", {}}, {"max_x", {}}, {"max_y", {}}, {"x_count", {}}, {"y_count", {}}};
  bool in_section_ = false, in_points_ = false, is_done_ = false, good_ = true;
};

/// A grid as firmware prints it: rows of heights, in Marlin after a row of the columns' numbers, and each
/// with the row's number first.
class PrintedGridReader {
 public:
  explicit PrintedGridReader(const HeightsSink& sink) : sink_(sink) {}

  void read(std::string_view bytes) {
    for_each_line(bytes, [&](std::size_t line, std::string_view text) { return good_ = take(line, text); });
    if (good_) finish();
  }

 private:
  bool take(std::size_t line, std::string_view text) {
    if (text.substr(0, 2) == "//") text = trim(text.substr(2));
    for (const std::string_view title : kGridTitles)
      if (text.find(title) != std::string_view::npos) {
        rows_.clear();  // the last grid counts
        in_grid_ = true, columns_ = 0;
        is_marlin_ = title == kGridTitles[0];
        return true;
      }
    if (!in_grid_) return true;
    std::string plain(text);
    std::replace(plain.begin(), plain.end(), '=', ' ');  // Marlin's points that were not measured
    auto numbers = numbers_of(plain, " \t,", kMaxLines);
    in_grid_ = numbers && !numbers->empty();
    if (!in_grid_) return !is_damaged_row(line, text);
    if (is_marlin_ && columns_ == 0) {
      columns_ = numbers->size();
      return is_counting(line, *numbers);
    }
    if (is_marlin_) {
      if (numbers->front() != double(rows_.size())) return fail_row(line);
      numbers->erase(numbers->begin());
    }
    if (columns_ == 0) columns_ = numbers->size();
    rows_.emplace_back(line, std::move(*numbers));
    return true;
  }
  bool fail_row(std::size_t line) {
    sink_.error(codes::heights_format, line, fmt::format("expected row {} of the grid", rows_.size()));
    return false;
  }
  /// "0 1 2": the numbers of the columns.
  bool is_counting(std::size_t line, const std::vector<double>& numbers) const {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (numbers[i] != double(i)) {
        sink_.error(codes::heights_format, line, "expected the numbers of the grid's columns: 0 1 2");
        return false;
      }
    return true;
  }
  /// An error for a line that ends the grid and is one of its rows: it starts as a number, or half of it is.
  bool is_damaged_row(std::size_t line, std::string_view text) {
    const auto words = words_of(text);
    const auto numbers = static_cast<std::size_t>(std::count_if(
        words.begin(), words.end(), [](std::string_view word) { return parse_number(word).has_value(); }));
    const bool starts_so =
        !words.empty() && std::string_view("+-.0123456789").find(words[0][0]) != std::string_view::npos;
    if (numbers == 0 && !starts_so) return false;
    if (!starts_so && 2 * numbers < words.size()) return false;
    return !sink_.numbers(line, words).has_value();
  }
  void finish() const {
    if (rows_.empty()) {
      sink_.error(codes::heights_format, 0, "expected rows of heights below the title of the grid");
      return;
    }
    if (!sink_.options.area) {
      sink_.error(codes::heights_missing, rows_[0].first, "the heights of this grid have no positions").hint =
          "specify the area of the grid: --map-area X0,Y0,X1,Y1";
      return;
    }
    const double unit = sink_.unit();
    const std::array<double, 4>& a = *sink_.options.area;
    RowReader reader({a[0] / unit, a[1] / unit, a[2] / unit, a[3] / unit, columns_, rows_.size()}, sink_,
                     unit);
    for (const auto& [line, numbers] : rows_)
      if (!reader.take(line, numbers)) return;
  }

  const HeightsSink& sink_;
  std::vector<NumberedRow> rows_;
  std::size_t columns_ = 0;
  bool in_grid_ = false, is_marlin_ = false, good_ = true;
};

}  // namespace

std::optional<HeightsFormat> map_format(std::string_view bytes) {
  const std::string_view text = trim(bytes);
  const auto has = [&](std::string_view words) { return text.find(words) != std::string_view::npos; };
  const std::string_view first = text.substr(0, text.find('\n'));
  if (text.empty()) return std::nullopt;
  // A console log starts with "<Idle|..." too.
  const auto starts = [&](std::string_view words) { return text.substr(0, words.size()) == words; };
  if (starts("<?xml") || starts("<!--") || starts("<svg") || (text[0] == '<' && has("<heightmap")))
    return HeightsFormat::xml;
  if (text[0] == '{' || (text[0] == '[' && trim(text.substr(1)).substr(0, 1) == "{"))
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
  if (format == HeightsFormat::json) return read_json(bytes, sink);
  if (format == HeightsFormat::duet) return read_duet(bytes, sink);
  if (format == HeightsFormat::klipper) return KlipperReader(sink).read(bytes);
  if (format == HeightsFormat::candle) return read_candle(bytes, sink);
  PrintedGridReader(sink).read(bytes);
}

}  // namespace kerf::heights_detail
