// The diameter of an unknown tool, derived from the distances between adjacent cuts: at points spread evenly
// over the cuts, the distances to the nearest parallel cut on the left and on the right.
#include "path/assumed_tool.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace kerf {
namespace {

constexpr std::size_t kMaxSegments = 200'000;  // of the first cuts; the pattern does not change after them
constexpr std::size_t kMaxCells = 400'000;     // entries of the grid
constexpr std::size_t kSamples = 1500;         // points at which distances are measured
constexpr std::size_t kMaxHoles = 1500;
constexpr double kSmallestCell = 0.25;  // mm
constexpr double kReach = 16.0;         // mm; more distant cuts are not adjacent
constexpr double kSamePass = 0.02;      // mm; closer cuts are the same pass at another depth
constexpr double kParallel = 0.9;       // cosine between adjacent passes
constexpr double kEqual = 0.1;          // relative difference of the distances on both sides in a pattern
/// Fractions of the samples: this many make a pattern; the distance of this quantile is the narrowest one.
constexpr double kPatternFraction = 0.1, kNarrowest = 0.1, kNarrowestStepover = 0.25;
constexpr double kOverStepover = 1.25;  // diameter / stepover: no ridges remain between passes
constexpr double kOverSpacing = 0.5;    // diameter / spacing: half of the material between cuts remains
/// Adjacent cuts in a pattern are at half of its stepover or more; closer ones are not part of it.
constexpr double kWithinPattern = 0.5 * kOverSpacing / kOverStepover;
constexpr double kSlenderness = 10.0;                              // deepest cut / diameter, at most
constexpr double kThinnest = 0.05, kThickest = 25.0;               // mm
constexpr double kNone = std::numeric_limits<double>::infinity();  // no adjacent cut
constexpr double kChordTurn = 0.35;                                // radians of an arc, as one segment
constexpr double kSpareFlute = 1.0;                                // mm above the highest cut

struct Segment {
  Point2 from, to;
  double length = 0.0;
};

/// The cuts of one tool in the XY plane.
struct Cuts {
  std::vector<Segment> segments;
  std::vector<Point2> holes;  // where the tool plunges
  bool sideways = false;
  double lowest = 0.0, highest = 0.0;  // Z, with Z0

  void add(Point2 from, Point2 to) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    if (segments.size() < kMaxSegments && length > 0.0) segments.push_back({from, to, length});
  }
};

Cuts cuts_of(const Toolpath& path, std::optional<int> tool) {
  constexpr unsigned kXY = 3, kAxisZ = 4;
  Cuts cuts;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if (!s.is_cutting() || context.tool != tool) return;
    if ((s.unknown_axes() & kAxisZ) == 0) {
      cuts.lowest = std::min(cuts.lowest, s.to().z);
      cuts.highest = std::max(cuts.highest, s.to().z);
    }
    if (((s.unknown_axes() | context.unknown_from) & kXY) != 0) return;
    const Point2 from{context.from.x, context.from.y}, to{s.to().x, s.to().y};
    if (s.kind() != StepKind::arc && distance(from, to) <= kSamePass) {
      if (s.to().z < context.from.z && cuts.holes.size() < kMaxHoles) cuts.holes.push_back(to);
      return;
    }
    cuts.sideways = true;
    if (s.kind() != StepKind::arc) return cuts.add(from, to);
    const ArcWalk walk = walk_of(s, context.from);
    const double turn = std::min(std::abs(walk.sweep), 100.0);
    const int chords = std::max(1, static_cast<int>(std::ceil(turn / kChordTurn)));
    Point3 last = context.from;
    for (int i = 1; i <= chords; ++i) {
      const Point3 at = walk.at(static_cast<double>(i) / chords);
      cuts.add({last.x, last.y}, {at.x, at.y});
      last = at;
    }
  });
  return cuts;
}

/// The segments in the square cells of a grid that they touch.
class SegmentGrid {
 public:
  explicit SegmentGrid(const std::vector<Segment>& segments) : segments_(segments) {
    double length = 0.0;
    Box2 box;
    for (const Segment& s : segments) {
      length += s.length;
      box.add(s.from);
      box.add(s.to);
    }
    const double area = std::max(box.high.x - box.low.x, 1.0) * std::max(box.high.y - box.low.y, 1.0);
    // Two passes per cell, as far as the number of cells allows.
    cell_ = std::max(std::clamp(2.0 * area / length, kSmallestCell, kReach),
                     2.0 * length / static_cast<double>(kMaxCells));
    for (std::uint32_t i = 0; i < segments.size(); ++i) add(i);
    std::sort(entries_.begin(), entries_.end());
    entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  }

  /// The distance from `at` in the direction of `ray` (length 1) to the nearest segment across it; kNone if
  /// there is none within kReach.
  double distance_along(Point2 at, Point2 ray) const {
    double nearest = kNone;
    std::uint64_t last = ~std::uint64_t{0};
    for (double t = 0.0; t <= std::min(nearest, kReach) + cell_; t += 0.25 * cell_) {
      const std::uint64_t key = key_of({at.x + t * ray.x, at.y + t * ray.y});
      if (key == std::exchange(last, key)) continue;
      auto it = std::lower_bound(entries_.begin(), entries_.end(), std::pair{key, std::uint32_t{0}});
      for (; it != entries_.end() && it->first == key; ++it)
        nearest = std::min(nearest, crossing(segments_[it->second], at, ray));
    }
    return nearest <= kReach ? nearest : kNone;
  }

 private:
  static std::uint64_t cell_index(double v) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v)) & 0xffffffff);
  }
  std::uint64_t key_of(Point2 p) const { return cell_index(p.x / cell_) << 32 | cell_index(p.y / cell_); }

  void add(std::uint32_t i) {
    const Segment& s = segments_[i];
    const int pieces = std::max(1, static_cast<int>(std::min(std::ceil(s.length / cell_), 1e6)));
    Point2 from = s.from;
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      const Point2 to{s.from.x + t * (s.to.x - s.from.x), s.from.y + t * (s.to.y - s.from.y)};
      for (const double x : {from.x, to.x})
        for (const double y : {from.y, to.y}) entries_.emplace_back(key_of({x, y}), i);
      from = to;
    }
  }

  /// The distance at which a ray meets a segment that is roughly at right angles to it; kNone if it does not.
  static double crossing(const Segment& s, Point2 at, Point2 ray) {
    const Point2 along{s.to.x - s.from.x, s.to.y - s.from.y}, start{s.from.x - at.x, s.from.y - at.y};
    const double across = ray.x * along.y - ray.y * along.x;
    if (std::abs(across) < kParallel * s.length) return kNone;
    const double t = (start.x * along.y - start.y * along.x) / across;
    const double u = (start.x * ray.y - start.y * ray.x) / across;
    return t > kSamePass && u >= 0.0 && u <= 1.0 ? t : kNone;
  }

  const std::vector<Segment>& segments_;
  double cell_ = 1.0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> entries_;  // cell and segment, sorted
};

/// Distances to adjacent cuts at the samples.
struct Distances {
  std::vector<double> nearest;  // of every sample, kNone included
  std::vector<double> pattern;  // of samples with the same distance on both sides
};

Distances distances_of(const std::vector<Segment>& segments) {
  Distances found;
  double length = 0.0;
  for (const Segment& s : segments) length += s.length;
  if (!(length > 0.0) || !std::isfinite(length)) return found;
  const SegmentGrid grid(segments);
  const double spacing = length / static_cast<double>(kSamples);
  double next = 0.5 * spacing, done = 0.0;
  for (const Segment& s : segments) {
    const double end = done + s.length;
    for (; next < end && found.nearest.size() < kSamples; next += spacing) {
      const double t = (next - done) / s.length;
      const Point2 way{(s.to.x - s.from.x) / s.length, (s.to.y - s.from.y) / s.length};
      const Point2 at{s.from.x + t * (s.to.x - s.from.x), s.from.y + t * (s.to.y - s.from.y)};
      const double left = grid.distance_along(at, {-way.y, way.x});
      const double right = grid.distance_along(at, {way.y, -way.x});
      found.nearest.push_back(std::min(left, right));
      if (std::max(left, right) < kNone && std::abs(left - right) <= kEqual * std::min(left, right))
        found.pattern.push_back(std::min(left, right));
    }
    done = end;
  }
  return found;
}

double quantile(std::vector<double>& values, double fraction) {
  if (values.empty()) return kNone;
  const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The smallest distance between two holes.
double hole_distance(const std::vector<Point2>& holes) {
  double nearest = kNone;
  for (std::size_t i = 0; i < holes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const double d = distance(holes[i], holes[k]);
      if (d > kSamePass) nearest = std::min(nearest, d);
    }
  return nearest;
}

/// Rounded down to two digits.
double tidy(double diameter) {
  const double unit = std::pow(10.0, std::floor(std::log10(diameter)) - 1.0);
  return std::floor(diameter / unit + 1e-6) * unit;
}

std::pair<double, AssumedDiameter> diameter_for(const Cuts& cuts) {
  const double usual = kUsualDiameter.mm();
  if (!cuts.sideways) {
    const double apart = kOverSpacing * hole_distance(cuts.holes);
    return apart < usual ? std::pair{apart, AssumedDiameter::spacing}
                         : std::pair{usual, AssumedDiameter::usual};
  }
  Distances found = distances_of(cuts.segments);
  const bool pattern = static_cast<double>(found.pattern.size()) >=
                       kPatternFraction * static_cast<double>(found.nearest.size());
  std::pair<double, AssumedDiameter> chosen{usual, AssumedDiameter::usual};
  if (pattern && !found.pattern.empty())
    chosen = {kOverStepover * quantile(found.pattern, kNarrowestStepover), AssumedDiameter::stepover};
  const double apart = kOverSpacing * quantile(found.nearest, kNarrowest);
  const bool within_pattern = pattern && apart > kWithinPattern * chosen.first;
  if (apart < chosen.first && !within_pattern) chosen = {apart, AssumedDiameter::spacing};
  const double thinnest = std::min(usual, (cuts.highest - cuts.lowest) / kSlenderness);
  chosen.first = std::max(chosen.first, thinnest);
  return chosen;
}

}  // namespace

AssumedTool assume_tool(const Toolpath& path, std::optional<int> tool) {
  const Cuts cuts = cuts_of(path, tool);
  auto [diameter, basis] = diameter_for(cuts);
  diameter = std::clamp(diameter, kThinnest, kThickest);
  if (basis != AssumedDiameter::usual) diameter = tidy(diameter);
  const double flute =
      std::max(usual_flute(mm(diameter)).mm(), std::ceil(cuts.highest - cuts.lowest + kSpareFlute));
  return {shape::Square{mm(diameter), mm(flute)}, mm(diameter), basis};
}

}  // namespace kerf
