// Calls of subroutines, and the modes that are stored and restored at them.
#include "front/gcode/run/calls.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxRepeats = 9999;

}  // namespace

void Calls::follow() {
  if (flow_->depth() == depth_ && &flow_->file_name() == file_name_) return;
  steps_.note_depth(flow_->depth());
  if (&flow_->file_name() != file_name_) {
    file_name_ = &flow_->file_name();
    reporter_.in_file(*file_name_);
    steps_.in_file(*file_name_);
  }
  depth_ = flow_->depth();
  while (saved_modes_.size() > depth_ + 1) {
    const std::optional<SavedModes> kept = saved_modes_.back();
    saved_modes_.pop_back();
    if (kept && kept->automatic) restore_modes(kept->modes);
  }
  saved_modes_.resize(depth_ + 1);
}

void Calls::control(const Block& block) {
  flow_->control(block);
  if (flow_->take_unknown_value()) report_unresolved("the flow of the program", block.o_word->column);
}

/// M98 P100 L2 calls subroutine 100 twice; so does Fanuc's M98 P20100.
bool Calls::subroutine() {
  if (is_macro_call(line_.code(Group::subroutine))) return true;  // macro_call()
  if (line_.code(Group::subroutine) == 990) {
    const std::uint32_t column = line_.column(Group::subroutine);
    const std::optional<double> target = is_fanuc(program_.dialect) ? line_.take('P') : std::nullopt;
    const bool returned = flow_->return_from_call(target.has_value());
    if (target && !program_.ended) flow_->go_to_line(*target, column);
    if (returned || target || program_.ended) return true;
    reporter_.unusual(codes::o_word_unmatched, column,
                      "M99 in the main program repeats it endlessly; read as its end");
    return false;
  }
  const double number = line_.take('P').value_or(-1.0);
  double repeats = line_.take('L').value_or(1.0);
  double label = number;
  if (!line_.has('L') && number > kMaxRepeats) {
    repeats = std::floor(number / (kMaxRepeats + 1.0));
    label = number - repeats * (kMaxRepeats + 1.0);
  }
  const bool whole = number == std::floor(number) && repeats == std::floor(repeats);
  if (!whole || number < 0.0 || number > 1e8 || repeats < 0.0 || repeats > kMaxRepeats) {
    reporter_.error(codes::word_out_of_range, line_.column(Group::subroutine),
                    "M98 needs P, a subroutine number, and a whole L up to 9999");
    return true;
  }
  if (repeats >= 1.0)
    flow_->call_number(static_cast<int>(label), static_cast<int>(repeats), line_.column(Group::subroutine));
  return true;
}

/// G65 P100 A1 B2: calls subroutine 100 with its letters as parameters, as on Fanuc's controls. G66 calls it
/// after each motion, up to G67.
void Calls::macro_call() {
  const Tenths code = line_.code(Group::subroutine);
  if (code == 670) return modal_.reset();
  std::optional<MacroCall> call = read_macro_call();
  if (!call) return;
  call->depth = depth_;
  if (code == 660)
    modal_ = std::move(call);
  else if (call->repeats > 0)
    flow_->call_macro(call->number, call->arguments, call->repeats, line_.column(Group::subroutine));
}

void Calls::modal_macro_call() {
  if (modal_ && modal_->depth == depth_ && modal_->repeats > 0)
    flow_->call_macro(modal_->number, modal_->arguments, modal_->repeats, line_.column());
}

/// The words of G65 and G66. A macro that is not in the program belongs to the machine.
std::optional<Calls::MacroCall> Calls::read_macro_call() {
  const double number = line_.take('P').value_or(-1.0);
  const bool whole = number == std::floor(number) && number >= 0.0 && number <= 1e8;
  const std::uint32_t column = line_.column(Group::subroutine);
  const std::string name = code_text('G', line_.code(Group::subroutine));
  if (!whole || !flow_->has_sub(static_cast<int>(number))) {
    reporter_.unusual(
        codes::unknown_g_code, column,
        fmt::format("{} calls the macro {:g}, which is not in the program; skipped", name, number));
    line_.leave_out(name, column);
    return std::nullopt;
  }
  const double repeats = line_.take('L').value_or(1.0);
  if (repeats != std::floor(repeats) || repeats < 0.0 || repeats > kMaxRepeats) {
    reporter_.error(codes::word_out_of_range, column,
                    fmt::format("L of {} is a whole number up to 9999", name));
    return std::nullopt;
  }
  MacroCall call;
  call.number = static_cast<int>(number);
  call.repeats = static_cast<int>(repeats);
  if (!set_arguments(call)) return std::nullopt;
  return call;
}

/// A is #1, B #2 and so on. I J K that are repeated, or not in the order of the alphabet, continue with the
/// next three variables: I1 J2 K3 I4 K5 are #4, #5, #6, #7 and #9. Of two words for one variable the later
/// one counts. Source: Fanuc, B-63684EN, page 278, "Argument specification I", "II", and their mixture.
bool Calls::set_arguments(MacroCall& call) {
  constexpr std::string_view kLetters = "ABCIJKDEF#H#M###QRSTUVWXYZ";  // of #1, #2 ...; '#': none
  constexpr std::size_t kFirstOfList = 3, kListed = 3, kMaxLists = 10;
  if (!parameters_.has_vacant()) {
    for (std::size_t i = 0; i < kLetters.size(); ++i)
      if (const auto value = kLetters[i] == '#' ? std::nullopt : line_.take(kLetters[i]))
        call.arguments[i] = {*value, (line_.unknown_letters() & LineWords::bit(kLetters[i])) != 0};
    return true;
  }
  call.arguments.fill(ParameterValue::nothing());
  std::size_t list = 0;
  char last = ' ';
  for (const ArgumentWord& word : line_.arguments()) {
    const std::size_t at = kLetters.find(word.letter);
    if (at == std::string_view::npos) continue;
    line_.use(LineWords::bit(word.letter));
    const bool listed = at >= kFirstOfList && at < kFirstOfList + kListed;
    if (listed && word.letter <= last) ++list;
    if (list == kMaxLists) {
      reporter_.error(codes::word_out_of_range, line_.column(word.letter),
                      "a macro has at most ten I, J and K; the line is skipped");
      line_.use(kAllLetters);
      return false;
    }
    if (listed) last = word.letter;
    call.arguments[at + (listed ? list * kListed : 0)] = word.value;
  }
  return true;
}

void Calls::save_modes() {
  std::optional<SavedModes>& kept = saved_modes_.back();
  switch (line_.code(Group::saved_modes)) {
    case 700: kept = SavedModes{modes_, false}; return;
    case 710: kept.reset(); return;
    case 730: kept = SavedModes{modes_, true}; return;
    default: break;
  }
  if (kept) return restore_modes(kept->modes);
  reporter_.error(codes::word_missing, line_.column(Group::saved_modes),
                  "M72 restores the modes that M70 stores; none are stored here");
}

/// Motion, tool and position are not restored.
void Calls::restore_modes(const Modes& kept) {
  const Modes now = modes_;
  coordinates_.note_zeros();
  modes_ = kept;
  modes_.system = now.system;
  modes_.motion = now.motion;
  modes_.tool = now.tool;
  modes_.selected_tool = now.selected_tool;
  if (kept.spindle != now.spindle || kept.speed != now.speed || kept.surface_speed != now.surface_speed)
    spindle_.turn(kept.spindle);
  if (kept.mist != now.mist || kept.flood != now.flood) add(step::Coolant{kept.mist, kept.flood});
  if (kept.system == now.system) return;
  coordinates_.return_to_system(kept.system);
}

}  // namespace kerf::gcode
