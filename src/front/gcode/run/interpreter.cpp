// One line carried out: comments, then the words in the order of their effect.
#include "front/gcode/run/interpreter.h"

#include <algorithm>
#include <fmt/format.h>

namespace kerf::gcode {
namespace {

constexpr std::size_t kBytesOfStep = 2;        // a text of n bytes has no more than n / 2 words
constexpr std::size_t kLongestCommand = 1000;  // bytes kept of a printer's command in words

/// A program that merely looks like one for GRBL may as well be run by a controller that stops.
AfterEnd usual_after_end(GcodeDialect dialect, const GcodeReadOptions& options) {
  const bool stops = dialect == GcodeDialect::rs274 || dialect == GcodeDialect::mach3;
  const bool perhaps = dialect == GcodeDialect::grbl && !options.dialect;
  return stops || perhaps ? AfterEnd::stop : AfterEnd::read_on;
}

}  // namespace

Interpreter::Interpreter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
                         Talker& talker)
    : program_(program),
      path_(program.path),
      tool_comments_(program.tools),
      talker_(talker),
      options_(options),
      parameters_(*this),
      max_steps_(std::min(options.max_steps, text.size() / kBytesOfStep + options.max_made_steps)),
      after_end_(options.after_end.value_or(usual_after_end(program.dialect, options))),
      file_(program.path.origins().file(options.file_name)) {
  if (!is_printer()) return;
  set_filament(text);
  line_.follow(LetterRules::printer);
}

void Interpreter::run(const Block& block) {
  look_where_we_are();
  talker_.at_line(block.line);
  for (const Comment& comment : block.comments) read_comment(comment);
  if (block.percent) return read_percent();
  if (block.faulty || (block.optional && options_.block_delete == BlockDelete::skip)) return;
  if (!block.command.empty()) {
    add(step::Verbatim{std::string(block.command.substr(0, kLongestCommand))});
    return;
  }
  const bool empty = block.words.empty() && block.assignments.empty() && !block.o_word;
  if (empty) return;
  words_since_percent_ = true;
  if (program_.ended && !goes_on(block)) return;
  if (block.o_word) return flow_->control(block);
  if (!line_.sort(block, parameters_, talker_)) return;
  if (printer_line()) return printer_code();
  execute();
  line_.report_unused(talker_);
}

/// Follows calls and returns: another text's name in messages, modes that M73 kept.
void Interpreter::look_where_we_are() {
  if (flow_->depth() == current_depth_ && &flow_->file_name() == current_file_) return;
  if (&flow_->file_name() != current_file_) {
    current_file_ = &flow_->file_name();
    talker_.in_file(*current_file_);
    file_ = path_.origins().file(*current_file_);
    origin_line_ = 0;
  }
  current_depth_ = flow_->depth();
  while (kept_modes_.size() > current_depth_ + 1) {
    const std::optional<KeptModes> kept = kept_modes_.back();
    kept_modes_.pop_back();
    if (kept && kept->automatic) restore_modes(kept->modes);
  }
  kept_modes_.resize(current_depth_ + 1);
}

/// Whether a line after the program's end is read. Subroutines that stand there run only where they are
/// called.
bool Interpreter::goes_on(const Block& block) {
  const bool number = !block.words.empty() && block.words.front().letter == 'O';
  if (after_end_ == AfterEnd::stop && (number || block.o_word)) {
    stopped_ = true;
    return false;
  }
  if (number && flow_->skip_subprogram()) return false;
  if (after_end_said_ || block.o_word) return true;
  after_end_said_ = true;
  stopped_ = after_end_ == AfterEnd::stop;
  const std::uint32_t column = block.words.empty() ? 1 : block.words.front().column;
  if (stopped_)
    talker_.unusual(
        Code::text_after_end, column, "the program has ended above; from here on nothing is read",
        "a file of several programs runs through where a sender streams it line by line: --read-on");
  else
    talker_.note(Code::text_after_end, column,
                 "the program has ended above; what follows is read as its continuation");
  return !stopped_;
}

/// A program stands between two percent lines, or has none.
void Interpreter::read_percent() {
  if (flow_->depth() > 0) return;  // of a subroutine's own file
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
  if (line_.other_spindle()) line_.use(Line::bit('S') | Line::bit('D'));
  if (line_.has(Group::spindle_mode) && !line_.other_spindle()) set_spindle_mode();
  if (line_.unused('S')) set_speed();
  if (line_.has('T')) select_tool();
  if (line_.has_codes()) {
    if (line_.has(Group::tool_change)) change_tool();
    if (line_.has(Group::spindle) && !line_.other_spindle()) turn_spindle();
    switch_coolant();
    if (line_.has(Group::dwell)) dwell();
    guard_compensation();
    if (line_.has(Group::plane)) set_plane();
    if (line_.has(Group::compensation)) set_compensation();
    if (line_.has(Group::saved_modes)) keep_modes();
    if (line_.has(Group::coordinates)) use_coordinates();
    if (line_.has(Group::path_control)) set_path_mode();
    set_distance();
    if (line_.has(Group::lathe)) modes_.diameters = line_.code(Group::lathe) == 70;
    if (line_.has(Group::scaling)) scale_program();
    if (line_.has(Group::rotation)) turn_program();
    use_words_of_other_codes();
    note_rest();
    if (line_.has(Group::reference)) use_reference();
  }
  if (line_.large_m_code() >= 0) read_large_m_code();
  if (line_.polar_radius() || line_.polar_angle()) polar();
  move();
  if (line_.has(Group::subroutine)) subroutine();
  if (line_.has(Group::stop)) end_or_pause();
}

void Interpreter::finish() {
  program_.stock = stock_.stock();
  tool_comments_.finish(talker_.diagnostics());
  leave_system();
  tell_silent_spindle();
  program_.cut_short = full_ || flow_->gave_up();
  const bool ends = !is_printer();  // a printer stops where its program stops
  if (ends && !program_.ended && !program_.cut_short && path_.size() > 0)
    talker_.unusual(Code::no_program_end, 0, "the program has no end (M2, M30 or a closing %)",
                    "was it cut off?");
}

/// A spindle that is started in a program without any S has no speed that a controller would know.
void Interpreter::tell_silent_spindle() {
  if (!silent_spindle_ || modes_.speed_told) return;
  const auto& [code, where] = *silent_spindle_;
  talker_.unusual_at(where, Code::word_missing,
                     fmt::format("{} starts the spindle, and no S says how fast; taken as set by hand",
                                 code_text('M', code)),
                     "put an S word before it or on its line");
}

/// Whether so many more steps are within the limit; else the program ends here, and it is said.
bool Interpreter::room_for(double steps) {
  if (static_cast<double>(path_.size()) + steps <= static_cast<double>(max_steps_)) return true;
  if (!full_)
    talker_.error(Code::too_many_steps, line_.column(),
                  fmt::format("the program makes more than {} steps, which is more than is read; the rest is "
                              "left out",
                              max_steps_));
  full_ = true;
  return false;
}

OriginId Interpreter::origin() {
  if (origin_line_ != talker_.line()) {
    origin_line_ = talker_.line();
    origin_ = path_.origins().text(file_, origin_line_, line_.column());
  }
  return origin_;
}

}  // namespace kerf::gcode
