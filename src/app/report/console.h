// The output of the command: results to stdout, messages to stderr (with --json: inside the JSON object).
#pragma once

#include <string>
#include <string_view>

#include "job/length_text.h"

#include "kerf/base/diagnostics.h"

namespace kerf::app {

struct OutputOptions {
  bool json = false;
  bool quiet = false;
  bool sends_output = false;  // -o -: stdout is for the output alone, text goes to stderr
};

/// Chooses when messages have colours, for the whole process: "auto", "always" or "never". False for other
/// words.
bool choose_colours(std::string_view when);
/// As chosen; by default, if stderr is a terminal that understands colours and the user has not set NO_COLOR.
bool stderr_has_colour();
/// True if stderr is a terminal on which a line can be overwritten.
bool stderr_is_terminal();

class Console {
 public:
  explicit Console(OutputOptions options) : options_(options), colour_(stderr_has_colour()) {}

  /// The units of lengths in texts.
  void set_lengths(LengthText lengths) { lengths_ = lengths; }
  const LengthText& lengths() const { return lengths_; }
  /// The objects of --json on one line each, for calls with several files.
  void set_object_lines(bool lines) { object_lines_ = lines; }
  bool object_lines() const { return object_lines_; }
  bool json() const { return options_.json && !options_.sends_output; }
  bool sends_output() const { return options_.sends_output; }
  bool quiet() const { return options_.quiet; }

  /// Text to stdout, to stderr if stdout is for an output; control characters are printed as "?".
  void print(std::string_view text);
  /// What a program prints, to stdout: unchanged in a pipe or file, on a terminal as print() does. To stderr
  /// where stdout is for the object of --json.
  void print_output(std::string_view text);
  /// Text or the bytes of an output to stdout unchanged; JSON escapes control characters itself.
  void print_json(std::string_view text);
  /// A line of the summary, as print(); nothing with --quiet.
  void summary(std::string_view line);
  /// Where diagnostics go: with --json into the object, or as text in any case.
  enum class Channel { text_or_object, always_text };
  /// Diagnostics to stderr as text, in colour on a terminal, without notes if --quiet. The same message for
  /// several lines is printed once, at the first of them.
  void show(const Diagnostics& diagnostics, Channel channel = Channel::text_or_object);
  /// An error of the command itself to stderr.
  void error(std::string_view message);
  /// Flushes stdout; false if writing to it has failed (full disk, closed pipe).
  bool finish();

 private:
  LengthText lengths_;
  OutputOptions options_;
  bool colour_;
  bool object_lines_ = false;
};

}  // namespace kerf::app
