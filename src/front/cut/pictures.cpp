// Pictures of a job: their keys, and their shapes.
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/row_keys.h"

#include "kerf/base/limits.h"
#include "kerf/program/cut_job.h"

namespace kerf {

const std::vector<CutPictureKey>& cut_picture_keys() {
  using op_detail::key_at;
  using Shape = PictureShape;
  static const std::vector<CutPictureKey> keys{
      key_at<Shape>(
          {.name = "picture",
           .meaning = "a picture for laser-picture (.png, .jpg)",
           .example = "\"photo.png\""},
          [](Shape & s) -> auto& { return s.file; }),
      key_at<Shape>(
          {.name = "pixels",
           .meaning = "a picture as rows of digits from 0, white, to 9, black",
           .example = "[\"0990\", \"9009\"]"},
          [](Shape & s) -> auto& { return s.pixels; }),
      key_at<Shape>(
          {.name = "picture-width",
           .meaning = "width of a picture on the board; 0: by the resolution of its file",
           .example = "80",
           .range = op_detail::within(0, limits::kMaxCoordinate)},
          [](Shape & s) -> auto& { return s.width; }),
      key_at<Shape>(
          {.name = "at", .meaning = "X,Y of the lower left corner of a picture", .example = "[0, 0]"},
          [](Shape & s) -> auto& { return s.at; })};
  return keys;
}

namespace {

/// Digits as pixels; nothing if there are none, or rows are of different length.
std::optional<GreyPicture> picture_of(const std::vector<std::string>& rows) {
  GreyPicture made;
  made.width = static_cast<int>(rows.front().size()), made.height = static_cast<int>(rows.size());
  for (const std::string& row : rows) {
    if (row.size() != rows.front().size() || row.empty()) return std::nullopt;
    for (const char c : row) {
      if (c < '0' || c > '9') return std::nullopt;
      made.grey.push_back(static_cast<std::uint8_t>((255 * ('9' - c) + 4) / 9));
    }
  }
  return made;
}

}  // namespace

std::optional<ArtShape> shape_of_picture(const PictureShape& shape, GreyPicture read,
                                         std::optional<double> per_mm, Diagnostics& diagnostics) {
  const auto refused = [&](const std::string& why, const char* hint) {
    diagnostics.error(codes::cut_job_key, shape.where, fmt::format("{}: {}", shape.name, why)).hint = hint;
    return std::nullopt;
  };
  if (!shape.pixels.empty()) {
    auto drawn = picture_of(shape.pixels);
    if (!drawn)
      return refused("rows of pixels are digits, of the same number each", "pixels = [\"09\", \"90\"]");
    read = std::move(*drawn);
  }
  Length width = shape.width;
  if (!(width > Length{}) && per_mm) width = mm(read.width / *per_mm);
  if (!(width > Length{}))
    return refused("the width of the picture on the board is missing", "picture-width = 80");
  ArtShape made{shape.name, shape.layer, {}, {}, {}};
  made.picture = std::make_shared<const PlacedPicture>(PlacedPicture{std::move(read), shape.at, width});
  return made;
}

}  // namespace kerf
