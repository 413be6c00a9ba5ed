// Which line comes next: loops, conditions, subroutines and their files.
//
// The O-words of a text are listed once, when the first of them is met, and paired (while with endwhile, if
// with its else); from then on each is a jump. A program without O-words costs nothing.
// Source: LinuxCNC's page "O Codes"; M98 and M99 as there and on Fanuc's controls.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "codec/gcode/block.h"
#include "front/gcode/program/expression.h"
#include "front/gcode/program/line_words.h"
#include "front/gcode/program/parameters.h"

#include "kerf/gcode_dialect.h"
#include "kerf/gcode_options.h"

namespace kerf::gcode {

struct OWord;

enum class OKind : std::uint8_t {
  number,  // "O100" alone: a program's number, or where M98 P100 goes
  sub,
  end_sub,
  give_back,  // return
  call,
  condition,  // if
  else_if,
  otherwise,  // else
  end_if,
  loop_while,
  end_while,
  loop_do,
  while_of_do,
  repeat,
  end_repeat,
  leave,   // break
  go_on,   // continue
  nothing  // not understood
};

/// One O-word of a text and where it leads.
struct OLine {
  std::size_t begin = 0, next = 0;  // of its line and of the line after it
  std::uint32_t lines_before = 0;
  std::string label;
  OKind kind = OKind::nothing;
  std::size_t partner = 0;  // of an opening word the end, of an end the opening one; itself: none
  std::size_t branch = 0;   // of if and elseif: the next branch
};

class Flow {
 public:
  Flow(std::string_view text, const GcodeReadOptions& options, Talker& talker, Parameters& parameters,
       GcodeDialect dialect, Diagnostics& diagnostics);
  ~Flow();

  /// The next line to carry out; false at the end, after an endless loop (said) too.
  bool next(Block& block);
  /// The text's reader while lines simply follow each other: no loop or call was met yet. Else null.
  BlockReader* straight_reader() { return jumped_ ? nullptr : sources_.front()->reader.get(); }
  /// Whether next() gave up before the text's end.
  bool gave_up() const { return stopped_; }
  /// Carries out the O-word of the line that next() gave last.
  void control(const Block& block);
  /// M98: calls a program by its number, `repeats` times.
  void call_number(int number, int repeats, std::uint32_t column);
  /// M99. False in the main program, where there is nothing to return to.
  bool return_from_call();

  /// Behind an O number: if what follows returns by M99 before it ends a program, goes on after it.
  bool skip_subprogram();

  /// Subroutines within each other, 0 in the main program.
  std::size_t depth() const { return frames_.size() - 1; }
  /// The name of the text that the last line came from; the same object while the text is the same.
  const std::string& file_name() const { return frames_.back().source->name; }
  /// Bytes read of the text at hand.
  std::size_t position() const { return frames_.back().source->reader->position(); }

 private:
  struct Source {
    std::string name;
    std::string owned;  // of a text that was loaded
    std::unique_ptr<BlockReader> reader;
    bool listed = false;
    std::vector<OLine> o_lines;
    std::unordered_map<std::string, std::size_t> subs;  // by label; numbers too
  };
  struct Repeat {
    std::size_t o_line = 0;
    double left = 0;
  };
  struct Frame {
    Source* source = nullptr;
    std::size_t return_to = 0;  // in the caller's text
    std::uint32_t return_lines = 0;
    int repeats_left = 0;
    std::size_t entry = 0;
    std::vector<Repeat> repeats;
    bool own_parameters = false;
  };
  void list(Source& source);
  const OLine& o_line(std::size_t i) const { return frames_.back().source->o_lines[i]; }
  std::optional<std::size_t> here(const Block& block);
  void jump_to(std::size_t o_line);
  void jump_behind(std::size_t o_line);
  std::optional<double> value_of(ExpressionReader& reader, std::uint32_t column);
  std::optional<double> only_value(const Block& block);
  std::optional<std::string> label_of(const OWord& word, std::uint32_t column);
  void branch(std::size_t at, const Block& block);
  void begin_repeat(std::size_t at, const Block& block);
  void end_repeat(std::size_t at);
  void leave_loop(std::size_t at, std::uint32_t column);
  std::optional<std::size_t> loop_around(std::size_t at) const;
  void carry_out(std::size_t at, const Block& block);
  void call(const Block& block);
  void give_back(const Block& block);
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
  Talker& talker_;
  Parameters& parameters_;
  Diagnostics& diagnostics_;
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<Frame> frames_;
  std::size_t work_ = 0;  // bytes read since the first jump
  bool jumped_ = false;
  bool stopped_ = false;
};

}  // namespace kerf::gcode
