// Coordinate systems: G54 to G59.3, G10, G52 and G92, homes, scaling and rotation.
//
// The coordinates of the toolpath are those of G54 at the start of the program, whose offset counts as 0.
// What the program sets shifts and rotates its coordinates relative to these. Source: LinuxCNC's pages "G10",
// "G52", "G92"; Mach3's manual for G51 and G68.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr int kFirstSystem = 5221, kPerSystem = 20, kRotationOfSystem = 9;  // parameters of G54's offsets
constexpr int kSystems = 9;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMinScale = 1e-6, kMaxScale = 1e6;

/// G54 is 1, G59.3 is 9.
int system_of(Tenths code) { return code <= 590 ? (code - 530) / 10 : code - 590 + 6; }

/// Rotated about zero in XY.
Point3 rotated(Point3 p, double angle) {
  if (angle == 0.0) return p;
  const double c = std::cos(angle * kDegree), s = std::sin(angle * kDegree);
  return {p.x * c - p.y * s, p.x * s + p.y * c, p.z};
}

int first_parameter(int system) { return kFirstSystem + kPerSystem * (system - 1); }

}  // namespace

Point3 ProgramFrame::to_path(Point3 p) const {
  for (int i = 0; i < 3; ++i) p[i] = scale_zero[i] + scale[i] * (p[i] - scale_zero[i]);
  return Point3{p.x * cosine - p.y * sine, p.x * sine + p.y * cosine, p.z} + shift;
}

Point3 ProgramFrame::to_program(Point3 p) const {
  p = p - shift;
  p = {p.x * cosine + p.y * sine, p.y * cosine - p.x * sine, p.z};
  for (int i = 0; i < 3; ++i) p[i] = scale_zero[i] + (p[i] - scale_zero[i]) / scale[i];
  return p;
}

double Interpreter::system_offset(int axis) const {
  return parameters_.slot(first_parameter(modes_.system) + axis);
}

/// The frame from its components: (program + local shift) rotated, then shifted by the coordinate system.
void Interpreter::update_frame() {
  const double rotation = parameters_.slot(first_parameter(modes_.system) + kRotationOfSystem);
  frame_.rotation = rotation + program_rotation_;
  frame_.cosine = std::cos(frame_.rotation * kDegree);
  frame_.sine = std::sin(frame_.rotation * kDegree);
  frame_.only_shifted = frame_.rotation == 0.0 && frame_.scale == Point3{1.0, 1.0, 1.0};
  Point3 shift = local_shift_;
  if (!frame_.only_shifted) {
    const double c = frame_.cosine, s = frame_.sine;
    const Point3 about = program_rotation_centre_;
    const double tc = std::cos(rotation * kDegree), ts = std::sin(rotation * kDegree);
    shift = {shift.x * tc - shift.y * ts, shift.x * ts + shift.y * tc, shift.z};
    // G68 rotates about a point, which is fixed
    shift = shift + Point3{about.x * tc - about.y * ts - (about.x * c - about.y * s),
                           about.x * ts + about.y * tc - (about.x * s + about.y * c), 0.0};
  }
  for (int axis = 0; axis < 3; ++axis) frame_.shift[axis] = shift[axis] + system_offset(axis);
}

void Interpreter::use_coordinates() {
  check_system_offsets();
  modes_.system = system_of(line_.code(Group::coordinates));
  system_location_ = reporter_.location(line_.column(Group::coordinates));
  update_frame();
}

/// Called where a coordinate system is left: if the program has motions in more than one of them, all their
/// offsets must be known. Motions in machine coordinates (G53, G28) do not count.
void Interpreter::check_system_offsets() {
  const auto& steps = path_.steps();
  const bool used = std::any_of(steps.begin() + static_cast<std::ptrdiff_t>(system_from_), steps.end(),
                                [](const Step& s) { return s.is_motion() && s.reference_axes() == 0; });
  system_from_ = steps.size();
  if (!used) return;
  systems_used_ |= 1u << modes_.system;
  const bool several = (systems_used_ & (systems_used_ - 1)) != 0;
  for (int system = 2; several && !unknown_offset_reported_ && system <= kSystems; ++system)
    if ((systems_used_ & (1u << system)) != 0) report_unknown_offset(system);
}

/// Reports an offset that is set neither by G10 nor by a parameter. The machine stores it, but the toolpath
/// has a single work zero.
void Interpreter::report_unknown_offset(int system) {
  bool known = (systems_set_ & (1u << system)) != 0;
  for (int i = 0; i <= kRotationOfSystem; ++i)
    known = known || parameters_.slot(first_parameter(system) + i) != 0.0;
  if (known) return;
  unknown_offset_reported_ = true;
  const std::string name = system <= 6 ? fmt::format("G{}", 53 + system) : fmt::format("G59.{}", system - 6);
  reporter_.unusual_at(
      system_location_, Code::offset_unknown,
      fmt::format("the program uses several work offsets, and that of {} is unknown; assuming that of G54",
                  name),
      fmt::format("set it in the program, e.g. G10 L2 P{} X100 Y0 Z0, or split the program by work offset",
                  system));
}

/// G10: L2 and L20 set a coordinate system, L1, L10 and L11 a tool.
void Interpreter::set_data() {
  const double what = line_.take('L').value_or(-1.0);
  const double number = line_.take('P').value_or(-1.0);
  if (what == 0.0) {
    reporter_.note(Code::code_ignored, line_.column(Group::reference),
                   "G10 L0 reloads the tool table of the machine; skipped");
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
  reporter_.error(Code::word_out_of_range, line_.column(Group::reference),
                  "G10 needs L2 or L20 and P0 to P9, or L1, L10 or L11 and a tool number P; skipped");
  line_.use(kAllLetters);
}

/// G10 L2: the offset itself, also in G91.
void Interpreter::set_system(int system) {
  systems_set_ |= 1u << system;
  const int first = first_parameter(system);
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    parameters_.slot(first + axis) = *word * modes_.scale;
  }
  if (const std::optional<double> rotation = line_.take('R'))
    parameters_.slot(first + kRotationOfSystem) = std::fmod(*rotation, 360.0);
  line_.use(kRotaryLetters);
  update_frame();
}

/// G10 L20: the offset with which the current position has the coordinates of the line. Axes of unknown
/// position get these coordinates.
void Interpreter::touch_off(int system) {
  systems_set_ |= 1u << system;
  const int first = first_parameter(system);
  Point3 offset;
  for (int axis = 0; axis < 3; ++axis) offset[axis] = parameters_.slot(first + axis);
  const double rotation = parameters_.slot(first + kRotationOfSystem);
  Point3 wanted =
      rotated(position_.at - offset, -rotation) - local_shift_;  // coordinates of the current position
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    const unsigned bit = 1u << axis;
    if ((position_.unknown & bit) == 0) {
      wanted[axis] = value;
    } else if (system == modes_.system) {
      position_.at[axis] = value + frame_.shift[axis];
      position_.unknown &= ~bit;
    }
  }
  offset = position_.at - rotated(wanted + local_shift_, rotation);
  for (int axis = 0; axis < 3; ++axis)
    if ((position_.unknown & (1u << axis)) == 0) parameters_.slot(first + axis) = offset[axis];
  line_.use(kRotaryLetters | LineWords::bit('R'));
  reachable(position_.at);
  update_frame();
}

/// Only the diameter of a tool is used; its length is compensated by the machine.
void Interpreter::set_tool_data(int tool) {
  if (const std::optional<double> radius = line_.take('R'))
    tool_diameters_[tool] = 2.0 * *radius * modes_.scale;
  line_.use(kAxisLetters | kRotaryLetters | LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('Q'));
}

/// From G10, else from the user, else from the program's comments.
std::optional<double> Interpreter::diameter_of(int tool) const {
  if (const auto set = tool_diameters_.find(tool); set != tool_diameters_.end()) return set->second;
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
  update_frame();
}

/// G92: new coordinates for the current position; axes of unknown position get them as their position.
void Interpreter::shift_zero() {
  if (!line_.has_unused(kAxisLetters | kRotaryLetters)) {
    reporter_.error(Code::word_missing, line_.column(Group::reference), "G92 needs the coordinates to set");
    return;
  }
  const Point3 program = frame_.to_program(position_.at);
  ToolPosition now = position_;
  Point3 shift = local_shift_;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    const bool known = (position_.unknown & (1u << axis)) == 0;
    shift[axis] = known ? shift[axis] + program[axis] - value : 0.0;
    if (!known) now.at[axis] = value + system_offset(axis);
    now.unknown &= ~(1u << axis);
  }
  line_.use(kRotaryLetters);
  if (!reachable(now.at) || !reachable(shift)) return;
  position_ = now;
  local_shift_ = kept_local_shift_ = shift;
  update_frame();
}

/// G28.1, G30.1: stores the current position.
void Interpreter::set_home(int first, ToolPosition& home) {
  home = position_;
  add(step::StoreHome{first == kHome28 ? Reference::home : Reference::second_home});
  for (int axis = 0; axis < 3; ++axis) parameters_.slot(first + axis) = position_.at[axis];
}

/// G51 X2 Y2: factors of the axes (Mach3); G50 ends it.
void Interpreter::scale_program() {
  Point3 factors{1.0, 1.0, 1.0};
  if (line_.code(Group::scaling) == 510)
    for (int axis = 0; axis < 3; ++axis)
      factors[axis] = line_.take(static_cast<char>('X' + axis)).value_or(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::abs(factors[axis]);
    if (size >= kMinScale && size <= kMaxScale) continue;
    reporter_.error(Code::word_out_of_range, line_.column(Group::scaling),
                    "the absolute value of a scale is from 1e-6 to 1e6");
    return;
  }
  frame_.scale = factors;
  update_frame();
}

/// G68 A B R (Mach3; Fanuc: X Y R): rotates the coordinates about a point; G69 ends it.
void Interpreter::rotate_program() {
  program_rotation_ = 0.0;
  program_rotation_centre_ = {};
  if (line_.code(Group::rotation) == 680) {
    const auto word = [this](char a, char b) {
      const std::optional<double> first = line_.take(a);
      return first ? first : line_.take(b);
    };
    program_rotation_centre_ = {word('A', 'X').value_or(0.0) * modes_.scale,
                                word('B', 'Y').value_or(0.0) * modes_.scale, 0.0};
    program_rotation_ = std::fmod(line_.take('R').value_or(0.0), 360.0);
    if (!reachable(program_rotation_centre_)) program_rotation_ = 0.0;
  }
  update_frame();
}

}  // namespace kerf::gcode
