// Where a vertex goes: surfaces near it are looked for on the triangles around it, each gives a plane, and
// the vertex goes to where the planes meet; then once more from there with places much nearer to it.
#include "sim/exact/vertex_fitter.h"

#include <algorithm>
#include <cmath>

namespace kerf::sim {
namespace {

// All in pitches.
constexpr double kFirstLook = 0.45;  // from the vertex: within the square of its corner
constexpr double kSecondLook = 0.1;  // from its new place: curves are planes there
constexpr double kHalfSquare = 0.5;
constexpr double kOnSide = 1e-9;  // of the square or the block: no further out
constexpr double kMaxMoved = 1.2;
constexpr double kMaxSpan = 10.0;
constexpr double kMaxRefined = 0.6;
constexpr double kMissed = 0.02;  // a new place that is further off all surfaces is none

/// Places closer to a surface are on it, mm: a tenth of what single precision of a mesh tells.
constexpr double kOnSurface = 1e-7;
/// How far from a surface its normal is looked for, mm: far more than kOnSurface, far less than any radius.
constexpr double kIntoMaterial = 1e-5;
constexpr int kCloserLooks = 3;
constexpr int kMaxSteps = 12;  // of Newton's method; the distance is nearly linear
/// Share of the most that a place may move by which it goes into the material at a time, if it is deeper than
/// the other share in what is cut away.
constexpr double kInwards = 0.15, kShallow = 1e-3;
/// A surface that the fixed axes leave less of its slope than this (squared) is met too far away.
constexpr double kMinGain = 0.05;
/// The normal of the surface and of the triangle that looks for it agree by at least this cosine.
constexpr double kSameSide = 0.1;
/// Triangles around a vertex that face so nearly the same way (cosine, 11 degrees) are one surface.
constexpr double kSmooth = 0.98;
/// A side of the block, by the larger part of its normal.
constexpr double kUpright = 0.9999;
/// And so nearly (1.1 degrees) one plane.
constexpr double kOnePlane = 0.9998;
/// Surfaces that bend less than this share of the tolerance between places are planes.
constexpr double kFlat = 1.0;
/// A direction in which planes pull by less than this share of the strongest tells nothing: planes that are
/// less than 6 degrees apart are one curved surface.
constexpr double kMinShare = 0.003;

enum class From : std::uint8_t { either_side, material };

Point3 freed(Point3 way, const std::array<bool, 3>& fixed) {
  for (int axis = 0; axis < 3; ++axis)
    if (fixed[static_cast<std::size_t>(axis)]) way[axis] = 0.0;
  return way;
}

/// Newton's method; `from` the material's side it first goes there.
bool find_surface(const Nearby& nearby, From from, double most, Point3 inwards,
                  const std::array<bool, 3>& fixed, Point3& place, Point3& normal) {
  Distance distance = nearby.at(place);
  for (int n = 0; n < kMaxSteps; ++n) {
    if (std::abs(distance.value) > most) return false;
    if (from == From::material && distance.value < -kShallow * most) {
      place = place + (kInwards * most - distance.value) * freed(inwards, fixed);
      distance = nearby.at(place);
      continue;
    }
    const Point3 way = freed(distance.gradient, fixed);
    const double gain = dot(way, way);
    if (gain < kMinGain) return false;
    place = place - (distance.value / gain) * way;
    // A little inside, since an edge of the tool sweeps a surface of its own, which is only told from there.
    distance = nearby.at(place + kIntoMaterial * inwards);
    distance.value -= kIntoMaterial * dot(distance.gradient, inwards);
    if (std::abs(distance.value) > kOnSurface) continue;
    const double steepness = length(distance.gradient);
    normal = (-1.0 / steepness) * distance.gradient;
    return steepness > 0.0;
  }
  return false;
}

}  // namespace

bool put_on_surface(const Nearby& nearby, double most, Point3 outwards, const std::array<bool, 3>& fixed,
                    Point3& place, Point3& normal) {
  const Point3 begin = place;
  const Point3 inwards = (-1.0 / length(outwards)) * outwards;
  // What is cut away by several sweeps is deeper than any of them tells; then from the material's side.
  for (const From from : {From::either_side, From::material}) {
    place = begin;
    if (find_surface(nearby, from, most, inwards, fixed, place, normal) && distance(place, begin) <= most &&
        dot(normal, outwards) >= kSameSide * length(outwards))
      return true;
  }
  return false;
}

/// The stock's own surface: of a block its side that faces nearly so, else the triangle's plane.
void Placer::add_stock_plane(Point3 from, Point3 normal) {
  if (!is_block_) return of_stock_.push_back({from, normal, normal});
  // Of what is no side of the block the columns have taken the step to the next one for a slope.
  int axis = 2;
  for (const int other : {0, 1})
    if (std::abs(normal[other]) > kUpright) axis = other;
  Sample side{from, {}, {}};
  side.at[axis] = normal[axis] > 0.0 ? size_[axis] : 0.0;
  side.normal[axis] = std::copysign(1.0, normal[axis]);
  if (std::abs(side.at[axis] - from[axis]) <= most_moved_) of_stock_.push_back(side);
}

void Placer::find_samples(std::uint32_t vertex, Point3 from) {
  samples_.clear();
  of_stock_.clear();
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, normal) == 0.0) return;
    if (mesh_.step(triangle) == kStockSurface) return add_stock_plane(from, normal);
    // Of triangles in one plane one is enough, if that is the surface's own.
    for (const Sample& sample : samples_)
      if (dot(sample.looking, normal) > kOnePlane && dot(sample.normal, normal) > kOnePlane) return;
    const Point3 way = mesh_.middle(triangle) - from;
    const double far = length(way);
    Sample sample{from + std::min(1.0, kFirstLook * pitch_ / far) * way, {}, normal};
    if (put_on_surface(sample, normal)) samples_.push_back(sample);
  });
  if (!samples_.empty() || of_stock_.empty()) return;
  // The columns have taken what was cut for a slope of the stock: the edge between them is near.
  Point3 outwards;
  mesh_.around(vertex, [&](std::uint32_t triangle) { outwards = outwards + mesh_.normal(triangle); });
  Sample sample{from, {}, {}};
  if (length(outwards) > 0.0 && put_on_surface(sample, outwards)) samples_.push_back(sample);
}

double miss_in_block(const Nearby& nearby, Point3 size, Point3 place) {
  double outside = -nearby.at(place).value;
  for (int axis = 0; axis < 3; ++axis) outside = std::max({outside, -place[axis], place[axis] - size[axis]});
  return std::abs(outside);
}

double Placer::miss_at(Point3 place) const {
  return is_block_ ? miss_in_block(*nearby_, size_, place) : std::abs(nearby_->at(place).value);
}

/// What lies on the block's sides stays there, and what lies on its top or bottom if these are left there.
void Placer::fix_axes(std::uint32_t vertex, Point3 from) {
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

Quadric Placer::quadric_at(Point3 from, const Fixed& fixed) const {
  Quadric quadric;
  for (const auto* list : {&samples_, &of_stock_})
    for (const Sample& sample : *list) quadric.add(sample.normal, dot(sample.normal, sample.at - from));
  for (int axis = 0; axis < 3; ++axis)
    if (fixed[static_cast<std::size_t>(axis)]) quadric.fix(axis);
  return quadric;
}

/// How far a place is from the planes, at most.
double Placer::miss_of(Point3 at) const {
  double most = 0.0;
  for (const auto* list : {&samples_, &of_stock_})
    for (const Sample& sample : *list) most = std::max(most, std::abs(dot(sample.normal, at - sample.at)));
  return most;
}

/// The place in the corner's square and in the block that lies best on the planes, as far as so many
/// directions tell. Where the nearest such place is outside, the vertex goes along the side.
Point3 Placer::solved(Point3 from, int directions) const {
  Fixed fixed = fixed_;
  Point3 to = from;
  for (int n = 0; n <= 3; ++n) {
    to = from + quadric_at(from, fixed).step(directions, kMinShare);
    int worst = -1;
    double most = kOnSide * pitch_;
    for (int axis = 0; axis < 3; ++axis) {
      const double out = std::abs(to[axis] - within(axis, to[axis]));
      if (fixed[static_cast<std::size_t>(axis)] || out <= most) continue;
      worst = axis;
      most = out;
    }
    if (worst < 0) break;
    from[worst] = within(worst, to[worst]);
    fixed[static_cast<std::size_t>(worst)] = true;
    to = from;
  }
  return to;
}

/// A coordinate kept in the corner's square and in the block.
double Placer::within(int axis, double value) const {
  if (axis < 2)
    value = std::clamp(value, corner_[axis] - kHalfSquare * pitch_, corner_[axis] + kHalfSquare * pitch_);
  return std::clamp(value, 0.0, size_[axis]);
}

Point3 Placer::best_step(Point3 from) const {
  for (int directions = quadric_at(from, fixed_).directions(kMinShare); directions > 0; --directions) {
    const Point3 to = solved(from, directions);
    if (distance(from, to) <= most_moved_ && (directions == 1 || miss_of(to) <= kMissed * pitch_)) return to;
  }
  return from;
}

/// Looks for the surfaces again at places that are nearer, where curved ones are as good as planes.
void Placer::look_closer(Point3 from) {
  std::size_t kept = 0;
  for (const Sample& sample : samples_) {
    const Point3 way = sample.at - from;
    const double far = length(way);
    Sample nearer{far > 0.0 ? from + std::min(1.0, kSecondLook * pitch_ / far) * way : from, {}, {}};
    if (put_on_surface(nearer, sample.normal)) samples_[kept++] = nearer;
  }
  samples_.resize(kept);
}

/// Whether the triangles around a vertex are those of one curved surface, and where it faces.
bool Placer::is_smooth(std::uint32_t vertex, Point3& outwards) const {
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

Point3 Placer::on_smooth(Point3 from, Point3 outwards) {
  Sample sample{from, {}, {}};
  return sim::put_on_surface(*nearby_, kMaxProjected * pitch_, outwards, fixed_, sample.at, sample.normal)
             ? sample.at
             : from;
}

/// Whether the surfaces bend so little between the places that planes stand for them.
bool Placer::is_flat_enough() const {
  for (const Sample& one : samples_)
    for (const Sample& other : samples_) {
      if (dot(one.normal, other.normal) < kSmooth) continue;
      // A circle strays from its chord by an eighth of the chord times the angle between its ends; the
      // vertex may be as far beyond the places as they are apart.
      if (distance(one.at, other.at) * distance(one.normal, other.normal) > kFlat * tolerance_) return false;
    }
  return true;
}

/// On steep places columns are far apart in height, and so may a vertex be from where it belongs.
double Placer::most_moved(std::uint32_t vertex, Point3 from) const {
  double span = 0.0;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    span = std::max(span, 1.5 * std::abs(mesh_.middle(triangle).z - from.z));
  });
  return kMaxMoved * pitch_ + std::min(span, kMaxSpan * pitch_);
}

Point3 Placer::on_edge(std::uint32_t vertex, Point3 from, Around& around) {
  most_moved_ = most_moved(vertex, from);
  find_samples(vertex, from);
  if (samples_.empty() && of_stock_.empty()) return from;
  Point3 to = best_step(from);
  if (distance(from, to) > kFirstLook * pitch_) nearby_ = &around.all(to);
  for (int n = 0; n < kCloserLooks && !is_flat_enough(); ++n) {
    look_closer(to);
    const Point3 better = best_step(to);
    if (distance(to, better) > kMaxRefined * pitch_) break;
    to = better;
  }
  const double after = miss_at(to);
  return after <= kMissed * pitch_ || after < miss_at(from) ? to : from;
}

Point3 Placer::place(std::uint32_t vertex, Around& around) {
  const Point3 from = mesh_.point(vertex);
  fix_axes(vertex, from);
  Point3 outwards;
  if (is_smooth(vertex, outwards)) {
    nearby_ = &around.of_columns(from);
    return on_smooth(from, outwards);
  }
  nearby_ = &around.all(from);
  return on_edge(vertex, from, around);
}

}  // namespace kerf::sim
