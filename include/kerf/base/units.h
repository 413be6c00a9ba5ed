// Units as types, so that a feed cannot be passed as a length.
//
// Kerf computes in mm, minutes and radians. Interfaces (options, steps, reports) use these types; kernels
// take the number out once (`.mm()`, `.mm_per_min()`) and wrap the result. Points are plain coordinates in mm
// of a documented frame (geometry.h) and need no unit type.
#pragma once

#include <compare>
#include <numbers>

namespace kerf {

inline constexpr double kMmPerInch = 25.4;

/// A quantity with the dimension length^L * time^T. Holds mm and minutes; never converts by itself.
template <int L, int T>
class Quantity {
 public:
  constexpr Quantity() = default;
  /// Makes a quantity from a number already in mm and minutes. Only this header and kernels call it.
  static constexpr Quantity raw(double value) { return Quantity(value); }
  constexpr double raw() const { return value_; }

  constexpr double mm() const requires(L == 1 && T == 0) { return value_; }
  constexpr double inch() const requires(L == 1 && T == 0) { return value_ / kMmPerInch; }
  constexpr double mm_per_min() const requires(L == 1 && T == -1) { return value_; }
  constexpr double minutes() const requires(L == 0 && T == 1) { return value_; }
  constexpr double seconds() const requires(L == 0 && T == 1) { return value_ * 60.0; }
  constexpr double rpm() const requires(L == 0 && T == -1) { return value_; }
  constexpr double mm3() const requires(L == 3 && T == 0) { return value_; }

  constexpr auto operator<=>(const Quantity&) const = default;
  constexpr Quantity operator-() const { return Quantity(-value_); }
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity(a.value_ + b.value_); }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity(a.value_ - b.value_); }
  friend constexpr Quantity operator*(double k, Quantity a) { return Quantity(k * a.value_); }
  friend constexpr Quantity operator*(Quantity a, double k) { return Quantity(k * a.value_); }
  friend constexpr Quantity operator/(Quantity a, double k) { return Quantity(a.value_ / k); }

 private:
  constexpr explicit Quantity(double value) : value_(value) {}
  double value_ = 0.0;
};

template <int L, int T, int M, int U>
constexpr auto operator*(Quantity<L, T> a, Quantity<M, U> b) {
  return Quantity<L + M, T + U>::raw(a.raw() * b.raw());
}
template <int L, int T, int M, int U>
constexpr auto operator/(Quantity<L, T> a, Quantity<M, U> b) {
  return Quantity<L - M, T - U>::raw(a.raw() / b.raw());
}
template <int L, int T>
constexpr double operator/(Quantity<L, T> a, Quantity<L, T> b) {
  return a.raw() / b.raw();
}

using Length = Quantity<1, 0>;
using Volume = Quantity<3, 0>;
using Duration = Quantity<0, 1>;
using Feed = Quantity<1, -1>;
using SpindleSpeed = Quantity<0, -1>;

constexpr Length mm(double v) { return Length::raw(v); }
constexpr Length inch(double v) { return Length::raw(kMmPerInch * v); }
constexpr Volume mm3(double v) { return Volume::raw(v); }
constexpr Duration minutes(double v) { return Duration::raw(v); }
constexpr Duration seconds(double v) { return Duration::raw(v / 60.0); }
constexpr Feed mm_per_min(double v) { return Feed::raw(v); }
constexpr Feed inch_per_min(double v) { return Feed::raw(kMmPerInch * v); }
constexpr SpindleSpeed rpm(double v) { return SpindleSpeed::raw(v); }

/// An angle; radians inside, made by `degrees()` or `radians()` only.
class Angle {
 public:
  constexpr Angle() = default;
  constexpr double rad() const { return rad_; }
  constexpr double deg() const { return rad_ * 180.0 / std::numbers::pi; }
  constexpr auto operator<=>(const Angle&) const = default;
  friend constexpr Angle operator*(double k, Angle a) { return Angle(k * a.rad_); }
  friend constexpr Angle radians(double v);
  friend constexpr Angle degrees(double v);

 private:
  constexpr explicit Angle(double rad) : rad_(rad) {}
  double rad_ = 0.0;
};
constexpr Angle radians(double v) { return Angle(v); }
constexpr Angle degrees(double v) { return Angle(v * std::numbers::pi / 180.0); }

}  // namespace kerf
