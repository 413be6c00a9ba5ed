// Points, boxes, and arcs as Kerf stores them. Coordinates are mm in work coordinates: Z up, right-handed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kerf/base/units.h"

namespace kerf {

struct Point2 {
  double x = 0.0, y = 0.0;  // mm
  bool operator==(const Point2&) const = default;
};
constexpr Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point2 operator-(Point2 a) { return {-a.x, -a.y}; }
constexpr Point2 operator*(double k, Point2 a) { return {k * a.x, k * a.y}; }
/// A quarter turn counter-clockwise.
constexpr Point2 left_of(Point2 a) { return {-a.y, a.x}; }
constexpr double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }
inline double length(Point2 a) { return std::hypot(a.x, a.y); }
inline double distance(Point2 a, Point2 b) { return length(b - a); }

struct Point3 {
  double x = 0.0, y = 0.0, z = 0.0;  // mm
  bool operator==(const Point3&) const = default;
  constexpr Point2 xy() const { return {x, y}; }
  constexpr double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};
constexpr Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point3 operator*(double k, Point3 a) { return {k * a.x, k * a.y, k * a.z}; }
constexpr double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Point3 cross(Point3 a, Point3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Point3 a) { return std::sqrt(dot(a, a)); }
inline double distance(Point3 a, Point3 b) { return length(b - a); }
inline bool finite(Point3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Axis-parallel box in the plane, mm; a new one is empty (low above high) and grows by `add`.
struct Box2 {
  Point2 low{kFar, kFar};
  Point2 high{-kFar, -kFar};

  bool empty() const { return low.x > high.x || low.y > high.y; }
  void add(Point2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  void add(const Box2& b) {
    if (b.empty()) return;
    add(b.low);
    add(b.high);
  }
  /// Touching boxes overlap.
  bool overlaps(const Box2& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y;
  }
  bool contains(const Box2& b) const {
    return b.low.x >= low.x && b.low.y >= low.y && b.high.x <= high.x && b.high.y <= high.y;
  }
  /// Larger by `margin` mm on all sides.
  Box2 grown(double margin) const {
    return {{low.x - margin, low.y - margin}, {high.x + margin, high.y + margin}};
  }
  bool operator==(const Box2&) const = default;

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
};

/// Axis-parallel box in mm; a new one is empty (low above high) and grows by `add`.
struct Box3 {
  Point3 low{kFar, kFar, kFar};
  Point3 high{-kFar, -kFar, -kFar};

  bool empty() const { return low.x > high.x || low.y > high.y || low.z > high.z; }
  void add(Point3 p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  void add(const Box3& b) {
    if (b.empty()) return;
    add(b.low);
    add(b.high);
  }
  /// Edge lengths in mm; meaningless for an empty box.
  Point3 size() const { return high - low; }
  bool operator==(const Box3&) const = default;

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
};

struct Circle {
  Point2 centre;  // mm
  Length radius;  // > 0
  bool operator==(const Circle&) const = default;
};

/// The plane an arc lies in. The third axis is the one the plane's name leaves out.
enum class Plane : std::uint8_t { xy, xz, yz };
/// Sense of turning, seen from the positive end of the third axis, as in RS274 (G2 is cw).
enum class Turn : std::uint8_t { cw, ccw };

/// Indices (0 = X, 1 = Y, 2 = Z) of a plane's axes in right-handed order: u towards v is counter-clockwise
/// seen from +w. So XY gives X Y Z, XZ gives Z X Y, YZ gives Y Z X.
struct PlaneAxes {
  int u, v, w;
};
constexpr PlaneAxes axes_of(Plane plane) {
  switch (plane) {
    case Plane::xz: return {2, 0, 1};
    case Plane::yz: return {1, 2, 0};
    case Plane::xy: break;
  }
  return {0, 1, 2};
}
/// The same in the order of the plane's name: XZ gives X Z Y. The words of a program (X Z, I K) and the
/// centres of step::Arc are in this order.
constexpr PlaneAxes named_axes_of(Plane plane) {
  const PlaneAxes axes = axes_of(plane);
  return plane == Plane::xz ? PlaneAxes{axes.v, axes.u, axes.w} : axes;
}
/// Coordinates u, v of a plane's right-handed frame in the order of its name, and the other way round.
constexpr Point2 in_name_order(Plane plane, Point2 uv) {
  return plane == Plane::xz ? Point2{uv.y, uv.x} : uv;
}

/// An arc by a parameter t from 0 to 1, in its plane's right-handed (u, v) frame: angle start_angle + t *
/// sweep, radius start_radius + t * (end_radius - start_radius), and the third axis likewise. Radii that
/// differ by rounding in the program give a spiral through both ends.
struct ArcWalk {
  Plane plane = Plane::xy;
  double u = 0.0, v = 0.0;  // centre, mm
  double start_radius = 0.0, end_radius = 0.0;
  double start_angle = 0.0;  // radians
  double sweep = 0.0;        // radians, signed: positive is counter-clockwise
  double start_w = 0.0, end_w = 0.0;

  Point3 at(double t) const;
  /// True length in mm, of a helix too (the spiral part by its mean radius).
  double length() const;
  /// Chords needed so that none strays from the curve by more than `chord`; at least 1, at most `limit`.
  int chords(Length chord, int limit = 1 << 20) const;
  Box3 bounds() const;
};

/// Makes the walk of an arc. `centre` is in the order of the plane's name (XZ: x, z). An end equal to the
/// start in the plane (angles within 1e-9 rad) is a full circle; `extra_turns` adds whole circles.
ArcWalk walk_arc(Point3 from, Point3 to, Point2 centre, Plane plane, Turn turn, int extra_turns);

}  // namespace kerf
