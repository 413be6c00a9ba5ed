// What the readers of height files have in common: where heights go, and the lines and numbers of a text.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/formats/measured.h"

namespace kerf::heights_detail {

/// The file that is read: its text, its heights, and the diagnostics at its lines.
struct HeightsSink {
  MeasuredFile& out;
  const MeasuredOptions& options;
  Diagnostics& diagnostics;
  std::string_view bytes;

  Diagnostic& error(Code code, std::size_t line, std::string message) const;
  Diagnostic& warning(Code code, std::size_t line, std::string message) const;
  /// An error of the file's form at the column of `part`, which is a part of `bytes` in `line`.
  Diagnostic& error_at(std::size_t line, std::string_view part, std::string message) const;
  /// The number of a field of a line; nothing, with an error, for other words and for an empty field.
  std::optional<double> number(std::size_t line, std::string_view field) const;
  /// The numbers of fields; nothing, with an error at the first field that is none.
  std::optional<std::vector<double>> numbers(std::size_t line,
                                             const std::vector<std::string_view>& fields) const;
  /// False, with an error, where the file has too many heights.
  bool add(std::size_t line, double x, double y, std::optional<double> z, double mm_per_unit) const;
  /// mm in the unit of a file that states `own`.
  double unit(double own = 1.0) const { return options.mm_per_unit.value_or(own); }
};

/// Calls visit(line number, trimmed text) for each line with text until it returns false.
void for_each_line(std::string_view bytes, const std::function<bool(std::size_t, std::string_view)>& visit);

/// The trimmed fields between separators: an empty field is kept, but for one at the end of the line.
std::vector<std::string_view> fields_of(std::string_view line, char separator);
/// The fields between blanks and tabs.
std::vector<std::string_view> words_of(std::string_view line);

/// All numbers of a line, separated by any of `separators`; nothing if it has anything else or too many.
std::optional<std::vector<double>> numbers_of(std::string_view line, std::string_view separators,
                                              std::size_t max_count = 16);
/// At least `count` numbers after `key` in a line, up to the next ']', '|', '>' or ':'.
std::optional<std::vector<double>> values_after(std::string_view line, std::string_view key,
                                                std::size_t count);

/// Whether the text is a map of one of the programs of read_map, and which.
std::optional<HeightsFormat> map_format(std::string_view bytes);
void read_map(HeightsFormat format, std::string_view bytes, const HeightsSink& sink);
void read_xml(std::string_view bytes, const HeightsSink& sink);
void read_json(std::string_view bytes, const HeightsSink& sink);

/// Whether the text is a map of bCNC, also a damaged one: by the ending .probe of its name, or by its first
/// lines.
bool is_probe_map(std::string_view bytes, std::string_view file);
void read_probe_map(std::string_view bytes, const HeightsSink& sink);

/// Lines "x y z", or columns that the first line names.
void read_positions(std::string_view bytes, const HeightsSink& sink);

/// Whether the text has lines of a controller with the results of probes.
bool is_log(std::string_view bytes);
void read_log(std::string_view bytes, const HeightsSink& sink);

/// The kind of a file that has no text, such as "a PNG picture"; nothing for texts.
std::optional<std::string_view> binary_kind(std::string_view bytes);

}  // namespace kerf::heights_detail
