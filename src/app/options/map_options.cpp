// The options of commands that read a map of measured heights.
#include "app/options/map_options.h"

#include <array>
#include <optional>
#include <vector>

#include "app/options/program_options.h"
#include "base/names.h"
#include "base/number.h"

namespace kerf::app {
namespace {

/// "1,2,3"
template <std::size_t count>
std::optional<std::array<double, count>> numbers_of(const std::string& text) {
  std::array<double, count> out{};
  std::size_t start = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t comma = text.find(',', start);
    if ((comma == std::string::npos) != (i + 1 == count)) return std::nullopt;
    const auto number = parse_number(trim(std::string_view(text).substr(start, comma - start)));
    if (!number) return std::nullopt;
    out[i] = *number;
    start = comma + 1;
  }
  return out;
}

std::optional<std::array<double, 4>> area_of(const std::string& text) {
  const auto area = numbers_of<4>(text);
  return area && (*area)[0] < (*area)[2] && (*area)[1] < (*area)[3] ? area : std::nullopt;
}

}  // namespace

void add_map_options(CommandParser& parser, MapOptions& options) {
  parser
      .add_text("--map-unit", options.unit,
                "The unit of the heights, mm or inch (default: as their file states)")
      .value_name("UNIT")
      .check([](const std::string& text) {
        return mm_per_unit(text) ? std::string() : std::string("expected mm or inch");
      });
  parser
      .add_text("--map-zero", options.zero,
                "What is height 0: mean, or the surface at X,Y (default: as their file states)")
      .value_name("WHERE")
      .check([](const std::string& text) {
        return text == "mean" || numbers_of<2>(text) ? std::string() : std::string("expected mean or X,Y");
      });
  parser.add_text("--map-area", options.area, "The area of a map whose file has no positions, mm")
      .value_name("X0,Y0,X1,Y1")
      .check([](const std::string& text) {
        return area_of(text) ? std::string()
                             : std::string("expected X0,Y0,X1,Y1 with X0 below X1 and Y0 below Y1");
      });
}

SurfaceReading surface_reading(const MapOptions& options, const std::string& work_offset) {
  SurfaceReading out;
  out.reading = measured_options(work_offset);
  if (!options.unit.empty()) out.reading.mm_per_unit = mm_per_unit(options.unit);
  if (!options.area.empty()) out.reading.area = area_of(options.area);
  if (options.zero == "mean") {
    out.zero = MapZero::mean;
  } else if (const auto at = numbers_of<2>(options.zero)) {
    out.zero = MapZero::point;
    out.zero_at = {(*at)[0], (*at)[1]};
  }
  return out;
}

}  // namespace kerf::app
