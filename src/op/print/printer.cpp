// The printer: settings, travel, beads, start and finish, vases.
#include "kerf/op/printer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>

#include "base/codes/op.h"
#include "path/bead.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/geom/outline.h"

namespace kerf {
namespace {

constexpr double kNoLength = 1e-6;          // mm; shorter motions are left out
constexpr double kMaxTemperature = 2000.0;  // C, as of the reader
constexpr double kMaxFilament = 10.0;       // mm
constexpr double kMaxRetraction = 1000.0;   // mm
constexpr double kMaxOverlap = 0.5;         // of the height
constexpr double kMaxFlow = 2.0;
constexpr double kMaxVolumeFlow = 1e4;  // mm3/s

bool is_coordinate(Point2 p) {
  return std::abs(p.x) <= limits::kMaxCoordinate && std::abs(p.y) <= limits::kMaxCoordinate;
}

/// Whether a path has a segment, and points that are coordinates.
bool has_coordinates(const Outline& path) {
  return !path.segments.empty() && is_coordinate(path.start) &&
         std::all_of(path.segments.begin(), path.segments.end(), [](const Segment& s) {
           return is_coordinate(s.to) && (!s.via || is_coordinate(*s.via));
         });
}

}  // namespace

void add_home(Toolpath& path, unsigned axes, OriginId origin) {
  std::array<double, 3> to{};
  unsigned unknown = axes;
  for (std::size_t i = path.size(); i-- > 0;) {
    if (!path[i].is_motion()) continue;
    const Point3 last = path[i].to();
    to = {last.x, last.y, last.z};
    unknown |= path[i].unknown_axes();
    break;
  }
  for (unsigned axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1u) != 0) to[axis] = 0.0;
  const std::size_t home = path.add(step::Rapid{{to[0], to[1], to[2]}}, origin);
  path.set_unknown_axes(home, unknown);
  path.set_reference(home, Reference::end_switches, axes);
}

void switch_off(Toolpath& path, OriginId origin) {
  std::map<int, double> fans;
  std::map<Heater, double> heaters;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].kind() == StepKind::fan) fans[path[i].fan().fan] = path[i].fan().fraction;
    if (path[i].kind() == StepKind::temperature)
      heaters[path[i].temperature().heater] = path[i].temperature().celsius;
  }
  for (const auto& [fan, fraction] : fans)
    if (fraction > 0.0) path.add(step::Fan{fan, 0.0}, origin);
  for (const auto& [heater, celsius] : heaters)
    if (celsius > 0.0) path.add(step::Temperature{heater, 0.0, false}, origin);
}

Printer::Printer(const PrinterSettings& settings, Diagnostics& diagnostics, const Origin& where)
    : settings_(settings), diagnostics_(diagnostics), where_(where), height_(settings.height) {
  origin_ = path_.origins().add(where);
  check_settings();
  check_speeds();
  if (valid_ && settings.filament != kUsualFilament)
    path_.add(step::Note{filament_note(settings.filament)}, origin_);
}

void Printer::set_origin(const Origin& where) {
  where_ = where;
  origin_ = path_.origins().add(where);
}

/// An error unless `holds`; comparisons with NaN do not hold.
bool Printer::expect(double value, bool holds, const char* what, const char* rule) {
  if (holds) return true;
  diagnostics_.error(codes::op_option, where_, fmt::format("{} is {:g}; it must be {}", what, value, rule));
  return false;
}

void Printer::check_settings() {
  const PrinterSettings& s = settings_;
  const double height = s.height.mm(), width = s.width.mm(), filament = s.filament.mm();
  valid_ &= expect(height, height > 0.0 && height <= limits::kMaxBeadWidth, "the height of the beads",
                   "above 0 mm");
  valid_ &= expect(width, width >= height && width <= limits::kMaxBeadWidth, "the width of the beads",
                   "at least their height");
  valid_ &= expect(filament, filament > 0.0 && filament <= kMaxFilament, "the diameter of the filament",
                   "above 0 mm and at most 10 mm");
  valid_ &= expect(s.flow, s.flow > 0.0 && s.flow <= kMaxFlow, "the flow", "above 0 and at most 2");
  valid_ &= expect(s.side_overlap, s.side_overlap >= 0.0 && s.side_overlap <= kMaxOverlap, "the side overlap",
                   "from 0 to 0.5");
  const double retract = s.retract.mm(), hop = s.hop.mm(), wipe = s.wipe.mm(), lowest = s.min_travel.mm();
  valid_ &=
      expect(retract, retract >= 0.0 && retract <= kMaxRetraction, "the retraction", "from 0 to 1000 mm");
  valid_ &= expect(hop, hop >= 0.0 && hop <= limits::kMaxCoordinate, "the hop", "0 mm or more");
  valid_ &= expect(wipe, wipe >= 0.0 && wipe <= limits::kMaxCoordinate, "the wipe", "0 mm or more");
  valid_ &=
      expect(lowest, lowest >= 0.0 && lowest <= limits::kMaxCoordinate, "the minimum travel", "0 mm or more");
  const double chord = s.chord.mm();
  valid_ &= expect(chord, chord >= 1e-4 && chord <= 1.0, "the chord tolerance", "from 0.0001 to 1 mm");
}

void Printer::check_speeds() {
  const PrinterSettings& s = settings_;
  const auto speed = [&](Feed feed, const char* what) {
    const double v = feed.mm_per_min();
    valid_ &= expect(v, v > 0.0 && v <= limits::kMaxSpeed, what, "above 0 mm/min");
  };
  speed(s.speed, "the speed");
  speed(s.travel_speed, "the travel speed");
  speed(s.retract_speed, "the retraction speed");
  if (s.first_layer_speed != Feed{}) speed(s.first_layer_speed, "the speed of the first layer");
  const double highest = in_mm3_per_s(s.max_flow);
  valid_ &= expect(highest, highest >= 0.0 && highest <= kMaxVolumeFlow, "the maximum flow",
                   "from 0 to 10000 mm3/s");
}

Length Printer::spacing() const { return settings_.width - settings_.side_overlap * height_; }

double Printer::filament_area() const {
  const double radius = 0.5 * settings_.filament.mm();
  return std::numbers::pi * radius * radius;
}

/// Whether a call that prints is possible.
bool Printer::usable(const char* call) const {
  if (!valid_) return false;
  if (z_ > 0.0) return true;
  diagnostics_.error(codes::op_option, where_,
                     fmt::format("{} before the first layer; call next_layer first", call));
  return false;
}

/// Whether so many steps more are within the limit.
bool Printer::room(std::size_t steps) {
  if (path_.size() + steps <= settings_.max_steps) return true;
  diagnostics_.error(codes::op_limit, where_,
                     fmt::format("the print has more than {} steps", settings_.max_steps));
  return false;
}

RegionOptions Printer::region_options() const { return {.where = where_}; }

void Printer::start(const PrintStart& start) {
  if (!valid_) return;
  const auto heats = [](double c) { return c >= 0.0 && c <= kMaxTemperature; };
  bool ok = true;
  ok &= expect(start.nozzle, heats(start.nozzle), "the temperature of the nozzle", "from 0 to 2000 C");
  ok &= expect(start.bed, heats(start.bed), "the temperature of the bed", "from 0 to 2000 C");
  ok &=
      expect(start.lift, start.lift > 0.0 && start.lift <= limits::kMaxCoordinate, "the lift", "above 0 mm");
  if (!ok || !room(8)) return;
  for (const bool wait : {false, true}) {
    if (start.bed > 0.0) path_.add(step::Temperature{Heater::bed, start.bed, wait}, origin_);
    if (start.nozzle > 0.0) path_.add(step::Temperature{Heater::nozzle, start.nozzle, wait}, origin_);
    if (wait) break;
    add_home(path_, 7, origin_);
    const std::size_t lift = path_.add(step::Cut{{0, 0, start.lift}, settings_.travel_speed}, origin_);
    path_.set_unknown_axes(lift, 3);
    known_ = false;
    at_ = {0, 0, start.lift};
  }
}

void Printer::finish(const PrintFinish& finish) {
  const bool ok = expect(finish.lift, finish.lift >= 0.0 && finish.lift <= limits::kMaxCoordinate, "the lift",
                         "0 mm or more");
  if (!ok || !valid_ || !room(6 + last_.size())) return;
  if (known_) {
    draw_back();
    move({at_.x, at_.y, at_.z + finish.lift}, settings_.travel_speed);
  }
  path_.add(step::Temperature{Heater::nozzle, 0.0, false}, origin_);
  path_.add(step::Temperature{Heater::bed, 0.0, false}, origin_);
  path_.add(step::Fan{0, 0.0}, origin_);
}

bool Printer::next_layer(std::optional<Length> height) {
  if (!valid_) return false;
  const Length wanted = height.value_or(settings_.height);
  bool ok = expect(wanted.mm(), wanted.mm() > 0.0 && wanted <= settings_.width, "the height of the layer",
                   "above 0 mm and at most the width of the beads");
  ok = ok &&
       expect(z_ + wanted.mm(), z_ + wanted.mm() <= limits::kMaxCoordinate, "Z of the layer", "a coordinate");
  if (!ok) return false;
  first_layer_ = z_ == 0.0;
  height_ = wanted;
  z_ += wanted.mm();
  return true;
}

// ---- motions

void Printer::move(Point3 to, Feed feed) {
  if (known_ && distance(to, at_) <= kNoLength) return;
  path_.add(step::Cut{to, feed}, origin_);
  at_ = to;
  known_ = true;
}

/// The speed of a bead of this cross-section, mm2.
Feed Printer::bead_feed(Feed speed, double area) const {
  if (!(speed > Feed{}))
    speed =
        first_layer_ && settings_.first_layer_speed > Feed{} ? settings_.first_layer_speed : settings_.speed;
  if (settings_.max_flow > VolumeFlow{} && area > 0.0)
    speed = std::min(speed, Feed::raw(settings_.max_flow.raw() / area));
  return speed;
}

/// Draws the filament back, over the way back along the last beads if they are to be wiped.
void Printer::draw_back() {
  const double length = settings_.retract.mm();
  if (!(length > 0.0) || drawn_back_ > 0.0 || printed_ == 0.0) return;
  drawn_back_ = length;
  const double volume = length * filament_area(), wipe = settings_.wipe.mm();
  double left = wipe;
  for (std::size_t i = last_.size(); i-- > 1 && left > kNoLength;) {
    const Point2 way = last_[i - 1] - last_[i];
    const double full = kerf::length(way);
    if (full <= kNoLength) continue;
    const double part = std::min(full, left);
    const Point2 to = last_[i] + part / full * way;
    at_ = {to.x, to.y, at_.z};
    path_.add(step::Extrude{at_, mm3(-volume * part / wipe), {}, {}, settings_.speed}, origin_);
    left -= part;
  }
  last_.clear();
  const double rest = wipe > 0.0 ? volume * left / wipe : volume;
  if (rest > kNoLength) path_.add(step::Extrude{at_, mm3(-rest), {}, {}, settings_.retract_speed}, origin_);
}

void Printer::push_back() {
  if (drawn_back_ == 0.0) return;
  path_.add(step::Extrude{at_, mm3(drawn_back_ * filament_area()), {}, {}, settings_.retract_speed}, origin_);
  drawn_back_ = 0.0;
}

bool Printer::travel(Point2 to) {
  if (!usable("a travel")) return false;
  if (!is_coordinate(to)) {
    diagnostics_.error(codes::op_option, where_, "a travel leads to a point that is no coordinate");
    return false;
  }
  if (!room(8 + last_.size())) return false;
  const Feed feed = settings_.travel_speed;
  const Point3 end{to.x, to.y, z_};
  if (!known_) {
    const Point3 above{to.x, to.y, std::max(at_.z, z_)};
    move(above, feed);
    move(end, feed);
    return true;
  }
  const bool far = distance(at_.xy(), to) >= std::max(settings_.min_travel.mm(), kNoLength);
  if (far) draw_back();
  const double high = std::max(at_.z, z_) + (far ? settings_.hop.mm() : 0.0);
  move({at_.x, at_.y, high}, feed);
  move({to.x, to.y, high}, feed);
  move(end, feed);
  last_.clear();
  return true;
}

/// `volume`: of the bead by its cross-section, mm3; the flow of the settings is applied here.
void Printer::lay(Point3 to, double width, double height, double volume, Feed feed, BeadKind kind) {
  push_back();
  if (last_.empty()) last_.push_back(at_.xy());
  path_.add(step::Extrude{to, mm3(settings_.flow * volume), mm(width), mm(height), feed, kind}, origin_);
  printed_ += settings_.flow * volume;
  at_ = to;
  last_.push_back(to.xy());
}

bool Printer::lay_along(const std::vector<Point2>& points, const BeadOptions& options) {
  if (points.size() < 2) return true;
  if (!room(2 * points.size() + 16) || !travel(points.front())) return false;
  const double width = options.width > Length{} ? options.width.mm() : settings_.width.mm();
  const double height = height_.mm();
  const double area = bead_volume(mm(1), mm(width), mm(height)).mm3();
  const Feed feed = bead_feed(options.speed, settings_.flow * area);
  last_.assign(1, points.front());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double length = distance(at_.xy(), points[i]);
    if (length <= kNoLength) continue;
    lay({points[i].x, points[i].y, z_}, width, height, area * length, feed, options.kind);
  }
  return true;
}

/// Closed points (the last is the first) from the seam on.
std::vector<Point2> Printer::from_seam(std::vector<Point2> points) const {
  points.pop_back();
  const auto before = [this](Point2 a, Point2 b) {
    if (settings_.seam == Seam::nearest && known_) return distance(a, at_.xy()) < distance(b, at_.xy());
    return a.y != b.y ? a.y > b.y : a.x < b.x;
  };
  std::rotate(points.begin(), std::min_element(points.begin(), points.end(), before), points.end());
  points.push_back(points.front());
  return points;
}

bool Printer::bead(const Outline& path, const BeadOptions& options) {
  if (!usable("a bead")) return false;
  const double width = options.width.mm(), speed = options.speed.mm_per_min();
  const bool sized = width == 0.0 || (width >= height_.mm() && width <= limits::kMaxBeadWidth);
  const bool timed = speed >= 0.0 && speed <= limits::kMaxSpeed;
  const bool placed = has_coordinates(path);
  if (!sized || !timed || !placed) {
    diagnostics_.error(codes::op_option, where_,
                       !placed  ? "the path of a bead is empty or has points that are no coordinates"
                       : !sized ? "the width of a bead must be at least the height of the layer"
                                : "the speed of a bead must be above 0 mm/min");
    return false;
  }
  std::vector<Point2> points = flattened(path, settings_.chord);
  if (path.closed()) points = from_seam(std::move(points));
  return lay_along(points, options);
}

// ---- vases

bool Printer::vase(const Outline& path, double top) {
  if (!usable("a vase")) return false;
  const double rise = top - z_;
  if (!path.closed() || !has_coordinates(path) || !(rise > 0.0 && top <= limits::kMaxCoordinate)) {
    diagnostics_.error(codes::op_option, where_,
                       path.closed() && has_coordinates(path)
                           ? "the top of a vase must be above the present layer"
                           : "the path of a vase must be closed, of points that are coordinates");
    return false;
  }
  const std::vector<Point2> points = from_seam(flattened(path, settings_.chord));
  double around = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) around += distance(points[i - 1], points[i]);
  const double height = height_.mm(), turns = std::max(1.0, std::round(rise / height));
  if (!(around > kNoLength) || !room(static_cast<std::size_t>(turns + 1.0) * points.size() + 16))
    return false;
  const double pitch = rise / turns, width = settings_.width.mm();
  const double area = bead_volume(mm(1), settings_.width, mm(pitch)).mm3();
  const Feed feed = bead_feed({}, settings_.flow * area);
  if (!travel(points.front())) return false;
  last_.clear();
  const double bottom = z_;
  double way = 0.0;  // in turns
  // The last turn, at the level of the top, ends where the one before it has reached the top.
  for (double turn = 0.0; turn <= turns; turn += 1.0) {
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double length = distance(points[i - 1], points[i]);
      const double halfway = way + 0.5 * length / around - turn;  // from 0 to 1 within the turn
      way += length / around;
      if (length <= kNoLength) continue;
      const double part = turn == 0.0 ? halfway : turn == turns ? 1.0 - halfway : 1.0;
      const double z = std::min(top, bottom + pitch * way), thick = pitch * part;
      lay({points[i].x, points[i].y, z}, width, thick,
          bead_volume(mm(length), settings_.width, mm(thick)).mm3(), feed, BeadKind::outer_wall);
    }
    way = turn + 1.0;
  }
  z_ = top;
  return true;
}

}  // namespace kerf
