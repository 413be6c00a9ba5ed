// Execution of one line: its comments, then its words in the order of their effect.
#include "front/gcode/run/interpreter.h"

#include <algorithm>
#include <fmt/format.h>

namespace kerf::gcode {
namespace {

constexpr std::size_t kMinBytesPerStep = 2;     // a text of n bytes has at most n / 2 words
constexpr std::size_t kMaxCommandBytes = 1000;  // of a printer's command in words; the rest is dropped

/// A dialect of GRBL that is only detected is no reason to read on: other controllers stop.
AfterEnd default_after_end(GcodeDialect dialect, const GcodeReadOptions& options) {
  const bool stops = dialect == GcodeDialect::rs274 || dialect == GcodeDialect::mach3;
  const bool uncertain = dialect == GcodeDialect::grbl && !options.dialect;
  return stops || uncertain ? AfterEnd::stop : AfterEnd::read_on;
}

/// A line with T or M6.
bool changes_tool(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(), [](const Word& w) {
    return w.letter == 'T' || (w.letter == 'M' && w.kind == ValueKind::number && w.value == 6.0);
  });
}

}  // namespace

Interpreter::Interpreter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
                         LineReporter& reporter)
    : program_(program),
      path_(program.path),
      tool_comments_(program.tools),
      reporter_(reporter),
      options_(options),
      parameters_(*this),
      max_steps_(std::min(options.max_steps, text.size() / kMinBytesPerStep + options.max_made_steps)),
      after_end_(options.after_end.value_or(default_after_end(program.dialect, options))),
      file_(program.path.origins().file(options.file_name)) {
  if (!is_printer()) return;
  set_filament(text);
  line_.set_rules(LetterRules::printer);
}

void Interpreter::run(const Block& block) {
  follow_calls();
  reporter_.at_line(block.line);
  const bool at_tool_change = !block.comments.empty() && changes_tool(block);
  for (const Comment& comment : block.comments) read_comment(comment, at_tool_change);
  if (block.percent) return read_percent();
  if (block.faulty || (block.optional && options_.block_delete == BlockDelete::skip)) return;
  if (!block.command.empty()) {
    add(step::Verbatim{std::string(block.command.substr(0, kMaxCommandBytes))});
    return;
  }
  if (block.sender) return reporter_.note(Code::sender_line, 0, "a command for the controller; skipped");
  const bool empty = block.words.empty() && block.assignments.empty() && !block.o_word;
  if (empty) return;
  words_since_percent_ = true;
  if (program_.ended && !reads_after_end(block)) return;
  if (block.o_word) return flow_->control(block);
  if (!line_.sort(block, parameters_, reporter_)) return;
  if (printer_line()) return printer_code();
  execute();
  line_.report_unused(reporter_);
}

/// After calls and returns: sets the file of diagnostics and origins, restores modes stored by M73.
void Interpreter::follow_calls() {
  if (flow_->depth() == current_depth_ && &flow_->file_name() == current_file_) return;
  if (&flow_->file_name() != current_file_) {
    current_file_ = &flow_->file_name();
    reporter_.in_file(*current_file_);
    file_ = path_.origins().file(*current_file_);
    origin_line_ = 0;
  }
  current_depth_ = flow_->depth();
  while (saved_modes_.size() > current_depth_ + 1) {
    const std::optional<SavedModes> kept = saved_modes_.back();
    saved_modes_.pop_back();
    if (kept && kept->automatic) restore_modes(kept->modes);
  }
  saved_modes_.resize(current_depth_ + 1);
}

/// Whether a line after the program's end is read. Subroutines there run only where they are called.
bool Interpreter::reads_after_end(const Block& block) {
  const bool number = !block.words.empty() && block.words.front().letter == 'O';
  if (after_end_ == AfterEnd::stop && (number || block.o_word)) {
    stopped_ = true;
    return false;
  }
  if (number && flow_->skip_subprogram()) return false;
  if (text_after_end_reported_ || block.o_word) return true;
  text_after_end_reported_ = true;
  stopped_ = after_end_ == AfterEnd::stop;
  const std::uint32_t column = block.words.empty() ? 1 : block.words.front().column;
  if (stopped_)
    reporter_.unusual(Code::text_after_end, column, "text after the end of the program is not read",
                      "use --read-on to read past M2, M30 and %, as G-code senders do");
  else
    reporter_.note(Code::text_after_end, column,
                   "text after the end of the program is read as its continuation");
  return !stopped_;
}

/// A program is enclosed in two percent lines, or has none.
void Interpreter::read_percent() {
  if (flow_->depth() > 0) return;  // in a subroutine's file
  const bool closes = percent_open_ || words_since_percent_;
  if (closes && !percent_open_)
    reporter_.unusual(Code::lone_percent, 1, "this percent line closes a program without an opening one");
  if (closes) program_.ended = true;
  percent_open_ = !closes;
  words_since_percent_ = false;
}

/// The order is that of LinuxCNC's "Order of Execution", except that G20 and G21 apply to the feed of their
/// own line.
void Interpreter::execute() {
  line_.use(LineWords::bit('O'));  // the program's number
  if (line_.has_codes()) {
    if (line_.has(Group::feed_mode)) set_feed_mode();
    if (line_.has(Group::units)) set_units();
  }
  if (line_.has('F')) set_feed();
  if (line_.other_spindle()) line_.use(LineWords::bit('S') | LineWords::bit('D'));
  if (line_.has(Group::spindle_mode) && !line_.other_spindle()) set_spindle_mode();
  if (line_.unused('S')) set_speed();
  if (line_.has('T')) select_tool();
  if (line_.has_codes()) {
    if (line_.has(Group::tool_change)) change_tool();
    if (line_.has(Group::spindle) && !line_.other_spindle()) switch_spindle();
    switch_coolant();
    if (line_.has(Group::dwell)) dwell();
    end_compensation_for_refused_codes();
    if (line_.has(Group::plane)) set_plane();
    if (line_.has(Group::compensation)) set_compensation();
    if (line_.has(Group::saved_modes)) save_modes();
    if (line_.has(Group::coordinates)) use_coordinates();
    if (line_.has(Group::path_control)) set_path_mode();
    set_distance();
    if (line_.has(Group::lathe)) modes_.diameters = line_.code(Group::lathe) == 70;
    if (line_.has(Group::scaling)) scale_program();
    if (line_.has(Group::rotation)) rotate_program();
    use_words_of_other_codes();
    note_stop();
    if (line_.has(Group::reference)) use_reference();
  }
  if (line_.large_m_code() >= 0) read_large_m_code();
  if (line_.polar_radius() || line_.polar_angle()) polar();
  run_line_motion();
  if (line_.has(Group::subroutine)) subroutine();
  if (line_.has(Group::stop)) end_or_pause();
}

void Interpreter::finish() {
  use_pending_comments();
  program_.stock = stock_.stock();
  if (!program_.stock) program_.stock = cam_stock_comments_.stock();
  tool_comments_.finish(reporter_.diagnostics());
  check_system_offsets();
  report_missing_speed();
  program_.cut_short = full_ || flow_->limit_reached();
  if (path_.size() == 0 && !flow_->first_subroutine().empty() && !program_.cut_short)
    reporter_.error(Code::subroutine_only, 0,
                    fmt::format("the file only defines the subroutine o<{0}>, and nothing calls it",
                                flow_->first_subroutine()),
                    fmt::format("call it from a program in the same folder, e.g. o<{}> call [1] [2]",
                                flow_->first_subroutine()));
  const bool ends = !is_printer();  // printers need no end
  if (ends && !program_.ended && !program_.cut_short && path_.size() > 0)
    reporter_.unusual(Code::no_program_end, 0, "the program has no end (M2, M30 or a closing %)",
                      "is the file complete?");
}

void Interpreter::report_missing_speed() {
  if (!spindle_without_speed_ || modes_.speed_given) return;
  const auto& [code, where] = *spindle_without_speed_;
  reporter_.unusual_at(where, Code::word_missing,
                       fmt::format("{} starts the spindle without an S word; assuming a speed set by hand",
                                   code_text('M', code)),
                       "put an S word before it or on its line");
}

/// Whether `steps` more are within the limit; otherwise the program ends here, with an error.
bool Interpreter::room_for(double steps) {
  if (static_cast<double>(path_.size()) + steps <= static_cast<double>(max_steps_)) return true;
  if (!full_)
    reporter_.error(Code::too_many_steps, line_.column(),
                    fmt::format("the program has more than {} steps; the rest is not read", max_steps_));
  full_ = true;
  return false;
}

OriginId Interpreter::origin() {
  if (origin_line_ != reporter_.line()) {
    origin_line_ = reporter_.line();
    origin_ = path_.origins().text(file_, origin_line_, line_.column());
  }
  return origin_;
}

}  // namespace kerf::gcode
