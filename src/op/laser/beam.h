// Steps of a laser: rapids with the beam at power 0, cuts with a power.
#pragma once

#include <optional>
#include <vector>

#include "op/base/cutter.h"

#include "kerf/op/laser.h"

namespace kerf::op_detail {

/// What the checks and regions of milling operations need.
CutOptions cut_options(const LaserOptions& options);
/// False, with errors appended, where options are out of range.
bool valid(const LaserOptions& options, Diagnostics& diagnostics);

class Beam {
 public:
  explicit Beam(const LaserOptions& options);

  std::optional<Point2> position() const { return at_; }
  bool full() const { return path_.size() >= options_.max_steps || stop_requested(options_.progress); }
  /// A rapid with power 0.
  void travel(Point2 to);
  /// Of the cuts that follow, a fraction of full power; rounded to whole S.
  void power(double fraction);
  void feed(Feed feed) { feed_ = feed; }
  void line(Point2 to);
  void arc(Point2 to, Point2 centre, Turn turn);
  /// Along a track from length `from` to `to`.
  void follow(const Track& track, double from, double to);

  /// The operation, with the beam off at its end. Nothing where it was stopped, or, with an error, where it
  /// has too many steps.
  std::optional<Operation> finished(Diagnostics& diagnostics);

 private:
  void add_motion(std::size_t step) { path_.set_unknown_axes(step, 4); }
  void set(double s);
  const LaserOptions& options_;
  Toolpath path_;
  OriginId origin_;
  Feed feed_;
  std::optional<Point2> at_;
  double s_ = -1.0;  // the power of the last step; -1: none
};

/// A part of a scan line with one power, by distances from the line's origin.
struct ScanPart {
  double from = 0.0, to = 0.0;  // from < to, mm
  double power = 0.0;           // fraction, > 0
};
/// A line through `origin` along the unit vector `along`. Its parts are in order, backwards lines start at
/// the last one. Between parts the beam moves on with power 0; long gaps are rapids.
void scan_line(Beam& beam, Point2 origin, Point2 along, const std::vector<ScanPart>& parts, bool backwards,
               Length overscan);

/// False, with errors, where options of scan lines are out of range.
bool valid(const ScanOptions& scan, const LaserOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
