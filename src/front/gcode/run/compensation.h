// G40 to G42: motions with cutter compensation.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/tool_diameters.h"
#include "op/mill/cutter_compensation.h"

namespace kerf::gcode {

enum class MotionKind : std::uint8_t { rapid, cut };

/// State of G41 and G42. Points are in the plane's right-handed frame.
class Compensation : Part {
 public:
  Compensation(Context& context, const Coordinates& coordinates, Mover& mover, const ToolDiameters& diameters)
      : Part(context), coordinates_(coordinates), mover_(mover), diameters_(diameters) {}

  void set();
  void end();
  void end_for_refused_codes();
  void refuse(std::string_view what, std::uint32_t column);
  void line(const ToolPosition& to, MotionKind kind, double feed);
  void arc(const ToolPosition& to, Point2 centre, Turn turn, int extra, Feed feed);

  /// The diameter in mm of the tool with this number, without one of the tool in the spindle; 0 for tool 0.
  /// Nothing with an error if it is unknown.
  std::optional<double> diameter_of_tool(std::optional<double> number);

  bool is_on() const { return cutter_.has_value(); }
  bool is_left() const { return cutter_->is_left(); }
  /// After G40, until the tool is back on the programmed path.
  bool is_leaving() const { return leaving_; }
  bool stop_leaving() { return std::exchange(leaving_, false); }

 private:
  std::optional<double> given_diameter(std::optional<double> number);
  std::optional<double> assumed_diameter(std::optional<int> tool);
  void reset();
  void along_third_axis(const ToolPosition& to, MotionKind kind, double feed);
  bool add_corner(const CompensatedElement& made, MotionKind kind, double feed);
  void report_gouge();
  void add_motion(Point3 at, const ToolPosition& to, MotionKind kind, double feed);

  const Coordinates& coordinates_;
  Mover& mover_;
  const ToolDiameters& diameters_;
  std::optional<CutterCompensation> cutter_;  // while it is on
  bool leaving_ = false;
  std::size_t last_step_ = 0;  // the first step of the last element
};

}  // namespace kerf::gcode
