// What the words mean: the modal state of a controller, and the steps that a line makes in that state.
//
// The order in which a line's words take effect, and what each does, is that of LinuxCNC's interpreter; where
// it refuses a line that other controllers read, the line is read as those do and the difference is said.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "front/gcode/line.h"

#include "kerf/gcode.h"
#include "kerf/geometry.h"
#include "kerf/progress.h"

namespace kerf::gcode {

enum class FeedMode : std::uint8_t { per_minute, inverse_time, per_turn };

inline constexpr unsigned kAllAxes = 7;
inline constexpr Tenths kNoMotion = 800;      // G80
inline constexpr Tenths kMotionNotSaid = -1;  // before the first motion code
inline constexpr Tenths kMotionNotRead = -2;  // after one that is not supported

/// A place with its unknown axes (Step::unknown_axes).
struct Place {
  Point3 at;  // mm
  unsigned unknown = kAllAxes;
};

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
  bool retract_to_start = false;  // G98
  std::optional<int> selected_tool;
};

/// What canned cycles keep from hole to hole. R and Z as the program gave them, in mm; the rest in mm and
/// seconds.
struct CycleMemory {
  Tenths motion = kNoMotion;  // the cycle these belong to
  std::optional<double> r, bottom, dwell, peck;
  std::optional<double> aside_u, aside_v, back_level;  // I J K of a back boring cycle
  std::optional<double> start_level;                   // where the series of cycles began
};

class Interpreter {
 public:
  Interpreter(GcodeProgram& program, const GcodeReadOptions& options, Talker& talker);

  /// Carries out one line.
  void run(const Block& block);
  /// To be called after the last line.
  void finish();
  /// True once nothing more is to be read: the program has ended, or the limit of steps is reached.
  bool done() const { return full_ || stopped_; }

 private:
  // interpreter.cpp
  bool goes_on(const Block& block);
  void read_percent();
  void execute();

  // comments.cpp
  void read_comment(const Comment& comment);
  void describe_tool(int number, const ToolShape& shape, const TextSpot& where);

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
  void set_plane();
  void set_path_mode();
  void set_distance();
  void use_words_of_other_codes();
  void end_or_pause();
  void end_program();

  // motion.cpp
  void move();
  void move_in(Tenths motion);
  void straight(Tenths motion);
  void probe(Tenths motion);
  void use_reference();
  void note_rest();
  void go_home(const Place& home);
  void shift_zero();
  std::optional<Place> target();
  std::optional<Place> machine_target();
  bool reachable(Point3 p);
  double feed_for(double length);
  double straight_length(const Place& to) const;

  // arcs.cpp
  void arc(Turn turn);
  std::optional<Point2> centre_of(const Place& to, Turn turn);
  std::optional<Point2> centre_from_offsets();
  std::optional<Point2> centre_from_radius(const Place& to, Turn turn);
  bool radii_agree(const Place& to, Point2 centre);
  int extra_turns();

  // cycles.cpp
  struct Hole;
  void cycle(Tenths motion);
  bool take_cycle_words(Tenths motion);
  std::optional<Hole> plan_hole();
  int repeats();
  bool approach(const Hole& hole);
  void drill(Tenths motion, const Hole& hole);
  void peck(Tenths motion, const Hole& hole);
  void tap(const Hole& hole, SpindleTurn forward);
  void back_bore(const Hole& hole);
  void cycle_rapid(const Hole& hole, double level);
  void cycle_cut(const Hole& hole, double level);
  void cycle_dwell();

  // steps
  OriginId origin();
  template <class S>
  bool add(const S& step);
  void rapid(const Place& to);
  void cut(const Place& to, double feed);
  void arrive(const Place& to);
  void spin(SpindleTurn turn);

  GcodeProgram& program_;
  Toolpath& path_;
  Talker& talker_;
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
  Point3 shift_;       // of the program's zero by G92, mm
  Point3 kept_shift_;  // what G92.2 put aside
  Tenths work_offset_ = 540;
  bool rests_ = false;  // the next motion begins at rest: a zero was shifted
  Place home_28_, home_30_;
  CycleMemory cycle_;

  StockComments stock_;
  std::optional<ToolShape> pending_shape_;  // described, and no tool change since
  TextSpot pending_spot_;
  std::optional<int> undescribed_tool_;  // changed to, not described, no motion since
  bool moved_ = false;
  bool no_feed_said_ = false;
  bool after_end_said_ = false;
  bool percent_open_ = false;
  bool words_since_percent_ = false;
};

template <class S>
bool Interpreter::add(const S& step) {
  if (path_.size() >= max_steps_) {
    if (!full_)
      talker_.error(Code::too_many_steps, line_.column(),
                    "the program makes more steps than are read; the rest is left out");
    full_ = true;
    return false;
  }
  path_.add(step, origin());
  return true;
}

}  // namespace kerf::gcode
