// Winding numbers of the faces between parts, and the outline of those that a rule selects.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "arrangement.h"

namespace kerf::region_detail {
namespace {

/// Grows with the angle of a direction, from -2 at -x over 0 at +x to 2.
double pseudo_angle(Point2 d) {
  const double cosine = d.x / (std::abs(d.x) + std::abs(d.y));
  return d.y < 0.0 || (d.y == 0.0 && d.x < 0.0) ? -1.0 + cosine : 1.0 - cosine;
}

}  // namespace

// -------------------------------------------------------------------------------------- order around points

Arrangement::Leaving Arrangement::leaving(std::uint32_t end) const {
  const Part& part = parts_[end >> 1];
  const Edge& e = edges()[part.edge];
  const bool forward = (end & 1) == 0;
  const Point2 v = forward ? points_[part.to] - points_[part.from] : points_[part.from] - points_[part.to];
  const double chord = norm(v);
  const double curvature = e.is_arc() ? (forward ? e.turn : -e.turn) / e.radius : 0.0;
  return {(1.0 / chord) * v, chord, curvature};
}

/// Counter-clockwise from -x (or -y). The directions at the point decide; where they are nearly equal, those
/// to points of the curves half way along the shorter one, as they may meet again at its end. Curves are
/// compared at least the tolerance away from the point.
void Arrangement::sort_ends_at(std::uint32_t* first, std::uint32_t* last, Axis from) const {
  struct Spoke {
    double angle;
    Leaving out;
    std::uint32_t end;
  };
  constexpr double kNearlyOne = 1e-3;
  const auto count = static_cast<std::size_t>(last - first);
  std::vector<Spoke> many;
  Spoke few[8];
  if (count > 8) many.resize(count);
  Spoke* spokes = count > 8 ? many.data() : few;
  for (std::size_t i = 0; i < count; ++i) {
    const Leaving out = leaving(first[i]);
    const bool curls = std::abs(out.curvature) * weld_ > 0.1 * kNearlyOne;
    const Point2 d =
        direction_at(out.unit, out.chord, out.curvature, curls ? std::min(weld_, 0.5 * out.chord) : 0.0);
    spokes[i] = {pseudo_angle(from == Axis::x ? d : Point2{d.y, -d.x}), out, first[i]};
  }
  std::sort(spokes, spokes + count, [](const Spoke& a, const Spoke& b) { return a.angle < b.angle; });
  const auto wrong = [](const Spoke& a, const Spoke& b) {
    const double ahead = 0.5 * std::min(a.out.chord, b.out.chord);
    const auto at = [&](const Leaving& l) { return direction_at(l.unit, l.chord, l.curvature, ahead); };
    return cross(at(a.out), at(b.out)) < 0.0;
  };
  for (std::size_t pass = 0; pass < std::min<std::size_t>(count, 64); ++pass) {
    bool moved = false;
    for (std::size_t i = 0; i < count; ++i) {
      Spoke &a = spokes[i], &b = spokes[i + 1 < count ? i + 1 : 0];
      const double gap = i + 1 < count ? b.angle - a.angle : b.angle - a.angle + 4.0;
      if (gap > kNearlyOne || !wrong(a, b)) continue;
      std::swap(a.out, b.out);  // the angles stay: they are the same but for rounding
      std::swap(a.end, b.end);
      moved = true;
    }
    if (!moved) break;
  }
  for (std::size_t i = 0; i < count; ++i) first[i] = spokes[i].end;
}

void Arrangement::sort_ends() {
  for (std::size_t point = 0; point < points_.size(); ++point)
    if (point_ends_[point + 1] - point_ends_[point] > 2)
      sort_ends_at(&ends_[point_ends_[point]], ends_.data() + point_ends_[point + 1], Axis::x);
}

// ------------------------------------------------------------------------------------------ winding numbers

/// Winding numbers of one component, relative to that of its first part.
bool Arrangement::spread_from(std::uint32_t root, std::uint32_t number) {
  walk_.assign(1, {ends_[point_ends_[root]], {}});
  component_[root] = number;
  const Point2 at = points_[root];
  Component made{root, root, {at, at}, {}, {}};
  for (std::size_t next = 0; next < walk_.size(); ++next) {
    const Step step = walk_[next];
    const std::uint32_t point = point_of(step.end);
    const Point2 p = points_[point];
    if (p.x < made.box.low.x) made.box.low.x = p.x, made.leftmost = point;
    if (p.y < made.box.low.y) made.box.low.y = p.y, made.lowest = point;
    made.box.high.x = std::max(made.box.high.x, p.x);
    made.box.high.y = std::max(made.box.high.y, p.y);
    if (!spread_around(step)) return false;
  }
  components_.push_back(made);
  return true;
}

/// Sets winding numbers around a point, counter-clockwise from an end whose left one is known. False where a
/// part already has another one.
bool Arrangement::spread_around(const Step& known) {
  const std::uint32_t point = point_of(known.end);
  const std::uint32_t first = point_ends_[point], count = point_ends_[point + 1] - first;
  std::uint32_t at = 0;
  while (ends_[first + at] != known.end) ++at;
  Winding left = known.left;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t end = ends_[first + at];
    if (++at == count) at = 0;
    Part& part = parts_[end >> 1];
    const bool forward = (end & 1) == 0;
    const Winding right = left;
    Winding own;
    for (int g = 0; g < 2; ++g) {
      const std::int32_t step = forward ? part.step.of[g] : -part.step.of[g];
      // The first one's left is known; the right of each other is the left of the one before.
      if (k > 0) left.of[g] = right.of[g] + step;
      own.of[g] = forward ? left.of[g] : left.of[g] + part.step.of[g];
    }
    if (part.known) {
      if (!(part.left == own)) return false;
      continue;
    }
    part.known = true;
    part.left = own;
    const std::uint32_t other = point_of(end ^ 1);
    if (component_[other] != kNone) continue;
    component_[other] = component_[point];
    walk_.push_back({end ^ 1, left_of_end(end ^ 1)});
  }
  return true;
}

bool Arrangement::spread_windings() {
  component_.assign(points_.size(), kNone);
  components_.clear();
  for (std::uint32_t point = 0; point < points_.size(); ++point)
    if (component_[point] == kNone && point_ends_[point] != point_ends_[point + 1] &&
        !spread_from(point, static_cast<std::uint32_t>(components_.size())))
      return false;
  return true;
}

/// The winding number outside of a component, at its extreme point along the axis.
Winding Arrangement::outside(std::uint32_t point, Axis axis) const {
  std::vector<std::uint32_t> ends(ends_.data() + point_ends_[point], ends_.data() + point_ends_[point + 1]);
  sort_ends_at(ends.data(), ends.data() + ends.size(), axis);
  return left_of_end(ends.back());
}

/// Components whose leftmost point is in the box of another: only these can have others around them.
std::vector<std::uint32_t> Arrangement::enclosed_components() const {
  std::vector<std::uint32_t> found;
  if (components_.size() < 2) return found;
  std::vector<Box2> boxes;
  for (const Component& c : components_)  // arcs may reach a little beyond the ends of parts
    boxes.push_back(c.box.grown(weld_));
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < components_.size(); ++i) {
    const Point2 p = points_[components_[i].leftmost];
    bool enclosed = false;
    tree.query({p, p}, [&](std::uint32_t other) { enclosed |= other != i; });
    if (enclosed) found.push_back(i);
  }
  return found;
}

/// The winding number outside of a component, from a ray through the others.
Winding Arrangement::around(const Component& c, std::uint32_t number, Axis axis, bool by_counting) const {
  Ray ray{points_[axis == Axis::x ? c.leftmost : c.lowest], number, kNone, {}};
  if (!by_counting) return cast(ray, axis);
  count(ray, axis);
  return ray.winding;
}

/// From left to right, so that the first part that a ray meets has its winding numbers. A second ray, from
/// another point and along the other axis, must have the same result.
bool Arrangement::locate_enclosed(const std::vector<std::uint32_t>& enclosed, bool by_counting) {
  for (const std::uint32_t i : enclosed) {
    Component& c = components_[i];
    const Winding around_it = around(c, i, Axis::x, by_counting);
    for (int g = 0; g < 2; ++g) c.offset.of[g] = around_it.of[g] - c.outside.of[g];
  }
  return std::all_of(enclosed.begin(), enclosed.end(), [&](std::uint32_t i) {
    const Component& c = components_[i];
    const Winding around_it = around(c, i, Axis::y, by_counting);
    return around_it.of[0] - c.outside.of[0] == c.offset.of[0] &&
           around_it.of[1] - c.outside.of[1] == c.offset.of[1];
  });
}

/// From relative to absolute winding numbers.
bool Arrangement::locate_components() {
  bool changes = false;
  for (Component& c : components_) {
    c.outside = outside(c.leftmost, Axis::x);
    if (!(outside(c.lowest, Axis::y) == c.outside)) return false;
    for (int g = 0; g < 2; ++g) c.offset.of[g] = -c.outside.of[g];
    changes = changes || !(c.offset == Winding{});
  }
  std::vector<std::uint32_t> enclosed = enclosed_components();
  if (!enclosed.empty()) {
    std::sort(enclosed.begin(), enclosed.end(), [&](std::uint32_t a, std::uint32_t b) {
      return components_[a].box.low.x < components_[b].box.low.x;
    });
    if (!locate_enclosed(enclosed, false) && !locate_enclosed(enclosed, true)) return false;
    changes = true;
  }
  for (Part& part : parts_) {
    if (!changes) break;
    if (part.kept)
      for (int g = 0; g < 2; ++g) part.left.of[g] += components_[component_[part.from]].offset.of[g];
  }
  for (Component& c : components_) c.offset = {};
  return true;
}

// ------------------------------------------------------------------------------------------------- outlines

std::vector<Arrangement::Loop> Arrangement::follow(const std::vector<std::int8_t>& sides) const {
  std::vector<std::uint32_t> index(2 * parts_.size());  // of an end among those of its point
  for (std::size_t point = 0; point < points_.size(); ++point)
    for (std::uint32_t k = point_ends_[point]; k < point_ends_[point + 1]; ++k)
      index[ends_[k]] = k - point_ends_[point];
  // The inside is clockwise from the part that arrives; it ends at the part that leaves, so that loops that
  // touch in a point stay separate. Consistent winding numbers have as many leaving parts as arriving ones.
  const auto after = [&](Link link) {
    const std::uint32_t arrival = 2 * link.part + (link.forward ? 1 : 0), point = point_of(arrival);
    const std::uint32_t first = point_ends_[point], count = point_ends_[point + 1] - first;
    std::uint32_t at = index[arrival], end = arrival;
    do {
      at = at == 0 ? count - 1 : at - 1;
      end = ends_[first + at];
    } while (sides[end >> 1] == 0);
    assert(sides[end >> 1] == ((end & 1) == 0 ? 1 : -1));
    return Link{end >> 1, (end & 1) == 0};
  };
  std::vector<Loop> loops;
  std::vector<bool> used(parts_.size(), false);
  for (std::uint32_t first = 0; first < parts_.size(); ++first) {
    if (sides[first] == 0 || used[first]) continue;
    Loop loop;
    for (Link link{first, sides[first] > 0}; !used[link.part]; link = after(link)) {
      used[link.part] = true;
      loop.push_back(link);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

Point2 Arrangement::point_on(const Part& part, double fraction) const {
  const Point2 a = points_[part.from], v = points_[part.to] - a;
  const Edge& e = edges()[part.edge];
  const Point2 on_chord = a + fraction * v;
  if (!e.is_arc()) return on_chord;
  const double chord2 = dot(v, v), rr = std::max(e.radius * e.radius, 0.25 * chord2);
  const double off = (fraction - 0.5) * (fraction - 0.5) * chord2;  // squared, from the midpoint of the chord
  const double height = (0.25 * chord2 - off) / (std::sqrt(rr - off) + std::sqrt(rr - 0.25 * chord2));
  return on_chord + (e.turn * height / std::sqrt(chord2)) * Point2{v.y, -v.x};
}

/// Whether a ray from a point of a part has the winding number of the part on that side.
bool Arrangement::confirms(std::uint32_t number, double fraction) const {
  const Part& part = parts_[number];
  const Point2 v = points_[part.to] - points_[part.from];
  const Axis axis = std::abs(v.y) >= std::abs(v.x) ? Axis::x : Axis::y;
  Ray ray{point_on(part, fraction), kNone, number, {}};
  // The ray starts to the left of an upward part, and to the right of one towards +x.
  const Winding expected = (axis == Axis::x ? v.y > 0.0 : v.x < 0.0) ? part.left : part.right();
  if (cast(ray, axis) == expected) return true;
  count(ray, axis);
  return ray.winding == expected;
}

bool Arrangement::confirms(const std::vector<Loop>& loops) const {
  const auto size = [&](Link link) {
    const Part& part = parts_[link.part];
    const Point2 v = points_[part.to] - points_[part.from];
    return dot(v, v);
  };
  const auto is_located = [&](Link link) {  // where the rays of its component started
    const Part& part = parts_[link.part];
    const std::uint32_t leftmost = components_[component_[part.from]].leftmost;
    return part.from == leftmost || part.to == leftmost;
  };
  return std::all_of(loops.begin(), loops.end(), [&](const Loop& loop) {
    if (std::any_of(loop.begin(), loop.end(), is_located)) return true;
    const Link longest =
        *std::max_element(loop.begin(), loop.end(), [&](Link a, Link b) { return size(a) < size(b); });
    // Another curve may touch the part where a ray starts, but not everywhere.
    return confirms(longest.part, 0.4142) || confirms(longest.part, 0.7321) || confirms(longest.part, 0.2361);
  });
}

}  // namespace kerf::region_detail
