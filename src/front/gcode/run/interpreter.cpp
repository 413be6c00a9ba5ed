// Execution of one line: its comments, then its words in the order of their effect.
#include "front/gcode/run/interpreter.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxCommandBytes = 1000;  // of a printer's command in words; the rest is dropped

/// A line with T or M6.
bool changes_tool(const Block& block) {
  return std::any_of(block.words.begin(), block.words.end(), [](const Word& w) {
    return w.letter == 'T' || (w.letter == 'M' && w.kind == ValueKind::number && w.value == 6.0);
  });
}

/// Fanuc's and Haas' controls return to the initial level (G98) after power-on and reset; grblHAL and
/// Smoothieware do too. LinuxCNC returns to the retract plane (G99); so do the others here.
constexpr bool returns_to_start(GcodeDialect dialect) {
  return is_fanuc(dialect) || dialect == GcodeDialect::grbl;
}

}  // namespace

Interpreter::Interpreter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
                         LineReporter& reporter)
    : system_(context_, coordinates_, rotary_, feeds_, tools_, diameters_, compensation_, calls_),
      parameters_(system_),
      context_(program, text, options, reporter, parameters_),
      rotary_(context_),
      diameters_(context_),
      coordinates_(context_, diameters_),
      comments_(context_, beads_),
      feeds_(context_, rotary_),
      mover_(context_, coordinates_, rotary_, comments_),
      spindle_(context_),
      dwells_(context_, text),
      tools_(context_, coordinates_, spindle_, comments_),
      compensation_(context_, coordinates_, mover_, diameters_),
      corners_(context_, coordinates_, mover_, compensation_),
      extruders_(context_, feeds_),
      printer_(context_, coordinates_, mover_, tools_, extruders_, beads_, comments_),
      references_(context_, coordinates_, rotary_, mover_, printer_),
      motion_(context_, coordinates_, rotary_, mover_, feeds_, dwells_, spindle_, compensation_, corners_,
              printer_),
      settings_(context_, coordinates_, compensation_, comments_),
      calls_(context_, coordinates_, spindle_),
      end_(context_),
      lathe_(context_),
      simple_lines_(context_, coordinates_, rotary_, mover_, feeds_, compensation_, corners_, calls_, end_) {
  context_.line.set_dialect(program.dialect);
  context_.modes.absolute_centres = options.arc_centres == ArcCentres::absolute;
  context_.modes.retract_to_start = returns_to_start(program.dialect);
  if (is_fanuc(program.dialect)) parameters_.use_vacant_variables();
  if (!is_printer(program.dialect)) return;
  printer_.set_filament(text);
}

void Interpreter::run(const Block& block) {
  calls_.follow();
  context_.reporter.at_line(block.line);
  const bool at_tool_change = !block.comments.empty() && changes_tool(block);
  for (const Comment& comment : block.comments) comments_.read(comment, at_tool_change);
  if (block.percent) {
    corners_.finish();
    return end_.read_percent();
  }
  if (block.faulty && context_.program.ended) return end_.report_unreadable();
  if (block.faulty || (block.optional && context_.options.block_delete == BlockDelete::skip)) return;
  if (block.sender) return settings_.skip_setting(block);
  if (!block.command.empty()) return printer_.command(block.command.substr(0, kMaxCommandBytes));
  const bool empty = block.words.empty() && block.assignments.empty() && !block.o_word;
  if (empty) return;
  end_.note_words();
  if (context_.program.ended && !end_.reads_on_after(block)) return;
  if (block.o_word) {
    calls_.control(block);
    return stop_by_variable(block);
  }
  if (!context_.line.sort(block, parameters_, context_.reporter)) return;
  stop_by_variable(block);
  if (printer_.has_code()) return printer_.run_code();
  execute();
  context_.line.report_unused(context_.reporter);
}

/// An assignment to #3000 ends the program with an alarm, one to #3006 stops it with a message.
void Interpreter::stop_by_variable(const Block& block) {
  const std::optional<int> variable = parameters_.take_stop();
  if (!variable) return;
  corners_.finish();
  if (*variable == Parameters::kMessage) return void(context_.steps.add(step::Pause{PauseKind::always}));
  const std::string_view message = block.comments.empty() ? std::string_view() : block.comments.front().text;
  context_.reporter.error(codes::program_alarm, 1,
                          fmt::format("the program stops itself here with an alarm: {}", message));
  end_program();
  context_.steps.add(step::End{false});
  end_.stop();
}

/// The order is that of LinuxCNC's "Order of Execution", except that G20 and G21 apply to the feed of their
/// own line.
void Interpreter::execute() {
  LineWords& line = context_.line;
  line.use(LineWords::bit('O'));  // the program's number
  corners_.finish_before_line();
  mover_.set_named(0);
  if (line.unknown_letters() != 0) motion_.note_unknown_words();
  const bool calls_macro = line.has(Group::subroutine) && is_macro_call(line.code(Group::subroutine));
  if (calls_macro && is_fanuc(context_.program.dialect)) {  // all other words are its arguments
    calls_.macro_call();
    if (line.unknown_g_column() != 0) motion_.leave_out_motion();
    return;
  }
  if (line.has_codes()) {
    lathe_.note();
    if (line.has(Group::feed_mode)) feeds_.set_mode();
    if (line.has(Group::units)) settings_.set_units();
  }
  if (line.has('F')) feeds_.set_feed();
  if (line.other_spindle()) line.use(LineWords::bit('S') | LineWords::bit('D'));
  if (line.has(Group::spindle_mode) && !line.other_spindle()) spindle_.set_mode();
  const bool is_time = is_printer(context_.program.dialect) && line.has(Group::dwell);
  if (line.unused('S') && !is_time) spindle_.set_speed();
  if (line.unused('T')) tools_.select();
  if (line.has_codes()) execute_codes();
  if (line.large_m_code() >= 0) run_large_m_code();
  if (!line.unknown_m_code().empty() && !is_printer(context_.program.dialect))
    motion_.leave_out(line.unknown_m_code());
  if (calls_macro) calls_.macro_call();
  const bool extended = coordinates_.selects_extended_offset();
  if (extended) coordinates_.use_extended_offset(line.unknown_g_code(), line.unknown_g_column());
  if (line.unknown_g_column() != 0 && !extended) {
    motion_.leave_out_motion();
  } else {
    if (line.polar_radius() || line.polar_angle()) mover_.use_polar_words();
    const bool in_machine = line.has(Group::reference) || line.has(Group::machine_coordinates);
    if (context_.modes.polar_centre && !in_machine && (line.has('X') || line.has('Y')))
      mover_.use_polar_mode();
    const Toolpath& path = context_.program.path;
    const std::size_t before = path.size();
    motion_.run_line();
    if (path.size() > before && path[path.size() - 1].is_motion()) calls_.modal_macro_call();
  }
  if (const std::optional<CornerWord> corner = line.take_corner()) report_corner(*corner);
  if (line.has(Group::subroutine) && !calls_.subroutine()) end_program();
  if (line.has(Group::stop)) end_or_pause();
}

/// The codes whose effect precedes the line's motion.
void Interpreter::execute_codes() {
  const LineWords& line = context_.line;
  if (line.has(Group::tool_change)) tools_.change();
  if (line.has(Group::spindle) && !line.other_spindle()) spindle_.switch_by_code();
  settings_.switch_coolant();
  if (line.has(Group::override_switch)) settings_.switch_overrides();
  if (line.has(Group::dwell)) dwells_.dwell();
  compensation_.end_for_refused_codes();
  if (line.has(Group::plane)) settings_.set_plane();
  if (line.has(Group::compensation)) compensation_.set();
  if (line.has(Group::saved_modes)) calls_.save_modes();
  if (line.has(Group::coordinates)) coordinates_.use_coordinates();
  if (line.has(Group::path_control)) settings_.set_path_mode();
  settings_.set_distance();
  if (line.has(Group::polar)) settings_.set_polar_mode();
  if (line.has(Group::scaling)) coordinates_.scale_program();
  if (line.has(Group::rotation)) coordinates_.rotate_program();
  if (line.has(Group::tool_length)) tools_.set_length();
  settings_.use_words_of_other_codes();
  mover_.note_stop();
  if (line.has(Group::reference)) references_.use();
}

/// A corner that the line's motion has not used.
void Interpreter::report_corner(const CornerWord& word) {
  const bool fanuc = is_fanuc(context_.program.dialect);
  context_.reporter.error(
      codes::corner_refused, word.column,
      fanuc ? "a corner belongs to a straight cut (G1) in the plane; skipped"
            : fmt::format("{} has no corner words; skipped", to_string(context_.program.dialect)),
      fanuc ? "" : "a corner of Fanuc and Haas is read with --dialect fanuc or haas");
}

void Interpreter::finish() {
  GcodeProgram& program = context_.program;
  const Flow& flow = *context_.flow;
  corners_.finish();
  comments_.finish();
  coordinates_.note_zeros();
  spindle_.report_missing_speed();
  lathe_.report();
  program.cut_short = context_.steps.full() || flow.limit_reached();
  if (program.path.size() == 0 && !flow.first_subroutine().empty() && !program.cut_short)
    context_.reporter.error(codes::subroutine_only, 0,
                            fmt::format("the file only defines the subroutine o{}, and nothing calls it",
                                        flow.first_subroutine()),
                            fmt::format("call it from a program in the same folder, e.g. o{} call [1] [2]",
                                        flow.first_subroutine()));
  end_.report_missing();
}

void Interpreter::end_or_pause() {
  const Tenths code = context_.line.code(Group::stop);
  // RepRapFirmware ends the job at M0 and M1; its pause is M226 (Duet's "G-code dictionary").
  const bool stops_print = context_.program.dialect == GcodeDialect::reprap && (code == 0 || code == 10);
  if (code == 20 || code == 300 || stops_print) {
    end_program();
    context_.steps.add(step::End{code == 300});
  } else {
    pause(code == 0 ? PauseKind::always : code == 10 ? PauseKind::optional : PauseKind::pallet_change);
  }
}

void Interpreter::pause(PauseKind kind) {
  if (comments_.change_at_pause() && kind == PauseKind::always) return tools_.change_at_pause();
  context_.steps.add(step::Pause{kind});
}

/// Smoothieware, which is read as GRBL, has no M0: it suspends the file at M600 (its Player.cpp).
void Interpreter::run_large_m_code() {
  constexpr int kSuspend = 600;
  const bool suspends =
      context_.program.dialect == GcodeDialect::grbl && context_.line.large_m_code() == kSuspend;
  if (suspends) return pause(PauseKind::always);
  if (!spindle_.switch_by_fan()) settings_.read_large_m_code();
}

/// M2 and M30 reset the modes (LinuxCNC's page "M2, M30"; GRBL does the same), but not units, position and
/// tool.
void Interpreter::end_program() {
  Modes& modes = context_.modes;
  end_.note();
  spindle_.stop();
  settings_.stop_coolant();
  compensation_.end();
  compensation_.stop_leaving();
  modes.motion = 10;
  coordinates_.end_program(end_.after());
  modes.plane = Plane::xy;
  modes.polar_centre.reset();
  modes.absolute = true;
  if (modes.feed_mode != FeedMode::per_minute) modes.feed = 0.0;
  modes.feed_mode = FeedMode::per_minute;
  if (returns_to_start(context_.program.dialect)) modes.retract_to_start = true;
  motion_.end_cycle();
}

}  // namespace kerf::gcode
