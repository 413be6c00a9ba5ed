// The plain formula decides where its error bound allows it. Elsewhere the sum is computed without rounding,
// as a list of doubles of which it is the exact sum (an expansion).
#include "exact.h"

#include <array>

namespace kerf {
namespace {

struct Pair {
  double high, low;  // their exact sum is the value, high its rounding
};

Pair two_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// An exact sum of doubles that do not overlap, the smallest first.
class Expansion {
 public:
  void add(double value) {
    double rest = value;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Pair sum = two_sum(rest, parts_[i]);
      rest = sum.high;
      if (sum.low != 0.0) parts_[kept++] = sum.low;
    }
    if (rest != 0.0 || kept == 0) parts_[kept++] = rest;
    count_ = kept;
  }
  void add_product(double a, double b) {
    const Pair product = two_product(a, b);
    add(product.low);
    add(product.high);
  }
  /// The largest part has the sign of the sum.
  double sign() const { return count_ == 0 ? 0.0 : parts_[count_ - 1]; }

 private:
  std::array<double, 16> parts_{};  // six products of two parts each, and room for one more sum
  std::size_t count_ = 0;
};

/// (a - c) x (b - c) written out in products of coordinates, so that no difference is rounded.
double exact_orientation(Point2 a, Point2 b, Point2 c) {
  Expansion sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(b.x, c.y);
  sum.add_product(-b.y, c.x);
  sum.add_product(c.x, a.y);
  sum.add_product(-c.y, a.x);
  return sum.sign();
}

}  // namespace

double orientation(Point2 a, Point2 b, Point2 c) {
  // Four differences, two products and their difference: the error is below 3.4 units of rounding of the sum
  // of the products' sizes. Six leave room for the rounding of the bound itself.
  constexpr double kBound = 6.0 * 1.1102230246251565e-16;
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double plain = left - right;
  if (std::abs(plain) > kBound * (std::abs(left) + std::abs(right))) return plain;
  return exact_orientation(a, b, c);
}

}  // namespace kerf
