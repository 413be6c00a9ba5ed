// Distances, boundaries and intervals of rectangles, circles and slots.
#include "region_pieces.h"

#include <algorithm>
#include <numbers>

namespace kerf::exact_pieces {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double norm(Point2 v) { return std::sqrt(dot(v, v)); }

}  // namespace

double Piece::distance_to(Point2 p) const {
  const Point2 q = own(p);
  const double x = std::abs(q.x) - a, y = std::abs(q.y) - b;
  if (!is_rectangle) return norm({std::max(x, 0.0), q.y}) - b;
  return norm({std::max(x, 0.0), std::max(y, 0.0)}) + std::min(std::max(x, y), 0.0);
}

Outline Piece::outline() const {
  const auto line = [&](double x, double y) { return Segment{world({x, y}), {}}; };
  const auto arc = [&](double x, double y, double via_x, double via_y) {
    return Segment{world({x, y}), world({via_x, via_y})};
  };
  Outline made;
  if (is_rectangle) {
    made.start = world({-a, -b});
    made.segments = {line(a, -b), line(a, b), line(-a, b), line(-a, -b)};
  } else if (a == 0.0) {
    made.start = world({b, 0.0});
    made.segments = {arc(-b, 0.0, 0.0, b), arc(b, 0.0, 0.0, -b)};
  } else {
    made.start = world({-a, -b});
    made.segments = {line(a, -b), arc(a, b, a + b, 0.0), line(-a, b), arc(-a, -b, -a - b, 0.0)};
  }
  return made;
}

Point2 Side::at(double t) const {
  if (!is_arc) return from + t * (to - from);
  const double angle = first + t * sweep;
  return centre + radius * Point2{std::cos(angle), std::sin(angle)};
}

Point2 Side::outwards(double t) const {
  if (is_arc) {
    const double angle = first + t * sweep;
    return {std::cos(angle), std::sin(angle)};
  }
  const Point2 d = to - from;
  const double length = norm(d);
  return {d.y / length, -d.x / length};
}

std::vector<Side> sides_of(const Piece& p, std::uint32_t number) {
  std::vector<Side> made;
  const auto line = [&](Point2 from, Point2 to) {
    made.push_back({number, false, p.world(from), p.world(to), {}, 0.0, 0.0, 0.0});
  };
  const double heading = std::atan2(p.axis.y, p.axis.x);
  const auto arc = [&](double x, double first, double sweep) {
    made.push_back({number, true, {}, {}, p.world({x, 0.0}), p.b, heading + first, sweep});
  };
  const double a = p.a, b = p.b;
  if (p.is_rectangle) {
    line({-a, -b}, {a, -b});
    line({a, -b}, {a, b});
    line({a, b}, {-a, b});
    line({-a, b}, {-a, -b});
  } else if (a == 0.0) {
    arc(0.0, 0.0, kTurn);
  } else {
    line({-a, -b}, {a, -b});
    arc(a, -0.25 * kTurn, 0.5 * kTurn);
    line({a, b}, {-a, b});
    arc(-a, 0.25 * kTurn, 0.5 * kTurn);
  }
  return made;
}

double Stretch::distance_to(Point2 p, double limit) const {
  if (!side.is_arc) {
    const Point2 a = at(0.0), d = at(1.0) - a;
    const double dd = dot(d, d);
    const double t = dd > 0.0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0.0;
    return norm(p - (a + t * d));
  }
  const Point2 q = p - side.centre;
  if (const double off = std::abs(norm(q) - side.radius); off >= limit) return off;
  double turned = std::atan2(q.y, q.x) - (side.first + first * side.sweep);
  turned -= kTurn * std::floor(turned / kTurn);
  if (turned <= (last - first) * side.sweep) return std::abs(norm(q) - side.radius);
  return std::min(norm(p - at(0.0)), norm(p - at(1.0)));
}

// ---------------------------------------------------------------------------------------------- expressions

bool Expression::combined(Boolean what, bool first, bool second) {
  switch (what) {
    case Boolean::unite: return first || second;
    case Boolean::intersect: return first && second;
    case Boolean::subtract: return first && !second;
    case Boolean::exclude: break;
  }
  return first != second;
}

bool Expression::has(const std::vector<bool>& inside) const {
  const auto first = inside.begin() + static_cast<std::ptrdiff_t>(first_count);
  return combined(what, std::find(inside.begin(), first, true) != first,
                  std::find(first, inside.end(), true) != inside.end());
}

bool Expression::has(Point2 p) const {
  bool in[2] = {false, false};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    bool& group = in[i < first_count ? 0 : 1];
    group = group || pieces[i].distance_to(p) <= 0.0;
  }
  return combined(what, in[0], in[1]);
}

bool Expression::is_clear(Point2 p, double margin) const {
  return std::all_of(pieces.begin(), pieces.end(),
                     [&](const Piece& piece) { return std::abs(piece.distance_to(p)) > margin; });
}

namespace {

/// Parameters where a side meets the line through a point, or the circle about it (`radius` > 0).
void meet_line(const Side& side, Point2 point, Point2 direction, std::vector<double>& at) {
  const Point2 normal{-direction.y, direction.x};
  if (!side.is_arc) {
    const double from = dot(side.from - point, normal), to = dot(side.to - point, normal);
    if (from != to) at.push_back(from / (from - to));
    return;
  }
  const double off = dot(side.centre - point, normal);
  if (std::abs(off) > side.radius) return;
  const double heading = std::atan2(normal.y, normal.x), half = std::acos(-off / side.radius);
  for (const double angle : {heading + half, heading - half}) {
    double turned = angle - side.first;
    turned -= kTurn * std::floor(turned / kTurn);
    at.push_back(turned / side.sweep);
  }
}

void meet_circle(const Side& side, Point2 centre, double radius, std::vector<double>& at) {
  if (!side.is_arc) {
    const Point2 d = side.to - side.from, q = side.from - centre;
    const double a = dot(d, d), b = dot(d, q), c = dot(q, q) - radius * radius;
    const double root = b * b - a * c;
    if (root < 0.0) return;
    at.push_back((-b - std::sqrt(root)) / a);
    at.push_back((-b + std::sqrt(root)) / a);
    return;
  }
  const Point2 between = centre - side.centre;
  const double d = norm(between);
  if (d == 0.0) return;
  const double cosine = (side.radius * side.radius + d * d - radius * radius) / (2.0 * side.radius * d);
  if (std::abs(cosine) > 1.0) return;
  const double heading = std::atan2(between.y, between.x), half = std::acos(cosine);
  for (const double angle : {heading + half, heading - half}) {
    double turned = angle - side.first;
    turned -= kTurn * std::floor(turned / kTurn);
    at.push_back(turned / side.sweep);
  }
}

void meet_piece(const Side& side, Piece p, double grow, std::vector<double>& at) {
  p.b += grow;
  if (p.is_rectangle) p.a += grow;
  const Point2 x = p.axis, y{-x.y, x.x};
  if (p.is_rectangle || p.a > 0.0) {
    meet_line(side, p.world({0.0, p.b}), x, at);
    meet_line(side, p.world({0.0, -p.b}), x, at);
    meet_line(side, p.world({p.a, 0.0}), y, at);
    meet_line(side, p.world({-p.a, 0.0}), y, at);
  }
  if (p.is_rectangle) return;
  meet_circle(side, p.world({p.a, 0.0}), p.b, at);
  if (p.a > 0.0) meet_circle(side, p.world({-p.a, 0.0}), p.b, at);
}

}  // namespace

/// The stretches of sides where selects(piece, point, outwards) says that the expression is on one side only:
/// 1 on the left, -1 on the right, 0 on both or none. It is asked once between points where a side meets the
/// other pieces as they are, and as they are when larger and smaller by `grown`.
template <class Selects>
std::vector<Stretch> Expression::stretches(double grown, Selects selects) const {
  std::vector<Stretch> made;
  std::vector<double> cuts;
  for (std::uint32_t i = 0; i < pieces.size(); ++i)
    for (const Side& side : sides_of(pieces[i], i)) {
      cuts.assign({0.0, 1.0});
      for (std::uint32_t k = 0; k < pieces.size(); ++k)
        if (k != i)
          for (const double grow : {-grown, 0.0, grown}) meet_piece(side, pieces[k], grow, cuts);
      std::sort(cuts.begin(), cuts.end());
      int before = 0;  // of the stretch that ends where this one starts
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        if (cuts[k] < 0.0 || cuts[k + 1] > 1.0 || cuts[k + 1] == cuts[k]) continue;
        // Not half way, where another piece may just touch.
        const double between = cuts[k] + 0.4142 * (cuts[k + 1] - cuts[k]);
        const int selected = selects(i, side.at(between), side.outwards(between));
        if (selected != 0 && selected == before)
          made.back().last = cuts[k + 1];
        else if (selected != 0)
          made.push_back({side, cuts[k], cuts[k + 1], selected > 0});
        before = selected;
      }
    }
  return made;
}

std::vector<Stretch> Expression::certain_boundary(double kept, double least) const {
  std::vector<Stretch> made = stretches(kept, [&](std::uint32_t, Point2 at, Point2 outwards) {
    const bool left = has(at - kept * outwards), right = has(at + kept * outwards);
    // Nor may these points be in a narrow gap or wall themselves.
    for (const double scale : {0.5 * kept, 2.0 * kept})
      if (has(at - scale * outwards) != left || has(at + scale * outwards) != right) return 0;
    return (left ? 1 : 0) - (right ? 1 : 0);
  });
  const auto length = [](const Stretch& s) {
    return (s.last - s.first) *
           (s.side.is_arc ? s.side.radius * s.side.sweep : distance(s.side.from, s.side.to));
  };
  made.erase(std::remove_if(made.begin(), made.end(), [&](const Stretch& s) { return length(s) < least; }),
             made.end());
  return made;
}

std::vector<Stretch> Expression::possible_boundary(double closed, double kept) const {
  std::vector<std::uint32_t> open;  // pieces that may be on either side
  std::vector<bool> inside[2];      // of each piece: to the left and to the right
  return stretches(kept, [&](std::uint32_t own, Point2 at, Point2 outwards) {
    open.clear();
    for (const int right : {0, 1}) {
      inside[right].resize(pieces.size());
      const Point2 p = at + (right != 0 ? closed : -closed) * outwards;
      for (std::size_t k = 0; k < pieces.size(); ++k) inside[right][k] = pieces[k].distance_to(p) <= 0.0;
    }
    for (std::uint32_t k = 0; k < pieces.size(); ++k)
      if (const double off = std::abs(pieces[k].distance_to(at)); k != own && off > closed && off < kept)
        open.push_back(k);
    for (std::uint32_t choice = 0; choice < (1u << open.size()); ++choice) {
      for (std::size_t k = 0; k < open.size(); ++k)
        inside[0][open[k]] = inside[1][open[k]] = (choice >> k & 1) != 0;
      const bool left = has(inside[0]), right = has(inside[1]);
      if (left != right) return left ? 1 : -1;
    }
    return 0;
  });
}

double distance_to(const std::vector<Stretch>& boundary, Point2 p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Stretch& s : boundary) least = std::min(least, s.distance_to(p, least));
  return least;
}

WindingCounter::WindingCounter(const Region& region) {
  for (const Outline& loop : region.loops) {
    Point2 from = loop.start;
    for (const Segment& s : loop.segments) {
      Chord chord{from, s.to, {}, 0.0, 0};
      if (const auto arc = arc_circle(from, s)) {
        chord.centre = arc->centre;
        chord.radius = arc->radius;
        chord.turn = arc->turn == Turn::ccw ? 1 : -1;
      }
      chords_.push_back(chord);
      from = s.to;
    }
  }
}

long WindingCounter::around(Point2 p) const {
  double turns = 0.0;
  for (const Chord& chord : chords_) {
    const Point2 a = chord.from - p, b = chord.to - p;
    const double area = cross(a, b);
    const int side = area >= 0.0 ? 1 : -1;  // left of the chord or on it, or right of it
    turns += side * std::atan2(std::abs(area), dot(a, b)) / kTurn;
    // Between the chord and the arc the arc goes around once instead of the chord.
    if (chord.turn == -side && norm(p - chord.centre) < chord.radius) turns += chord.turn;
  }
  return std::lround(turns);
}

// --------------------------------------------------------------------------------------------------
// intervals

namespace {

/// What a line has of a piece that is larger by `grow`.
void add_interval(const Piece& p, const Line& line, double grow, Intervals& out) {
  const Point2 q = p.own(line.from), d = p.own(line.from + line.direction) - q;
  const double a = p.a + (p.is_rectangle ? grow : 0.0), b = p.b + grow;
  if (b <= 0.0 || a < 0.0) return;
  constexpr double kFar = 1e30;
  double low = kFar, high = -kFar;
  const auto add = [&](double first, double last) {
    if (first > last) return;
    low = std::min(low, first);
    high = std::max(high, last);
  };
  const auto slab = [](double at, double step, double half, double& first, double& last) {
    if (step == 0.0) {
      if (std::abs(at) > half) last = first - 1.0;
      return;
    }
    const double u = (-half - at) / step, v = (half - at) / step;
    first = std::max(first, std::min(u, v));
    last = std::min(last, std::max(u, v));
  };
  double first = -kFar, last = kFar;
  slab(q.x, d.x, a, first, last);
  if (first <= last) slab(q.y, d.y, b, first, last);
  if (p.is_rectangle || p.a > 0.0) add(first, last);
  if (!p.is_rectangle)
    for (const double x : {p.a, -p.a}) {
      const Point2 e = q - Point2{x, 0.0};
      const double half = dot(d, e), root = half * half - (dot(e, e) - b * b) * dot(d, d);
      if (root >= 0.0) add((-half - std::sqrt(root)) / dot(d, d), (-half + std::sqrt(root)) / dot(d, d));
    }
  if (low <= high) out.push_back({low, high});
}

Intervals merged(Intervals all) {
  std::sort(all.begin(), all.end());
  Intervals made;
  for (const auto& [low, high] : all)
    if (!made.empty() && low <= made.back().second)
      made.back().second = std::max(made.back().second, high);
    else
      made.push_back({low, high});
  return made;
}

template <class Wanted>
Intervals picked(const Intervals& first, const Intervals& second, Wanted wanted) {
  std::vector<double> cuts;
  for (const Intervals* list : {&first, &second})
    for (const auto& [low, high] : *list) {
      cuts.push_back(low);
      cuts.push_back(high);
    }
  std::sort(cuts.begin(), cuts.end());
  const auto has = [](const Intervals& list, double t) {
    return std::any_of(list.begin(), list.end(), [&](const auto& i) { return i.first < t && t < i.second; });
  };
  Intervals made;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double between = 0.5 * (cuts[i] + cuts[i + 1]);
    if (cuts[i] < cuts[i + 1] && wanted(has(first, between), has(second, between)))
      made.push_back({cuts[i], cuts[i + 1]});
  }
  return merged(made);
}

Intervals unions(const Expression& e, bool second, const Line& line, double grow) {
  Intervals all;
  for (std::size_t i = second ? e.first_count : 0; i < (second ? e.pieces.size() : e.first_count); ++i)
    add_interval(e.pieces[i], line, grow, all);
  return merged(all);
}

}  // namespace

Bracket bracket(const Expression& e, const Line& line, double margin) {
  const Intervals a_least = unions(e, false, line, -margin), a_max = unions(e, false, line, margin);
  const Intervals b_least = unions(e, true, line, -margin), b_max = unions(e, true, line, margin);
  const auto rule = [&](bool a, bool b) { return Expression::combined(e.what, a, b); };
  switch (e.what) {
    case Boolean::unite:
    case Boolean::intersect: return {picked(a_least, b_least, rule), picked(a_max, b_max, rule)};
    case Boolean::subtract: return {picked(a_least, b_max, rule), picked(a_max, b_least, rule)};
    case Boolean::exclude: break;
  }
  const auto minus = [](bool a, bool b) { return a && !b; };
  const auto either = [](bool a, bool b) { return a || b; };
  return {picked(picked(a_least, b_max, minus), picked(b_least, a_max, minus), either),
          picked(picked(a_max, b_least, minus), picked(b_max, a_least, minus), either)};
}

Intervals stretches(const Region& region, const Line& line) {
  std::vector<double> cuts;
  const Point2 normal{-line.direction.y, line.direction.x};
  for (const Outline& loop : region.loops) {
    Point2 from = loop.start;
    for (const Segment& s : loop.segments) {
      const double a = dot(from - line.from, normal), b = dot(s.to - line.from, normal);
      if (const auto arc = arc_circle(from, s)) {
        const double off = dot(arc->centre - line.from, normal);
        if (std::abs(off) <= arc->radius) {
          const double half = std::sqrt(arc->radius * arc->radius - off * off);
          const double sign = arc->turn == Turn::ccw ? 1.0 : -1.0;
          for (const double t : {-half, half}) {
            const Point2 p = arc->centre + t * line.direction - off * normal;
            if (sign * cross(s.to - from, p - from) <= 0.0)
              cuts.push_back(dot(p - line.from, line.direction));
          }
        }
      } else if ((a > 0.0) != (b > 0.0)) {
        const Point2 p = from + (a / (a - b)) * (s.to - from);
        cuts.push_back(dot(p - line.from, line.direction));
      }
      from = s.to;
    }
  }
  std::sort(cuts.begin(), cuts.end());
  const WindingCounter winding(region);
  Intervals made;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] - cuts[i] < 1e-9) continue;
    if (winding.around(line.at(0.5 * (cuts[i] + cuts[i + 1]))) > 0) made.push_back({cuts[i], cuts[i + 1]});
  }
  for (std::size_t i = 1; i < made.size(); ++i)  // what was left out between is no gap
    if (made[i].first - made[i - 1].second < 1e-9 * 16) made[i].first = made[i - 1].second;
  return merged(made);
}

double longest_outside(const Intervals& inner, const Intervals& outer) {
  double longest = 0.0;
  for (const auto& [low, high] : picked(inner, outer, [](bool a, bool b) { return a && !b; }))
    longest = std::max(longest, high - low);
  return longest;
}

}  // namespace kerf::exact_pieces
