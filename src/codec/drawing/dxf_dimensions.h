// The dimensions of a DXF file, with the points between which they measure.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/drawing/dxf.h"

namespace kerf::dxf {

struct Dimension {
  std::string layer;
  std::string text;               ///< in place of the measured number: its name in OpenSCAD programs
  int type = 0;                   ///< group 70
  double angle = 0.0;             ///< degrees, of a dimension along a line
  std::array<Point, 7> points{};  ///< groups 10 to 16
};

/// In the order of the file. Errors as in read_dxf().
std::vector<Dimension> read_dimensions(std::string_view bytes, const std::string& file_name,
                                       Diagnostics& diagnostics);

/// What a dimension measures, in drawing units; of an angle degrees, of an ordinate the coordinate.
double measured(const Dimension& dimension);

}  // namespace kerf::dxf
