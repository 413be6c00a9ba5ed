// One line carried out: comments, then the words in the order of their effect.
#include "front/gcode/interpreter.h"

namespace kerf::gcode {

Interpreter::Interpreter(GcodeProgram& program, const GcodeReadOptions& options, Talker& talker)
    : program_(program),
      path_(program.path),
      talker_(talker),
      max_steps_(options.max_steps),
      after_end_(options.after_end),
      file_(program.path.origins().file(options.file_name)) {}

void Interpreter::run(const Block& block) {
  talker_.at_line(block.line);
  for (const Comment& comment : block.comments) read_comment(comment);
  if (block.percent) return read_percent();
  if (block.faulty) return;
  const bool empty = block.words.empty() && block.assignments.empty() && !block.o_word;
  if (empty) return;
  words_since_percent_ = true;
  if (program_.ended && !goes_on(block)) return;
  if (!line_.sort(block, talker_)) return;
  execute();
  line_.report_unused(talker_);
}

/// Whether a line after the program's end is read.
bool Interpreter::goes_on(const Block& block) {
  if (after_end_said_) return true;
  after_end_said_ = true;
  stopped_ = after_end_ == AfterEnd::stop;
  const std::uint32_t column = block.words.empty() ? 1 : block.words.front().column;
  if (stopped_)
    talker_.unusual(Code::text_after_end, column, "the program has ended above; from here on nothing is read",
                    "a file of several programs runs through only where a sender streams it line by line");
  else
    talker_.note(Code::text_after_end, column,
                 "the program has ended above; what follows is read as its continuation");
  return !stopped_;
}

/// A program stands between two percent lines, or has none.
void Interpreter::read_percent() {
  const bool closes = percent_open_ || words_since_percent_;
  if (closes && !percent_open_)
    talker_.unusual(Code::lone_percent, 1, "this percent line closes a program that no percent line opens");
  if (closes) program_.ended = true;
  percent_open_ = !closes;
  words_since_percent_ = false;
}

/// The order is that of LinuxCNC's "Order of Execution", except that new units hold for the feed of their own
/// line.
void Interpreter::execute() {
  line_.use(Line::bit('O'));  // the program's number
  if (line_.has_codes()) {
    if (line_.has(Group::feed_mode)) set_feed_mode();
    if (line_.has(Group::units)) set_units();
  }
  if (line_.has('F')) set_feed();
  if (line_.has('S')) set_speed();
  if (line_.has('T')) select_tool();
  if (line_.has_codes()) {
    if (line_.has(Group::tool_change)) change_tool();
    if (line_.has(Group::spindle)) turn_spindle();
    switch_coolant();
    if (line_.has(Group::dwell)) dwell();
    if (line_.has(Group::plane)) set_plane();
    if (line_.has(Group::path_control)) set_path_mode();
    set_distance();
    use_words_of_other_codes();
    note_rest();
    if (line_.has(Group::reference)) use_reference();
  }
  move();
  if (line_.has(Group::stop)) end_or_pause();
}

void Interpreter::finish() {
  program_.stock = stock_.stock();
  if (pending_shape_)
    talker_.diagnostics().warning(Code::tool_comment_unused, pending_spot_,
                                  "the comment describes a tool, but no tool change follows");
  if (!program_.ended)
    talker_.unusual(Code::no_program_end, 0, "the program has no end (M2, M30 or a closing %)",
                    "was it cut off?");
}

OriginId Interpreter::origin() {
  if (origin_line_ != talker_.line()) {
    origin_line_ = talker_.line();
    origin_ = path_.origins().text(file_, origin_line_, line_.column());
  }
  return origin_;
}

}  // namespace kerf::gcode
