// The writer of a toolpath: the state of the controller after the lines so far, and the lines of each step.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "back/gcode/arc_plan.h"
#include "back/gcode/line_buffer.h"
#include "path/state.h"

#include "kerf/path/report.h"
#include "kerf/program/post.h"

namespace kerf::gcode {

inline constexpr unsigned kAllAxes = 7;

/// True for a line of a template that is a comment.
bool is_comment(std::string_view line);
/// True for the text of a comment that a controller would carry out.
bool acts(std::string_view text);

class Poster {
 public:
  Poster(const Toolpath& path, const PostProfile& profile, const PostOptions& options,
         Diagnostics& diagnostics);

  std::vector<PostedFile> run(Progress* progress);

 private:
  // poster.cpp
  void write_step(std::size_t i);
  void write_motion(std::size_t i);
  void cut(std::size_t i);
  void straight(int g, std::size_t i);
  void straight_to(int g, std::size_t i, const Counts& to, double fraction);
  void move_by(const std::vector<int>& codes, std::size_t i, const Counts& to);
  void arc(std::size_t i);
  void chords(std::size_t i);
  void probe(std::size_t i);
  void to_reference(int g, std::size_t i);
  void to_end_switches(std::size_t i);
  bool fits(std::size_t i);
  std::string_view correction_of(std::size_t i) const;
  void put_correction(std::size_t i);
  unsigned axes_to_write(std::size_t i, const Counts& to) const;
  unsigned axes_by_distance(std::size_t i, const Counts& to) const;
  bool add_rotary(std::size_t i, double fraction);
  bool only_turns(std::size_t i) const;
  void arrive(std::size_t i, const Counts& to, unsigned written);
  Counts grid_counts(Point3 p) const { return grid_.counts(p - zero_); }
  void put_feed(std::size_t i);
  void put_axes(const Counts& to, unsigned axes);
  void put_motion(int g);
  void put_plane(std::size_t i, Plane plane);
  void put_power();

  // printing.cpp
  void extrude(std::size_t i);
  void select_extruder(std::size_t i);
  void comment_on_bead(std::size_t i, const step::Extrude& bead);
  void put_comment(std::string_view text);
  void temperature(std::size_t i);
  void fan(std::size_t i);
  void motion_limits(std::size_t i);
  void put_limits(std::size_t i, const step::MotionLimits& limits, std::string_view letters, double factor);
  void put_klipper_limit(std::size_t i, const step::MotionLimits& limits);
  void skip_limits(std::size_t i, LimitKind kind);
  void thumbnails();
  std::optional<std::string> print_value_of(std::string_view key);
  Length filament_diameter() const;
  bool states_filament() const;
  double filament_area() const;

  // threads.cpp
  struct Tap {
    std::size_t end = 0;  // the step after it
    Duration dwell{};
  };
  SpindleLock lock_of(std::size_t i) const;
  std::optional<Tap> tap_at(std::size_t i) const;
  bool locked_motion(std::size_t i);
  bool tapping_cycle(std::size_t i);
  void put_tap(std::size_t i, const Tap& tap, int cycle);

  // state_steps.cpp
  void spindle(std::size_t i);
  void laser(std::size_t i);
  void coolant(std::size_t i, const step::Coolant& wanted);
  void dwell(std::size_t i, Duration time);
  void path_mode(std::size_t i, const step::PathMode& mode);
  void tool_change(std::size_t i);
  void set_tool_number(std::size_t i);
  void change_file(std::size_t i);
  void restore_modes(std::size_t i);
  void pause(std::size_t i);
  bool is_visited_after(std::size_t i, Reference home) const;
  void store_home(std::size_t i);
  void work_zero(std::size_t i);
  void select_system(std::size_t i);
  bool can_set_zero(std::size_t i, const step::WorkZero& zero);
  void tool_length(std::size_t i, const step::ToolLength& length);
  void left_out(std::size_t i);
  void unresolved(std::size_t i);
  void verbatim(std::size_t i);
  void restore(std::size_t i);
  void stop_spindle();
  void start_spindle(std::size_t i);

  // templates.cpp
  void open_file(std::size_t first_step);
  void find_file_end();
  void close_file();
  void approach(std::size_t i);
  void comment(std::string_view text, NoteKind kind = NoteKind::comment);
  void templates(const std::vector<std::string>& lines);
  std::string expanded(std::string_view line);
  std::optional<std::string> value_of(std::string_view key);
  std::string sanitised(std::string_view text, std::size_t longest) const;
  void header_comment(std::string_view text);
  void divided_comment(std::string_view text);
  const MotionFigures& figures();
  std::string bounds_text();
  std::string time_text();
  std::string tools_text() const;
  void raw_line(std::string_view text);
  void forget();

  // lines
  void start_line();
  void word(char letter, std::int64_t counts, int decimals);
  void code(char letter, int tenths);
  void end_line(std::size_t i);
  void m_line(std::size_t i, int tenths);
  bool can_m(std::size_t i, int tenths, std::string_view what);
  void report_unsupported(std::size_t i, std::string message);
  void report_skipped(std::size_t i, std::string message);

  const Toolpath& path_;
  const PostProfile& profile_;
  const PostOptions& options_;
  Diagnostics& diagnostics_;
  LengthUnit unit_;
  ToolChangePolicy tool_policy_;
  int decimals_ = 3;
  Fraction fraction_;
  Grid grid_;
  double counts_per_feed_ = 1.0;  // of mm/min

  std::vector<PostedFile> files_;
  std::string out_;
  std::size_t lines_ = 0;
  std::size_t file_start_ = 0, file_end_ = 0;  // steps of the current file
  std::optional<MotionFigures> figures_;       // of those steps
  std::optional<int> file_tool_;               // at the first motion of the file
  int line_number_ = 0;
  LineBuffer line_;
  ArcPlan plan_;

  // State of the toolpath.
  StateReader states_;  // at changes of files
  PathPosition position_;
  double path_top_ = -std::numeric_limits<double>::infinity();  // highest Z so far
  double cut_top_ = path_top_;                                  // highest end of a cut that does not rise
  std::optional<int> tool_;
  step::Spindle wanted_spindle_;
  step::Coolant wanted_coolant_;

  // State of the controller.
  Point3 zero_;     // of its coordinates, in those of the toolpath
  int system_ = 1;  // selected work offset
  bool system_selected_ = false;
  Counts at_{};
  unsigned known_axes_ = 0;   // axes whose at_ has been written in work coordinates
  unsigned paused_axes_ = 0;  // axes not written since a pause, in which the operator may have moved them
  std::array<std::int64_t, 3> rotary_{};
  std::array<double, 3> rotary_from_{};  // degrees, of the toolpath
  unsigned known_rotary_ = 0;
  int motion_ = -1;
  std::optional<Plane> plane_;
  std::int64_t feed_ = -1;
  step::Spindle spindle_;
  step::Coolant coolant_;
  LaserMode laser_ = LaserMode::off;
  std::optional<double> pending_power_;
  Length filament_;                    // diameter
  double extruded_ = 0.0;              // mm of filament
  std::int64_t written_extruded_ = 0;  // in counts of E
  int extruder_ = 0;                   // for templates
  std::optional<double> layer_z_;      // of the last layer in comments, mm
  std::optional<BeadKind> commented_kind_;
  double commented_width_ = 0.0, commented_height_ = 0.0;  // mm
  bool on_bead_ = false;                                   // the last motion laid a bead
  unsigned skipped_limits_ = 0;                            // one bit per LimitKind that was reported
  bool restore_ = false;  // spindle or coolant may have been stopped by a tool change
  bool moved_ = false;    // in this file
  bool no_feed_reported_ = false, uncorrected_reported_ = false, tap_reported_ = false;
  std::size_t skip_to_ = 0;  // the steps before it are part of a tap that has been written
};

}  // namespace kerf::gcode
