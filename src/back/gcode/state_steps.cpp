// Steps other than motions: path modes, pauses, what has no meaning here, verbatim lines.
#include <algorithm>
#include <fmt/format.h>

#include "back/gcode/lint.h"
#include "back/gcode/poster.h"
#include "base/codes/gcode.h"
#include "path/firmware_commands.h"

namespace kerf::gcode {

void Poster::path_mode(std::size_t i, const step::PathMode& mode) {
  const int tenths = mode.kind == PathModeKind::blend        ? 640
                     : mode.kind == PathModeKind::exact_stop ? 611
                                                             : 610;
  if (!profile_.has_g(tenths)) {
    if (mode.kind != PathModeKind::exact_path) report_skipped(i, "the controller has no such path mode; it");
    return;
  }
  const bool has_tolerance = mode.kind == PathModeKind::blend && mode.tolerance > Length{};
  if (has_tolerance && !profile_.form.blend_tolerance)
    report_skipped(i, "G64 of the controller has no tolerance; P");
  lines_.start_line();
  lines_.code('G', tenths);
  if (has_tolerance && profile_.form.blend_tolerance)
    lines_.word('P', units_.grid.count(mode.tolerance.mm()), units_.decimals);
  lines_.end_line(i);
}

/// A pause; by the profile's pause lines if the controller has no such M code.
void Poster::pause(std::size_t i) {
  const PauseKind kind = path_[i].pause().kind;
  const int m = kind == PauseKind::always ? 0 : kind == PauseKind::optional ? 10 : 600;
  if (profile_.has_m(m)) {
    axes_.pause();
    return lines_.code_line(i, 'M', m);
  }
  if (kind == PauseKind::optional) return report_skipped(i, "the controller has no M1; the optional pause");
  put_pause(i);
}

void Poster::put_pause(std::size_t i) {
  axes_.pause();
  std::vector<std::string> lines = profile_.pause_lines;
  lines.erase(std::remove_if(lines.begin(), lines.end(), is_comment), lines.end());
  if (lines.empty()) return report_unsupported(i, "the controller has no way to pause");
  texts_.templates(lines);
}

/// A code that the reader has left out and reported. It may have moved the tool, or changed the tool or the
/// zero. The procedures of a printer end where its next motions start.
void Poster::left_out(std::size_t i) {
  axes_.lose(kAllAxes);
  if (options_.left_out == LeftOutCodes::skipped || profile_.syntax == LineSyntax::commands) return;
  Diagnostic& d = diagnostics_.error(
      codes::post_code_left_out, path_.origin_of(i),
      fmt::format("{} was left out; it may move the tool, or change the tool or the work zero",
                  path_.text(i)));
  d.hint = "write the program without it with --allow-left-out";
}

/// What the program does from here on is known to its controller only.
void Poster::unresolved(std::size_t i) {
  position_.pass(path_[i]);
  if (path_[i].unresolved() == UnresolvedKind::code) return left_out(i);
  report_unsupported(i,
                     fmt::format("{} depends on a value known only at run time, such as a probed position; "
                                 "it cannot be written for another one",
                                 path_.text(i)));
}

/// Homing and heating before the first bead that the header has done already.
bool Poster::is_in_header(std::size_t i) const {
  const Step& s = path_[i];
  if (extruded_ || !profile_.has_letter('E')) return false;
  if (s.kind() == StepKind::temperature) {
    const step::Temperature t = s.temperature();
    return t.celsius > 0.0 && t.extruder <= 0 && header_.heats(t.heater, t.wait);
  }
  return s.is_motion() && s.reference() == Reference::end_switches && header_.homes();
}

void Poster::verbatim(std::size_t i) {
  const std::string_view text = path_.text(i);
  if (is_comment(text) && acts(text.substr(1)) && !profile_.form.parameters)
    return report_skipped(i, fmt::format("the controller does not carry out comments; {}", text));
  const bool one_line = text.find_first_of("\r\n") == std::string_view::npos;
  if (!one_line || text.size() > profile_.longest_line) {
    if (one_line && replace_command(i)) return;
    return report_unsupported(i, "a verbatim text does not fit on one line of the controller");
  }
  if (const FirmwareRetraction retraction = read_firmware_retraction(text);
      retraction.line != RetractionLine::none)
    return prints_.firmware_retraction(i, retraction);
  const std::string line(text);
  Diagnostics found;
  if (lint(line, profile_, "", LintStart::foreign_line, found)) return words_.raw_line(line);
  if (replace_command(i)) return;
  Diagnostic& d = diagnostics_.error(codes::post_cannot, path_.origin_of(i),
                                     fmt::format("the controller does not accept \"{}\"", line));
  for (const Diagnostic& f : found.list()) d.notes.push_back({{}, f.message});
}

/// A command of another printer's firmware: a pause is written as the controller's own, a harmless one is
/// left out; each is reported once. False for a command that may move the nozzle or change the zero or the
/// tool.
bool Poster::replace_command(std::size_t i) {
  if (profile_.syntax != LineSyntax::commands) return false;
  const FirmwareCommand command = firmware_command(path_.text(i));
  if (command.effect == CommandEffect::unknown || command.effect == CommandEffect::heat) return false;
  const bool pauses = command.effect == CommandEffect::pause;
  if (replaced_.insert(command.name).second) {
    const std::string lacks =
        fmt::format("the controller does not accept {} ({}); ", command.name, command.what);
    if (pauses)
      diagnostics_.warning(codes::post_left_out, path_.origin_of(i), lacks + "its own pause is written");
    else
      report_skipped(i, lacks + "it");
  }
  if (pauses) put_pause(i);
  return true;
}

}  // namespace kerf::gcode
