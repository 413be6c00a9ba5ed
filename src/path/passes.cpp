// Common functions of the passes, and the passes over one or two steps.
#include "kerf/path/passes.h"

#include <cmath>
#include <optional>

#include "path/chain.h"

#include "kerf/path/report.h"

namespace kerf {

namespace detail {

PassFigures figures_of(const Toolpath& path) {
  const MotionFigures all = report_on(path, {}).all;
  return {path.size(), all.cut_mm, all.rapid_mm};
}

PassResult finished(const Toolpath& before, Toolpath after) {
  PassResult result;
  result.before = figures_of(before);
  result.after = figures_of(after);
  result.path = std::move(after);
  return result;
}

bool is_plain(const Toolpath& path, std::size_t i) {
  return path[i].unknown_axes() == 0 && path.extra(i) == nullptr;
}

bool chains(const Toolpath& path, std::size_t i, std::size_t first) {
  return i < path.size() && path[i].kind() == path[first].kind() && path[i].feed() == path[first].feed() &&
         is_plain(path, i);
}

double distance_to_segment(Point3 p, Point3 a, Point3 b) {
  const Point3 way = b - a;
  const double square = dot(way, way);
  const double t = square > 0.0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
  return distance(p, a + t * way);
}

}  // namespace detail

PassResult arcs_to_chords(const Toolpath& path, Length chord) {
  Toolpath out;
  detail::StartPosition start;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    if (s.kind() != StepKind::arc) {
      out.add_copy(path, i);
    } else {
      const ArcWalk walk = walk_of(s, start.at);
      const int count = walk.chords(chord);
      const OriginId origin = out.copy_origin(path, i);
      const MotionExtra* extra = path.extra(i);
      for (int k = 1; k <= count; ++k) {
        const Point3 to = k == count ? s.to() : walk.at(static_cast<double>(k) / count);
        const std::size_t added = out.add(step::Cut{to, s.feed()}, origin);
        if (s.unknown_axes() != 0) out.set_unknown_axes(added, s.unknown_axes());
        if (extra != nullptr) out.set_extra(added, *extra);
      }
    }
    start.pass(s);
  }
  return detail::finished(path, std::move(out));
}

namespace {

/// True if the chain from `first` to `last` (inclusive) can be one straight step: every point lies near it,
/// in increasing order along it.
bool is_straight(const Toolpath& path, Point3 from, std::size_t first, std::size_t last, double tolerance) {
  const Point3 to = path[last].to();
  const Point3 way = to - from;
  double along = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    const Point3 p = path[i].to();
    const double here = dot(p - from, way);
    if (here < along || detail::distance_to_segment(p, from, to) > tolerance) return false;
    along = here;
  }
  return dot(way, way) >= along;
}

constexpr std::size_t kMaxChain = 256;  // bounds the time, which grows with its square

}  // namespace

PassResult join_straight(const Toolpath& path, Length tolerance) {
  Toolpath out;
  detail::StartPosition start;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool straight = path[i].kind() == StepKind::cut || path[i].kind() == StepKind::rapid;
    std::size_t last = i;
    if (straight && detail::is_plain(path, i) && start.is_known())
      while (last - i < kMaxChain && detail::chains(path, last + 1, i) &&
             is_straight(path, start.at, i, last + 1, tolerance.mm()))
        ++last;
    if (last == i) {
      out.add_copy(path, i);
    } else {
      const OriginId origin = out.copy_origin(path, i);
      if (path[i].kind() == StepKind::cut)
        out.add(step::Cut{path[last].to(), path[last].feed()}, origin);
      else
        out.add(step::Rapid{path[last].to()}, origin);
    }
    i = last;
    start.pass(path[i]);
  }
  return detail::finished(path, std::move(out));
}

namespace {

/// True if rapid `i` goes straight up from `from` and rapid `i + 1` straight down.
bool goes_up_and_down(const Toolpath& path, std::size_t i, Point3 from) {
  if (i + 1 >= path.size() || path[i + 1].kind() != StepKind::rapid) return false;
  if (!detail::is_plain(path, i) || !detail::is_plain(path, i + 1)) return false;
  const Point3 up = path[i].to(), down = path[i + 1].to();
  return up.xy() == from.xy() && down.xy() == from.xy() && up.z >= from.z && down.z <= up.z;
}

}  // namespace

PassResult shorten_rapids(const Toolpath& path) {
  Toolpath out;
  detail::StartPosition start;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    const bool rapid = s.kind() == StepKind::rapid && start.is_known() && detail::is_plain(path, i);
    if (rapid && s.to() == start.at) continue;
    if (rapid && goes_up_and_down(path, i, start.at)) {
      // The second one alone ends at the same position, along the path of both.
      if (path[i + 1].to() != start.at) out.add_copy(path, i + 1);
      ++i;
    } else {
      out.add_copy(path, i);
    }
    start.pass(path[i]);
  }
  return detail::finished(path, std::move(out));
}

Toolpath without_unused_first_tool(const Toolpath& path) {
  if (path.size() == 0 || path[0].kind() != StepKind::tool_change) return path;
  for (std::size_t i = 1; i < path.size() && path[i].kind() != StepKind::tool_change; ++i)
    if (path[i].is_motion() && path[i].kind() != StepKind::rapid) return path;
  Toolpath out;
  for (std::size_t i = 1; i < path.size(); ++i) out.add_copy(path, i);
  return out;
}

}  // namespace kerf
