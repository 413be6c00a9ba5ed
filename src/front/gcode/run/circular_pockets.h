// G12 and G13 of Haas and Mach3: circular pockets.
#pragma once

#include <optional>
#include <vector>

#include "front/gcode/run/compensation.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"

namespace kerf::gcode {

class CircularPockets : Part {
 public:
  CircularPockets(Context& context, Mover& mover, Feeds& feeds, Compensation& compensation)
      : Part(context), mover_(mover), feeds_(feeds), compensation_(compensation) {}

  /// The line's pocket.
  void mill();

 private:
  bool accepts();
  std::optional<double> length_word(char letter);
  void mill_as_mach3(Turn turn);
  void mill_as_haas(Turn turn);
  std::optional<std::vector<double>> radii();
  void mill_level(const std::vector<double>& radii, Turn turn, double feed);
  void cut_to(double x, double feed);
  void arc_to(double x, double centre_x, Turn turn, double feed);
  void refuse(std::uint32_t column, std::string what);

  Mover& mover_;
  Feeds& feeds_;
  Compensation& compensation_;
};

}  // namespace kerf::gcode
