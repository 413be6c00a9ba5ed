// Where the command says things: results to stdout, messages to stderr (or, with --json, inside the one
// object).
#pragma once

#include <string>
#include <string_view>

#include "kerf/diagnostics.h"

namespace kerf::app {

struct OutputOptions {
  bool json = false;
  bool quiet = false;
};

/// True if stderr is a terminal that understands colours and the user has not set NO_COLOR.
bool stderr_has_colour();
/// True if stderr is a terminal on which a line can be drawn again.
bool stderr_is_terminal();

class Console {
 public:
  explicit Console(OutputOptions options) : options_(options), colour_(stderr_has_colour()) {}

  bool json() const { return options_.json; }
  bool quiet() const { return options_.quiet; }

  /// Text to stdout; control bytes that a hostile file may hold come out as "?".
  void print(std::string_view text);
  /// JSON to stdout, as it is (JSON escapes control bytes by itself).
  void print_json(std::string_view text);
  /// A line of the summary to stdout; nothing with --quiet.
  void summary(std::string_view line);
  /// Where diagnostics go: with --json they stand in the object, unless there is none.
  enum class Channel { text_or_object, always_text };
  /// Diagnostics to stderr as text, in colour on a terminal, notes left out with --quiet. What is said of
  /// many lines stands there once, with the first of them.
  void show(const Diagnostics& diagnostics, Channel channel = Channel::text_or_object);
  /// A message of the command itself to stderr.
  void complain(std::string_view message);
  /// Pushes out what was printed; false if stdout could not take it (a full disk, a closed pipe).
  bool finish();

 private:
  OutputOptions options_;
  bool colour_;
};

}  // namespace kerf::app
