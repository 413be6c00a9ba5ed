// The stock in the comments of CAM programs: CopperCAM, SketchUcam, PyCAM, and corners as "X MIN: ... X MAX:
// ...".
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "kerf/geom/geometry.h"
#include "kerf/stock/stock.h"

namespace kerf::gcode {

class CamStockComments {
 public:
  /// Reads a comment; others have no effect. Lengths without a unit are in mm times `scale`.
  void read(std::string_view text, double scale);
  /// The block; nothing if the comments do not suffice or have no volume.
  std::optional<Stock> stock() const;

 private:
  void read_corners(std::string_view text, double scale);
  void read_sizes(std::string_view text, double scale);

  Box3 box_;                    // of corners, as far as given
  unsigned given_ = 0;          // bits: 0 to 2 the lower corner's axes, 3 to 5 those of the upper one
  std::optional<Point3> size_;  // with work zero at the lower left corner of the top
  std::optional<double> length_, width_, thickness_;  // of several comments
  std::size_t comments_left_ = 2000;                  // the stock is described in the header or at the end
};

}  // namespace kerf::gcode
