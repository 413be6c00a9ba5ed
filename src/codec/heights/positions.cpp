// Lists of positions and heights: lines "x y z", or columns that the first line names.
#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/sink.h"

#include "kerf/base/units.h"

namespace kerf::heights_detail {
namespace {

using Fields = std::vector<std::string_view>;

// Of three, six or nine axes, as Mach3 and LinuxCNC write them; a row of a grid may have any other number.
bool is_usual_count(std::size_t count) { return count == 3 || count == 6 || count == 9; }

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
bool is_comment(std::string_view line) { return line[0] == ';' || line[0] == '(' || line[0] == '#'; }

/// What separates the fields of a line, and whether a comma in them is a decimal point.
enum class Form : std::uint8_t { blanks, decimal_commas, commas, semicolons, tabs, unknown };

/// A comma is a decimal point where semicolons or blanks separate the numbers ("1,5;2;0,1", "1,5 2 0,1"),
/// else it separates them ("1.5,2,0.1"). Unknown where it may be either.
Form form_of(std::string_view line) {
  const bool has_point = line.find('.') != std::string_view::npos;
  const bool has_comma = line.find(',') != std::string_view::npos;
  if (line.find(';') != std::string_view::npos)
    return has_comma && has_point ? Form::unknown : Form::semicolons;
  if (!has_comma) return Form::blanks;
  const Fields words = words_of(line);
  const bool comma_at_end = std::any_of(words.begin(), words.end(), [](std::string_view word) {
    return word.front() == ',' || word.back() == ',';
  });
  if (words.size() > 1 && !comma_at_end) return has_point ? Form::unknown : Form::decimal_commas;
  return !has_point && fields_of(line, ',').size() > 3 ? Form::unknown : Form::commas;
}

Fields split(std::string_view line, Form form) {
  switch (form) {
    case Form::semicolons: return fields_of(line, ';');
    case Form::commas: return fields_of(line, ',');
    case Form::tabs: return fields_of(line, '\t');
    case Form::blanks:
    case Form::decimal_commas:
    case Form::unknown: break;
  }
  return words_of(line);
}

/// The form of a line of names.
Form form_of_names(std::string_view line) {
  for (const auto& [separator, form] :
       {std::pair(';', Form::semicolons), std::pair('\t', Form::tabs), std::pair(',', Form::commas)})
    if (line.find(separator) != std::string_view::npos) return form;
  return Form::blanks;
}

/// Where the columns are, by the names of a line.
struct Columns {
  Form form = Form::blanks;
  std::size_t count = 0;
  std::array<std::size_t, 3> of{};  // of x, y, z
  std::optional<double> unit;       // "x [inch]"
};

/// A column's axis, 0 to 2, and its unit: "Y", "x (mm)", "Z_inch", "height".
struct ColumnName {
  std::size_t axis = 0;
  std::optional<double> unit;
};
std::optional<ColumnName> column_name(std::string_view text) {
  std::string name = fold_name(text);
  name.erase(
      std::remove_if(name.begin(), name.end(),
                     [](char c) { return std::string_view("[]()\"'").find(c) != std::string_view::npos; }),
      name.end());
  for (const auto& [word, axis] :
       {std::pair<std::string_view, std::size_t>("x", 0), {"y", 1}, {"z", 2}, {"height", 2}}) {
    if (name.substr(0, word.size()) != word) continue;
    const std::string rest = name.substr(word.size());
    if (rest.empty()) return ColumnName{axis, std::nullopt};
    if (const auto unit = mm_per_unit(rest)) return ColumnName{axis, unit};
  }
  return std::nullopt;
}

/// Columns with one x, one y and one z; nothing otherwise, or where their units differ.
std::optional<Columns> columns_of(std::string_view line) {
  Columns out;
  out.form = form_of_names(line);
  const Fields names = split(line, out.form);
  out.count = names.size();
  std::array<int, 3> seen{};
  std::array<std::optional<double>, 3> units;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto name = column_name(names[i])) {
      ++seen[name->axis];
      out.of[name->axis] = i;
      units[name->axis] = name->unit;
    }
  if (seen != std::array<int, 3>{1, 1, 1} || units[0] != units[1] || units[0] != units[2])
    return std::nullopt;
  out.unit = units[0];
  return out;
}

/// Whether a line has names alone.
bool has_names(std::string_view line) {
  if (std::none_of(line.begin(), line.end(), is_letter)) return false;
  const Fields fields = split(line, form_of_names(line));
  return std::none_of(fields.begin(), fields.end(), [](std::string_view f) {
    return !f.empty() && std::none_of(f.begin(), f.end(), is_letter);
  });
}

class PositionReader {
 public:
  explicit PositionReader(const HeightsSink& sink) : sink_(sink) {}

  bool take(std::size_t line, std::string_view text) {
    if (is_comment(text)) {
      // "# y x z" names the columns; of longer texts that is not known.
      const auto named = columns_of(trim(text.substr(1, text.find_last_not_of(')'))));
      if (!first_ && !columns_ && named && named->count == 3) columns_ = named;
      return true;
    }
    if (!first_ && !columns_ && has_names(text)) {
      columns_ = columns_of(text);
      if (columns_) return true;
      sink_
          .error(codes::heights_format, line, "expected one column each of the names x, y and z, in one unit")
          .hint = "name the columns, such as N;X;Y;Z, or remove the line: lines x y z are read in this order";
      return false;
    }
    if (!first_) first_ = line;
    return columns_ ? take_named(line, text) : take_unnamed(line, text);
  }

 private:
  /// A number whose comma may be a decimal point.
  std::optional<double> number(std::size_t line, std::string_view field, Form form) const {
    const bool has_decimal_comma = form != Form::commas && field.find('.') == std::string_view::npos &&
                                   std::count(field.begin(), field.end(), ',') == 1;
    if (!has_decimal_comma) return sink_.number(line, field);
    std::string with_point(field);
    with_point[with_point.find(',')] = '.';
    const auto value = parse_number(with_point);
    return value ? value : sink_.number(line, field);
  }
  bool take_named(std::size_t line, std::string_view text);
  bool take_unnamed(std::size_t line, std::string_view text);

  const HeightsSink& sink_;
  std::optional<Columns> columns_;
  std::optional<std::size_t> first_;  // line of the first point
  std::size_t count_ = 0;             // fields of that line
};

bool PositionReader::take_named(std::size_t line, std::string_view text) {
  const Columns& c = *columns_;
  const std::size_t needed = *std::max_element(c.of.begin(), c.of.end()) + 1;
  // The last column may be a comment that has separators, or is left out.
  const bool has_comment = needed < c.count;
  const auto fits = [&](const Fields& fields) {
    return fields.size() + (has_comment ? 1 : 0) >= c.count && (fields.size() <= c.count || has_comment);
  };
  Form form = c.form;
  Fields fields = split(text, form);
  if (form == Form::blanks || !fits(fields)) {  // "x,y,z" above "1;2;3"
    form = form_of(text);
    fields = split(text, form);
  }
  if (!fits(fields)) {
    sink_.error(codes::heights_format, line,
                fmt::format("expected {} columns as named above, found {}", c.count, fields.size()));
    return true;
  }
  std::array<double, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = number(line, fields[c.of[k]], form);
    if (!value) return true;
    at[k] = *value;
  }
  return sink_.add(line, at[0], at[1], at[2], sink_.unit(c.unit.value_or(1.0)));
}

bool PositionReader::take_unnamed(std::size_t line, std::string_view text) {
  const Form form = form_of(text);
  if (form == Form::unknown) {
    sink_
        .error(codes::heights_format, line,
               "expected numbers: x y z; a comma here may be a decimal point or a separator")
        .hint = "separate numbers that have decimal commas by semicolons or blanks";
    return true;
  }
  const Fields fields = split(text, form);
  if (line == *first_) count_ = fields.size();
  if (!is_usual_count(fields.size()) || fields.size() != count_) {
    const std::string expected = is_usual_count(count_)
                                     ? fmt::format("expected {} numbers as in line {}", count_, *first_)
                                     : "expected numbers: x y z";
    sink_.error(codes::heights_format, line, fmt::format("{}; found {} fields", expected, fields.size()))
        .hint = "name the columns of a list in its first line, such as x,y,z,comment";
    return true;
  }
  std::vector<double> numbers;
  for (const std::string_view field : fields) {
    const auto value = number(line, field, form);
    if (!value) return true;
    numbers.push_back(*value);
  }
  return sink_.add(line, numbers[0], numbers[1], numbers[2], sink_.unit());
}

}  // namespace

void read_positions(std::string_view bytes, const HeightsSink& sink) {
  if (sink.options.area) {
    sink.error(codes::heights_format, 0,
               "the file is read as lines x y z, and --map-area is for grids without "
               "positions")
        .hint = "keep the title above the rows of a grid, as Marlin or Klipper prints it";
    return;
  }
  PositionReader reader(sink);
  for_each_line(bytes, [&](std::size_t line, std::string_view text) { return reader.take(line, text); });
}

}  // namespace kerf::heights_detail
