// Following a mesh with a tool.
#include "op/mesh/surface_path.h"

#include <algorithm>
#include <cmath>

namespace kerf::op_detail {
namespace {

// Between two positions of the tool that cut nothing, a disc of radius R leaves uncut what is up to d^2 / 8R
// inside of its sweep.
constexpr double kBetween = 0.1;        // of the tolerance, of that depth
constexpr double kMaxPitch = 0.25;      // of the tool's radius
constexpr double kMinPitch = 2.0;       // of the tolerance: half of it on both sides of a point
constexpr double kMaxDeviation = 0.25;  // of the tolerance: of a sample from the chord of its neighbours
constexpr double kMinInterval = 0.5;    // of the tolerance, that is not halved
constexpr double kMaxSamples = 1e7;     // of one line

}  // namespace

double sample_pitch(const SurfaceTool& tool, double tolerance) {
  const double end = std::max(tool.flat, tool.corner);
  const double pitch = std::sqrt(8.0 * end * kBetween * tolerance);
  return std::max(std::min(pitch, kMaxPitch * tool.radius), kMinPitch * tolerance);
}

SurfaceFollower::SurfaceFollower(const DropCutter& cutter, double floor, double tolerance)
    : cutter_(cutter), floor_(floor), tolerance_(tolerance), pitch_(sample_pitch(cutter.tool(), tolerance)) {}

void SurfaceFollower::refine(std::vector<Sample>& samples, Point2 from, Point2 along) const {
  const double deviation = kMaxDeviation * tolerance_, smallest = kMinInterval * tolerance_;
  std::vector<Sample> finer;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
      const Sample &a = samples[i - 1], &b = samples[i], &c = samples[i + 1];
      const double chord = a.z + (c.z - a.z) * (b.s - a.s) / (c.s - a.s);
      if (std::abs(b.z - chord) > deviation) samples[i - 1].split = samples[i].split = true;
    }
    finer.clear();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const bool split = samples[i].split && i + 1 < samples.size();
      finer.push_back({samples[i].s, samples[i].z, false});
      if (!split || samples[i + 1].s - samples[i].s <= smallest) continue;
      const double s = 0.5 * (samples[i].s + samples[i + 1].s);
      finer.push_back({s, cutter_.at(from + s * along, floor_), false});
      changed = true;
    }
    samples.swap(finer);
    if (static_cast<double>(samples.size()) > kMaxSamples) return;
  }
}

std::vector<SurfaceFollower::Sample> SurfaceFollower::with_jumps(const std::vector<Sample>& samples) const {
  std::vector<Sample> made;
  const double deviation = kMaxDeviation * tolerance_, smallest = kMinInterval * tolerance_;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    made.push_back(samples[i]);
    if (i + 1 == samples.size()) break;
    const Sample &a = samples[i], &b = samples[i + 1];
    if (b.s - a.s > smallest || std::abs(a.z - b.z) <= deviation) continue;
    made.push_back(a.z < b.z ? Sample{a.s, b.z, false} : Sample{b.s, a.z, false});
  }
  return made;
}

void SurfaceFollower::thin(const std::vector<Sample>& samples, std::size_t first, std::size_t last,
                           std::vector<Sample>& kept) const {
  Sample start = samples[first];
  kept.push_back(start);
  double low = -INFINITY, high = INFINITY;  // slopes from `start` that are above all samples, but not too far
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double run = samples[i].s - start.s, lower = (samples[i].z - start.z) / run;
    const double upper = lower + tolerance_ / run;
    if (lower > high || upper < low) {
      const double s = samples[i - 1].s;
      start = {s, std::max(start.z + low * (s - start.s), samples[i - 1].z), false};
      kept.push_back(start);
      const double next = samples[i].s - s;
      low = (samples[i].z - start.z) / next, high = low + tolerance_ / next;
    } else {
      low = std::max(low, lower), high = std::min(high, upper);
    }
  }
  if (last == first) return;
  const double s = samples[last].s;
  kept.push_back({s, std::max(start.z + low * (s - start.s), samples[last].z), false});
}

std::vector<Point3> SurfaceFollower::follow(Point2 from, Point2 to) const {
  const double whole = distance(from, to);
  if (!(whole > 0.0)) return {{from.x, from.y, cutter_.at(from, floor_)}};
  const Point2 along = (1.0 / whole) * (to - from);
  const double count = std::clamp(std::ceil(whole / pitch_), 2.0, kMaxSamples);
  std::vector<Sample> samples;
  for (double i = 0.0; i <= count; i += 1.0) {
    const double s = whole * (i / count);
    samples.push_back({s, cutter_.at(from + s * along, floor_), false});
  }
  refine(samples, from, along);
  samples = with_jumps(samples);
  std::vector<Sample> kept;
  for (std::size_t first = 0; first < samples.size();) {
    std::size_t last = first;
    while (last + 1 < samples.size() && samples[last + 1].s > samples[last].s) ++last;
    thin(samples, first, last, kept);
    first = last + 1;
  }
  std::vector<Point3> points;
  for (const Sample& sample : kept) {
    const Point2 at = sample.s >= whole ? to : from + sample.s * along;
    points.push_back({at.x, at.y, sample.z});
  }
  return points;
}

}  // namespace kerf::op_detail
