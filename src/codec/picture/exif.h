// The few values of a photo's EXIF data that change how it is read.
#pragma once

#include <optional>
#include <string_view>

namespace kerf {

struct ExifValues {
  int orientation = 1;                    ///< 1 to 8: how the rows lie; 1: from the top, each from the left
  std::optional<double> pixels_per_mm{};  ///< along a row of the file, if it is stated
};
/// Of the data of a marker APP1, which starts with "Exif"; damaged data has no values.
ExifValues read_exif(std::string_view data);

}  // namespace kerf
