// The lines of a posted file: words, line numbers, and the length that a controller reads.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "back/gcode/line_buffer.h"
#include "base/ending.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"
#include "kerf/program/post.h"

namespace kerf::gcode {

class LineWriter {
 public:
  LineWriter(const Toolpath& path, const PostProfile& profile, Diagnostics& diagnostics)
      : path_(path),
        profile_(profile),
        diagnostics_(diagnostics),
        fraction_(profile.zeros == Zeros::kept    ? Fraction::full
                  : profile.zeros == Zeros::point ? Fraction::point
                                                  : Fraction::shortest) {}

  void reserve(std::size_t bytes) { text_.reserve(text_.size() + bytes); }
  void start_file() {
    text_.clear();
    lines_ = 0;
    line_number_ = 0;
  }
  std::string take_text() { return std::exchange(text_, {}); }
  std::size_t lines() const { return lines_; }

  void start_line() {
    line_.clear();
    if (profile_.line_number_step != 0) put_number();
  }
  void word(char letter, std::int64_t counts, int decimals) {
    if (profile_.spacing == WordSpacing::blank && !line_.empty()) line_.put(' ');
    line_.put(letter);
    line_.units(counts, decimals, decimals == 0 ? Fraction::shortest : fraction_);
  }
  /// The P word of a time, in the controller's unit.
  void time_word(Duration time) {
    constexpr int kDecimals = 3;
    const std::int64_t milliseconds = std::llround(1000.0 * time.seconds());
    word('P', milliseconds, profile_.dwell_unit == DwellUnit::seconds ? kDecimals : 0);
  }
  /// A G or M code, with a decimal only if it needs one.
  void code(char letter, int tenths) {
    if (profile_.spacing == WordSpacing::blank && !line_.empty()) line_.put(' ');
    line_.put(letter);
    line_.units(tenths, 1, Fraction::shortest);
  }
  void put(std::string_view text) { line_.put(text); }
  /// The line is not written.
  void drop_line() { line_.clear(); }
  /// Writes the line, which is from step `i`; the number of steps: from none.
  void end_line(std::size_t i) {
    const std::string_view text = line_.text();
    if (text.size() > profile_.longest_line) report_long(i, text.size());
    write(text);
  }
  /// A line with this code alone.
  void code_line(std::size_t i, char letter, int tenths) {
    start_line();
    code(letter, tenths);
    end_line(i);
  }
  /// A line without a number, as it is.
  void text_line(std::string_view text) {
    if (text.size() > profile_.longest_line) report_long(path_.size(), text.size());
    write(text);
  }

 private:
  void put_number();
  void report_long(std::size_t i, std::size_t bytes);
  void write(std::string_view text) {
    const std::size_t start = text_.size();
    text_ += text;
    if (profile_.form.capitals)
      for (std::size_t i = start; i < text_.size(); ++i) text_[i] = capital_letter(text_[i]);
    text_ += profile_.line_end == LineEnd::crlf ? "\r\n" : "\n";
    ++lines_;
  }

  const Toolpath& path_;
  const PostProfile& profile_;
  Diagnostics& diagnostics_;
  Fraction fraction_;
  std::string text_;
  std::size_t lines_ = 0;
  int line_number_ = 0;
  LineBuffer line_;
};

}  // namespace kerf::gcode
