// Coordinate systems: work offsets, shifts, homes, scaling and rotation of the program.
#pragma once

#include <array>
#include <optional>

#include "front/gcode/run/part.h"
#include "front/gcode/run/tool_diameters.h"

namespace kerf::gcode {

inline constexpr int kHome28 = 5161, kHome30 = 5181;  // first of the parameters that store the homes

/// Offsets of the coordinate systems, and what they are measured from. Index 1 to 9: G54 to G59.3. The stored
/// offset of a system that the program has not set is unknown and counts as 0.
struct WorkOffsets {
  /// What the zero of an axis is measured from: 0 machine zero, 1 to 9 the stored offset of that system,
  /// above: a position at which the program has set it.
  using Base = int;
  static constexpr int kSystems = 9;

  Point3 in_effect;                            // of the active system, mm
  double rotation = 0.0;                       // of the active system, degrees
  std::array<Point3, kSystems + 1> written{};  // as the steps so far set them in the controller
  std::array<std::array<Base, 3>, kSystems + 1> base{};
  std::array<Base, 3> shift_base{};  // of G92; 0: none of unknown size
  Base next_base = kSystems + 1;
  int selected = 0;         // by the last step; 0: none
  unsigned kept_shift = 0;  // axes whose stored shift is of unknown size

  WorkOffsets() {
    for (int system = 1; system <= kSystems; ++system) base[static_cast<std::size_t>(system)].fill(system);
  }
  /// Axes on which two systems are measured from different bases.
  unsigned unrelated(int a, int b) const {
    unsigned axes = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (base[static_cast<std::size_t>(a)][axis] != base[static_cast<std::size_t>(b)][axis])
        axes |= 1u << axis;
    return axes;
  }
  /// Axes with a shift (G92) of unknown size.
  unsigned unknown_shift() const {
    unsigned axes = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (shift_base[axis] != 0) axes |= 1u << axis;
    return axes;
  }
};

/// Transformation from program coordinates to those of the toolpath: scaled, rotated about zero, shifted.
struct ProgramFrame {
  Point3 shift;           // mm
  double rotation = 0.0;  // degrees, in XY
  double cosine = 1.0, sine = 0.0;
  Point3 scale{1.0, 1.0, 1.0};  // G51, about `scale_zero` in program coordinates
  Point3 scale_zero;
  bool only_shifted = true;

  Point3 to_path(Point3 program) const;
  Point3 to_program(Point3 path) const;
};

/// The zero of the program's coordinates, and the coordinates of the toolpath.
class Coordinates : Part {
 public:
  Coordinates(Context& context, ToolDiameters& diameters) : Part(context), diameters_(diameters) {}

  const ProgramFrame& frame() const { return frame_; }
  const WorkOffsets& offsets() const { return offsets_; }
  Point3 local_shift() const { return local_shift_; }
  bool shift_is_on() const { return shift_is_on_; }
  /// The position of G28 or of G30.
  const ToolPosition& home(Reference home) const { return home == Reference::home ? home_28_ : home_30_; }

  /// G54 to G59.3.
  void use_coordinates();
  /// Of restored modes.
  void return_to_system(int system);
  bool selects_extended_offset();
  void use_extended_offset(std::string_view selection, std::uint32_t column);
  void set_data();
  void set_home(Reference home);
  void shift_locally();
  void shift_zero();
  void end_shift(Tenths code);
  void scale_program();
  void rotate_program();
  /// The position, and the homes stored so far, are unknown in the present coordinates.
  void lose(unsigned axes);
  void note_zeros();
  /// `after`: what follows the program's end.
  void end_program(AfterEnd after);

 private:
  /// The zero that motions had.
  struct Zero {
    int system = 1;
    std::array<WorkOffsets::Base, 3> base, shift;
  };
  void select_system(int system);
  void load_offsets();
  void report_unknown_zero(const Zero& first, const Zero& now);
  void set_system(int system);
  void touch_off(int system);
  void add_touch_off(int system, unsigned axes, unsigned located, Point3 at);
  bool take_scale_about(Point3& factors, Point3& centre);
  void update_frame();

  ToolDiameters& diameters_;
  ProgramFrame frame_;
  WorkOffsets offsets_;
  std::size_t zero_from_ = 0;              // the first step with the present zero
  TextLocation zero_location_;             // of the word that set it
  std::optional<Zero> moved_in_, cut_in_;  // of the first motion, of the first cut
  Point3 local_shift_;                     // by G92 and G52, mm
  Point3 kept_local_shift_;                // stored by G92 and G52, for G92.3
  bool shift_is_on_ = false;               // #5210: by G92, G52 and G92.3, until G92.1 or G92.2
  double program_rotation_ = 0.0;          // G68, degrees
  Point3 program_rotation_centre_;         // program coordinates, mm
  ToolPosition home_28_, home_30_;
  bool unknown_offset_reported_ = false;
};

}  // namespace kerf::gcode
