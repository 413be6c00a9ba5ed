// Execution of one line: its comments, then its words in the order of their effect.
#include "front/gcode/run/interpreter.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/gcode.h"

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
  if (block.faulty && program_.ended) return report_unreadable_end();
  if (block.faulty || (block.optional && options_.block_delete == BlockDelete::skip)) return;
  if (block.sender) return skip_setting(block);
  if (!block.command.empty()) return printer_command(block.command.substr(0, kMaxCommandBytes));
  const bool empty = block.words.empty() && block.assignments.empty() && !block.o_word;
  if (empty) return;
  words_since_percent_ = true;
  if (program_.ended && !reads_after_end(block)) return;
  if (block.o_word) {
    flow_->control(block);
    if (flow_->take_unknown_value()) report_unresolved("the flow of the program", block.o_word->column);
    return;
  }
  if (!line_.sort(block, parameters_, reporter_)) return;
  if (printer_line()) return printer_code();
  execute();
  line_.report_unused(reporter_);
}

/// The last line has called a subroutine, or returned from one.
void Interpreter::note_caller() {
  origin_line_ = 0;
  if (flow_->depth() <= callers_.size()) return callers_.resize(flow_->depth());
  const OriginId call = path_.origins().text(file_, reporter_.line(), 0);
  if (!callers_.empty()) path_.origins().set_caller(call, callers_.back());
  callers_.resize(flow_->depth(), call);
}

/// After calls and returns: sets the file of diagnostics and origins, restores modes stored by M73.
void Interpreter::follow_calls() {
  if (flow_->depth() == current_depth_ && &flow_->file_name() == current_file_) return;
  note_caller();
  if (&flow_->file_name() != current_file_) {
    current_file_ = &flow_->file_name();
    reporter_.in_file(*current_file_);
    file_ = path_.origins().file(*current_file_);
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
    reporter_.unusual(codes::text_after_end, column, "text after the end of the program is not read",
                      "use --read-on to read past M2, M30 and %, as G-code senders do");
  else
    reporter_.note(codes::text_after_end, column,
                   "text after the end of the program is read as its continuation");
  return !stopped_;
}

/// A line after the program's end that is not G-code.
void Interpreter::report_unreadable_end() {
  stopped_ = stopped_ || after_end_ == AfterEnd::stop;
  if (text_after_end_reported_) return;
  text_after_end_reported_ = true;
  reporter_.unusual(codes::text_after_end, 1, "text after the end of the program is not G-code; skipped");
}

void Interpreter::note_program_end() {
  program_.ended = true;
  flow_->note_program_end();
}

/// A program is enclosed in two percent lines, or has none.
void Interpreter::read_percent() {
  if (flow_->depth() > 0) return;  // in a subroutine's file
  const bool closes = percent_open_ || words_since_percent_;
  if (closes && !percent_open_)
    reporter_.unusual(codes::lone_percent, 1, "this percent line closes a program without an opening one");
  if (closes) note_program_end();
  percent_open_ = !closes;
  words_since_percent_ = false;
}

/// The order is that of LinuxCNC's "Order of Execution", except that G20 and G21 apply to the feed of their
/// own line.
void Interpreter::execute() {
  line_.use(LineWords::bit('O'));  // the program's number
  named_ = 0;
  if (line_.unknown_letters() != 0) note_unknown_words();
  if (line_.has_codes()) {
    note_lathe_words();
    if (line_.has(Group::feed_mode)) set_feed_mode();
    if (line_.has(Group::units)) set_units();
  }
  if (line_.has('F')) set_feed();
  if (line_.other_spindle()) line_.use(LineWords::bit('S') | LineWords::bit('D'));
  if (line_.has(Group::spindle_mode) && !line_.other_spindle()) set_spindle_mode();
  if (line_.unused('S')) set_speed();
  if (line_.unused('T')) select_tool();
  if (line_.has_codes()) {
    if (line_.has(Group::tool_change)) change_tool();
    if (line_.has(Group::spindle) && !line_.other_spindle()) switch_spindle();
    switch_coolant();
    if (line_.has(Group::override_switch)) switch_overrides();
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
    if (line_.has(Group::tool_length)) set_tool_length();
    use_words_of_other_codes();
    note_stop();
    if (line_.has(Group::reference)) use_reference();
  }
  if (line_.large_m_code() >= 0) read_large_m_code();
  if (line_.has(Group::subroutine) && line_.code(Group::subroutine) == 650) macro_call();
  const bool extended = selects_extended_offset();
  if (extended) use_extended_offset(line_.unknown_g_code(), line_.unknown_g_column());
  if (line_.unknown_g_column() != 0 && !extended) {
    leave_out();
  } else {
    if (line_.polar_radius() || line_.polar_angle()) polar();
    run_line_motion();
  }
  if (line_.has(Group::subroutine)) subroutine();
  if (line_.has(Group::stop)) end_or_pause();
}

/// A line for GRBL itself, such as "$110=5000". "$H" homes and "$J=" jogs: the position is unknown after
/// them.
void Interpreter::skip_setting(const Block& block) {
  reporter_.note(codes::sender_line, 0, "a command for the controller; skipped");
  const std::string_view start = block.command.substr(0, 2);
  if (start != "$H" && start != "$J" && start != "$h" && start != "$j") return;
  add(step::Unresolved{std::string(start), UnresolvedKind::code});
  lose(kAllAxes);
}

/// Words whose value is known only at run time. The targets of straight motions are unknown
/// then (see target()); anything else cannot be represented.
void Interpreter::note_unknown_words() {
  const std::uint32_t letters = line_.unknown_letters();
  std::uint32_t column = line_.column();
  std::string which;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if ((letters & LineWords::bit(letter)) == 0) continue;
    if (which.empty() && line_.has(letter)) column = line_.column(letter);
    which += fmt::format("{}{}", which.empty() ? "" : ", ", letter);
  }
  reporter_.unusual(
      codes::value_unknown, column,
      fmt::format("{} depends on a value known only at run time, such as a probed position", which));
  const Tenths motion = line_.has(Group::motion) ? line_.code(Group::motion) : modes_.motion;
  const bool straight = motion == 0 || motion == 10 || (motion >= 382 && motion <= 385);
  if ((letters & ~kAxisLetters) != 0 || !straight || line_.has(Group::reference) || !frame_.only_shifted)
    add(step::Unresolved{fmt::format("the value of {}", which)});
}

void Interpreter::report_unresolved(std::string_view what, std::uint32_t column) {
  reporter_.unusual(
      codes::value_unknown, column,
      fmt::format("{} depends on a value known only at run time, such as a probed position", what));
  add(step::Unresolved{std::string(what)});
}

/// G54.1 P3, G154 P3: an offset of the control that programs do not set. The words of its line stay those of
/// the line's motion.
bool Interpreter::selects_extended_offset() {
  const std::string& code = line_.unknown_g_code();
  if (line_.unknown_g_column() == 0 || (code != "G54.1" && code != "G154")) return false;
  if (program_.dialect == GcodeDialect::fanuc) return true;
  reporter_.unusual(codes::unknown_g_code, line_.unknown_g_column(),
                    fmt::format("unknown code {}; skipped", code),
                    "it selects a work offset on Fanuc and Haas: --dialect");
  return false;
}

void Interpreter::use_extended_offset(std::string_view selection, std::uint32_t column) {
  const std::string code = fmt::format("{} P{:g}", selection, line_.take('P').value_or(0.0));
  note_zeros();
  zero_location_ = reporter_.location(column);
  unknown_offset_reported_ = true;
  reporter_.unusual(
      codes::offset_unknown, column,
      fmt::format("{} selects a work offset whose distance from the others is unknown; counted as 0", code),
      "split the program by work offset");
  add(step::Unresolved{code, UnresolvedKind::code});
  lose(kAllAxes);
}

/// A code that is not known may be a motion: the words of its line belong to it, and the tool may be anywhere
/// after it.
void Interpreter::leave_out() {
  line_.use(kAllLetters);
  add(step::Unresolved{line_.unknown_g_code(), UnresolvedKind::code});
  lose(kAllAxes);
  rotary_unknown_ = kAllAxes;
}

void Interpreter::finish() {
  use_pending_comments();
  program_.units_given = units_given_;
  program_.stock = stock_.stock();
  if (!program_.stock) program_.stock = cam_stock_comments_.stock();
  tool_comments_.finish(reporter_.diagnostics());
  note_zeros();
  report_missing_speed();
  report_turning();
  program_.cut_short = full_ || flow_->limit_reached();
  if (path_.size() == 0 && !flow_->first_subroutine().empty() && !program_.cut_short)
    reporter_.error(codes::subroutine_only, 0,
                    fmt::format("the file only defines the subroutine o{}, and nothing calls it",
                                flow_->first_subroutine()),
                    fmt::format("call it from a program in the same folder, e.g. o{} call [1] [2]",
                                flow_->first_subroutine()));
  const bool ends = !is_printer();  // printers need no end
  if (ends && !program_.ended && !program_.cut_short && path_.size() > 0)
    reporter_.unusual(codes::no_program_end, 0, "the program has no end (M2, M30 or a closing %)",
                      "is the file complete?");
}

void Interpreter::report_missing_speed() {
  if (!spindle_without_speed_ || modes_.speed_given) return;
  const auto& [code, where] = *spindle_without_speed_;
  reporter_.unusual_at(where, codes::word_missing,
                       fmt::format("{} starts the spindle without an S word; assuming a speed set by hand",
                                   code_text('M', code)),
                       "put an S word before it or on its line");
}

/// Words that programs for lathes have: diameters (G7, G8), the plane of X and Z (G18), feeds per turn (G95),
/// cutting speeds (G96, G97), threads (G76).
void Interpreter::note_lathe_words() {
  const bool signs[] = {line_.has(Group::lathe), line_.has(Group::plane) && line_.code(Group::plane) == 180,
                        line_.has(Group::feed_mode) && line_.code(Group::feed_mode) == 950,
                        line_.has(Group::spindle_mode),
                        line_.has(Group::motion) && line_.code(Group::motion) == 760};
  for (std::size_t i = 0; i < std::size(signs); ++i) {
    if (!signs[i]) continue;
    if (lathe_signs_ == 0) lathe_location_ = reporter_.location(line_.column());
    lathe_signs_ |= 1u << i;
  }
}

/// A program with words of two kinds that moves in X and Z only is one for a lathe.
void Interpreter::report_turning() {
  if ((lathe_signs_ & (lathe_signs_ - 1)) == 0) return;
  constexpr unsigned kY = 2;
  bool cuts = false;
  for (const Step& s : path_.steps()) {
    if (s.is_motion() && (s.named_axes() & kY) != 0) return;
    cuts = cuts || s.is_cutting();
  }
  if (cuts)
    reporter_.unusual_at(
        lathe_location_, codes::turning_program,
        "the program seems to be for a lathe; turning is not supported, it is read as milling", "");
}

/// Whether `steps` more are within the limit; otherwise the program ends here, with an error.
bool Interpreter::room_for(double steps) {
  if (static_cast<double>(path_.size()) + steps <= static_cast<double>(max_steps_)) return true;
  if (!full_)
    reporter_.error(codes::too_many_steps, line_.column(),
                    fmt::format("the program has more than {} steps; the rest is not read", max_steps_));
  full_ = true;
  return false;
}

OriginId Interpreter::origin() {
  if (origin_line_ != reporter_.line()) start_origin(line_.column());
  return origin_;
}

/// The origin of the steps of the present line.
void Interpreter::start_origin(std::uint32_t column) {
  origin_line_ = reporter_.line();
  origin_ = path_.origins().text(file_, origin_line_, column);
  if (!callers_.empty()) path_.origins().set_caller(origin_, callers_.back());
}

}  // namespace kerf::gcode
