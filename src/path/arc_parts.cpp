// Arcs in parts.
#include "path/arc_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf {

bool can_be_divided(const Step& s, const PathPosition& from) {
  const PlaneAxes axes = axes_of(s.arc().plane);
  const unsigned unknown = from.unknown | s.unknown_axes(), third = 1u << axes.w;
  if ((unknown & ~third) != 0) return false;
  if (unknown == 0) return true;
  // At one unknown height all points are; between a known and an unknown one none is known.
  return from.unknown == third && s.unknown_axes() == third && s.to()[axes.w] == from.at[axes.w];
}

std::vector<Point3> chords_of(const Step& s, Point3 from, Length chord, int limit) {
  const ArcWalk walk = walk_of(s, from);
  const int count = std::max(walk.chords(chord, limit), 1);
  std::vector<Point3> ends;
  ends.reserve(static_cast<std::size_t>(count));
  for (int k = 1; k < count; ++k) ends.push_back(walk.at(static_cast<double>(k) / count));
  ends.push_back(s.to());
  return ends;
}

ArcPart arc_part(const step::Arc& arc, const ArcWalk& walk, double t0, double t1, Point3 from, Point3 to) {
  const double swept = std::abs(walk.sweep) * (t1 - t0);
  const double once = std::abs(walk_arc(from, to, arc.centre, arc.plane, arc.turn, 0).sweep);
  // As an arc without further turns the part sweeps `once`, which differs from `swept` by whole turns.
  const double turns = std::round((swept - once) / (2.0 * std::numbers::pi));
  if (turns < 0.0) {
    if (from == to) return {};
    return step::Cut{to, arc.feed};
  }
  step::Arc part = arc;
  part.to = to;
  part.extra_turns = static_cast<int>(turns);
  return part;
}

bool add_part(Toolpath& out, const ArcPart& part, OriginId origin) {
  if (const auto* arc = std::get_if<step::Arc>(&part)) return out.add(*arc, origin), true;
  if (const auto* cut = std::get_if<step::Cut>(&part)) return out.add(*cut, origin), true;
  return false;
}

}  // namespace kerf
