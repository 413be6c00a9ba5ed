// Coordinate systems: G54 to G59.3, G10, G52 and G92, homes, scaling and rotation.
//
// The toolpath's coordinates are those of G54 as it is when the program begins; its offset counts as 0. What
// the program sets from then on moves and turns its coordinates in these.
// Source: LinuxCNC's pages "G10", "G52", "G92"; Mach3's manual for G51 and G68.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr int kFirstSystem = 5221, kPerSystem = 20, kTurnOfSystem = 9;  // parameters of G54's offsets
constexpr int kSystems = 9;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLeastScale = 1e-6, kMostScale = 1e6;

/// G54 is 1, G59.3 is 9.
int system_of(Tenths code) { return code <= 590 ? (code - 530) / 10 : code - 590 + 6; }

/// Turned about zero in XY.
Point3 turned(Point3 p, double angle) {
  if (angle == 0.0) return p;
  const double c = std::cos(angle * kDegree), s = std::sin(angle * kDegree);
  return {p.x * c - p.y * s, p.x * s + p.y * c, p.z};
}

int first_parameter(int system) { return kFirstSystem + kPerSystem * (system - 1); }

}  // namespace

Point3 Placement::to_path(Point3 p) const {
  for (int i = 0; i < 3; ++i) p[i] = scale_zero[i] + scale[i] * (p[i] - scale_zero[i]);
  return Point3{p.x * cosine - p.y * sine, p.x * sine + p.y * cosine, p.z} + shift;
}

Point3 Placement::to_program(Point3 p) const {
  p = p - shift;
  p = {p.x * cosine + p.y * sine, p.y * cosine - p.x * sine, p.z};
  for (int i = 0; i < 3; ++i) p[i] = scale_zero[i] + (p[i] - scale_zero[i]) / scale[i];
  return p;
}

double Interpreter::system_offset(int axis) const {
  return parameters_.slot(first_parameter(modes_.system) + axis);
}

/// Works out the placement from all that takes part: (program + local shift) turned, and then shifted by the
/// coordinate system.
void Interpreter::refresh_placement() {
  const double turn = parameters_.slot(first_parameter(modes_.system) + kTurnOfSystem);
  placement_.turn = turn + program_turn_;
  placement_.cosine = std::cos(placement_.turn * kDegree);
  placement_.sine = std::sin(placement_.turn * kDegree);
  placement_.plain = placement_.turn == 0.0 && placement_.scale == Point3{1.0, 1.0, 1.0};
  Point3 shift = local_shift_;
  if (!placement_.plain) {
    const double c = placement_.cosine, s = placement_.sine;
    const Point3 about = program_turn_about_;
    const double tc = std::cos(turn * kDegree), ts = std::sin(turn * kDegree);
    shift = {shift.x * tc - shift.y * ts, shift.x * ts + shift.y * tc, shift.z};
    // G68 turns about its own point, which stays where it was
    shift = shift + Point3{about.x * tc - about.y * ts - (about.x * c - about.y * s),
                           about.x * ts + about.y * tc - (about.x * s + about.y * c), 0.0};
  }
  for (int axis = 0; axis < 3; ++axis) placement_.shift[axis] = shift[axis] + system_offset(axis);
}

void Interpreter::use_coordinates() {
  leave_system();
  modes_.system = system_of(line_.code(Group::coordinates));
  system_spot_ = talker_.spot(line_.column(Group::coordinates));
  refresh_placement();
}

/// Looks whether the program has moved in the coordinate system that it leaves. Where it did so in another
/// one too, both offsets must be known; machine coordinates (G53, G28) need none.
void Interpreter::leave_system() {
  const auto& steps = path_.steps();
  const bool used = std::any_of(steps.begin() + static_cast<std::ptrdiff_t>(system_from_), steps.end(),
                                [](const Step& s) { return s.is_motion() && s.reference_axes() == 0; });
  system_from_ = steps.size();
  if (!used) return;
  systems_used_ |= 1u << modes_.system;
  const bool several = (systems_used_ & (systems_used_ - 1)) != 0;
  for (int system = 2; several && !offset_said_ && system <= kSystems; ++system)
    if ((systems_used_ & (1u << system)) != 0) tell_unknown_offset(system);
}

/// Unless G10 or a parameter told it. Offsets are the machine's matter, but the toolpath has one zero.
void Interpreter::tell_unknown_offset(int system) {
  bool told = (systems_set_ & (1u << system)) != 0;
  for (int i = 0; i <= kTurnOfSystem; ++i)
    told = told || parameters_.slot(first_parameter(system) + i) != 0.0;
  if (told) return;
  offset_said_ = true;
  const std::string name = system <= 6 ? fmt::format("G{}", 53 + system) : fmt::format("G59.{}", system - 6);
  talker_.unusual_at(
      system_spot_, Code::offset_unknown,
      fmt::format("the program moves in several work offsets, and does not say how far that of {} lies from "
                  "G54's; it is taken as the same",
                  name),
      fmt::format("tell it, e.g. G10 L2 P{} X100 Y0 Z0, or look at each part by itself", system));
}

/// G10: L2 and L20 set a coordinate system, L1, L10 and L11 a tool.
void Interpreter::set_data() {
  const double what = line_.take('L').value_or(-1.0);
  const double number = line_.take('P').value_or(-1.0);
  if (what == 0.0) {
    talker_.note(Code::code_ignored, line_.column(Group::reference),
                 "G10 L0 reloads the tool table, which is the machine's; it is left out");
    return;
  }
  const bool whole = number == std::floor(number) && number >= 0.0 && number <= 1e6;
  const bool system = (what == 2.0 || what == 20.0) && whole && number <= kSystems;
  const bool tool = (what == 1.0 || what == 10.0 || what == 11.0) && whole;
  if (system) {
    const int n = number == 0.0 ? modes_.system : static_cast<int>(number);
    if (what == 2.0) return set_system(n);
    return touch_off(n);
  }
  if (tool) return set_tool_data(static_cast<int>(number));
  talker_.error(Code::word_out_of_range, line_.column(Group::reference),
                "G10 needs L2 or L20 and P0 to P9, or L1, L10 or L11 and a tool's P; it is left out");
  line_.use(kAllLetters);
}

/// G10 L2: the offset itself, whatever the distance mode.
void Interpreter::set_system(int system) {
  systems_set_ |= 1u << system;
  const int first = first_parameter(system);
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    parameters_.slot(first + axis) = *word * modes_.scale;
  }
  if (const std::optional<double> turn = line_.take('R'))
    parameters_.slot(first + kTurnOfSystem) = std::fmod(*turn, 360.0);
  line_.use(kRotaryLetters);
  refresh_placement();
}

/// G10 L20: the offset that gives the place where the tool stands the coordinates of the line. Where the
/// place was not known, it has them from now on.
void Interpreter::touch_off(int system) {
  systems_set_ |= 1u << system;
  const int first = first_parameter(system);
  Point3 offset;
  for (int axis = 0; axis < 3; ++axis) offset[axis] = parameters_.slot(first + axis);
  const double turn = parameters_.slot(first + kTurnOfSystem);
  Point3 wanted = turned(here_.at - offset, -turn) - local_shift_;  // what it has now
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    const unsigned bit = 1u << axis;
    if ((here_.unknown & bit) == 0) {
      wanted[axis] = value;
    } else if (system == modes_.system) {
      here_.at[axis] = value + placement_.shift[axis];
      here_.unknown &= ~bit;
    }
  }
  offset = here_.at - turned(wanted + local_shift_, turn);
  for (int axis = 0; axis < 3; ++axis)
    if ((here_.unknown & (1u << axis)) == 0) parameters_.slot(first + axis) = offset[axis];
  line_.use(kRotaryLetters | Line::bit('R'));
  reachable(here_.at);
  refresh_placement();
}

/// Only a tool's diameter counts here; its length is the machine's matter.
void Interpreter::set_tool_data(int tool) {
  if (const std::optional<double> radius = line_.take('R'))
    tool_diameters_[tool] = 2.0 * *radius * modes_.scale;
  line_.use(kAxisLetters | kRotaryLetters | Line::bit('I') | Line::bit('J') | Line::bit('Q'));
}

/// What G10 says, then the user, then the program's remarks.
std::optional<double> Interpreter::diameter_of(int tool) const {
  if (const auto told = tool_diameters_.find(tool); told != tool_diameters_.end()) return told->second;
  const auto found = program_.tools.find(tool);
  const Tool* described = found == program_.tools.end() ? nullptr : &found->second;
  if (options_.tool_diameter) return options_.tool_diameter(tool, described);
  if (described == nullptr) return std::nullopt;
  return described->diameter.mm();
}

/// G52: the shift itself.
void Interpreter::shift_locally() {
  for (int axis = 0; axis < 3; ++axis)
    if (const auto word = line_.take(static_cast<char>('X' + axis)))
      local_shift_[axis] = *word * modes_.scale;
  kept_local_shift_ = local_shift_;
  line_.use(kRotaryLetters);
  refresh_placement();
}

/// G92: the place where the tool stands gets new coordinates. Where the place was not known, they are simply
/// its coordinates from now on.
void Interpreter::shift_zero() {
  if (!line_.has_unused(kAxisLetters | kRotaryLetters)) {
    talker_.error(Code::word_missing, line_.column(Group::reference), "G92 needs the coordinates to set");
    return;
  }
  const Point3 program = placement_.to_program(here_.at);
  Place now = here_;
  Point3 shift = local_shift_;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    const bool known = (here_.unknown & (1u << axis)) == 0;
    shift[axis] = known ? shift[axis] + program[axis] - value : 0.0;
    if (!known) now.at[axis] = value + system_offset(axis);
    now.unknown &= ~(1u << axis);
  }
  line_.use(kRotaryLetters);
  if (!reachable(now.at) || !reachable(shift)) return;
  here_ = now;
  local_shift_ = kept_local_shift_ = shift;
  refresh_placement();
}

/// G28.1, G30.1: the place where the tool stands.
void Interpreter::set_home(int first, Place& home) {
  home = here_;
  add(step::StoreHome{first == kHome28 ? Reference::home : Reference::second_home});
  for (int axis = 0; axis < 3; ++axis) parameters_.slot(first + axis) = here_.at[axis];
}

/// G51 X2 Y2: factors of the axes (Mach3); G50 ends it.
void Interpreter::scale_program() {
  Point3 factors{1.0, 1.0, 1.0};
  if (line_.code(Group::scaling) == 510)
    for (int axis = 0; axis < 3; ++axis)
      factors[axis] = line_.take(static_cast<char>('X' + axis)).value_or(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::abs(factors[axis]);
    if (size >= kLeastScale && size <= kMostScale) continue;
    talker_.error(Code::word_out_of_range, line_.column(Group::scaling), "a scale that makes no sense");
    return;
  }
  placement_.scale = factors;
  refresh_placement();
}

/// G68 A B R (Mach3; Fanuc: X Y R): all that follows is turned about a point; G69 ends it.
void Interpreter::turn_program() {
  program_turn_ = 0.0;
  program_turn_about_ = {};
  if (line_.code(Group::rotation) == 680) {
    const auto word = [this](char a, char b) {
      const std::optional<double> first = line_.take(a);
      return first ? first : line_.take(b);
    };
    program_turn_about_ = {word('A', 'X').value_or(0.0) * modes_.scale,
                           word('B', 'Y').value_or(0.0) * modes_.scale, 0.0};
    program_turn_ = std::fmod(line_.take('R').value_or(0.0), 360.0);
    if (!reachable(program_turn_about_)) program_turn_ = 0.0;
  }
  refresh_placement();
}

}  // namespace kerf::gcode
