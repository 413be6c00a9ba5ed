// What the readers of height files have in common: where heights go, and the lines of a text.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/formats/measured.h"

namespace kerf::heights_detail {

/// The file that is read: its heights, and the diagnostics at its lines.
struct HeightsSink {
  MeasuredFile& out;
  const MeasuredOptions& options;
  Diagnostics& diagnostics;

  Diagnostic& error(Code code, std::size_t line, std::string message) const;
  Diagnostic& warning(Code code, std::size_t line, std::string message) const;
  /// False, with an error, where the file has too many heights.
  bool add(std::size_t line, double x, double y, std::optional<double> z, double mm_per_unit) const;
};

/// Calls visit(line number, trimmed text) for each line with text until it returns false.
void for_each_line(std::string_view bytes, const std::function<bool(std::size_t, std::string_view)>& visit);

/// All numbers of a line, separated by any of `separators`; nothing if it has anything else or too many.
std::optional<std::vector<double>> numbers_of(std::string_view line, std::string_view separators,
                                              std::size_t max_count = 16);
/// The first `count` numbers after `key` in a line.
std::optional<std::vector<double>> values_after(std::string_view line, std::string_view key,
                                                std::size_t count);

/// Whether the text is a map of one of the programs of read_map, and which.
std::optional<HeightsFormat> map_format(std::string_view bytes);
void read_map(HeightsFormat format, std::string_view bytes, const HeightsSink& sink);

/// Whether the text has lines of a controller with the results of probes.
bool is_log(std::string_view bytes);
void read_log(std::string_view bytes, const HeightsSink& sink);

}  // namespace kerf::heights_detail
