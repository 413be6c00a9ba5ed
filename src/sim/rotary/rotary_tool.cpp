// Intersections of frusta with tilted lines.
#include "sim/rotary/rotary_tool.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf::sim {
namespace {

constexpr double kParallel = 1e-12;  // of a component of a direction: the line is parallel to the other axis
constexpr double kConvex = 1e-9;     // mm, and of a slope: smaller steps do not make a tool concave
constexpr double kLevel = 1e-6;      // of a cosine: the ray may cross bands in any order
constexpr double kMaxChords = 4096;  // of an arc
constexpr double kGolden = 0.381966;
constexpr int kNarrowings = 26;  // to a quarter of a millionth

/// Clips [low, high] to minimum <= a + b * r <= maximum.
bool clip_between(double a, double b, double minimum, double maximum, double& low, double& high) {
  if (std::abs(b) < kParallel) return a >= minimum && a <= maximum;
  const double r0 = (minimum - a) / b, r1 = (maximum - a) / b;
  low = std::max(low, std::min(r0, r1));
  high = std::min(high, std::max(r0, r1));
  return low < high;
}

/// Clips [low, high] to a r^2 + 2 b r + c <= 0, which is known to be one interval.
bool clip_quadratic(double a, double b, double c, double& low, double& high) {
  if (std::abs(a) < kParallel) {
    if (std::abs(b) < kParallel) return c <= 0.0;
    const double root = -c / (2.0 * b);
    (b > 0.0 ? high : low) = b > 0.0 ? std::min(high, root) : std::max(low, root);
    return low < high;
  }
  const double discriminant = b * b - a * c;
  if (discriminant <= 0.0) return a < 0.0;
  // The root without cancellation first, the other one from the product of both.
  const double q = b > 0.0 ? -b - std::sqrt(discriminant) : -b + std::sqrt(discriminant);
  const double r0 = std::min(q / a, c / q), r1 = std::max(q / a, c / q);
  if (a > 0.0) {
    low = std::max(low, r0);
    high = std::min(high, r1);
    return low < high;
  }
  // In one nappe of the cone: below the lower root or above the upper one.
  const double below = std::min(high, r0) - low, above = high - std::max(low, r1);
  if (below <= 0.0 && above <= 0.0) return false;
  if (below >= above) {
    high = std::min(high, r0);
  } else {
    low = std::max(low, r1);
  }
  return true;
}

}  // namespace

Frusta::Frusta(double radius, double bottom, double top) { add_band(radius, bottom, radius, top); }

void Frusta::add_band(double r0, double z0, double r1, double z1) {
  if (!(z1 > z0) || (r0 <= 0.0 && r1 <= 0.0)) return;
  const double slope = (r1 - r0) / (z1 - z0);
  if (r0 < 0.0) z0 -= r0 / slope;  // shrunk beyond the axis there
  if (r1 < 0.0) z1 -= r1 / slope;
  r0 = std::max(r0, 0.0);
  r1 = std::max(r1, 0.0);
  const double rim = std::max(r0, r1);
  bool continues = !bands_.empty();
  if (continues) {
    const Band& last = bands_.back();
    continues = std::abs(last.high - z0) < kConvex && slope < last.slope + kConvex &&
                std::abs(last.radius + last.slope * (last.high - last.low) - r0) < kConvex;
  }
  if (!bands_.empty()) {
    const Band& last = bands_.back();
    widens_ = widens_ && std::abs(last.high - z0) < kConvex &&
              r0 > last.radius + last.slope * (last.high - last.low) - kConvex;
  }
  widens_ = widens_ && slope >= 0.0;
  if (!continues) bodies_.push_back({bands_.size(), bands_.size(), 0.0});
  bands_.push_back({z0, z1, r0, slope, rim, r1 * r1, rim_});
  bodies_.back().end = bands_.size();
  bodies_.back().rim = std::max(bodies_.back().rim, rim);
  rim_ = std::max(rim_, rim);
}

Frusta::Frusta(const Profile& profile, Length chord, Length shrink) {
  std::vector<Knot> points;
  for (std::size_t k = 0; k + 1 < profile.knots.size(); ++k) {
    const Knot& a = profile.knots[k];
    const Knot& b = profile.knots[k + 1];
    const double angle = 4.0 * std::atan(a.bulge);
    const double span = std::hypot(b.r - a.r, b.z - a.z);
    double count = 1.0;
    if (std::abs(angle) > 0.0 && span > 0.0) {
      const double radius = 0.5 * span / std::sin(0.5 * std::abs(angle));
      const double turn = 2.0 * std::acos(std::max(1.0 - chord.mm() / radius, 0.0));
      count = std::clamp(std::ceil(std::abs(angle) / std::max(turn, 1e-6)), 1.0, kMaxChords);
    }
    // Points of the arc are found by rotating its chord; a straight segment is one step.
    for (double n = 1.0; n <= count; ++n) {
      const double fraction = n / count;
      double r1 = a.r + fraction * (b.r - a.r), z1 = a.z + fraction * (b.z - a.z);
      if (count > 1.0) {
        // From a, the chord to the point at `fraction` is rotated by half of the remaining angle of the arc.
        const double reach = span * std::sin(0.5 * angle * fraction) / std::sin(0.5 * angle);
        const double turn = -0.5 * angle * (1.0 - fraction);
        const double ux = (b.r - a.r) / span, uz = (b.z - a.z) / span;
        r1 = a.r + reach * (ux * std::cos(turn) - uz * std::sin(turn));
        z1 = a.z + reach * (ux * std::sin(turn) + uz * std::cos(turn));
      }
      if (points.empty()) points.push_back({a.r, a.z, 0.0});
      points.push_back({r1, z1, 0.0});
    }
  }
  add_bands(points, shrink.mm());
}

/// Faces that look down are raised, those that look up are lowered, and all are moved towards the axis.
void Frusta::add_bands(const std::vector<Knot>& points, double less) {
  const auto moved = [&](std::size_t n) {
    const bool is_first = n == 0, is_last = n + 1 == points.size();
    const bool down =
        is_first || points[n].r > points[n - 1].r || (!is_last && points[n + 1].r > points[n].r);
    const bool up =
        (!is_first && points[n].r < points[n - 1].r) || (!is_last && points[n + 1].r < points[n].r);
    return Knot{points[n].r - less, points[n].z + (down ? less : 0.0) - (up ? less : 0.0), 0.0};
  };
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    const Knot a = moved(n), b = moved(n + 1);
    add_band(a.r, a.z, b.r, b.z);
  }
}

double Frusta::rim_below(double height) const {
  if (bands_.empty() || height >= bands_.back().high) return rim_;
  const auto above = std::upper_bound(bands_.begin(), bands_.end(), height,
                                      [](double h, const Band& band) { return h < band.low; });
  if (above == bands_.begin()) return 0.0;
  const Band& band = *(above - 1);
  const double reached = std::min(height, band.high) - band.low;
  return std::max(band.rim_before, band.radius + std::max(band.slope, 0.0) * reached);
}

/// The part of [low, high] of a ray inside a band.
bool Frusta::cross(const Band& band, const TiltedRay& ray, double low, double high, RayInterval& out) {
  if (ray.x * ray.x >= band.rim * band.rim ||
      !clip_between(ray.z, ray.cosine, band.low, band.high, low, high))
    return false;
  const double radius = band.radius + band.slope * (ray.z - band.low), turn = band.slope * ray.cosine;
  if (!clip_quadratic(ray.sine * ray.sine - turn * turn, ray.y * ray.sine - radius * turn,
                      ray.x * ray.x + ray.y * ray.y - radius * radius, low, high) ||
      !(high > low))
    return false;
  out = {low, high};
  return true;
}

/// The number, within the body, of the first band at whose upper end a rising ray is inside, from where it
/// starts; that of no band if there is none.
std::size_t Frusta::first_entered(const Body& body, const TiltedRay& ray) const {
  const double lean = ray.sine / ray.cosine, y0 = ray.y - ray.z * lean, x_square = ray.x * ray.x;
  for (std::size_t n = body.first; n < body.end; ++n) {
    const double y = y0 + bands_[n].high * lean;
    if (x_square + y * y < bands_[n].top_square && bands_[n].high > ray.z) return n - body.first;
  }
  return body.end - body.first;
}

bool Frusta::intersect(std::size_t body, const TiltedRay& ray, double reach, RayInterval& out) const {
  const std::size_t first = bodies_[body].first, end = bodies_[body].end;
  const double rim = bodies_[body].rim;
  double start = 0.0, stop = reach;
  if (ray.x * ray.x >= rim * rim ||
      !clip_between(ray.z, ray.cosine, bands_[first].low, bands_[end - 1].high, start, stop))
    return false;
  // A rising ray enters through the lowest band that it crosses and leaves through the highest one.
  const bool rises = ray.cosine > 0.0;
  const std::size_t count = end - first;
  const auto band = [&](std::size_t n) -> const Band& { return bands_[rises ? first + n : end - 1 - n]; };
  // By convexity no band below the first one that it is inside of at its upper end is entered.
  std::size_t n = count > 2 && ray.cosine > kLevel ? first_entered(bodies_[body], ray) : 0;
  if (n == count || !cross(band(n), ray, start, stop, out)) n = 0;
  while (n < count && !cross(band(n), ray, start, stop, out)) ++n;
  if (n == count) return false;
  RayInterval last{};
  const bool is_level = std::abs(ray.cosine) < kLevel;
  for (std::size_t m = count; --m > n;) {
    if (!cross(band(m), ray, start, stop, last)) continue;
    out = {std::min(out.low, last.low), std::max(out.high, last.high)};
    if (!is_level) break;
  }
  return true;
}

/// The radius at a height; the lines of the lowest and the highest band continue beyond them.
double Frusta::radius_at(const Body& body, double height) const {
  const auto from = bands_.begin() + static_cast<std::ptrdiff_t>(body.first) + 1;
  const auto to = bands_.begin() + static_cast<std::ptrdiff_t>(body.end);
  const Band& band =
      *(std::upper_bound(from, to, height, [](double h, const Band& b) { return h < b.low; }) - 1);
  return band.radius + band.slope * (height - band.low);
}

double Frusta::shortfall(std::size_t body, const TiltedRay& ray, double reach) const {
  const Body& found = bodies_[body];
  const double bottom = bands_[found.first].low, top = bands_[found.end - 1].high;
  const auto lack = [&](double r) {
    const double y = ray.y + r * ray.sine, z = ray.z + r * ray.cosine;
    return std::max({std::sqrt(ray.x * ray.x + y * y) - radius_at(found, z), bottom - z, z - top});
  };
  double low = 0.0, high = reach, a = low + kGolden * (high - low), b = high - kGolden * (high - low);
  double at_a = lack(a), at_b = lack(b);
  for (int n = 0; n < kNarrowings && std::min(at_a, at_b) > 0.0; ++n) {
    if (at_a < at_b) {
      high = std::exchange(b, a);
      at_b = at_a;
      at_a = lack(a = low + kGolden * (high - low));
    } else {
      low = std::exchange(a, b);
      at_a = at_b;
      at_b = lack(b = high - kGolden * (high - low));
    }
  }
  return std::min(at_a, at_b);
}

}  // namespace kerf::sim
