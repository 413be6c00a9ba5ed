// The block of material: from its size and zero, from the cuts, from a program's comments.
#include "kerf/stock/stock.h"

#include <array>
#include <cmath>

#include "base/names.h"
#include "base/number.h"

namespace kerf {
namespace {

struct CornerName {
  std::string_view name;
  ZeroCorner corner;
};
constexpr std::array kCorners{
    CornerName{"lower-left", ZeroCorner::lower_left},   CornerName{"lower-centre", ZeroCorner::lower_centre},
    CornerName{"lower-right", ZeroCorner::lower_right}, CornerName{"centre-left", ZeroCorner::centre_left},
    CornerName{"centre", ZeroCorner::centre},           CornerName{"centre-right", ZeroCorner::centre_right},
    CornerName{"top-left", ZeroCorner::top_left},       CornerName{"top-centre", ZeroCorner::top_centre},
    CornerName{"top-right", ZeroCorner::top_right},
};

bool solid(const Box3& box) {
  return finite(box.low) && finite(box.high) && box.low.x < box.high.x && box.low.y < box.high.y &&
         box.low.z < box.high.z;
}

}  // namespace

Point2 fraction_of(ZeroCorner corner) {
  const auto index = static_cast<unsigned>(corner);
  return {0.5 * (index % 3), 0.5 * (index / 3)};
}

Stock make_block(Point3 size, ZeroCorner corner, ZeroHeight height) {
  const Point2 low_side = fraction_of(corner);
  const Point3 low{-low_side.x * size.x, -low_side.y * size.y, height == ZeroHeight::top ? -size.z : 0.0};
  const Point3 zero{};  // adding it turns -0 into 0
  Stock stock;
  stock.block.low = low + zero;
  stock.block.high = stock.block.low + size;
  return stock;
}

std::optional<ZeroCorner> parse_zero_corner(std::string_view name) {
  const std::string folded = fold_name(name);
  for (const CornerName& known : kCorners) {
    if (folded == fold_name(known.name)) return known.corner;
  }
  return std::nullopt;
}

std::optional<ZeroHeight> parse_zero_height(std::string_view name) {
  const std::string folded = fold_name(name);
  if (folded == "top") return ZeroHeight::top;
  if (folded == "bottom") return ZeroHeight::bottom;
  return std::nullopt;
}

const std::vector<std::string>& zero_corner_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const CornerName& known : kCorners) all.emplace_back(known.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& zero_height_names() {
  static const std::vector<std::string> names{"top", "bottom"};
  return names;
}

bool is_solid(const Stock& stock) { return solid(stock.block); }

std::vector<std::string> write_stock_comments(const Stock& stock) {
  constexpr int kDecimals = 6;
  const auto text = [](double value) {
    std::string plain = number_text(value, kDecimals);
    const std::size_t point = plain.find('.');
    if (point == std::string::npos) return plain + ".00";
    if (plain.size() - point == 2) plain += '0';
    return plain;
  };
  const auto point = [&](const char* word, Point3 p) {
    return std::string(word) + ":" + text(p.x) + "mm, " + text(p.y) + "mm, " + text(p.z) + "mm";
  };
  const Box3& box = stock.block;
  const Point3 size = box.size();
  return {point("stockMin", box.low), point("stockMax", box.high),
          "STOCK/BLOCK, " + text(size.x) + ", " + text(size.y) + ", " + text(size.z) + ", " +
              text(-box.low.x) + ", " + text(-box.low.y) + ", " + text(-box.low.z)};
}

}  // namespace kerf
