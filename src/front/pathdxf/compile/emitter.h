// The steps of a compiled path: rapids that are merged, plunges, cuts, comments, and their statistics.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/pathdxf/text/pathdxf_options.h"

#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf::pathdxf {

/// A probed point in work coordinates.
struct PlacedProbe {
  Point2 at;               // work coordinates
  Point2 drawn;            // in its drawing
  double thickness = 0.0;  // mm, the expected height
  double feed = 0.0;       // mm/min
  std::string label;       // L
  std::string name;        // "#51"
  Origin where;
};

/// Lengths in mm and times in minutes, as PathDxf2GCode counts them.
struct Statistics {
  double milling = 0.0, drilling = 0.0, sweeps = 0.0;
  double milling_time = 0.0, drilling_time = 0.0, sweep_time = 0.0;
  std::size_t commands = 0;
};

/// "2.000"
std::string number_text3(double value);
/// "[1.000 2.000 3.000]"
std::string point_text3(Point3 p);

class Emitter {
 public:
  Emitter(Toolpath& path, const PathdxfOptions& options, const std::vector<PlacedProbe>& probes, double feed);

  bool traces() const { return options_.comments == PathdxfComments::trace; }
  void set_origin(OriginId origin) { origin_ = origin; }
  void start_at(Point3 position) { position_ = position; }
  Point3 position() const { return position_; }
  bool full() const;

  /// A comment of the trace. `indent` blanks precede it.
  void trace(int indent, std::string_view text);
  /// A comment in any case.
  void comment(int indent, std::string_view text);

  /// Rapid along Z; `at` selects the correction by probes, `length` is what the statistics count.
  void rapid_z(double z, Point2 at, double length);
  /// Rapid in XY. Of consecutive mergeable ones only the last is made. `length` is what the statistics count.
  void rapid_xy(Point2 to, double length, bool mergeable);
  /// Feed along Z, at the modal feed rate; `length` and `feed` are what the statistics count.
  void plunge(double z, Point2 at, double length, double feed);
  /// A cut at `feed`; `at` selects the correction.
  void cut(Point3 to, double feed, double length, Point2 at);
  void arc(Point3 to, Point2 centre, Turn turn, double feed, double length, Point2 at);
  /// The end of a program: up to a height, without correction, even if it is reached already.
  void last_rapid(double z);
  /// Makes the rapid that waits for being merged.
  void flush();

  const Statistics& statistics() const { return statistics_; }
  std::size_t add_rapid(Point3 to, unsigned named_axes);

 private:
  struct Waiting {
    Point2 to;
    double z = 0.0, length = 0.0;
    bool mergeable = false;
    OriginId origin = OriginId::none;
    std::vector<std::pair<std::string, OriginId>> comments;  // after it
  };
  void correct(std::size_t step, double z, Point2 at);
  void add_comment(std::string text, OriginId origin);
  void count_sweep(double length);

  Toolpath& path_;
  const PathdxfOptions& options_;
  const std::vector<PlacedProbe>& probes_;
  OriginId origin_ = OriginId::none;
  Point3 position_;
  double modal_feed_;
  double sweep_speed_;  // for the statistics
  std::optional<Waiting> waiting_;
  Statistics statistics_;
};

}  // namespace kerf::pathdxf
