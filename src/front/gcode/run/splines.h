// G5 to G5.3.
#pragma once

#include <optional>
#include <vector>

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"

#include "kerf/geom/fit.h"

namespace kerf::gcode {

class Splines : Part {
 public:
  Splines(Context& context, const Coordinates& coordinates, Mover& mover, Feeds& feeds)
      : Part(context), coordinates_(coordinates), mover_(mover), feeds_(feeds) {}

  void curve(Tenths motion);
  /// A motion that no G5 may continue.
  void forget_tangent() { last_control_point_.reset(); }

 private:
  void quadratic();
  void cubic();
  void nurbs();
  void add_control_point();
  std::optional<Point2> point_words(char u, char v);
  void cut_along(const Spline& spline);

  const Coordinates& coordinates_;
  Mover& mover_;
  Feeds& feeds_;
  std::vector<Point2> control_points_;  // of G5.2
  std::vector<double> control_weights_;
  int curve_order_ = 0;
  std::optional<Point2> last_control_point_;  // of G5: second control point, relative to the end
};

}  // namespace kerf::gcode
