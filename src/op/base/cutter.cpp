// Steps of an operation: entries, links and cuts along tracks.
#include "op/base/cutter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kerf/base/limits.h"

namespace kerf::op_detail {
namespace {

constexpr int kMaxLineSteps = 200;       // of the search along a line between walls
constexpr double kMaxSamples = 4096.0;   // of a line that stays inside of a region
constexpr double kHelixFraction = 0.45;  // default radius of a helix, of the tool's diameter
constexpr double kMinHelix = 0.1;     // a smaller fraction of the diameter leaves a core that stops the tool
constexpr double kMinRamp = 0.2;      // a ramp on a shorter path, as a fraction of the diameter, is a plunge
constexpr double kMaxRounds = 500.0;  // of a ramp along a track

/// Whether an arc differs from its chord: a flatter one, whose ends may coincide by rounding, is a line.
bool is_curved(const LineArc& piece, double weld) {
  if (!piece.is_arc()) return false;
  const double along = length_of(piece);
  return along * along > 8.0 * piece.radius * weld;
}

}  // namespace

double Walls::clearance(Point2 at) const {
  const std::optional<BoundaryPoint> nearest = search_->nearest(at);
  return nearest ? nearest->distance.mm() - (radius_ - tolerance_) : INFINITY;
}

bool Walls::permits_circle(Point2 centre, double radius) const {
  return !search_ || clearance(centre) >= radius;
}

Walls Walls::around(const Region& region, double margin) {
  Walls walls(region, 0.0, 0.0);
  walls.margin_ = margin;
  return walls;
}

bool Walls::stays_inside(Point2 from, Point2 to) const {
  const double whole = distance(from, to);
  for (double along = 0.0; along < whole;) {
    const auto inside = search_->clearance(from + (along / whole) * (to - from));
    if (!inside || inside->mm() < -margin_) return false;
    along += std::max({inside->mm(), margin_, whole / kMaxSamples});
  }
  return true;
}

bool Walls::permits_line(Point2 from, Point2 to) const {
  if (!search_) return kind_ == Kind::none;
  if (margin_ > 0.0) return stays_inside(from, to);
  const double whole = distance(from, to);
  double along = 0.0;
  for (int i = 0; i < kMaxLineSteps; ++i) {
    const double free = clearance(along >= whole ? to : from + (along / whole) * (to - from));
    if (free < 0.0) return false;
    // At every point the distance from the walls is at least `free`, less the way from there.
    if (along + free >= whole) return true;
    along += std::max(free, 0.5 * tolerance_);
  }
  return false;
}

Cutter::Cutter(const CutOptions& options, const Tool& tool, Walls walls)
    : options_(options), tool_(tool), walls_(std::move(walls)) {
  origin_ = std::holds_alternative<std::monostate>(options.where) ? OriginId::none
                                                                  : path_.origins().add(options.where);
  plunge_ = options.plunge > Feed{} ? options.plunge : 0.5 * options.feed;
}

bool Cutter::full() const { return path_.size() >= options_.max_steps || stop_requested(options_.progress); }

void Cutter::rapid(Point3 to) {
  if (at_ && *at_ == to) return;
  path_.add(step::Rapid{to}, origin_);
  at_ = to;
}

void Cutter::lift() {
  if (at_) return rapid({at_->x, at_->y, options_.retract_plane});
  // Where the tool is before the operation is unknown; it rises there.
  if (path_.size() > 0) return;
  path_.set_unknown_axes(path_.add(step::Rapid{{0.0, 0.0, options_.retract_plane}}, origin_), 3);
}

void Cutter::rapid_down(double z) {
  if (z < at_->z) rapid({at_->x, at_->y, z});
}

void Cutter::travel(Point2 to, double cleared) {
  const double low = cleared + options_.clearance.mm();
  if (at_ && distance(at_->xy(), to) <= options_.tolerance.weld.mm() && at_->z <= low) return;
  if (at_ && low < options_.retract_plane && walls_.permits_line(at_->xy(), to)) {
    if (at_->z < low) rapid({at_->x, at_->y, low});
    rapid({to.x, to.y, at_->z});
  } else {
    lift();
    rapid({to.x, to.y, options_.retract_plane});
  }
}

Feed Cutter::descent_feed(double drop, double along) const {
  if (!(drop > 0.0)) return options_.feed;
  const double slope = drop / std::hypot(drop, along);
  return std::min(options_.feed, plunge_ / slope);
}

void Cutter::line(Point2 to) {
  if (distance(at_->xy(), to) <= options_.tolerance.weld.mm()) return;
  at_ = Point3{to.x, to.y, at_->z};
  path_.add(step::Cut{*at_, options_.feed}, origin_);
}

void Cutter::plunge(double z) {
  if (z >= at_->z) return;
  at_->z = z;
  path_.add(step::Cut{*at_, plunge_}, origin_);
}

void Cutter::rise(double z) { slope({at_->x, at_->y, z}); }

void Cutter::slope(Point3 to) {
  if (to == *at_) return;
  const Feed feed = descent_feed(at_->z - to.z, distance(at_->xy(), to.xy()));
  at_ = to;
  path_.add(step::Cut{to, feed}, origin_);
}

void Cutter::arc(Point2 to, Point2 centre, Turn turn, double z, int turns) {
  const double along = 2.0 * std::numbers::pi * std::max(turns, 1) * distance(centre, to);
  const Feed feed = descent_feed(at_->z - z, along);
  at_ = Point3{to.x, to.y, z};
  path_.add(step::Arc{.to = *at_,
                      .centre = centre,
                      .plane = Plane::xy,
                      .turn = turn,
                      .extra_turns = std::max(turns - 1, 0),
                      .feed = feed},
            origin_);
}

void Cutter::helix(Point2 centre, Turn turn, double z) {
  const double round = 2.0 * std::numbers::pi * distance(centre, at_->xy());
  const double pitch = round * std::tan(options_.entry.angle.rad());
  const double turns = std::ceil((at_->z - z) / pitch - 1e-9);
  if (turns > 0.0)
    arc(at_->xy(), centre, turn, z, static_cast<int>(std::min(turns, double{limits::kMaxTurns})));
}

Point3 add_along(Toolpath& path, const Track& track, double from, double to, Point3 here, double z, Feed feed,
                 OriginId origin, double weld, std::size_t max_steps) {
  const double z0 = here.z, whole = std::abs(to - from);
  if (!(whole > 0.0)) return here;
  const std::vector<LineArc> pieces = track.pieces(from, to);
  double along = 0.0;
  for (std::size_t i = 0; i < pieces.size() && path.size() < max_steps; ++i) {
    const LineArc& piece = pieces[i];
    along += length_of(piece);
    const double level = i + 1 == pieces.size() ? z : z0 + (z - z0) * std::min(along / whole, 1.0);
    here = Point3{piece.to.x, piece.to.y, level};
    if (is_curved(piece, weld))
      path.add(step::Arc{.to = here,
                         .centre = piece.circle_centre(),
                         .plane = Plane::xy,
                         .turn = piece.turn > 0.0 ? Turn::ccw : Turn::cw,
                         .extra_turns = 0,
                         .feed = feed},
               origin);
    else
      path.add(step::Cut{here, feed}, origin);
  }
  return here;
}

void Cutter::follow(const Track& track, double from, double to, double z) {
  const Feed feed = descent_feed(at_->z - z, std::abs(to - from));
  at_ = add_along(path_, track, from, to, *at_, z, feed, origin_, options_.tolerance.weld.mm(),
                  options_.max_steps);
}

double Cutter::helix_radius() const {
  return options_.entry.radius > Length{} ? options_.entry.radius.mm() : kHelixFraction * tool_.diameter.mm();
}

double Cutter::ramp(const Track& track, double s, double z) {
  const double run = (at_->z - z) / std::tan(options_.entry.angle.rad());
  if (track.closed()) {
    follow(track, s, s + run, z);
    return s + run;
  }
  // Back and forth on the first part of an open track, from either of its ends.
  const double forwards = s <= 0.0 ? 1.0 : -1.0;
  const double there = std::ceil(run / (2.0 * track.length()));
  const double leg = run / (2.0 * there), drop = (at_->z - z) / (2.0 * there);
  for (double k = 0.0; k < there && !full(); k += 1.0) {
    follow(track, s, s + forwards * leg, at_->z - drop);
    follow(track, s + forwards * leg, s, k + 1.0 < there ? at_->z - drop : z);
  }
  return s;
}

double Cutter::enter(const Track& track, double s, double cleared, double z) {
  rapid_down(cleared + options_.clearance.mm());
  if (z >= at_->z) return s;
  EntryKind kind = options_.entry.kind;
  if (kind == EntryKind::helix) {
    const Point2 start = track.at(s), aside = left_of(track.direction(s));
    const double usual = helix_radius(), smallest = std::min(usual, kMinHelix * tool_.diameter.mm());
    for (double radius = usual; radius >= smallest; radius *= 0.5)
      for (const double side : {1.0, -1.0}) {
        const Point2 centre = start + (side * radius) * aside;
        if (!track.closed() || !walls_.permits_circle(centre, radius)) continue;
        helix(centre, side > 0.0 ? Turn::ccw : Turn::cw, z);
        return s;
      }
    kind = EntryKind::ramp;
  }
  if (kind == EntryKind::plunge && !tool_.plunges) kind = EntryKind::ramp;
  const double shortest = std::max(kMinRamp * tool_.diameter.mm(),
                                   (at_->z - z) / std::tan(options_.entry.angle.rad()) / kMaxRounds);
  if (kind == EntryKind::ramp && track.length() >= shortest) return ramp(track, s, z);
  if (!tool_.plunges && !bad_plunge_) bad_plunge_ = at_->xy();
  plunge(z);
  return s;
}

}  // namespace kerf::op_detail
