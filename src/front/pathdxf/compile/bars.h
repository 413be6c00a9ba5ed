// Support bars: where along a cut the tool stays above the bars.
#pragma once

#include <cstdint>
#include <vector>

#include "front/pathdxf/model/path.h"

namespace kerf::pathdxf {

enum class BarSection : std::uint8_t { bar, down, between, up };

struct Section {
  BarSection kind = BarSection::bar;
  double length = 0.0;  // mm; below 0 where bars are closer than the tool is wide
};

constexpr double kMaxBars = 10'000;  // along one element

/// The sections of a cut of the given length with a tool of the given diameter; none where it has no room for
/// bars. There are at most kMaxBars bars, which the caller checks.
std::vector<Section> bar_sections(double length, double tool, const MillingValues& values);
/// The number of bars.
double bar_count(double length, const MillingValues& values);

}  // namespace kerf::pathdxf
