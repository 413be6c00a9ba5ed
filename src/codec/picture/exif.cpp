// Reads orientation and resolution of EXIF data: the first directory of a TIFF file in a marker.
#include "codec/picture/exif.h"

#include <cstdint>

namespace kerf {
namespace {

constexpr double kMmPerInch = 25.4, kMmPerCm = 10.0;
constexpr double kUnknownPerInch = 72.0;  // by EXIF what is written where the resolution is not known

/// Numbers of a TIFF file in its byte order; what lies beyond the data is 0.
class Tiff {
 public:
  explicit Tiff(std::string_view data) : data_(data), little_(data.starts_with("II")) {}
  std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at > data_.size() || size > data_.size() - at) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value = value << 8 | static_cast<std::uint8_t>(data_[at + (little_ ? size - 1 - i : i)]);
    return value;
  }
  std::uint32_t u16(std::size_t at) const { return number(at, 2); }
  std::uint32_t u32(std::size_t at) const { return number(at, 4); }
  bool is_valid() const { return (little_ || data_.starts_with("MM")) && u16(2) == 42; }

 private:
  std::string_view data_;
  bool little_;
};

}  // namespace

ExifValues read_exif(std::string_view data) {
  using namespace std::string_view_literals;
  constexpr std::size_t kEntry = 12, kShort = 3, kRational = 5;
  constexpr std::uint32_t kOrientation = 0x0112, kResolution = 0x011A, kUnit = 0x0128;
  ExifValues values;
  if (!data.starts_with("Exif\0\0"sv)) return values;
  const Tiff tiff(data.substr(6));
  if (!tiff.is_valid()) return values;
  const std::size_t directory = tiff.u32(4), count = tiff.u16(directory);
  double per_unit = 0.0;
  std::uint32_t unit = 2;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = directory + 2 + kEntry * i;
    const std::uint32_t tag = tiff.u16(at), type = tiff.u16(at + 2), value = tiff.u16(at + 8);
    if (tag == kOrientation && type == kShort && value >= 1 && value <= 8)
      values.orientation = static_cast<int>(value);
    if (tag == kUnit && type == kShort) unit = value;
    if (tag == kResolution && type == kRational)
      if (const std::uint32_t below = tiff.u32(tiff.u32(at + 8) + 4); below > 0)
        per_unit = static_cast<double>(tiff.u32(tiff.u32(at + 8))) / below;
  }
  if (per_unit > 0.0 && (unit == 3 || (unit == 2 && per_unit != kUnknownPerInch)))
    values.pixels_per_mm = per_unit / (unit == 3 ? kMmPerCm : kMmPerInch);
  return values;
}

}  // namespace kerf
