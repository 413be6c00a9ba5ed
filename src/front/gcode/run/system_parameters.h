// Parameters that hold the controller's state: #5220, #5420, #<_x>, #<_feed> and so on.
#pragma once

#include <optional>
#include <string_view>

#include "front/gcode/run/calls.h"
#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/rotary_axes.h"
#include "front/gcode/run/tool_diameters.h"
#include "front/gcode/run/tools.h"

namespace kerf::gcode {

/// What programs can read. It may be made before what it refers to.
class SystemParameters : public SystemValues {
 public:
  SystemParameters(const Context& context, const Coordinates& coordinates, const RotaryAxes& rotary,
                   const Feeds& feeds, const Tools& tools, const ToolDiameters& diameters,
                   const Compensation& compensation, const Calls& calls)
      : context_(context),
        coordinates_(coordinates),
        rotary_(rotary),
        feeds_(feeds),
        tools_(tools),
        diameters_(diameters),
        compensation_(compensation),
        calls_(calls) {}

  std::optional<double> system_number(int number) const override;
  std::optional<double> system_name(std::string_view name) const override;
  double unit_of(int number) const override;
  bool is_unknown_number(int number) const override;
  bool is_unknown_name(std::string_view name) const override;

 private:
  Point3 program_position() const;
  std::optional<double> position_parameter(std::string_view name) const;

  const Context& context_;
  const Coordinates& coordinates_;
  const RotaryAxes& rotary_;
  const Feeds& feeds_;
  const Tools& tools_;
  const ToolDiameters& diameters_;
  const Compensation& compensation_;
  const Calls& calls_;
};

}  // namespace kerf::gcode
