// The text as the real program writes it: every word of every call; with `brief` without repeated words.
#pragma once

#include <memory>
#include <string>

#include "front/gcmc/run/sink.h"
#include "front/gcmc/run/vm.h"
#include "front/gcmc/value/gcmc_options.h"

namespace kerf::gcmc {

class TextSink final : public Sink {
 public:
  TextSink(Vm& vm, GcmcOutput& output);
  void start();
  void end();
  /// Passes on the buffered text of a program that was ended by an error.
  void flush_after_error();

  void move(const Move& m) override;
  void arc(const ArcMove& m) override;
  void drill(const DrillMove& m) override;
  void broken_move(bool rapid) override;
  void feed_rate(double feed) override;
  void feed_mode(int mode) override;
  void spindle(double speed) override;
  void spindle_speed(double speed) override;
  void coolant(int bits) override;
  void tool_change(int tool, bool length_offset) override;
  void dwell(double seconds) override;
  void path_mode(bool exact, std::optional<double> p, std::optional<double> q) override;
  void pause(bool optional) override;
  void plane(Plane plane) override;
  void comment(std::string_view text) override;
  void literal(std::string_view text) override;
  void store_position(bool second) override;
  void restore_position(bool second, const Axes& via, unsigned named, const Axes& end) override;
  void layer(const std::string&) override {}
  void close_path() override {}

 private:
  std::string_view take_buffer();
  void pass_on(std::string_view piece);
  void flush();
  void make_room();
  void put(std::string_view text);
  void line(std::string_view text);
  enum class LineStart : std::uint8_t { no, yes };
  void word(char letter, double value, LineStart start = LineStart::no);
  enum class Words : std::uint8_t {
    all,
    unless_repeated
  };  // unless_repeated: brief text omits words that repeat a coordinate
  void axes(const Axes& to, unsigned named, Words words = Words::unless_repeated);
  void start_motion(std::string_view word, bool modal);
  void end_line() { *at_++ = '\n'; }
  void forget();

  Vm& vm_;
  const GcmcOptions& options_;
  GcmcOutput& output_;
  std::unique_ptr<char[]> buffer_;
  char* at_;               // where the next character goes
  Axes last_{};            // of the machine, offsets included
  unsigned known_ = 0;     // axes whose position follows from the text (brief only)
  Axes written_{};         // their positions
  std::string_view mode_;  // the motion word in force (brief only)
  double feed_ = -1.0;
};

}  // namespace kerf::gcmc
