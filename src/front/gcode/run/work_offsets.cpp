// Coordinate systems: G54 to G59.3, G10, G52 and G92, homes, scaling and rotation.
//
// The coordinates of the toolpath are those of G54 at the start of the program, whose offset counts as 0.
// What the program sets shifts and rotates its coordinates relative to these. Source: LinuxCNC's pages "G10",
// "G52", "G92"; Mach3's manual for G51 and G68.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/gcode.h"
#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr int kFirstSystem = 5221, kPerSystem = 20, kRotationOfSystem = 9;  // parameters of G54's offsets
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

/// The frame from its components: (program + local shift) rotated, then shifted by the coordinate system.
void Interpreter::update_frame() {
  const double rotation = offsets_.rotation;
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
  frame_.shift = shift + offsets_.in_effect;
}

void Interpreter::use_coordinates() {
  if (program_.dialect == GcodeDialect::fanuc && line_.code(Group::coordinates) == 540 && line_.unused('P'))
    return use_extended_offset("G54", line_.column(Group::coordinates));  // the same as G54.1 P3
  note_zeros();
  zero_location_ = reporter_.location(line_.column(Group::coordinates));
  select_system(system_of(line_.code(Group::coordinates)));
}

/// Offsets that the program has written into parameters take effect where their system is selected; the
/// selection of the present one changes nothing.
void Interpreter::select_system(int system) {
  const auto n = static_cast<std::size_t>(system);
  if (system == modes_.system) {
    if (std::exchange(offsets_.selected, system) != system)
      add(step::WorkZero{.system = system, .zero = offsets_.written[n]});
    return;
  }
  Point3 stored;
  for (int axis = 0; axis < 3; ++axis) stored[axis] = parameters_.slot(first_parameter(system) + axis);
  const bool set_directly = !(stored == offsets_.written[n]);
  const auto before = offsets_.base[static_cast<std::size_t>(modes_.system)];
  if (set_directly) offsets_.base[n].fill(0);
  unsigned lost = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (offsets_.base[n][axis] != before[axis]) lost |= 1u << axis;
  modes_.system = system;
  offsets_.written[n] = stored;
  if (set_directly)
    add(step::WorkZero{.kind = ZeroKind::offset, .system = system, .axes = kAllAxes, .zero = stored});
  add(step::WorkZero{.system = system, .zero = stored, .unknown = lost});
  offsets_.selected = system;
  lose(lost);
  load_offsets();
}

/// Makes the active system's parameters take effect.
void Interpreter::load_offsets() {
  const int first = first_parameter(modes_.system);
  for (int axis = 0; axis < 3; ++axis) offsets_.in_effect[axis] = parameters_.slot(first + axis);
  offsets_.rotation = parameters_.slot(first + kRotationOfSystem);
  update_frame();
}

/// The position, and the homes stored so far, are unknown in the present coordinates.
void Interpreter::lose(unsigned axes) {
  position_.unknown |= axes;
  home_28_.unknown |= axes;
  home_30_.unknown |= axes;
}

/// Called where the zero changes: the motions since the last call belong to the present one. All zeros with
/// motions must have a known distance. Motions in machine coordinates (G53, G28) and probes do not count;
/// of zeros set by touching off, only cuts count.
void Interpreter::note_zeros() {
  const auto& steps = path_.steps();
  const auto first = steps.begin() + static_cast<std::ptrdiff_t>(zero_from_);
  const bool moved =
      std::any_of(first, steps.end(), [](const Step& s) { return s.is_motion() && s.reference_axes() == 0; });
  const bool cut = std::any_of(first, steps.end(), [](const Step& s) { return s.is_cutting(); });
  zero_from_ = steps.size();
  const Zero now{modes_.system, offsets_.base[static_cast<std::size_t>(modes_.system)], offsets_.shift_base};
  bool unrelated = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (moved && moved_in_) {
      const int a = moved_in_->base[axis], b = now.base[axis];
      unrelated = unrelated || (a != b && std::max(a, b) <= WorkOffsets::kSystems);
    }
    if (cut && cut_in_)
      unrelated =
          unrelated || cut_in_->base[axis] != now.base[axis] || cut_in_->shift[axis] != now.shift[axis];
  }
  if (unrelated && !unknown_offset_reported_) report_unknown_zero(moved_in_ ? *moved_in_ : *cut_in_, now);
  if (moved && !moved_in_) moved_in_ = now;
  if (cut && !cut_in_) cut_in_ = now;
}

/// The distance of the zeros is set on the machine, but the toolpath has a single zero.
void Interpreter::report_unknown_zero(const Zero& first, const Zero& now) {
  unknown_offset_reported_ = true;
  if (first.system == now.system) {
    reporter_.unusual_at(zero_location_, codes::offset_unknown,
                         "the work zero changes here by an unknown distance; assuming that it stays",
                         "split the program here");
    return;
  }
  const auto name = [](int system) {
    return system <= 6 ? fmt::format("G{}", 53 + system) : fmt::format("G59.{}", system - 6);
  };
  reporter_.unusual_at(
      zero_location_, codes::offset_unknown,
      fmt::format("the program uses several work offsets, and the distance between {} and {} is unknown; "
                  "an offset that it does not set counts as 0",
                  name(first.system), name(now.system)),
      fmt::format("set both in the program (G10 L2 P{} X... Y... Z... and P{}), or split it by work offset",
                  first.system, now.system));
}

/// G10: L2 and L20 set a coordinate system, L1, L10 and L11 a tool.
void Interpreter::set_data() {
  const double what = line_.take('L').value_or(-1.0);
  const double number = line_.take('P').value_or(-1.0);
  if (what == 0.0) {
    reporter_.note(codes::code_ignored, line_.column(Group::reference),
                   "G10 L0 reloads the tool table of the machine; skipped");
    return;
  }
  const bool whole = number == std::floor(number) && number >= 0.0 && number <= 1e6;
  const bool system = (what == 2.0 || what == 20.0) && whole && number <= WorkOffsets::kSystems;
  const bool tool = (what == 1.0 || what == 10.0 || what == 11.0) && whole;
  if (system) {
    const int n = number == 0.0 ? modes_.system : static_cast<int>(number);
    if (what == 2.0) return set_system(n);
    return touch_off(n);
  }
  if (tool) return set_tool_data(static_cast<int>(number));
  reporter_.error(codes::word_out_of_range, line_.column(Group::reference),
                  "G10 needs L2 or L20 and P0 to P9, or L1, L10 or L11 and a tool number P; skipped");
  line_.use(kAllLetters);
}

/// G10 L2: the offset itself, also in G91.
void Interpreter::set_system(int system) {
  note_zeros();
  const auto n = static_cast<std::size_t>(system);
  const int first = first_parameter(system);
  unsigned axes = 0, lost = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    axes |= 1u << axis;
    if (std::exchange(offsets_.base[n][static_cast<std::size_t>(axis)], 0) != 0) lost |= 1u << axis;
    parameters_.slot(first + axis) = *word * modes_.scale;
    offsets_.written[n][axis] = parameters_.slot(first + axis);
  }
  if (const std::optional<double> rotation = line_.take('R'))
    parameters_.slot(first + kRotationOfSystem) = std::fmod(*rotation, 360.0);
  line_.use(kRotaryLetters);
  if (system != modes_.system) lost = 0;
  if (axes != 0)
    add(step::WorkZero{.kind = ZeroKind::offset,
                       .system = system,
                       .axes = axes,
                       .zero = offsets_.written[n],
                       .unknown = lost});
  lose(lost);
  if (system != modes_.system) return;
  zero_location_ = reporter_.location(line_.column(Group::reference));
  load_offsets();
}

/// G10 L20: the offset with which the current position has the coordinates of the line. Axes of unknown
/// position get these coordinates.
void Interpreter::touch_off(int system) {
  note_zeros();
  const auto n = static_cast<std::size_t>(system);
  const int first = first_parameter(system);
  Point3 offset;
  for (int axis = 0; axis < 3; ++axis) offset[axis] = parameters_.slot(first + axis);
  const double rotation = parameters_.slot(first + kRotationOfSystem);
  Point3 wanted =
      rotated(position_.at - offset, -rotation) - local_shift_;  // coordinates of the current position
  unsigned axes = 0, unknown = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    wanted[axis] = *word * modes_.scale;
    axes |= 1u << axis;
    const bool known = (position_.unknown >> axis & 1u) == 0;
    const auto k = static_cast<std::size_t>(axis);
    offsets_.base[n][k] =
        known ? offsets_.base[static_cast<std::size_t>(modes_.system)][k] : offsets_.next_base++;
    if (!known) unknown |= 1u << axis;
  }
  line_.use(kRotaryLetters | LineWords::bit('R'));
  // Where the position is unknown, the offset stays and the position follows from it.
  const Point3 at = rotated(wanted + local_shift_, rotation) + offset;
  const Point3 moved = position_.at - rotated(wanted + local_shift_, rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned bit = 1u << axis;
    const bool turned = rotation != 0.0 && axis < 2;
    if ((axes & bit) != 0 || turned)
      parameters_.slot(first + axis) = (position_.unknown & bit) == 0 ? moved[axis] : offset[axis];
    offsets_.written[n][axis] = parameters_.slot(first + axis);
  }
  const unsigned located = system == modes_.system ? unknown : 0u;
  lose(unknown);
  for (int axis = 0; axis < 3; ++axis)
    if ((located >> axis & 1u) != 0) position_.at[axis] = at[axis];
  position_.unknown &= ~located;
  if (!reachable(position_.at)) position_.unknown = kAllAxes;
  add_touch_off(system, axes, located, rotated(wanted + local_shift_, rotation) + offsets_.written[n]);
  if (system != modes_.system) return;
  zero_location_ = reporter_.location(line_.column(Group::reference));
  load_offsets();
}

/// The step of G10 L20. In rotated coordinates its words would mean something else.
void Interpreter::add_touch_off(int system, unsigned axes, unsigned located, Point3 at) {
  const auto n = static_cast<std::size_t>(system);
  if (parameters_.slot(first_parameter(system) + kRotationOfSystem) != 0.0) {
    if (located != 0) report_unresolved("the zero of rotated coordinates", line_.column(Group::reference));
    return;
  }
  add(step::WorkZero{.kind = ZeroKind::here,
                     .system = system,
                     .axes = axes,
                     .zero = offsets_.written[n],
                     .at = at,
                     .known = located});
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
  for (int axis = 0; axis < 3; ++axis) {
    const auto word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    if (offsets_.shift_base[static_cast<std::size_t>(axis)] != 0)
      report_unresolved("G52 after a G92 at an unknown position", line_.column(Group::reference));
    local_shift_[axis] = *word * modes_.scale;
  }
  kept_local_shift_ = local_shift_;
  shift_is_on_ = true;
  line_.use(kRotaryLetters);
  update_frame();
}

/// G92: new coordinates for the current position; axes of unknown position get them as their position.
void Interpreter::shift_zero() {
  if (!line_.has_unused(kAxisLetters | kRotaryLetters)) {
    reporter_.error(codes::word_missing, line_.column(Group::reference), "G92 needs the coordinates to set");
    return;
  }
  const Point3 program = frame_.to_program(position_.at);
  ToolPosition now = position_;
  Point3 shift = local_shift_;
  unsigned located = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
    if (!word) continue;
    const double value = *word * modes_.scale;
    const bool known = (position_.unknown & (1u << axis)) == 0;
    shift[axis] = known ? shift[axis] + program[axis] - value : 0.0;
    if (known) continue;
    now.at[axis] = value + offsets_.in_effect[axis];
    located |= 1u << axis;
  }
  now.unknown &= ~located;
  line_.use(kRotaryLetters);
  if (!reachable(now.at) || !reachable(shift)) return;
  if (located != 0) {
    note_zeros();
    zero_location_ = reporter_.location(line_.column(Group::reference));
    lose(located);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((located >> axis & 1u) != 0) offsets_.shift_base[axis] = offsets_.next_base++;
    if (!frame_.only_shifted)
      report_unresolved("the zero of rotated or scaled coordinates", line_.column(Group::reference));
    add(step::WorkZero{.kind = ZeroKind::shift,
                       .system = modes_.system,
                       .axes = located,
                       .zero = offsets_.written[static_cast<std::size_t>(modes_.system)],
                       .at = now.at,
                       .known = located});
  }
  position_ = now;
  local_shift_ = kept_local_shift_ = shift;
  shift_is_on_ = true;
  offsets_.kept_shift = offsets_.unknown_shift();
  update_frame();
}

/// G92.1, G92.2, G92.3: G92 and G52 have stored the shift; only G92.1 clears what is stored. After them the
/// position is unknown on axes whose shift is.
void Interpreter::end_shift(Tenths code) {
  const unsigned unknown = offsets_.unknown_shift() | (code == 923 ? offsets_.kept_shift : 0u);
  shift_is_on_ = code == 923;
  local_shift_ = shift_is_on_ ? kept_local_shift_ : Point3{};
  if (code == 921) kept_local_shift_ = {};
  if (unknown != 0) {
    note_zeros();
    zero_location_ = reporter_.location(line_.column(Group::reference));
    if (code == 921) offsets_.kept_shift = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool kept = code == 923 && (offsets_.kept_shift >> axis & 1u) != 0;
      offsets_.shift_base[axis] = kept ? offsets_.next_base++ : 0;
    }
    add(step::WorkZero{.kind = code == 921   ? ZeroKind::shift_off
                               : code == 922 ? ZeroKind::shift_paused
                                             : ZeroKind::shift_on,
                       .system = modes_.system,
                       .zero = offsets_.written[static_cast<std::size_t>(modes_.system)],
                       .unknown = unknown});
    lose(unknown);
  }
  update_frame();
}

/// G28.1, G30.1: stores the current position.
void Interpreter::set_home(int first, ToolPosition& home) {
  home = position_;
  add(step::StoreHome{first == kHome28 ? Reference::home : Reference::second_home});
  for (int axis = 0; axis < 3; ++axis) parameters_.store(first + axis, position_.at[axis]);
}

/// G51 X10 Y10 P0.5 (Fanuc, Haas): the factor of all axes, or I J K, about a centre; without words of an axis
/// that is its present position. A factor without a decimal point is in thousandths. False after an error.
bool Interpreter::take_scale_about(Point3& factors, Point3& centre) {
  constexpr double kThousandths = 1000.0, kMinInteger = 10.0;
  const bool is_whole = line_.is_integer_text('P');
  const std::optional<double> all = line_.take('P');
  if (!all && !line_.has_unused(LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('K'))) {
    reporter_.error(codes::word_missing, line_.column(Group::scaling),
                    "G51 needs P, the factor of the scale, or I J K, those of the axes");
    return false;
  }
  if (is_whole && std::abs(*all) < kMinInteger) {
    reporter_.error(codes::word_out_of_range, line_.column('P'),
                    "a factor without a decimal point is in thousandths, and this one is too small",
                    "write it with a decimal point");
    return false;
  }
  centre = frame_.to_program(position_.at);
  unsigned unknown = position_.unknown;
  for (int axis = 0; axis < 3; ++axis) {
    const auto own = line_.take(static_cast<char>('I' + axis));
    factors[axis] = all ? (is_whole ? *all / kThousandths : *all) : own.value_or(1.0);
    if (const auto word = line_.take(static_cast<char>('X' + axis))) {
      centre[axis] = *word * modes_.scale;
      unknown &= ~(1u << axis);
    }
    if (factors[axis] == 1.0) unknown &= ~(1u << axis);
  }
  if (unknown == 0) return true;
  reporter_.error(codes::value_unknown, line_.column(Group::scaling),
                  "G51 scales about the present position, which is unknown here",
                  "give the centre with X, Y and Z");
  return false;
}

/// G51 X2 Y2: factors of the axes (Mach3); G50 ends it.
void Interpreter::scale_program() {
  Point3 factors{1.0, 1.0, 1.0}, centre;
  const bool starts = line_.code(Group::scaling) == 510;
  if (starts && program_.dialect == GcodeDialect::fanuc) {
    if (!take_scale_about(factors, centre)) return line_.use(kAllLetters);
  } else if (starts) {
    for (int axis = 0; axis < 3; ++axis)
      factors[axis] = line_.take(static_cast<char>('X' + axis)).value_or(1.0);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::abs(factors[axis]);
    if (size >= kMinScale && size <= kMaxScale) continue;
    reporter_.error(codes::word_out_of_range, line_.column(Group::scaling),
                    "the absolute value of a scale is from 1e-6 to 1e6");
    return;
  }
  frame_.scale = factors;
  frame_.scale_zero = centre;
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
