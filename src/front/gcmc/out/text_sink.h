// The text that the real program writes: every word of every call, no modal suppression unless asked for.
#pragma once

#include <memory>
#include <string>

#include "front/gcmc/run/sink.h"
#include "front/gcmc/run/vm.h"

#include "kerf/gcmc_options.h"

namespace kerf::gcmc {

class TextSink final : public Sink {
 public:
  TextSink(Vm& vm, GcmcOutput& output);
  void begin();
  void end();
  /// Hands on what is there of a program that was ended by an error.
  void break_off();

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
  std::string_view taken();
  void pass_on(std::string_view piece);
  void flush();
  void make_room();
  void put(std::string_view text);
  void line(std::string_view text);
  enum class Begins : std::uint8_t { no, yes };
  void word(char letter, double value, Begins begins = Begins::no);
  enum class Words : std::uint8_t {
    all,
    unless_repeated
  };  // brief text omits those that repeat a coordinate
  void axes(const Axes& to, unsigned named, Words words = Words::unless_repeated);
  void begin_motion(std::string_view word, bool modal);
  void end_line() { *at_++ = '\n'; }
  void forget();

  Vm& vm_;
  const GcmcOptions& options_;
  GcmcOutput& output_;
  std::unique_ptr<char[]> buffer_;
  char* at_;               // where the next character goes
  Axes last_{};            // of the machine, offsets included
  unsigned known_ = 0;     // axes whose position the reader of the text knows (brief only)
  Axes written_{};         // what it knows of them
  std::string_view mode_;  // the motion word in force (brief only)
  double feed_ = -1.0;
};

}  // namespace kerf::gcmc
