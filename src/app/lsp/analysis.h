// A text in an editor as a program: its messages, its hazards, and what each of its lines does.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/report/annotations.h"

#include "kerf/job/job.h"

namespace kerf::app::lsp {

/// What the motions that a line caused do.
struct LineWork {
  std::size_t motions = 0;
  double cut_mm = 0.0, rapid_mm = 0.0;
  double seconds = 0.0, seconds_before = 0.0;  // at the programmed feeds; from the program's start
  Point3 end;                                  // mm, of the last motion
  unsigned unknown_axes = 0;                   // of `end`, see Step::unknown_axes
  double feed = 0.0;                           // mm/min of the last cut; 0: none
  std::optional<int> tool;
  SpindleTurn spindle = SpindleTurn::off;
  double rpm = 0.0;
};

struct Analysis {
  std::vector<Annotation> annotations;
  std::map<std::uint32_t, LineWork> lines;  // by line of the text, from 1
  std::map<int, std::string> tools;         // in a few words
  double seconds = 0.0;
  bool is_stopped = false;
};

enum class Depth : std::uint8_t { reading, hazards };
/// Reads the text of a file, which need not be saved, and with Depth::hazards checks what it cuts.
/// `must_stop` is asked while that takes time.
Analysis analyse(const std::string& path, const std::string& text, Depth depth,
                 const std::function<bool()>& must_stop);

/// A few lines for the pointer over a line.
std::string text_of(const LineWork& work, const Analysis& analysis);

}  // namespace kerf::app::lsp
