// The order of lines: loops, conditions, subroutines and their files.
//
// At the first O-word of a text all of them are listed and paired (while with endwhile, if with its else);
// each is a jump then. A program without O-words is not scanned. Source: LinuxCNC's page "O Codes"; M98 and
// M99 as there and on Fanuc's controllers, whose macros (WHILE, DO, END, IF, GOTO) are listed and paired in
// the same way. They follow what is commonly known of the macros, and have not been compared with the manual.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "codec/gcode/block.h"
#include "front/gcode/program/expression.h"
#include "front/gcode/program/line_reporter.h"
#include "front/gcode/program/parameters.h"

#include "kerf/program/gcode_options.h"

namespace kerf::gcode {

struct OWord;

enum class OKind : std::uint8_t {
  number,  // "O100" alone: a program's number, the target of M98 P100
  sub,
  end_sub,
  return_sub,
  call,
  if_branch,
  else_if,
  else_branch,
  end_if,
  loop_while,
  end_while,
  loop_do,
  while_of_do,
  repeat,
  end_repeat,
  break_loop,
  continue_loop,
  endless_loop,  // DO1 of Fanuc's macros without a WHILE
  go_to,
  go_to_if,
  assign_if,
  invalid
};

/// A line with an O-word, and the lines that it jumps to.
struct OLine {
  std::size_t start = 0, next = 0;  // offsets of this line and of the line after it
  std::uint32_t lines_before = 0;
  std::string label;
  OKind kind = OKind::invalid;
  std::size_t partner = 0;  // index of the end of an opening word, and vice versa; its own index: none
  std::size_t branch = 0;   // of if and elseif: index of the next branch
};

class Flow {
 public:
  Flow(std::string_view text, const GcodeReadOptions& options, LineReporter& reporter, Parameters& parameters,
       GcodeDialect dialect, Diagnostics& diagnostics);
  ~Flow();

  /// The next line to execute; false at the end, or with an error for a loop that does not end.
  bool next(Block& block);
  /// Faults in lines after the program's end are not reported.
  void note_program_end() { sources_.front()->reader->note_program_end(); }
  /// The text's reader before the first jump; null after it.
  BlockReader* sequential_reader() { return jumped_ ? nullptr : sources_.front()->reader.get(); }
  /// True if next() has stopped at a limit, before the end of the text.
  bool limit_reached() const { return stopped_; }
  /// Executes the O-word of the last line of next().
  void control(const Block& block);
  /// Whether a condition or a number of repeats since the last call depended on a value
  /// known only at run time.
  bool take_unknown_value() { return std::exchange(unknown_value_, false); }
  /// Whether the program has the subroutine.
  bool has_sub(int number);
  /// G65: calls a subroutine with arguments for #1 to #30.
  void call_macro(int number, std::span<const ParameterValue> arguments, int repeats, std::uint32_t column);
  /// M98: calls a subroutine by its number, `repeats` times.
  void call_number(int number, int repeats, std::uint32_t column);
  /// M99. False in the main program, which has no caller. `leaves`: repeats that are left do not run.
  bool return_from_call(bool leaves = false);
  /// GOTO, M99 P: continues at the line with this N; searched towards the end, then from the start.
  void go_to_line(double number, std::uint32_t column);

  /// After an O number outside of the program: if a M99 comes before a program end, skips up to the last such
  /// M99.
  bool skip_subprogram();

  /// The label of the first subroutine whose definition the main program has passed; empty if there is none.
  const std::string& first_subroutine() const { return first_subroutine_; }

  /// Depth of nested calls, 0 in the main program.
  std::size_t depth() const { return frames_.size() - 1; }
  /// The file name of the last line; the same object for all lines of a file.
  const std::string& file_name() const { return frames_.back().source->name; }
  /// Bytes read of the current text.
  std::size_t position() const { return frames_.back().source->reader->position(); }

 private:
  struct Source {
    std::string name;
    std::string owned;  // the text, of a file that was loaded
    std::unique_ptr<BlockReader> reader;
    bool listed = false;
    std::vector<OLine> o_lines;
    std::unordered_map<std::string, std::size_t> subs;  // by label; numbers too
    struct Line {
      std::size_t start = 0;
      std::uint32_t lines_before = 0;
    };
    std::unordered_map<std::string, std::vector<Line>> line_numbers;  // of Fanuc's programs
  };
  struct Repeat {
    std::size_t o_line = 0;
    double left = 0;
  };
  struct Frame {
    Source* source = nullptr;
    std::size_t return_to = 0;  // offset in the caller's text
    std::uint32_t return_lines = 0;
    int repeats_left = 0;
    std::size_t entry = 0;
    std::vector<Repeat> repeats;
    bool own_parameters = false;
    std::vector<ParameterValue> arguments;  // of a macro that is repeated
  };
  void list_o_words(Source& source);
  const OLine& o_line(std::size_t i) const { return frames_.back().source->o_lines[i]; }
  std::optional<std::size_t> find_o_line(const Block& block);
  void jump_to(std::size_t o_line);
  void jump_after(std::size_t o_line);
  std::optional<double> value_of(ExpressionReader& reader, std::uint32_t column);
  std::optional<double> condition_value(const Block& block);
  std::optional<std::string> label_of(const OWord& word, std::uint32_t column);
  void branch(std::size_t at, const Block& block);
  void start_repeat(std::size_t at, const Block& block);
  void end_repeat(std::size_t at);
  void leave_loop(std::size_t at, std::uint32_t column);
  std::optional<std::size_t> loop_around(std::size_t at) const;
  void execute(std::size_t at, const Block& block);
  void run_macro_statement(const OLine& line, const Block& block);
  std::pair<std::size_t, std::size_t> program_around(std::size_t position);
  void call(const Block& block);
  void return_with_value(const Block& block);
  bool enter(const std::string& label, int repeats, std::uint32_t column);
  Source* source_of(const std::string& label, std::size_t& entry);
  Source* load(const std::string& label);
  bool unmatched(const OLine& line, std::uint32_t column);
  void leave_call();
  void jump(std::size_t position, std::uint32_t lines);
  bool may_run(const Block& block);

  BlockReaderOptions reader_options(const std::string& name) const;

  const GcodeReadOptions& options_;
  GcodeDialect dialect_;
  LineReporter& reporter_;
  Parameters& parameters_;
  Diagnostics& diagnostics_;
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<Frame> frames_;
  std::size_t work_ = 0;  // bytes read since the first jump
  std::string first_subroutine_;
  bool jumped_ = false;
  bool stopped_ = false;  // a limit was reached
  bool unknown_value_ = false;
  std::unordered_set<std::string> called_;  // labels of called subroutines
};

}  // namespace kerf::gcode
