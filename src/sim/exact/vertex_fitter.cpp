// Fitting a vertex. Points on the triangles around it are projected onto the surfaces of the sweeps; each
// gives a plane, and the vertex moves to the intersection of the planes. If the surfaces are curved, this is
// repeated with points much closer to the new position.
#include "sim/exact/vertex_fitter.h"

#include <algorithm>
#include <cmath>

namespace kerf::sim {
namespace {

// All in pitches.
constexpr double kFirstDistance = 0.45;  // of samples from the vertex: within the square of its corner
constexpr double kSecondDistance = 0.1;  // of samples from its new position: surfaces are nearly flat there
constexpr double kHalfSquare = 0.5;
constexpr double kOnSide = 1e-9;  // excess over the side of the square or the block that is rounding
constexpr double kMaxMoved = 1.2;
constexpr double kMaxSpan = 10.0;
constexpr double kMaxRefined = 0.6;
constexpr double kMaxError = 0.02;  // of a new position, from the surfaces

/// Points closer to a surface are on it, mm: a tenth of the single precision of a mesh.
constexpr double kOnSurface = 1e-7;
/// Depth below a surface at which its normal is evaluated, mm: much more than kOnSurface, much less than any
/// radius.
constexpr double kIntoMaterial = 1e-5;
constexpr int kResamples = 3;
constexpr int kMaxSteps = 12;  // of Newton's method; the distance is nearly linear
/// A point deeper in the removed volume than kMaxDepth first moves into the material, by kInwardStep at a
/// time. Both are fractions of the maximum distance.
constexpr double kInwardStep = 0.15, kMaxDepth = 1e-3;
/// Minimum squared length of the gradient without the fixed axes: below, the intersection with the surface is
/// too far away.
constexpr double kMinGain = 0.05;
/// Minimum cosine of the angle between the normals of a surface and of the triangle projected onto it.
constexpr double kSameSide = 0.1;
/// Triangles around a vertex are one surface if their normals are within this angle of the mean (cosine, 11
/// degrees).
constexpr double kSmooth = 0.98;
/// A triangle lies on a side of the block if a component of its normal exceeds this.
constexpr double kAxisAligned = 0.9999;
/// Triangles with normals within this angle (cosine, 1.1 degrees) are in one plane.
constexpr double kOnePlane = 0.9998;
/// Surfaces are flat if chord * angle between two samples is at most this fraction of the tolerance.
constexpr double kFlat = 1.0;
/// Minimum eigenvalue of a direction that the planes determine, as a fraction of the largest: planes that
/// differ by less than 6 degrees are one curved surface.
constexpr double kMinEigenvalue = 0.003;

enum class From : std::uint8_t { either_side, material };

Point3 without_fixed(Point3 vector, const std::array<bool, 3>& fixed) {
  for (int axis = 0; axis < 3; ++axis)
    if (fixed[static_cast<std::size_t>(axis)]) vector[axis] = 0.0;
  return vector;
}

/// Newton's method on the signed distance; From::material first moves the point into the material.
bool find_surface(const NearbySweeps& nearby, From from, double max_distance, Point3 inwards,
                  const std::array<bool, 3>& fixed, Point3& point, Point3& normal) {
  Distance distance = nearby.at(point);
  for (int n = 0; n < kMaxSteps; ++n) {
    if (std::abs(distance.value) > max_distance) return false;
    if (from == From::material && distance.value < -kMaxDepth * max_distance) {
      point = point + (kInwardStep * max_distance - distance.value) * without_fixed(inwards, fixed);
      distance = nearby.at(point);
      continue;
    }
    const Point3 slope = without_fixed(distance.gradient, fixed);
    const double gain = dot(slope, slope);
    if (gain < kMinGain) return false;
    point = point - (distance.value / gain) * slope;
    // Evaluated slightly inside the material, as the gradient is not defined on a surface that an edge of the
    // tool sweeps.
    distance = nearby.at(point + kIntoMaterial * inwards);
    distance.value -= kIntoMaterial * dot(distance.gradient, inwards);
    if (std::abs(distance.value) > kOnSurface) continue;
    const double steepness = length(distance.gradient);
    normal = (-1.0 / steepness) * distance.gradient;
    return steepness > 0.0;
  }
  return false;
}

}  // namespace

bool project_to_surface(const NearbySweeps& nearby, double max_distance, Point3 outwards,
                        const std::array<bool, 3>& fixed, Point3& point, Point3& normal) {
  const Point3 start = point;
  const Point3 inwards = (-1.0 / length(outwards)) * outwards;
  // Inside several sweeps the distance is only a bound of the depth: then from the material's side.
  for (const From from : {From::either_side, From::material}) {
    point = start;
    if (find_surface(nearby, from, max_distance, inwards, fixed, point, normal) &&
        distance(point, start) <= max_distance && dot(normal, outwards) >= kSameSide * length(outwards))
      return true;
  }
  return false;
}

/// Adds the stock's own surface: of a block the side that faces like the triangle, else the triangle's plane.
void VertexFitter::add_stock_plane(Point3 from, Point3 normal) {
  if (!is_block_) return of_stock_.push_back({from, normal, normal});
  // Not on X or Y sides: the top or the bottom. If the triangle is slanted, the mesh of the columns took the
  // step to a neighbouring column for a slope.
  int axis = 2;
  for (const int other : {0, 1})
    if (std::abs(normal[other]) > kAxisAligned) axis = other;
  Sample side{from, {}, {}};
  side.at[axis] = normal[axis] > 0.0 ? size_[axis] : 0.0;
  side.normal[axis] = std::copysign(1.0, normal[axis]);
  if (std::abs(side.at[axis] - from[axis]) <= max_move_) of_stock_.push_back(side);
}

void VertexFitter::find_samples(std::uint32_t vertex, Point3 from) {
  samples_.clear();
  of_stock_.clear();
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, normal) == 0.0) return;
    if (mesh_.step(triangle) == kStockSurface) return add_stock_plane(from, normal);
    // One sample per plane is enough if it is also the plane of the surface.
    for (const Sample& sample : samples_)
      if (dot(sample.triangle_normal, normal) > kOnePlane && dot(sample.normal, normal) > kOnePlane) return;
    const Point3 vector = mesh_.centroid(triangle) - from;
    const double far = length(vector);
    Sample sample{from + std::min(1.0, kFirstDistance * pitch_ / far) * vector, {}, normal};
    if (project(sample, normal)) samples_.push_back(sample);
  });
  if (!samples_.empty() || of_stock_.empty()) return;
  // All triangles have kStockSurface, but the edge to a steep cut may be near: the mesh of the columns has a
  // slope of the stock there.
  Point3 outwards;
  mesh_.around(vertex, [&](std::uint32_t triangle) { outwards = outwards + mesh_.normal(triangle); });
  Sample sample{from, {}, {}};
  if (length(outwards) > 0.0 && project(sample, outwards)) samples_.push_back(sample);
}

double surface_error_in_block(const NearbySweeps& nearby, Point3 size, Point3 point) {
  double outside = -nearby.at(point).value;
  for (int axis = 0; axis < 3; ++axis) outside = std::max({outside, -point[axis], point[axis] - size[axis]});
  return std::abs(outside);
}

double VertexFitter::surface_error(Point3 point) const {
  return is_block_ ? surface_error_in_block(*nearby_, size_, point) : std::abs(nearby_->at(point).value);
}

/// Fixes the axes of the block's sides that the vertex lies on; Z only if a triangle of the uncut top or
/// bottom is at the vertex.
void VertexFitter::fix_axes(std::uint32_t vertex, Point3 from) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_low = from[axis] <= kOnBlock, is_high = from[axis] >= size_[axis] - kOnBlock;
    corner_[axis] = std::round(from[axis] / pitch_) * pitch_;
    bool& fixed = fixed_[static_cast<std::size_t>(axis)];
    fixed = axis < 2 && (is_low || is_high);
    if (axis < 2 || (!is_low && !is_high)) continue;
    mesh_.around(vertex, [&](std::uint32_t triangle) {
      if (mesh_.step(triangle) == kStockSurface && std::abs(mesh_.normal(triangle).z) > 0.999) fixed = true;
    });
  }
}

Quadric VertexFitter::quadric_at(Point3 from, const Fixed& fixed) const {
  Quadric quadric;
  for (const auto* list : {&samples_, &of_stock_})
    for (const Sample& sample : *list) quadric.add(sample.normal, dot(sample.normal, sample.at - from));
  for (int axis = 0; axis < 3; ++axis)
    if (fixed[static_cast<std::size_t>(axis)]) quadric.fix(axis);
  return quadric;
}

/// The largest distance of a point from the planes.
double VertexFitter::plane_error(Point3 at) const {
  double largest = 0.0;
  for (const auto* list : {&samples_, &of_stock_})
    for (const Sample& sample : *list)
      largest = std::max(largest, std::abs(dot(sample.normal, at - sample.at)));
  return largest;
}

/// The least-squares intersection of the planes (see Quadric) within the corner's square and the block. If it
/// is outside, the axis with the largest excess is fixed at the side and the rest solved again.
Point3 VertexFitter::intersection(Point3 from, int rank) const {
  Fixed fixed = fixed_;
  Point3 to = from;
  for (int n = 0; n <= 3; ++n) {
    to = from + quadric_at(from, fixed).solve(rank, kMinEigenvalue);
    int worst = -1;
    double worst_excess = kOnSide * pitch_;
    for (int axis = 0; axis < 3; ++axis) {
      const double excess = std::abs(to[axis] - within(axis, to[axis]));
      if (fixed[static_cast<std::size_t>(axis)] || excess <= worst_excess) continue;
      worst = axis;
      worst_excess = excess;
    }
    if (worst < 0) break;
    from[worst] = within(worst, to[worst]);
    fixed[static_cast<std::size_t>(worst)] = true;
    to = from;
  }
  return to;
}

/// A coordinate clamped to the corner's square, the block and the deepest cut.
double VertexFitter::within(int axis, double value) const {
  if (axis < 2)
    value = std::clamp(value, corner_[axis] - kHalfSquare * pitch_, corner_[axis] + kHalfSquare * pitch_);
  return std::clamp(value, axis == 2 ? min_z_ : 0.0, size_[axis]);
}

Point3 VertexFitter::best_intersection(Point3 from) const {
  for (int rank = quadric_at(from, fixed_).rank(kMinEigenvalue); rank > 0; --rank) {
    const Point3 to = intersection(from, rank);
    if (distance(from, to) <= max_move_ && (rank == 1 || plane_error(to) <= kMaxError * pitch_)) return to;
  }
  return from;
}

/// Projects again from points closer to `from`, where curved surfaces are nearly flat.
void VertexFitter::resample_around(Point3 from) {
  std::size_t kept = 0;
  for (const Sample& sample : samples_) {
    const Point3 vector = sample.at - from;
    const double far = length(vector);
    Sample nearer{far > 0.0 ? from + std::min(1.0, kSecondDistance * pitch_ / far) * vector : from, {}, {}};
    if (project(nearer, sample.normal)) samples_[kept++] = nearer;
  }
  samples_.resize(kept);
}

/// Whether the triangles around a vertex belong to one smooth surface; `outwards`: its normal.
bool VertexFitter::is_smooth(std::uint32_t vertex, Point3& outwards) const {
  Point3 sum;
  bool stock = false, cut = false;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    sum = sum + mesh_.normal(triangle);
    (mesh_.step(triangle) == kStockSurface ? stock : cut) = true;
  });
  if (stock || !cut) return false;
  const double size = length(sum);
  if (size <= 0.0) return false;
  outwards = (1.0 / size) * sum;
  bool smooth = true;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, normal) > 0.0 && dot(normal, outwards) < kSmooth) smooth = false;
  });
  return smooth;
}

Point3 VertexFitter::fit_smooth(Point3 from, Point3 outwards) {
  Sample sample{from, {}, {}};
  return sim::project_to_surface(*nearby_, kMaxProjected * pitch_, outwards, fixed_, sample.at, sample.normal)
             ? sample.at
             : from;
}

/// Whether the surfaces between the samples are flat within the tolerance.
bool VertexFitter::is_flat_enough() const {
  for (const Sample& one : samples_)
    for (const Sample& other : samples_) {
      if (dot(one.normal, other.normal) < kSmooth) continue;
      // The sagitta is chord * angle / 8, but the vertex may be as far beyond the samples as they are apart.
      if (distance(one.at, other.at) * distance(one.normal, other.normal) > kFlat * tolerance_) return false;
    }
  return true;
}

/// On steep surfaces neighbouring columns differ much in height, and so may a vertex from its true position.
double VertexFitter::max_move_of(std::uint32_t vertex, Point3 from) const {
  double span = 0.0;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    span = std::max(span, 1.5 * std::abs(mesh_.centroid(triangle).z - from.z));
  });
  return kMaxMoved * pitch_ + std::min(span, kMaxSpan * pitch_);
}

Point3 VertexFitter::fit_edge(std::uint32_t vertex, Point3 from, SweepFinder& finder) {
  max_move_ = max_move_of(vertex, from);
  find_samples(vertex, from);
  if (samples_.empty() && of_stock_.empty()) return from;
  Point3 to = best_intersection(from);
  if (distance(from, to) > kFirstDistance * pitch_) nearby_ = &finder.all(to);
  for (int n = 0; n < kResamples && !is_flat_enough(); ++n) {
    resample_around(to);
    const Point3 better = best_intersection(to);
    if (distance(to, better) > kMaxRefined * pitch_) break;
    to = better;
  }
  const double after = surface_error(to);
  return after <= kMaxError * pitch_ || after < surface_error(from) ? to : from;
}

Point3 VertexFitter::fit(std::uint32_t vertex, SweepFinder& finder) {
  const Point3 from = mesh_.point(vertex);
  fix_axes(vertex, from);
  min_z_ = from.z >= lowest_cut_ ? std::max(lowest_cut_, 0.0) : 0.0;
  Point3 outwards;
  if (is_smooth(vertex, outwards)) {
    nearby_ = &finder.of_columns(from);
    return fit_smooth(from, outwards);
  }
  nearby_ = &finder.all(from);
  return fit_edge(vertex, from, finder);
}

}  // namespace kerf::sim
