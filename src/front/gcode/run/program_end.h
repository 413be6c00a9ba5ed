// Where the program ends: M2, M30, percent lines, and the text after them.
#pragma once

#include "front/gcode/run/part.h"

namespace kerf::gcode {

class ProgramEnd : Part {
 public:
  explicit ProgramEnd(Context& context);

  bool reads_on_after(const Block& block);
  void report_unreadable();
  void note();
  void read_percent();
  /// The line has words.
  void note_words() { words_since_percent_ = true; }
  /// At the end of the text.
  void report_missing();

  AfterEnd after() const { return after_; }
  /// True at text after the program's end (AfterEnd::stop).
  bool stopped() const { return stopped_; }
  /// Nothing after this line runs.
  void stop() { stopped_ = true; }

 private:
  bool ends_with_beam_off() const;
  AfterEnd after_;
  bool stopped_ = false;
  bool text_after_reported_ = false;
  bool percent_open_ = false;
  bool words_since_percent_ = false;
};

}  // namespace kerf::gcode
