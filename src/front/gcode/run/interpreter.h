// What the words mean: the modal state of a controller, and the steps that a line makes in that state.
//
// The order in which a line's words take effect, and what each does, is that of LinuxCNC's interpreter; where
// it refuses a line that other controllers read, the line is read as those do and the difference is reported.
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

#include "front/gcode/program/flow.h"
#include "front/gcode/program/line_words.h"
#include "front/gcode/program/parameters.h"
#include "op/cutter_compensation.h"
#include "path/feed_mode.h"

#include "kerf/drill.h"
#include "kerf/fit.h"
#include "kerf/gcode.h"
#include "kerf/geometry.h"
#include "kerf/progress.h"
#include "kerf/tool_comments.h"

namespace kerf::gcode {

inline constexpr unsigned kAllAxes = 7;
inline constexpr double kNoWay = 1e-9;                // mm; a move of less is none in its plane
inline constexpr int kHome28 = 5161, kHome30 = 5181;  // first of the parameters that keep the homes
inline constexpr std::uint32_t kAllLetters = (1u << 26) - 1;
inline constexpr Tenths kNoMotion = 800;      // G80
inline constexpr Tenths kMotionNotSaid = -1;  // before the first motion code
inline constexpr Tenths kMotionNotRead = -2;  // after one that is not supported

/// A place with its unknown axes (Step::unknown_axes).
struct Place {
  Point3 at;  // mm
  unsigned unknown = kAllAxes;
  Reference reference = Reference::work;  // what the axes of reference_axes were told in on this line
  unsigned reference_axes = 0;
};

inline constexpr double kFarthest = 1e7;  // mm; 10 km
/// Whether a place is one that a program may mean.
inline bool is_near(Point3 p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// What a controller remembers from line to line.
struct Modes {
  Tenths motion = kMotionNotSaid;
  Plane plane = Plane::xy;
  bool absolute = true;
  bool absolute_centres = false;
  double scale = 1.0;  // mm of one unit of the program
  FeedMode feed_mode = FeedMode::per_minute;
  double feed = 0.0;   // mm/min, 1/min or mm/turn; 0: none given
  double speed = 0.0;  // rpm
  SpindleTurn spindle = SpindleTurn::off;
  bool mist = false, flood = false;
  double surface_speed = 0.0;     // m/min of G96; 0: the speed is in rpm
  bool speed_told = false;        // an S word was read
  bool retract_to_start = false;  // G98
  bool diameters = false;         // G7: X words are diameters
  int system = 1;                 // 1 to 9: G54 to G59.3
  std::optional<int> selected_tool, tool;
};

/// How the program's coordinates lie in the toolpath's: turned about zero, then shifted.
struct Placement {
  Point3 shift;       // mm
  double turn = 0.0;  // degrees, in XY
  double cosine = 1.0, sine = 0.0;
  Point3 scale{1.0, 1.0, 1.0};  // G51, about `scale_zero` in program coordinates
  Point3 scale_zero;
  bool plain = true;  // only shifted

  Point3 to_path(Point3 program) const;
  Point3 to_program(Point3 path) const;
};

/// What M70 and M73 keep.
struct KeptModes {
  Modes modes;
  bool automatic = false;  // M73: put back when the subroutine ends
};

/// What canned cycles keep from hole to hole. R and Z as the program gave them, in mm; the rest in mm and
/// seconds.
struct CycleMemory {
  Tenths motion = kNoMotion;  // the cycle these belong to
  std::optional<double> r, bottom, dwell, peck;
  std::optional<double> aside_u, aside_v, back_level;  // I J K of a back boring cycle
  std::optional<double> start_level;                   // before the series of cycles
};

/// What G41 and G42 keep. Points lie in the plane's right-handed frame.
struct Compensation {
  std::optional<CutterCompensation> cutter;  // while it is on
  bool leaving = false;                      // G40 was read, and the tool has not come back to the path
  std::size_t last_step = 0;                 // that makes the last element
};

enum class MoveKind : std::uint8_t { rapid, cut };

class Interpreter : public SystemValues {
 public:
  Interpreter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options, Talker& talker);

  Parameters& parameters() { return parameters_; }
  /// Which texts and lines follow each other; needed before the first run().
  void follow(Flow& flow) { flow_ = &flow; }
  std::optional<double> system_number(int number) const override;
  std::optional<double> system_name(std::string_view name) const override;
  double unit_of(int number) const override;

  /// Carries out one line.
  void run(const Block& block);
  /// The short way for the lines that long programs are made of: reads on while the lines hold nothing but G0
  /// or G1, axis words and F, at most `limit` of them, and gives their number. What is not surely such a line
  /// is left to run(), which does the same with it.
  std::size_t run_plain_lines(BlockReader& reader, std::size_t limit);
  /// To be called after the last line.
  void finish();
  /// True once nothing more is to be read: the program has ended, or the limit of steps is reached.
  bool done() const { return full_ || stopped_; }

 private:
  // interpreter.cpp
  bool goes_on(const Block& block);
  void read_percent();
  void tell_silent_spindle();
  void execute();

  void look_where_we_are();
  bool is_printer() const {
    return program_.dialect == GcodeDialect::marlin || program_.dialect == GcodeDialect::klipper;
  }
  bool printer_line();

  // simple_lines.cpp
  bool takes_plain_lines() const;
  bool run_plain_line(std::string_view text, std::uint32_t number);

  // comment_effects.cpp
  void read_comment(const Comment& comment);
  bool read_tool_remark(std::string_view text, const TextSpot& where);
  void use_waiting_remarks();
  void use_tool_remark(std::string_view text, const TextSpot& where);

  // settings.cpp
  void set_feed_mode();
  void set_units();
  void set_feed();
  void set_speed();
  void select_tool();
  void change_tool();
  void turn_spindle();
  void switch_coolant();
  void dwell();
  void tell_long_dwell(double time, char letter);
  void set_plane();
  void set_path_mode();
  void set_distance();
  void use_words_of_other_codes();
  void end_or_pause();
  void end_program();
  void set_spindle_mode();
  void subroutine();
  void keep_modes();
  void restore_modes(const Modes& modes);
  void beam();
  void read_large_m_code();

  // work_offsets.cpp
  void use_coordinates();
  void leave_system();
  void tell_unknown_offset(int system);
  void set_data();
  void set_system(int system);
  void touch_off(int system);
  void set_tool_data(int tool);
  void shift_locally();
  void scale_program();
  void turn_program();
  void refresh_placement();
  double system_offset(int axis) const;
  void set_home(int first, Place& home);

  // system_parameters.cpp
  Point3 program_position() const;
  std::optional<double> system_place(std::string_view name) const;
  std::optional<double> diameter_of(int tool) const;

  // printer.cpp
  void printer_code();
  void printer_reference();
  void run_to_end_switches();
  void set_filament(std::string_view text);
  void set_volumetric();
  bool filament_is_relative() const;
  void extrude(const Place& to, double feed);
  void extrude_arc(const ArcWalk& walk, const Place& to, Feed feed);

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
  Point3 moved_in_plane(Point3 p, Point2 to) const;
  void set_compensation();
  std::optional<double> told_diameter(std::optional<double> number);
  std::optional<double> diameter_for_compensation(std::optional<double> number);
  void end_compensation();
  void guard_compensation();
  void refuse_compensated(std::string_view what, std::uint32_t column);
  void compensated_line(const Place& to, MoveKind kind, double feed);
  void along_third_axis(const Place& to, MoveKind kind, double feed);
  bool follow(const CompensatedElement& made, MoveKind kind, double feed);
  void tell_gouge();
  void compensated_arc(const Place& to, Point2 centre, Turn turn, int extra, Feed feed);
  void add_compensated(Point3 at, const Place& to, MoveKind kind, double feed);

  // thread_cycles.cpp
  void spindle_move(Tenths motion);
  struct Thread;
  Thread take_thread_words();
  void thread_pass(const Thread& thread, const Place& start, double end_z, double depth);
  void thread_cycle();

  // motion.cpp
  void move();
  void move_in(Tenths motion);
  void straight(Tenths motion);
  void probe(Tenths motion);
  void use_reference();
  void go_home(const Place& home, Reference reference);
  void note_rest();
  void shift_zero();
  std::optional<Place> target();
  Place placed_target();
  void polar();
  std::optional<Place> machine_target();
  bool reachable(Point3 p);
  double feed_for(double length);
  double straight_length(const Place& to) const;

  // arcs.cpp
  void arc(Turn turn);
  std::optional<Point2> centre_of(const Place& to, Turn turn);
  std::optional<Point2> centre_from_offsets();
  Point2 turned_offset(Point2 offset) const;
  std::optional<Point2> centre_from_radius(const Place& to, Turn turn);
  bool radii_agree(const Place& to, Point2 centre);
  bool leaves_compensation();
  int extra_turns();

  // canned_cycles.cpp
  class CycleSink;
  void cycle(Tenths motion);
  bool take_cycle_words(Tenths motion);
  std::optional<DrillCycle> plan_cycle(Tenths motion, Place& place);
  void plan_back_bore(DrillCycle& cycle) const;
  int repeats();
  int reachable_holes(const DrillCycle& cycle, int holes);
  double cycle_feed();

  // steps
  bool room_for(double steps);
  OriginId origin();
  template <class S>
  bool add(const S& step);
  void rapid(const Place& to);
  void cut(const Place& to, double feed);
  void arrive(const Place& to);
  void spin(SpindleTurn turn);

  GcodeProgram& program_;
  Toolpath& path_;
  ToolComments tool_comments_;
  Talker& talker_;
  const GcodeReadOptions& options_;
  Parameters parameters_;
  Flow* flow_ = nullptr;
  const std::string* current_file_ = nullptr;
  std::size_t current_depth_ = 0;
  std::size_t max_steps_;
  AfterEnd after_end_;
  std::uint32_t file_;
  Line line_;
  std::uint32_t origin_line_ = 0;  // the line that origin_ belongs to
  OriginId origin_ = OriginId::none;
  bool full_ = false;
  bool stopped_ = false;  // there is text after the program's end, which is not to be read

  Modes modes_;
  Place here_;
  std::array<double, 3> rotary_{};  // degrees
  bool rotary_used_ = false;
  Placement placement_;
  std::size_t system_from_ = 0;                       // the first step made in the coordinate system in force
  TextSpot system_spot_;                              // where that was chosen
  std::uint32_t systems_used_ = 0, systems_set_ = 0;  // bit n: moved in; told by G10
  Point3 local_shift_;                                // by G92 and G52, mm
  Point3 kept_local_shift_;                           // what G92.2 put aside
  double program_turn_ = 0.0;                         // G68, degrees
  Point3 program_turn_about_;                         // program coordinates, mm
  Tenths work_offset_ = 540;
  bool rests_ = false;  // the next motion begins at rest: a zero was shifted
  Place home_28_, home_30_;
  std::vector<std::optional<KeptModes>> kept_modes_{1};  // one a subroutine's level
  std::map<int, double> tool_diameters_;                 // mm, by G10 L1
  std::vector<Point2> control_points_;                   // of G5.2
  std::vector<double> control_weights_;
  int curve_order_ = 0;
  std::optional<Point2> last_curve_handle_;  // of G5: second control point, from the end
  LaserMode beam_mode_ = LaserMode::off;
  double beam_power_ = 0.0;
  double filament_ = 0.0;           // E position, mm (mm3 where E tells volumes)
  double filament_diameter_ = 0.0;  // mm
  bool filament_relative_ = false;
  bool volumetric_ = false;                      // M200: E tells volumes
  double bead_width_ = 0.0, bead_height_ = 0.0;  // mm, as remarks tell; 0: not told
  CycleMemory cycle_;
  Compensation compensation_;

  StockComments stock_;
  std::vector<std::pair<std::string, TextSpot>> waiting_remarks_;
  std::optional<std::pair<Tenths, TextSpot>> silent_spindle_;  // the first M3 or M4 with no S word so far
  bool units_told_ = false;
  bool moved_ = false;
  bool no_feed_said_ = false;
  bool offset_said_ = false;
  bool long_dwell_said_ = false;
  bool after_end_said_ = false;
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
