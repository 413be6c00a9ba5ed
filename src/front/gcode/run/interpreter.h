// The interpreter: the modal state of a controller, and the steps that each line adds in that state.
//
// Words take effect in the order of LinuxCNC's interpreter and as it defines them. A line that LinuxCNC
// refuses but other controllers read is read as by those, with a diagnostic.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "front/gcode/comments/cam_comments.h"
#include "front/gcode/comments/cam_stock_comments.h"
#include "front/gcode/comments/own_comments.h"
#include "front/gcode/program/flow.h"
#include "front/gcode/program/line_words.h"
#include "front/gcode/program/parameters.h"
#include "op/mill/cutter_compensation.h"
#include "path/feed_mode.h"
#include "tool/tool_comments.h"

#include "kerf/base/progress.h"
#include "kerf/geom/fit.h"
#include "kerf/geom/geometry.h"
#include "kerf/op/holes.h"
#include "kerf/program/gcode.h"

namespace kerf::gcode {

inline constexpr unsigned kAllAxes = 7;
inline constexpr double kMinPlaneMotion = 1e-9;       // mm; a shorter distance is no motion in the plane
inline constexpr int kHome28 = 5161, kHome30 = 5181;  // first of the parameters that store the homes
inline constexpr std::uint32_t kAllLetters = (1u << 26) - 1;
inline constexpr Tenths kNoMotion = 800;          // G80
inline constexpr Tenths kMotionNotGiven = -1;     // before the first motion code
inline constexpr Tenths kMotionUnsupported = -2;  // after one that is not supported

/// A position with its unknown axes (Step::unknown_axes).
struct ToolPosition {
  Point3 at;  // mm
  unsigned unknown = kAllAxes;
  Reference reference = Reference::work;  // of reference_axes, which this line sets
  unsigned reference_axes = 0;
};

inline constexpr double kMaxCoordinate = 1e7;  // mm; 10 km
/// Whether the absolute values of all coordinates are <= kMaxCoordinate.
inline bool within_limit(Point3 p) {
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
         std::abs(p.z) <= kMaxCoordinate;
}

/// Modal state.
struct Modes {
  Tenths motion = kMotionNotGiven;
  Plane plane = Plane::xy;
  bool absolute = true;
  bool absolute_centres = false;
  double scale = 1.0;  // mm of one unit of the program
  FeedMode feed_mode = FeedMode::per_minute;
  double feed = 0.0;        // mm/min, 1/min or mm/turn; 0: none given
  double feed_scale = 1.0;  // `scale` at the F word: #<_feed> is its number, also after a change of units
  double speed = 0.0;       // rpm
  SpindleTurn spindle = SpindleTurn::off;
  bool mist = false, flood = false;
  // M48 to M53: without effect on the toolpath, but programs can read them
  bool feed_override = true, speed_override = true, adaptive_feed = false, feed_hold = true;
  double surface_speed = 0.0;     // m/min of G96; 0: the speed is in rpm
  bool speed_given = false;       // an S word was read
  bool retract_to_start = false;  // G98
  bool diameters = false;         // G7: X words are diameters
  int system = 1;                 // 1 to 9: G54 to G59.3
  std::optional<int> selected_tool, tool;
};

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

/// Modes stored by M70 and M73.
struct SavedModes {
  Modes modes;
  bool automatic = false;  // M73: restored at the end of the subroutine
};

/// Words of a canned cycle, in force until its end. R and Z as in the program, in mm; the rest in mm and
/// seconds.
struct CycleWords {
  Tenths motion = kNoMotion;  // the cycle of these words
  std::optional<double> r, bottom, dwell, peck;
  std::optional<double> aside_u, aside_v, back_level;  // I J K of a back boring cycle
  std::optional<double> start_level;                   // before the first of consecutive cycles
};

/// State of G41 and G42. Points are in the plane's right-handed frame.
struct Compensation {
  std::optional<CutterCompensation> cutter;  // while it is on
  bool leaving = false;                      // after G40, until the tool is back on the programmed path
  std::size_t last_step = 0;                 // the first step of the last element
};

enum class MotionKind : std::uint8_t { rapid, cut };

class Interpreter : public SystemValues {
 public:
  Interpreter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
              LineReporter& reporter);

  Parameters& parameters() { return parameters_; }
  /// Must be set before the first run().
  void set_flow(Flow& flow) { flow_ = &flow; }
  std::optional<double> system_number(int number) const override;
  std::optional<double> system_name(std::string_view name) const override;
  double unit_of(int number) const override;
  bool is_unknown_number(int number) const override;
  bool is_unknown_name(std::string_view name) const override;

  /// Executes one line.
  void run(const Block& block);
  /// Fast path: executes lines of nothing but G0 or G1, axis words and F, at most `limit` of them, with the
  /// same result as run(). Stops before any other line. Returns the number of lines.
  std::size_t run_simple_lines(BlockReader& reader, std::size_t limit);
  /// Must be called after the last line.
  void finish();
  /// True after the end of the program, or at the limit of steps.
  bool done() const { return full_ || stopped_; }

 private:
  // interpreter.cpp
  bool reads_after_end(const Block& block);
  void report_unreadable_end();
  void note_program_end();
  void read_percent();
  void report_missing_speed();
  void note_lathe_words();
  void report_turning();
  void execute();

  void skip_setting(const Block& block);
  void note_unknown_words();
  void leave_out();
  bool selects_extended_offset();
  void use_extended_offset(std::string_view selection, std::uint32_t column);

  void follow_calls();
  void note_caller();
  bool is_printer() const { return kerf::is_printer(program_.dialect); }
  bool printer_line();

  // simple_lines.cpp
  bool accepts_simple_lines() const;
  bool run_simple_line(std::string_view text, std::uint32_t number);

  // comment_effects.cpp
  void read_comment(const Comment& comment, bool at_tool_change);
  void use_own_comment(const OwnComment& own, const TextLocation& where);
  void pass_on(std::string_view text, std::uint32_t column);
  void read_cam_comment(std::string_view text, const TextLocation& where, bool at_tool_change);
  void use_pending_comments();
  void use_cam_comment(std::string_view text, const TextLocation& where, bool at_tool_change);
  void assign_description(int number);
  struct DescribedTool {
    std::string text;
    TextLocation where;
    CamTool tool;
  };
  void describe_tool(int number, const DescribedTool& described);

  // settings.cpp
  void set_feed_mode();
  void set_units();
  void set_feed();
  void set_speed();
  void select_tool();
  void change_tool();
  void put_tool(int number);
  void change_tool_at_pause();
  void switch_spindle();
  void switch_coolant();
  void switch_overrides();
  void dwell();
  double seconds_of_p(double p) const;
  void report_long_dwell(double time, char letter);
  void set_plane();
  void set_path_mode();
  void set_distance();
  void use_words_of_other_codes();
  void set_tool_length();
  void end_or_pause();
  void end_program();
  void set_spindle_mode();
  void report_surface_speed(std::uint32_t column);
  void subroutine();
  void macro_call();
  void save_modes();
  void restore_modes(const Modes& modes);
  void set_beam();
  void read_large_m_code();

  // work_offsets.cpp
  /// The zero that motions had.
  struct Zero {
    int system = 1;
    std::array<WorkOffsets::Base, 3> base, shift;
  };
  void use_coordinates();
  void select_system(int system);
  void load_offsets();
  void note_zeros();
  void report_unknown_zero(const Zero& first, const Zero& now);
  void set_data();
  void set_system(int system);
  void touch_off(int system);
  void add_touch_off(int system, unsigned axes, unsigned located, Point3 at);
  void lose(unsigned axes);
  void end_shift(Tenths code);
  void set_tool_data(int tool);
  void shift_locally();
  bool take_scale_about(Point3& factors, Point3& centre);
  void scale_program();
  void rotate_program();
  void update_frame();
  void set_home(int first, ToolPosition& home);

  // system_parameters.cpp
  Point3 program_position() const;
  std::optional<double> position_parameter(std::string_view name) const;
  std::optional<double> diameter_of(int tool) const;

  // printer.cpp
  void printer_command(std::string_view text);
  void printer_code();
  bool tool_offset_command(std::string_view text);
  void lose_by_tool_offset();
  // extruders.cpp
  std::optional<int> extruder_number(double number, std::uint32_t column);
  void use_extruder(int number);
  double flow_factor() const;
  bool extruder_command(std::string_view text);
  std::optional<double> factor_of(double percent, double least, std::string_view code);
  bool set_speed_factor(std::string_view words);
  bool set_flow_factor(std::string_view words);
  bool set_tool_temperature(std::string_view code, std::string_view words);

  void printer_reference();
  void run_to_end_switches();
  void set_filament(std::string_view text);
  void set_volumetric();
  bool filament_is_relative() const;
  void extrude(const ToolPosition& to, double feed);
  void extrude_arc(const ArcWalk& walk, const ToolPosition& to, Feed feed);

  // splines.cpp
  void curve(Tenths motion);
  void quadratic();
  void cubic();
  void nurbs();
  void add_control_point();
  std::optional<Point2> point_words(char u, char v);
  void cut_along(const Spline& spline);

  // compensation.cpp
  Point2 in_plane(Point3 p) const;
  Point3 with_plane_position(Point3 p, Point2 to) const;
  void set_compensation();
  std::optional<double> given_diameter(std::optional<double> number);
  std::optional<double> diameter_for_compensation(std::optional<double> number);
  std::optional<double> assumed_diameter(std::optional<int> tool);
  void end_compensation();
  void end_compensation_for_refused_codes();
  void refuse_compensated(std::string_view what, std::uint32_t column);
  void compensated_line(const ToolPosition& to, MotionKind kind, double feed);
  void along_third_axis(const ToolPosition& to, MotionKind kind, double feed);
  bool add_corner(const CompensatedElement& made, MotionKind kind, double feed);
  void report_gouge();
  void compensated_arc(const ToolPosition& to, Point2 centre, Turn turn, int extra, Feed feed);
  void add_compensated(Point3 at, const ToolPosition& to, MotionKind kind, double feed);

  // thread_cycles.cpp
  void spindle_motion(Tenths motion);
  struct Thread;
  Thread take_thread_words();
  void thread_pass(const Thread& thread, const ToolPosition& start, double end_z, double depth);
  void thread_cycle();

  // motion.cpp
  void run_line_motion();
  void run_motion(Tenths motion);
  void straight(Tenths motion);
  bool may_move_after_cancel();
  void probe(ProbeKind kind);
  void use_reference();
  void reference_axes();
  void go_home(const ToolPosition& home, Reference reference);
  void take_assigned_home(int first, unsigned axes, unsigned rotary, ToolPosition& to) const;
  void note_stop();
  void shift_zero();
  std::optional<ToolPosition> target();
  ToolPosition target_in_frame();
  void polar();
  std::optional<ToolPosition> machine_target();
  bool reachable(Point3 p);
  double feed_for(double length);
  double straight_length(const ToolPosition& to) const;
  double straight_feed(const ToolPosition& to);
  unsigned take_rotary_words();
  void mark_measured(ToolPosition& to) const;

  // arcs.cpp
  void use_idle_offset();
  void arc(Turn turn);
  void arc_as_chords(Turn turn);
  std::optional<Point2> centre_of(const ToolPosition& to, Turn turn);
  std::optional<Point2> centre_from_offsets();
  Point2 rotated_offset(Point2 offset) const;
  std::optional<Point2> centre_from_radius(const ToolPosition& to, Turn turn);
  bool radii_agree(const ToolPosition& to, Point2 centre);
  bool refuse_arc_after_compensation();
  int extra_turns();

  // canned_cycles.cpp
  class CycleSink;
  void cycle(Tenths motion);
  bool take_cycle_words(Tenths motion);
  void report_wrong_turn(Tenths motion);
  void repeat_on_circle(DrillCycle cycle, const ToolPosition& to);
  std::optional<DrillCycle> plan_cycle(Tenths motion, ToolPosition& target_position);
  void plan_back_bore(DrillCycle& cycle) const;
  bool refuse_variable_pecks(Tenths motion);
  double unit_of_peck();
  int repeats();
  int reachable_holes(const DrillCycle& cycle, int holes);
  double cycle_feed();

  void report_unresolved(std::string_view what, std::uint32_t column);

  // steps
  bool room_for(double steps);
  OriginId origin();
  void start_origin(std::uint32_t column);
  template <class S>
  bool add(const S& step);
  void rapid(const ToolPosition& to);
  void cut(const ToolPosition& to, double feed);
  void locked_cut(const ToolPosition& to, double feed, SpindleLock lock);
  void arrive(const ToolPosition& to);
  void set_motion_extra();
  void set_spindle(SpindleTurn turn);

  GcodeProgram& program_;
  Toolpath& path_;
  ToolComments tool_comments_;
  LineReporter& reporter_;
  const GcodeReadOptions& options_;
  Parameters parameters_;
  Flow* flow_ = nullptr;
  const std::string* current_file_ = nullptr;
  std::size_t current_depth_ = 0;
  std::size_t max_steps_;
  AfterEnd after_end_;
  std::uint32_t file_;
  LineWords line_;
  std::uint32_t origin_line_ = 0;  // the line of origin_
  OriginId origin_ = OriginId::none;
  std::vector<OriginId> callers_;  // the lines of the calls that are being executed
  bool full_ = false;
  bool stopped_ = false;  // at text after the program's end (AfterEnd::stop)

  Modes modes_;
  ToolPosition position_;
  std::array<double, 3> rotary_{};       // degrees
  std::array<double, 3> rotary_from_{};  // before the line's words
  unsigned rotary_unknown_ = kAllAxes;   // bits 1, 2, 4: A, B, C
  unsigned rotary_unknown_from_ = kAllAxes;
  unsigned rotary_reference_ = 0;  // axes that the next motion moves to its reference
  unsigned rotary_axes_ = 0;       // those that the program has
  bool rotary_used_ = false;
  SpindleLock lock_ = SpindleLock::none;  // of the motion that is added
  Tenths motion_before_cycle_ = kMotionNotGiven;
  std::pair<double, double> polar_step_{};  // radius in mm and angle in degrees of the line's polar words
  unsigned named_ = 0;  // axes named by the line, for Step::named_axes; 0: its motions are computed
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
  Tenths work_offset_ = 540;
  bool starts_at_rest_ = false;  // the next motion starts at rest: a zero was shifted
  ToolPosition home_28_, home_30_;
  std::vector<std::optional<SavedModes>> saved_modes_{1};  // one per call level
  std::map<int, double> tool_diameters_;                   // mm, by G10 L1
  std::vector<Point2> control_points_;                     // of G5.2
  std::vector<double> control_weights_;
  int curve_order_ = 0;
  std::optional<Point2> last_control_point_;  // of G5: second control point, relative to the end
  LaserMode beam_mode_ = LaserMode::off;
  double beam_power_ = 0.0;
  double filament_ = 0.0;           // E position, mm (mm3 after M200)
  double filament_diameter_ = 0.0;  // mm
  bool filament_relative_ = false;
  bool volumetric_ = false;                      // M200: E is a volume
  double bead_width_ = 0.0, bead_height_ = 0.0;  // mm, of comments; 0: unknown
  bool extrudes_ = false;                        // T words of such a program select extruders
  int extruder_ = 0;
  double speed_factor_ = 1.0, stored_speed_factor_ = 1.0;  // M220
  std::map<int, double> flow_factors_;                     // M221, by extruder; 1 without an entry
  std::map<int, double> tool_celsius_;                     // as G10 of RepRapFirmware has set them
  BeadKind bead_kind_ = BeadKind::none;                    // of comments
  std::optional<step::ToolLength> tool_length_;
  std::optional<int> length_tool_;  // in the spindle when it was set
  CycleWords cycle_;
  Compensation compensation_;

  StockComments stock_;
  OwnComments own_comments_;
  std::optional<int> change_at_pause_;  // the tool of a comment of Kerf's posts
  CamComments cam_comments_;
  CamStockComments cam_stock_comments_;
  struct PendingComment {
    std::string text;
    TextLocation where;
    bool at_tool_change = false;
  };
  std::vector<PendingComment> pending_comments_;  // before the units are known
  std::optional<DescribedTool> described_;        // by the last comment without a number, not yet assigned
  bool changed_without_motion_ = false;           // since the last tool change
  std::optional<std::pair<Tenths, TextLocation>> spindle_without_speed_;  // first M3 or M4 before any S word
  bool units_given_ = false;
  bool moved_ = false;
  unsigned lathe_signs_ = 0;  // kinds of words of lathes that the program has, as bits
  TextLocation lathe_location_;
  bool no_feed_reported_ = false;
  bool feed_mode_repeated_ = false;  // G94 or G95 again, and no F since
  bool unknown_offset_reported_ = false;
  bool long_dwell_reported_ = false;
  bool text_after_end_reported_ = false;
  bool percent_open_ = false;
  bool words_since_percent_ = false;
};

template <class S>
bool Interpreter::add(const S& step) {
  if (path_.size() >= max_steps_ && !room_for(1.0)) return false;
  path_.add(step, origin());
  return true;
}

}  // namespace kerf::gcode
