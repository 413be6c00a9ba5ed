// Steps of an operation: entries, links and cuts along tracks, with rapids only where they are free of
// material.
#pragma once

#include <memory>
#include <optional>

#include "op/base/track.h"

#include "kerf/op/operation.h"

namespace kerf::op_detail {

/// The walls that the axis of a tool keeps its distance from.
class Walls {
 public:
  enum class Kind : bool {
    none,    ///< every line is free
    unknown  ///< no line is known to be free
  };
  explicit Walls(Kind kind) : kind_(kind) {}
  /// The boundary of `region`, which the axis approaches to `radius`.
  Walls(const Region& region, double radius, double tolerance)
      : search_(region), radius_(radius), tolerance_(tolerance) {}
  /// Lines inside of the region are free, and along its boundary: they may leave it by `margin` (mm, above
  /// 0).
  static Walls around(const Region& region, double margin);
  /// Whether a circle of the axis' path about `centre` keeps clear of them.
  bool permits_circle(Point2 centre, double radius) const;
  /// Whether the straight line between two permitted points keeps clear of them. May be false for lines
  /// along walls.
  bool permits_line(Point2 from, Point2 to) const;

 private:
  double clearance(Point2 at) const;
  bool stays_inside(Point2 from, Point2 to) const;
  Kind kind_ = Kind::none;
  std::optional<RegionSearch> search_;
  double radius_ = 0.0, tolerance_ = 0.0;
  double margin_ = 0.0;  // above 0: lines stay inside of the region
};

/// Appends the lines and arcs of a track from length `from` to `to`, Z from `here` to `z` in proportion to
/// the length, and returns where they end. Stops where the path has `max_steps`.
Point3 add_along(Toolpath& path, const Track& track, double from, double to, Point3 here, double z, Feed feed,
                 OriginId origin, double weld, std::size_t max_steps);

class Cutter {
 public:
  Cutter(const CutOptions& options, const Tool& tool, Walls walls);

  /// Where the tool is; nothing before the first motion.
  std::optional<Point3> position() const { return at_; }
  bool full() const;
  /// Rapids to above a point. Material was removed down to `cleared` where the axis may be; elsewhere, and
  /// where no straight line leads, the tool lifts to the retract plane.
  void travel(Point2 to, double cleared);
  /// From above the start `s` of a track into the material, to level `z`; material was removed there down to
  /// `cleared`. Returns the length of the track at which it is then.
  double enter(const Track& track, double s, double cleared, double z);
  /// Along a track from length `from` to `to`, from the present level to `z` in proportion to the length.
  void follow(const Track& track, double from, double to, double z);
  /// Straight at feed, on the level.
  void line(Point2 to);
  /// A quarter circle, or `turns` whole ones to the level `z`, about a centre.
  void arc(Point2 to, Point2 centre, Turn turn, double z, int turns = 0);
  /// Down to `z` about a centre; the axis is on the circle. Ends where it starts.
  void helix(Point2 centre, Turn turn, double z);
  void plunge(double z);
  bool plunges() const { return tool_.plunges; }
  /// Where `enter` had no other way than a plunge for a tool that must not: an error of `finished`.
  std::optional<Point2> bad_plunge() const { return bad_plunge_; }
  /// Straight at feed: up, or to a point at another level.
  void rise(double z);
  void slope(Point3 to);
  /// Down along a track to `z` at the angle of the entry: around a closed one, back and forth on the first
  /// part of an open one, from either end. Returns the length of the track at which it ends.
  double ramp(const Track& track, double s, double z);
  void lift();
  void rapid_down(double z);

  const Walls& walls() const { return walls_; }
  Toolpath take() { return std::move(path_); }

 private:
  void rapid(Point3 to);
  Feed descent_feed(double drop, double along) const;
  double helix_radius() const;
  const CutOptions& options_;
  const Tool& tool_;
  Walls walls_;
  Toolpath path_;
  OriginId origin_;
  std::optional<Point3> at_;
  Feed plunge_;
  std::optional<Point2> bad_plunge_;
};

/// False, with errors appended, where options are out of range. A flute shorter than the depth is a warning.
bool valid(const CutOptions& options, const Tool& tool, Diagnostics& diagnostics);
bool valid_stepover(double stepover, const CutOptions& options, Diagnostics& diagnostics);
RegionOptions region_options(const CutOptions& options);
/// False, with an error, for a tool that does not cut at its centre and therefore `cannot`: "drill".
bool may_plunge(const Tool& tool, std::string_view cannot, const CutOptions& options,
                Diagnostics& diagnostics);
/// "pocket 'left': " or nothing: the start of a message.
std::string prefix(const CutOptions& options);
/// Appends an error of the operation; false.
bool fail(const CutOptions& options, Code code, const std::string& message, Diagnostics& diagnostics);
/// Whether a point is within the limit for coordinates.
bool in_range(Point2 p);
/// False, with an error, where outlines extend beyond it.
bool within_limits(const std::vector<Outline>& outlines, const CutOptions& options, Diagnostics& diagnostics);
/// The operation of a cutter that has made its motions, which ends on the retract plane. Nothing where it was
/// stopped, or, with an error, where it has too many steps or plunges with a tool that must not.
std::optional<Operation> finished(Cutter& cutter, const CutOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
