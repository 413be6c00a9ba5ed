// Random regions where much coincides, checked from outside the kernel.
//   property_region_brackets [COUNT] [SEED] [MAX_FAILURES]
// Rectangles, circles and slots on integer coordinates, turned by 0, 90 or any angle, that touch, share
// sides, are tangent, or lie 1e-8 to 1e-4 apart, are united and combined, and the result is offset, at once
// or in a chain. Each result has to lie between the exact one smaller and larger by 1e-4 mm, as formulas
// independent of the kernel have it (region_pieces.h): along whole lines for boolean operations, at
// points near each stretch of the boundary, at random points, and at each vertex of the result. Gaps and
// walls from 1e-11 to 1e-5 wide may be kept or closed: weld is 1e-6. Prints the seed, each case that fails
// with the seed that makes it alone, and counts by kind. Exit status 1 if any failed.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "region_pieces.h"

#include "kerf/geom/offset.h"

namespace {

using namespace kerf;
using namespace kerf::exact_pieces;

constexpr double kMargin = 1e-4;            // mm: what a result may be off
constexpr double kKept = 1e-5;              // mm: gaps and walls at least this wide must be kept
constexpr double kClosed = 1e-11;           // mm: those at most this wide must be closed
constexpr double kOffLine = 4.0 * kMargin;  // mm: what a line may have on the wrong side of the bracket

constexpr double kShort =
    1e-2;  // mm: where curves touch, gaps change their width from 0 to kKept over such a length
constexpr double kRounding = 1e-9;  // square mm

double norm(Point2 v) { return std::sqrt(dot(v, v)); }

class Drawer {
 public:
  explicit Drawer(std::uint64_t seed) : random_(seed) {}
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(double probability) { return in(0.0, 1.0) < probability; }
  Point2 direction() {
    const double angle = in(0.0, 6.283185307179586);
    return {std::cos(angle), std::sin(angle)};
  }
  /// 0, a multiple of half the tolerance, or from 1e-8 to 1e-4, with either sign.
  double slight() {
    if (chance(0.2)) return 0.0;
    const double sign = chance(0.5) ? 1.0 : -1.0;
    return sign * (chance(0.2) ? 0.5e-6 * whole(1, 6) : std::pow(10.0, in(-8.0, -4.0)));
  }
  Expression expression();
  /// The points of a path whose lines are the centre lines of the pieces; else empty.
  const std::vector<Point2>& path() const { return path_; }

 private:
  Expression rectangles();
  Expression strokes();
  Piece piece();
  Piece tangent(const Piece& other);
  Piece beside(const Piece& other);
  std::mt19937_64 random_;
  std::vector<Point2> path_;
};

Piece Drawer::piece() {
  Piece p;
  const double x = whole(0, 10), y = whole(0, 10);
  switch (whole(0, 4)) {
    case 0:
      p.is_rectangle = false;
      p.centre = {x, y};
      p.a = 0.0;
      p.b = whole(1, 4);
      break;
    case 1:
      p.is_rectangle = false;
      p.centre = {x, y};
      p.a = whole(1, 8) * 0.5;
      p.b = whole(1, 4) * 0.5;
      break;
    default: {
      const double width = whole(1, 8), height = whole(1, 8);
      p.centre = {x + 0.5 * width, y + 0.5 * height};
      p.a = 0.5 * width;
      p.b = 0.5 * height;
    }
  }
  if (chance(0.3)) p.axis = {0.0, 1.0};
  if (chance(0.1)) p.axis = direction();
  return p;
}

/// A piece that lies to another as pieces of drawings do: shifted, larger, or next to it, but for a little.
Piece Drawer::beside(const Piece& other) {
  Piece p = other;
  const double little = slight();
  const Point2 x = other.axis, y{-x.y, x.x};
  switch (whole(0, 6)) {
    case 5: return tangent(other);
    case 6: {  // turned slightly: sides that intersect at a small angle
      p.axis = {x.x - little * x.y, x.y + little * x.x};
      const double size = norm(p.axis);
      p.axis = {p.axis.x / size, p.axis.y / size};
      break;
    }
    case 0: p.centre = other.centre + little * (chance(0.5) ? x : y); break;
    case 1: p.centre = other.centre + little * direction(); break;
    case 2:
      p.b += little;
      if (p.is_rectangle) p.a += little;
      break;
    case 3: {  // next to it, with a part of its side
      if (chance(0.5) && p.is_rectangle) p.a = std::max(0.5, p.a - 0.5 * whole(0, 4));
      const double slide = p.is_rectangle ? other.a - p.a : 0.0;
      const double sign = chance(0.5) ? 1.0 : -1.0;
      p.centre = other.centre + sign * (2.0 * other.b + little) * y + (chance(0.5) ? slide : -slide) * x;
      break;
    }
    default: {  // a rectangle that starts or ends near the centre or the side
      Piece r;
      r.axis = other.axis;
      r.a = 0.5 * whole(1, 6);
      r.b = 0.5 * whole(1, 6);
      const double at = (chance(0.5) ? other.b : 0.0) + (chance(0.5) ? r.b : -r.b) + little;
      r.centre = other.centre + at * y + 0.5 * whole(-4, 4) * x;
      return r;
    }
  }
  return p;
}

/// A circle that touches another piece from inside or outside, but for a little.
Piece Drawer::tangent(const Piece& other) {
  constexpr Point2 kDirections[] = {{1.0, 0.0},  {0.0, 1.0},  {0.6, 0.8},
                                    {-0.8, 0.6}, {-1.0, 0.0}, {0.6, -0.8}};
  Piece p;
  p.is_rectangle = false;
  p.a = 0.0;
  p.b = 0.5 * whole(1, 6);
  p.axis = other.axis;
  const double off = (chance(0.6) ? p.b : -p.b) + slight();
  if (other.is_rectangle) {
    p.centre = other.world({0.5 * whole(-4, 4), other.b + off});
  } else {
    const Point2 d = kDirections[whole(0, 5)];
    p.centre = other.world({other.a + (other.b + off) * std::abs(d.x), (other.b + off) * d.y});
  }
  return p;
}

/// A path of lines between whole numbers with a width: a slot for each line.
Expression Drawer::strokes() {
  constexpr double kTriples[][2] = {{3, 4}, {4, 3}, {6, 8}, {8, 6}, {5, 12}};
  Expression e;
  Point2 at{1.0 * whole(0, 10), 1.0 * whole(0, 10)};
  const double width = chance(0.7) ? 0.25 * whole(1, 8) : in(0.01, 2.0);
  for (int count = whole(1, 7); count > 0; --count) {
    Point2 step{0.0, 0.0};
    const double along = (chance(0.5) ? 1.0 : -1.0) * whole(1, 8) + (chance(0.2) ? slight() : 0.0);
    switch (whole(0, 3)) {
      case 0: step = {along, 0.0}; break;
      case 1: step = {0.0, along}; break;
      case 2: {
        const double* sides = kTriples[whole(0, 4)];
        step = {(chance(0.5) ? 1.0 : -1.0) * sides[0], (chance(0.5) ? 1.0 : -1.0) * sides[1]};
        break;
      }
      default: step = {along, 1.0 * whole(-6, 6)};
    }
    const double length = norm(step);
    Piece p;
    p.is_rectangle = false;
    p.a = 0.5 * length;
    p.b = width;
    p.axis = {step.x / length, step.y / length};
    p.centre = at + 0.5 * step;
    e.pieces.push_back(p);
    at = at + step;
    path_.push_back(at);
    if (e.pieces.size() == 1) path_.insert(path_.begin(), at - step);
  }
  e.first_count = e.pieces.size();
  return e;
}

Expression Drawer::expression() {
  Expression e;
  if (chance(0.1)) return strokes();
  if (chance(0.25)) return rectangles();
  const int count = whole(2, 6);
  const double near = chance(0.5) ? 0.0 : 0.5;
  for (int i = 0; i < count; ++i)
    e.pieces.push_back(i > 0 && chance(near) ? beside(e.pieces[static_cast<std::size_t>(whole(0, i - 1))])
                                             : piece());
  const Boolean kinds[] = {Boolean::unite, Boolean::intersect, Boolean::subtract, Boolean::exclude};
  e.what = kinds[whole(0, 3)];
  e.first_count = static_cast<std::size_t>(whole(1, count - 1));
  if (chance(0.35)) {
    e.what = Boolean::unite;
    e.first_count = e.pieces.size();
  }
  const int turned = whole(0, 2);
  if (turned == 0) return e;
  const Point2 axis = turned == 1 ? Point2{0.0, 1.0} : direction();
  const auto turn = [&](Point2 p) {
    return Point2{p.x * axis.x - p.y * axis.y, p.x * axis.y + p.y * axis.x};
  };
  for (Piece& p : e.pieces) {
    p.centre = turn(p.centre);
    p.axis = turn(p.axis);
  }
  return e;
}

/// The union of rectangles on whole numbers: necks of whole width that an offset closes exactly.
Expression Drawer::rectangles() {
  Expression e;
  for (int count = whole(4, 14); count > 0; --count) {
    Piece p;
    const double x = whole(0, 20), y = whole(0, 20), width = whole(1, 10), height = whole(1, 10);
    p.centre = {x + 0.5 * width, y + 0.5 * height};
    p.a = 0.5 * width;
    p.b = 0.5 * height;
    e.pieces.push_back(p);
  }
  e.first_count = e.pieces.size();
  return e;
}

struct Verdict {
  std::string wrong;  // empty if nothing
  std::string kind;
};

class Case {
 public:
  explicit Case(std::uint64_t seed) : drawer_(seed) {}
  Verdict run();
  /// The pieces of the expression.
  void print() const {
    for (std::size_t i = 0; i < exact_.pieces.size(); ++i) {
      const Piece& p = exact_.pieces[i];
      fmt::print("{} {} at ({}, {}), half sizes {} {}, axis ({}, {})\n",
                 i < exact_.first_count ? "first" : "second", p.is_rectangle ? "rectangle" : "slot",
                 p.centre.x, p.centre.y, p.a, p.b, p.axis.x, p.axis.y);
    }
    fmt::print("boolean {}\n", static_cast<int>(exact_.what));
  }

 private:
  std::optional<Region> united(std::size_t begin, std::size_t end);
  std::string check_boolean(const Region& made);
  std::string check_offset(const Region& made, double by);
  std::string check_point(const WindingCounter& made, double by, Point2 p);
  std::string check_sources(const Region& original, const Offset& made, double by);
  std::string check_mitre(const Region& original, const Region& round, double by);
  Point2 anywhere() { return {drawer_.in(low_.x, high_.x), drawer_.in(low_.y, high_.y)}; }

  Drawer drawer_;
  Expression exact_;
  std::vector<Stretch> certain_, possible_;  // the boundary without gaps narrower than kKept, kClosed
  Diagnostics diagnostics_;
  Point2 low_{1e9, 1e9}, high_{-1e9, -1e9};
};

std::optional<Region> Case::united(std::size_t begin, std::size_t end) {
  if (const std::vector<Point2>& path = drawer_.path(); !path.empty() && drawer_.chance(0.7)) {
    Outline line{path[0], {}};
    for (std::size_t i = 1; i < path.size(); ++i) line.segments.push_back({path[i], {}});
    return buffer(line, mm(exact_.pieces[0].b), PathEnds::round, {}, diagnostics_);
  }
  std::vector<Outline> outlines;
  for (std::size_t i = begin; i < end; ++i) outlines.push_back(exact_.pieces[i].outline());
  const int way = drawer_.whole(0, 2);
  if (way == 0) return make_region(outlines, FillRule::nonzero, {}, diagnostics_);
  if (way == 1) {
    std::vector<Region> regions;
    for (const Outline& o : outlines) regions.push_back({{o}});
    return unite(regions, {}, diagnostics_);
  }
  Region sum;
  for (const Outline& o : outlines) {
    const auto more = combine(sum, Region{{o}}, Boolean::unite, {}, diagnostics_);
    if (!more) return std::nullopt;
    sum = more->region;
  }
  return sum;
}

std::string Case::check_boolean(const Region& made) {
  for (int i = 0; i < 6; ++i) {
    const Point2 d = i < 2 && drawer_.chance(0.5) ? exact_.pieces[0].axis : drawer_.direction();
    const Point2 from = i < 3 ? anywhere() : exact_.pieces[0].world({drawer_.in(-1, 1), drawer_.in(-1, 1)});
    const Line line{from, d};
    const Bracket between = bracket(exact_, line, kMargin);
    const Intervals found = stretches(made, line);
    const double missing = longest_outside(between.least, found),
                 beyond = longest_outside(found, between.max);
    if (missing > kOffLine || beyond > kOffLine)
      return fmt::format("the line from ({}, {}) to ({}, {}) has {} too little and {} too much", from.x,
                         from.y, d.x, d.y, missing, beyond);
  }
  return check_offset(made, 0.0);
}

/// Whether a point is on the right side of the region offset by `by`.
std::string Case::check_point(const WindingCounter& made, double by, Point2 p) {
  const bool has = exact_.has(p), clear = exact_.is_clear(p, kKept);
  const double possible = distance_to(possible_, p), certain = distance_to(certain_, p);
  // The kernel's boundary has all of the certain one and nothing but the possible one.
  const bool in = by < 0.0 ? clear && has && possible >= -by + kMargin
                           : (clear && has && possible >= kMargin) || (by > 0.0 && certain <= by - kMargin);
  const bool out =
      by < 0.0 ? (clear && !has) || certain <= -by - kMargin : clear && !has && possible >= by + kMargin;
  if (in == out) return "";  // neither is certain
  if (const long found = made.around(p); found != (in ? 1 : 0))
    return fmt::format("({}, {}) is {}, {} from the boundary, and has the winding number {}", p.x, p.y,
                       in ? "inside" : "outside", possible, found);
  return "";
}

std::string Case::check_offset(const Region& made, double by) {
  const WindingCounter counter(made);
  for (const Stretch& s : possible_)
    for (int i = 0; i < 2; ++i) {
      const double fraction = drawer_.in(0.0, 1.0), off = (i == 0 ? 2.0 : -2.0) * kMargin;
      std::string wrong = check_point(counter, by, s.at(fraction) + (by + off) * s.outwards(fraction));
      if (!wrong.empty()) return wrong;
    }
  for (int i = 0; i < 12; ++i) {
    const std::string wrong = check_point(counter, by, anywhere());
    if (!wrong.empty()) return wrong;
  }
  const auto near_two = [&](Point2 p) {  // pieces: whether they touch or overlap is not for weld to decide
    return by == 0.0 && std::count_if(exact_.pieces.begin(), exact_.pieces.end(), [&](const Piece& piece) {
                          return std::abs(piece.distance_to(p)) < kKept;
                        }) > 1;
  };
  for (const Outline& loop : made.loops)
    for (const Segment& s : loop.segments)
      for (const Point2 p : {s.to, s.via.value_or(s.to)})
        if (const double possible = distance_to(possible_, p), certain = distance_to(certain_, p);
            (possible > std::abs(by) + kMargin && !near_two(p)) || certain < std::abs(by) - kMargin)
          return fmt::format("the boundary at ({}, {}) is {} or {} from that of the original", p.x, p.y,
                             possible, certain);
  return "";
}

double distance_to_segment(Point2 from, const Segment& segment, Point2 p) {
  const double ends = std::min(distance(from, p), distance(segment.to, p));
  if (const auto arc = arc_circle(from, segment)) {
    const double sign = arc->turn == Turn::ccw ? 1.0 : -1.0;
    const auto heading = [&](Point2 q) { return std::atan2(q.y - arc->centre.y, q.x - arc->centre.x); };
    double turned = sign * (heading(p) - heading(from));
    turned -= 2.0 * std::numbers::pi * std::floor(turned / (2.0 * std::numbers::pi));
    return turned <= arc->sweep.rad() ? std::abs(distance(p, arc->centre) - arc->radius) : ends;
  }
  const Point2 chord = segment.to - from;
  const double along = dot(p - from, chord) / dot(chord, chord);
  return along >= 0.0 && along <= 1.0 ? distance(p, from + along * chord) : ends;
}

/// Whether each segment of an offset lies at the distance from the segment, or the corner, that it names.
std::string Case::check_sources(const Region& original, const Offset& made, double by) {
  for (std::size_t k = 0; k < made.region.loops.size(); ++k) {
    const Outline& loop = made.region.loops[k];
    if (made.sources[k].size() != loop.segments.size()) return "a segment has no source";
    for (std::size_t i = 0; i < loop.segments.size(); ++i) {
      const BoundaryElement& source = made.sources[k][i];
      const Outline& owner = original.loops.at(source.loop);
      const Segment& own = owner.segments.at(source.segment);
      const Point2 from = loop.point(i);
      const Point2 p = loop.segments[i].via.value_or(0.5 * (from + loop.segments[i].to));
      const double off =
          source.corner ? distance(own.to, p) : distance_to_segment(owner.point(source.segment), own, p);
      if (std::abs(off - std::abs(by)) > kMargin)
        return fmt::format("segment {} of loop {} is {} from its source", i, k, off);
    }
  }
  return "";
}

/// An offset with mitred corners contains the round one; the line that cuts a tip off at the limit ends no
/// further from the corner than sqrt(1 + limit^2).
std::string Case::check_mitre(const Region& original, const Region& round, double by) {
  const double limit = drawer_.chance(0.3) ? 1.0 : drawer_.in(1.0, 3.0);
  const auto made = offset(original, mm(by), {Join::mitre, limit}, {}, diagnostics_);
  const auto wide = offset(original, mm(by * std::sqrt(1.0 + limit * limit)), {}, diagnostics_);
  if (!made || !wide) return "a mitred offset failed";
  const double own = area(made->region), low = by > 0.0 ? area(round) : area(wide->region),
               high = by > 0.0 ? area(wide->region) : area(round);
  const double margin = kMargin * (length(made->region).mm() + length(round).mm());
  if (own < low - margin || own > high + margin)
    return fmt::format("the mitred offset by {} has the area {}, not from {} to {}", by, own, low, high);
  const auto beyond = by > 0.0 ? combine(round, made->region, Boolean::subtract, {}, diagnostics_)
                               : combine(made->region, round, Boolean::subtract, {}, diagnostics_);
  if (!beyond) return "a difference failed";
  if (area(beyond->region) > margin) return fmt::format("{} mm2 beyond", area(beyond->region));
  return "";
}

Verdict Case::run() {
  exact_ = drawer_.expression();
  if (drawer_.path().empty() && drawer_.chance(0.1))
    for (Piece& p : exact_.pieces) p.centre = p.centre + Point2{1024.0, -2048.0};
  for (const Piece& p : exact_.pieces) {
    const double r = p.a + p.b + 3.0;
    low_ = {std::min(low_.x, p.centre.x - r), std::min(low_.y, p.centre.y - r)};
    high_ = {std::max(high_.x, p.centre.x + r), std::max(high_.y, p.centre.y + r)};
  }
  possible_ = exact_.possible_boundary(kClosed, kKept);
  certain_ = exact_.certain_boundary(kKept, kShort);
  const auto failed = [&](const char* what) {
    return fmt::format("{} failed: {}", what, to_string(diagnostics_.list().back()));
  };
  auto region = united(0, exact_.first_count);
  if (!region) return {failed("union"), "union"};
  if (exact_.first_count < exact_.pieces.size()) {
    const auto second = united(exact_.first_count, exact_.pieces.size());
    if (!second) return {failed("union"), "union"};
    const auto combined = combine(*region, *second, exact_.what, {}, diagnostics_);
    if (!combined) return {failed("boolean"), "boolean"};
    region = combined->region;
  }
  const char* kind = exact_.first_count < exact_.pieces.size() ? "boolean" : "union";
  if (std::string wrong = check_boolean(*region); !wrong.empty()) return {wrong, kind};
  if (drawer_.chance(0.15)) return {"", kind};
  const Region first = *region;
  // Thirds and whole numbers: necks of rectangles on whole numbers close up to rounding.
  const bool thirds = drawer_.chance(0.4);
  const int steps = thirds ? 3 : drawer_.chance(0.4) ? 1 : drawer_.whole(2, 4);
  double total = thirds                ? 0.5 * drawer_.whole(1, 2)
                 : drawer_.chance(0.6) ? 0.5 * drawer_.whole(1, 4)
                                       : std::pow(10.0, drawer_.in(-2.0, 0.5));
  if (!thirds && drawer_.chance(0.3))
    total += (drawer_.chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, drawer_.in(-10.0, -4.0));
  const double sign = drawer_.chance(0.35) ? 1.0 : -1.0;
  const std::string chain =
      fmt::format("{} {}", steps == 1 ? "direct" : "chained", sign > 0 ? "outward" : "inward");
  for (int i = 1; i <= steps; ++i) {
    const auto made = offset(*region, mm(sign * total / steps), {}, diagnostics_);
    if (!made) return {failed("offset"), chain};
    std::string wrong = check_sources(*region, *made, sign * total / steps);
    if (wrong.empty() && drawer_.chance(0.1))
      wrong = check_mitre(*region, made->region, sign * total / steps);
    region = made->region;
    if (wrong.empty()) wrong = check_offset(*region, sign * total * i / steps);
    if (!wrong.empty())
      return {fmt::format("offset {} of {} by {}: {}", i, steps, sign * total / steps, wrong), chain};
  }
  const auto more = offset(first, mm(sign * total + kMargin), {}, diagnostics_);
  const auto less = offset(first, mm(sign * total - kMargin), {}, diagnostics_);
  if (!more || !less) return {failed("offset"), chain};
  if (area(*region) > area(more->region) + kRounding || area(*region) < area(less->region) - kRounding)
    return {fmt::format("offset {} times by {}: the area {} is not between {} and {}", steps,
                        sign * total / steps, area(*region), area(less->region), area(more->region)),
            chain};
  return {"", chain};
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 10000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : std::random_device()();
  const long max_failures = argc > 3 ? std::atol(argv[3]) : 20;
  fmt::print("{} random expressions, seed {}\n", count, seed);
  std::map<std::string, std::array<long, 2>> kinds;  // cases, failures
  long failed = 0;
  for (long i = 0; i < count && failed < max_failures; ++i) {
    const std::uint64_t own = seed + static_cast<std::uint64_t>(i);
    Case one(own);
    const Verdict verdict = one.run();
    if (count == 1) one.print();
    ++kinds[verdict.kind][0];
    if (verdict.wrong.empty()) continue;
    ++failed;
    ++kinds[verdict.kind][1];
    fmt::print("property_region_brackets 1 {}: {}: {}\n", own, verdict.kind, verdict.wrong);
  }
  for (const auto& [kind, counts] : kinds)
    fmt::print("{:16} {:8} cases, {} failed ({:.3f}%)\n", kind, counts[0], counts[1],
               100.0 * static_cast<double>(counts[1]) / static_cast<double>(counts[0]));
  return failed == 0 ? 0 : 1;
}
