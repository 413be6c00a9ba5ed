// Travel, holes and helices.
#include "front/pathdxf/compile/miller.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/pathdxf.h"
#include "base/number.h"
#include "front/pathdxf/compile/bars.h"
#include "front/pathdxf/text/nearly.h"

#include "kerf/base/limits.h"

namespace kerf::pathdxf {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kMinArc = 1e-6;  // mm; a shorter arc with equal ends would be a full circle

constexpr Bilingual kNoBars{"Support bars are too close together: nothing between them is milled down to B",
                            "Stützstege liegen zu dicht: Zwischen ihnen wird nicht bis B gefräst"};
constexpr Bilingual kShort{"No support bar fits on {} mm (P+U={}): milled to D only, not to B",
                           "Kein Stützsteg passt auf {} mm (P+U={}): nur bis D gefräst, nicht bis B"};
constexpr Bilingual kBarsBelow{
    "D={} is not above B={}: no support bars are left, the part may come loose",
    "D={} liegt nicht über B={}: Es bleiben keine Stützstege, das Teil kann sich lösen"};
constexpr Bilingual kBarsMissed{
    "Helix reaches D below B in one step: it is not milled down to B, without support bars",
    "Wendel erreicht D unter B in einem Schritt: Sie wird nicht bis B gefräst, ohne Stützstege"};
constexpr Bilingual kTooManyBars{"P={} and U={} make more than {} support bars",
                                 "P={} und U={} ergeben mehr als {} Stützstege"};
constexpr Bilingual kMissing{"{} value missing", "{}-Wert fehlt"};
constexpr Bilingual kTooManyPasses{"infeed {} makes more than {} passes",
                                   "Zustellung {} ergibt mehr als {} Durchgänge"};

/// Degrees from 0 to 360.
double degrees_of(double angle) {
  double degrees = std::fmod(angle * 180.0 / std::numbers::pi, 360.0);
  if (degrees < 0.0) degrees += 360.0;
  return degrees > 360.0 - 1e-7 ? 0.0 : degrees;
}

std::string text_of(Point2 p) { return fmt::format("[{} {}]", number_text3(p.x), number_text3(p.y)); }

}  // namespace

/// Along Z at the present position: rapidly upwards and above the material, else at feed.
void Miller::move_z(double to, double feed) {
  const Point3 from = out_.position();
  if (near(from.z, to)) return;
  if (out_.traces())
    out_.trace(4, fmt::format("DrillOrPullZFromTo {} {}", number_text3(from.z), number_text3(to)));
  if (to > top() || to > from.z) return out_.rapid_z(to, from.xy(), std::abs(to - from.z));
  if (from.z > top()) out_.rapid_z(top(), from.xy(), from.z - top());
  if (!near(to, top())) out_.plunge(to, from.xy(), std::abs(top() - to), feed);
}

/// To another position, over a height where it differs in XY.
void Miller::travel(Point3 to, double height, double feed) {
  const Point3 from = out_.position();
  if (out_.traces())
    out_.trace(2, fmt::format("SweepAndDrillSafelyFromTo {} {} s={} bt=False", point_text3(from),
                              point_text3(to), number_text3(height)));
  if (near(from.xy(), to.xy())) return move_z(to.z, feed);
  move_z(height, feed);
  const double length = distance(Point3{from.x, from.y, height}, to);
  if (!near(length, 0.0)) out_.rapid_xy(to.xy(), length, at_least(height, sweep_height()));
  move_z(to.z, feed);
}

void Miller::comment_of(const MillingValues& values) {
  if (!values.comment.empty()) out_.comment(4, "Q:" + values.comment);
}

/// Whether the depths that a kind of milling needs are known; else they are reported.
bool Miller::has_depths(const MillingValues& values, const Origin& where) {
  bool has_all = true;
  const auto need = [&](const std::optional<double>& value, const char* key) {
    if (value) return;
    report_.error(codes::pathdxf_value_missing, where, kMissing, key);
    has_all = false;
  };
  if (values.depth != Depth::full) need(values.d, "D");
  if (values.depth != Depth::mark) need(values.b, "B");
  return has_all;
}

double Miller::bottom_of(const MillingValues& values) const {
  return (values.depth == Depth::mark ? *values.d : *values.b) + frame_.raise;
}

/// Warns where an element of this length gets no support bars, or is not milled to B.
void Miller::check_bars(const MillingValues& v, double length, const Origin& where) {
  if (v.depth != Depth::bars) return;
  const double count = bar_count(length, v);
  if (!above(*v.d, *v.b))
    report_.warning(codes::pathdxf_bars, where, kBarsBelow, kerf::number_text(*v.d, 9),
                    kerf::number_text(*v.b, 9));
  else if (!(count >= 1.0))
    report_.warning(codes::pathdxf_bars, where, kShort, kerf::number_text(length, 3),
                    kerf::number_text(v.bar_length + v.bar_distance, 9));
  else if (count <= kMaxBars && bar_sections(length, path_.tool, v)[2].length <= 0.0)
    report_.warning(codes::pathdxf_bars, where, kNoBars);
}

std::vector<double> Miller::levels(double first, double infeed, double bottom, const Origin& where) {
  std::vector<double> list;
  if ((first - bottom) / infeed > limits::kMaxPecks) {
    report_.error(codes::pathdxf_limit, where, kTooManyPasses, kerf::number_text(infeed, 9),
                  limits::kMaxPecks);
    return list;
  }
  for (double z = first; at_least(z, bottom); z -= infeed) list.push_back(z);
  if (list.empty() || !near(list.back(), bottom)) list.push_back(bottom);
  return list;
}

void Miller::sweep(const Sweep& s) {
  const double height = s.height ? *s.height + frame_.raise : sweep_height();
  const Point2 to = frame_(s.to);
  travel({to.x, to.y, height}, height, path_.feed);
}

void Miller::drill(const Drill& d, const Origin& where) {
  if (!has_depths(d.values, where)) return;
  if (out_.traces()) out_.trace(2, fmt::format("Drill l={}", text_of(frame_(d.at))));
  comment_of(d.values);
  const double bottom = bottom_of(d.values);
  move_z(bottom, d.values.feed);
  // As G81 with its R at that height: the tool returns there.
  if (d.cycle_from && above(*d.cycle_from + frame_.raise, bottom))
    move_z(*d.cycle_from + frame_.raise, d.values.feed);
}

// ------------------------------------------------------------------------------------------------- helices

void Miller::helix(const Helix& h, const Origin& where) {
  const MillingValues& v = h.values;
  if (!has_depths(v, where)) return;
  if (!v.infeed) {
    report_.error(codes::pathdxf_value_missing, where, kMissing, "I");
    return;
  }
  const double bottom = (v.depth == Depth::full ? *v.b : *v.d) + frame_.raise;
  if ((top() - bottom) / *v.infeed > limits::kMaxPecks) {
    report_.error(codes::pathdxf_limit, where, kTooManyPasses, kerf::number_text(*v.infeed, 9),
                  limits::kMaxPecks);
    return;
  }
  const Point2 c = frame_(h.centre);
  const double radius = h.radius - path_.tool / 2.0;
  move_z(top() + path_.tool, v.feed);
  comment_of(v);
  if (out_.traces()) out_.trace(2, fmt::format("MillHelix l={} r={}", text_of(c), number_text3(h.radius)));
  out_.rapid_xy({c.x, c.y - radius}, radius, at_least(out_.position().z, sweep_height()));
  helix_turns(h, bottom, *v.infeed);
  if (v.depth == Depth::bars) helix_bars(h, *v.infeed, where);
  const bool fills = at_least(path_.tool, h.radius);
  if (!fills) out_.rapid_z(sweep_height(), c, std::abs(sweep_height() - helix_level_));
  out_.rapid_xy(c, radius, !fills);
}

void Miller::helix_turns(const Helix& h, double bottom, double infeed) {
  const Point2 c = frame_(h.centre);
  const double radius = h.radius - path_.tool / 2.0, half = std::numbers::pi * radius;
  double previous = top();
  for (double level = top(); level == top() || above(previous, bottom); previous = level, level -= infeed) {
    if (level == previous && level != top()) break;  // an infeed too small for the numbers
    if (out_.traces()) out_.trace(4, fmt::format("MillSemiCircle l={}", number_text3(level)));
    const double first = std::max(level - infeed / 2.0, bottom),
                 second = std::max(first - infeed / 2.0, bottom);
    out_.arc({c.x, c.y + radius, first}, c, Turn::cw, h.values.feed, half, c);
    out_.arc({c.x, c.y - radius, second}, c, Turn::cw, h.values.feed, half, c);
    helix_level_ = level;
  }
}

void Miller::helix_bars(const Helix& h, double infeed, const Origin& where) {
  const double bottom = *h.values.b + frame_.raise;
  const double radius = h.radius - path_.tool / 2.0;
  MillSegment circle;
  circle.is_arc = true;
  circle.where = where;
  circle.centre = h.centre;
  circle.radius = radius;
  circle.start_angle = 1.5 * std::numbers::pi - frame_.angle();
  circle.turn = -kTurn;
  circle.values = h.values;
  check_bars(h.values, kTurn * radius, where);
  if (!(bar_count(kTurn * radius, h.values) >= 1.0)) return;
  if (!above(helix_level_, bottom)) report_.warning(codes::pathdxf_bars, where, kBarsMissed);
  for (double level = helix_level_; above(level, bottom);) {
    level = helix_level_ = std::max(level - infeed, bottom);
    mill_segment(circle, level, false);
  }
}

// ---------------------------------------------------------------------------------------------------- cuts

void Miller::line(Point2 from, Point2 to, double from_z, double to_z, double feed) {
  move_z(from_z, feed);
  if (out_.traces())
    out_.trace(2, fmt::format("MillLine s={} e={} fr={} to={} bt=False", text_of(from), text_of(to),
                              number_text3(from_z), number_text3(to_z)));
  out_.cut({to.x, to.y, to_z}, feed, distance(from, to), from);
}

void Miller::arc(Point2 centre, double radius, double start_angle, double turn, Point2 from, Point2 to,
                 double from_z, double to_z, double feed) {
  move_z(from_z, feed);
  if (out_.traces())
    out_.trace(2, fmt::format("MillArc l={} r={} a0={} a1={} fr={} to={} p0={} p1={} bt=False",
                              text_of(centre), number_text3(radius), number_text3(degrees_of(start_angle)),
                              number_text3(degrees_of(start_angle + turn)), number_text3(from_z),
                              number_text3(to_z), text_of(from), text_of(to)));
  const double length = std::abs(turn) * radius;
  if (length < kMinArc) return out_.cut({to.x, to.y, to_z}, feed, length, from);
  out_.arc({to.x, to.y, to_z}, centre, turn < 0.0 ? Turn::cw : Turn::ccw, feed, length, from);
}

/// The part of a segment between two distances from its start.
void Miller::mill_section(const MillSegment& s, double from, double to, double from_z, double to_z) {
  if (!s.is_arc) {
    const Point2 a = frame_(s.start), b = frame_(s.end);
    const double whole = distance(a, b);
    const auto at = [&](double d) { return whole > 0.0 ? a + (d / whole) * (b - a) : a; };
    return line(at(from), at(to), from_z, to_z, s.values.feed);
  }
  const double sign = s.turn < 0.0 ? -1.0 : 1.0;
  const double start = s.start_angle + frame_.angle() + sign * from / s.radius,
               turn = sign * (to - from) / s.radius;
  const Point2 centre = frame_(s.centre);
  const auto at = [&](double angle) {
    return Point2{centre.x + s.radius * std::cos(angle), centre.y + s.radius * std::sin(angle)};
  };
  arc(centre, s.radius, start, turn, at(start), at(start + turn), from_z, to_z, s.values.feed);
}

/// A segment at a level, or at its own bottom where that is higher; with support bars below their height.
void Miller::mill_segment(const MillSegment& segment, double level, bool reversed) {
  if (!reversed) return mill_forwards(segment, level);
  MillSegment s = segment;
  std::swap(s.start, s.end);
  s.start_angle += s.turn;
  s.turn = -s.turn;
  mill_forwards(s, level);
}

void Miller::mill_forwards(const MillSegment& s, double level) {
  const bool has_bars = s.values.depth == Depth::bars;
  const double bars = has_bars ? *s.values.d + frame_.raise : 0.0;
  const double length = length_of(s);
  if (has_bars && bar_count(length, s.values) > kMaxBars) {
    report_.error(codes::pathdxf_limit, s.where, kTooManyBars, kerf::number_text(s.values.bar_length, 9),
                  kerf::number_text(s.values.bar_distance, 9), kMaxBars);
    return;
  }
  const std::vector<Section> sections = has_bars && !at_least(level, bars)
                                            ? bar_sections(length, path_.tool, s.values)
                                            : std::vector<Section>();
  if (sections.empty()) {
    const double z = std::max(level, has_bars ? bars : bottom_of(s.values));
    const Point2 from = frame_(s.start), to = frame_(s.end);
    if (!s.is_arc) return line(from, to, z, z, s.values.feed);
    return arc(frame_(s.centre), s.radius, s.start_angle + frame_.angle(), s.turn, from, to, z, z,
               s.values.feed);
  }
  const double low = std::max(level, *s.values.b + frame_.raise);
  double at = 0.0;
  for (const Section& section : sections) {
    const bool is_bar = section.kind == BarSection::bar, is_down = section.kind == BarSection::down;
    out_.trace(2, is_bar                                ? "Support.Bar"
                  : is_down                             ? "Support.Down"
                  : section.kind == BarSection::between ? "Support.Between"
                                                        : "Support.Up");
    const bool is_up = section.kind == BarSection::up;
    mill_section(s, at, at + section.length, is_bar || is_down ? bars : low, is_bar || is_up ? bars : low);
    at += section.length;
  }
}

}  // namespace kerf::pathdxf
