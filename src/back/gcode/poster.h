// The writer of a toolpath: which part writes each step, the files, and tool changes.
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "back/gcode/axis_words.h"
#include "back/gcode/file_texts.h"
#include "back/gcode/modal_words.h"
#include "back/gcode/motion_lines.h"
#include "back/gcode/post_part.h"
#include "back/gcode/print_lines.h"
#include "back/gcode/spindle_lines.h"
#include "back/gcode/thread_lines.h"
#include "back/gcode/zero_lines.h"
#include "path/state.h"

namespace kerf::gcode {

class Poster : PostPart {
 public:
  explicit Poster(PostContext& context);

  std::vector<PostedFile> run(Progress* progress);

 private:
  void write_step(std::size_t i);
  void write_motion(std::size_t i);

  // files.cpp
  void open_file(std::size_t first_step);
  void close_file();
  std::optional<double> height_of_rapids(std::size_t i) const;
  std::optional<std::size_t> raised_by(std::size_t i) const;
  bool rises_by_itself(std::size_t i) const;
  void approach(std::size_t i);
  Counts put_rapid(Point3 at, unsigned axes, std::size_t i);
  void across(std::size_t i);
  void approach_from_unknown(std::size_t i, std::optional<double> own);
  void tool_change(std::size_t i);
  void set_tool_number(std::size_t i);
  void change_file(std::size_t i);
  void restore_modes(std::size_t i);
  std::optional<std::size_t> length_before_cut(std::size_t i) const;

  // state_steps.cpp
  void path_mode(std::size_t i, const step::PathMode& mode);
  void pause(std::size_t i);
  void put_pause(std::size_t i);
  void left_out(std::size_t i);
  void unresolved(std::size_t i);
  bool is_in_header(std::size_t i) const;
  void verbatim(std::size_t i);
  bool replace_command(std::size_t i);

  ToolChangePolicy tool_policy_;
  AxisWords axes_;
  RotaryWords rotary_;
  ModalWords words_;
  SpindleLines spindle_;
  ZeroLines zeros_;
  ThreadLines threads_;
  MotionLines motions_;
  Filament filament_;
  FileTexts texts_;
  PrintLines prints_;
  HeaderActs header_;
  LimitLines limits_;

  bool extruded_ = false;           // filament, so far
  bool worked_ = false;             // by more than rapids, so far
  std::set<std::string> replaced_;  // names of commands that were reported
  std::vector<PostedFile> files_;
  StateReader states_;                     // at changes of files
  std::optional<std::size_t> own_length_;  // the step of a further file that states the length of its tool
  double path_top_ = -std::numeric_limits<double>::infinity();  // highest Z so far
  double cut_top_ = path_top_;                                  // highest end of a cut that does not rise
};

}  // namespace kerf::gcode
