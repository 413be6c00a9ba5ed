// Calls of subroutines, and the modes that are stored and restored at them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/spindle.h"

namespace kerf::gcode {

/// Modes stored by M70 and M73.
struct SavedModes {
  Modes modes;
  bool automatic = false;  // M73: restored at the end of the subroutine
};

class Calls : Part {
 public:
  Calls(Context& context, Coordinates& coordinates, Spindle& spindle)
      : Part(context), coordinates_(coordinates), spindle_(spindle) {}

  /// After calls and returns: sets the file of diagnostics and origins, restores modes stored by M73.
  void follow();
  /// A line with an O-word.
  void control(const Block& block);
  /// M98, M99. False for an M99 that ends the program.
  bool subroutine();
  /// G65 to G67.
  void macro_call();
  /// After a motion: calls the macro of G66.
  void modal_macro_call();
  /// M70 to M73.
  void save_modes();
  std::size_t depth() const { return depth_; }
  bool has_modal_macro() const { return modal_.has_value(); }

 private:
  struct MacroCall {
    int number = 0, repeats = 1;
    std::array<ParameterValue, Parameters::kMacroLocals> arguments;
    std::size_t depth = 0;  // of the lines after which G66 calls it
  };
  std::optional<MacroCall> read_macro_call();
  bool set_arguments(MacroCall& call);
  void restore_modes(const Modes& modes);

  Coordinates& coordinates_;
  Spindle& spindle_;
  const std::string* file_name_ = nullptr;
  std::size_t depth_ = 0;
  std::optional<MacroCall> modal_;
  std::vector<std::optional<SavedModes>> saved_modes_{1};  // one per call level
};

}  // namespace kerf::gcode
