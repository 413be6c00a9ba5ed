// Cuts outlines into dashes by their length.
#include "front/outline/dashes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::outline_front {
namespace {

constexpr double kMaxDashes = 100'000.0;  // dashes of one outline: more take minutes as areas

/// The ends of segments by their distance from the start.
std::vector<double> distances(const Outline& outline) {
  std::vector<double> out{0.0};
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    out.push_back(out.back() + length(Outline{outline.point(i), {outline.segments[i]}}).mm());
  }
  return out;
}

class Cutter {
 public:
  explicit Cutter(const Outline& outline) : outline_(outline), ends_(distances(outline)) {}
  double whole() const { return ends_.back(); }

  /// The part between two distances from the start, the second not before the first.
  Dash piece(double from, double to) const {
    std::size_t i = segment_at(from);
    Dash made;
    const CurvePoint first_point = at(i, from);
    made.outline.start = first_point.at;
    made.direction = {std::cos(first_point.heading.rad()), std::sin(first_point.heading.rad())};
    for (; i < outline_.segments.size() && ends_[i] < to; ++i) {
      const double first = std::max(from, ends_[i]), last = std::min(to, ends_[i + 1]);
      if (!(last > first)) continue;
      Segment segment{last == ends_[i + 1] ? outline_.segments[i].to : at(i, last).at, {}};
      if (outline_.segments[i].via) segment.via = at(i, 0.5 * (first + last)).at;
      made.outline.segments.push_back(segment);
    }
    return made;
  }

 private:
  std::size_t segment_at(double at) const {
    const auto next = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, at);
    return static_cast<std::size_t>(next - ends_.begin()) - 1;
  }
  CurvePoint at(std::size_t i, double along) const {
    return at_length(Outline{outline_.point(i), {outline_.segments[i]}}, mm(along - ends_[i]));
  }

  const Outline& outline_;
  const std::vector<double> ends_;
};

}  // namespace

std::optional<std::vector<Dash>> dashed(const Outline& outline, const std::vector<double>& pattern,
                                        double offset) {
  const double period = std::accumulate(pattern.begin(), pattern.end(), 0.0);
  const Cutter cutter(outline);
  const double whole = cutter.whole();
  std::vector<Dash> out;
  if (!(whole > 0.0)) return std::vector{Dash{outline}};
  if (!(period > 0.0) || static_cast<double>(pattern.size()) * (whole / period) > kMaxDashes)
    return std::nullopt;
  double phase = std::fmod(offset, period);
  if (phase < 0.0) phase += period;
  std::size_t k = 0;
  while (phase >= pattern[k] && phase > 0.0) {
    phase -= pattern[k];
    k = (k + 1) % pattern.size();
  }
  const bool starts = k % 2 == 0;
  bool ends = false;
  double at = 0.0;
  for (double left = pattern[k] - phase; at < whole; k = (k + 1) % pattern.size(), left = pattern[k]) {
    const double next = std::min(at + left, whole);
    ends = k % 2 == 0 && at + left >= whole;
    if (k % 2 == 0) out.push_back(cutter.piece(at, next));
    at = next;
  }
  if (outline.closed() && starts && ends && out.size() > 1) {
    Outline& last = out.back().outline;
    const Outline& first = out.front().outline;
    last.segments.insert(last.segments.end(), first.segments.begin(), first.segments.end());
    out.erase(out.begin());
  }
  return out;
}

}  // namespace kerf::outline_front
