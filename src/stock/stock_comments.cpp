// Stock comments as real programs write them: "stockMin:0.00mm, -30.0mm, -12.7mm", "STOCK/BLOCK,100, 60,
// ...".
#include <array>
#include <cmath>

#include "base/codes/stock.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/base/units.h"
#include "kerf/stock/stock.h"

namespace kerf {
namespace {

constexpr double kMaxReach = 1e6;  // mm; a stock beyond a kilometre is a typing error
constexpr double kPrinted = 0.05;  // mm: maximum difference of two comments from rounding

/// Removes and returns the word before the numbers: "stockmin", "stock/block".
std::string_view take_word(std::string_view& text) {
  while (!text.empty() && (text.front() == '(' || text.front() == ';')) text = trim(text.substr(1));
  while (!text.empty() && text.back() == ')') text = trim(text.substr(0, text.size() - 1));
  const std::size_t end = text.find_first_of(":,=");
  if (end == std::string_view::npos || end > 24) return {};
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end + 1);
  return word;
}

/// A coordinate with or without a unit; without one it is multiplied by `scale`.
std::optional<double> coordinate(std::string_view field, double scale) {
  field = trim(field);
  const auto ends_in = [&](std::string_view unit) {
    return field.size() > unit.size() && fold_name(field.substr(field.size() - unit.size())) == unit;
  };
  if (ends_in("mm")) {
    scale = 1.0;
    field = trim(field.substr(0, field.size() - 2));
  } else if (ends_in("in")) {
    scale = kMmPerInch;
    field = trim(field.substr(0, field.size() - 2));
  }
  const std::optional<double> value = parse_number(field);
  if (!value || std::abs(*value * scale) > kMaxReach) return std::nullopt;
  return *value * scale;
}

/// The numbers of a comma-separated list; nothing if they are not exactly `N`.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(std::string_view list, double scale) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t comma = list.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == N)) return std::nullopt;
    const std::optional<double> value = coordinate(list.substr(0, comma), scale);
    if (!value) return std::nullopt;
    values[i] = *value;
    if (comma != std::string_view::npos) list.remove_prefix(comma + 1);
  }
  return values;
}

Point3 to_point(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

bool solid(const Box3& box) {
  return box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z;
}

bool alike(Point3 a, Point3 b) {
  return std::abs(a.x - b.x) <= kPrinted && std::abs(a.y - b.y) <= kPrinted &&
         std::abs(a.z - b.z) <= kPrinted;
}

}  // namespace

bool StockComments::read(std::string_view comment, double scale, const Origin& where,
                         Diagnostics& diagnostics) {
  std::string_view list = trim(comment);
  const std::string word = fold_name(take_word(list));
  if (word == "stockmin" || word == "stockmax") {
    const auto values = numbers<3>(list, scale);
    if (!values) {
      diagnostics.error(codes::stock_comment_malformed, where,
                        "stock comment: expected three coordinates, x, y, z");
      return true;
    }
    (word == "stockmin" ? minimum_ : maximum_) = to_point(*values);
    check_corners(where, diagnostics);
    return true;
  }
  if (word != "stock/block") return false;
  const auto values = numbers<6>(list, scale);
  if (!values) {
    diagnostics.error(codes::stock_comment_malformed, where,
                      "stock comment: expected six numbers: length, width, height and the origin's x, y, z");
    return true;
  }
  const auto& v = *values;
  const Point3 low = Point3{0.0, 0.0, 0.0} - Point3{v[3], v[4], v[5]};
  const Box3 box{low, low + Point3{v[0], v[1], v[2]}};
  if (!solid(box)) {
    diagnostics.error(codes::stock_impossible, where,
                      "stock comment: length, width and height must be above 0");
    return true;
  }
  block_ = box;
  check_agreement(where, diagnostics);
  return true;
}

/// stockMin and stockMax without volume are dropped in favour of STOCK/BLOCK.
void StockComments::check_corners(const Origin& where, Diagnostics& diagnostics) {
  if (!minimum_ || !maximum_) return;
  if (!solid({*minimum_, *maximum_})) {
    diagnostics.warning(codes::stock_impossible, where,
                        "stockMin is not below stockMax in every axis; ignored");
    minimum_.reset();
    maximum_.reset();
    return;
  }
  check_agreement(where, diagnostics);
}

void StockComments::check_agreement(const Origin& where, Diagnostics& diagnostics) {
  if (!minimum_ || !maximum_ || !block_ || (alike(*minimum_, block_->low) && alike(*maximum_, block_->high)))
    return;
  diagnostics.warning(
      codes::stock_comments_differ, where,
      "STOCK/BLOCK and stockMin, stockMax describe different blocks; stockMin, stockMax are used");
}

std::optional<Stock> StockComments::stock() const {
  if (minimum_ && maximum_) return Stock{{*minimum_, *maximum_}};
  if (block_) return Stock{*block_};
  return std::nullopt;
}

}  // namespace kerf
