// G52, G92, G51 and G68: the program shifts, scales and rotates its coordinates.
//
// Source: LinuxCNC's pages "G52", "G92"; Mach3's manual for G51 and G68.
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"
#include "front/gcode/run/coordinates.h"

namespace kerf::gcode {
namespace {

constexpr double kMinScale = 1e-6, kMaxScale = 1e6;

}  // namespace

/// G52: the shift itself.
void Coordinates::shift_locally() {
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
void Coordinates::shift_zero() {
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
void Coordinates::end_shift(Tenths code) {
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

/// G51 X10 Y10 P0.5 (Fanuc, Haas): the factor of all axes, or I J K, about a centre; without words of an axis
/// that is its present position. A factor without a decimal point is in thousandths. False after an error.
bool Coordinates::take_scale_about(Point3& factors, Point3& centre) {
  constexpr double kThousandths = 1000.0, kMinInteger = 10.0;
  bool is_readable = true;
  const auto factor = [&](char letter) {
    const bool is_whole = line_.is_integer_text(letter);
    const std::optional<double> value = line_.take(letter);
    if (!value || !is_whole) return value;
    if (is_readable && std::abs(*value) < kMinInteger)
      reporter_.error(codes::word_out_of_range, line_.column(letter),
                      "a factor without a decimal point is in thousandths, and this one is too small",
                      "write it with a decimal point");
    is_readable = is_readable && std::abs(*value) >= kMinInteger;
    return std::optional(*value / kThousandths);
  };
  const std::optional<double> all = factor('P');
  if (!all && !line_.has_unused(LineWords::bit('I') | LineWords::bit('J') | LineWords::bit('K'))) {
    reporter_.error(codes::word_missing, line_.column(Group::scaling),
                    "G51 needs P, the factor of the scale, or I J K, those of the axes");
    return false;
  }
  centre = frame_.to_program(position_.at);
  unsigned unknown = position_.unknown;
  for (int axis = 0; axis < 3; ++axis) {
    const auto own = factor(static_cast<char>('I' + axis));
    factors[axis] = all ? *all : own.value_or(1.0);
    if (const auto word = line_.take(static_cast<char>('X' + axis))) {
      centre[axis] = *word * modes_.scale;
      unknown &= ~(1u << axis);
    }
    if (factors[axis] == 1.0) unknown &= ~(1u << axis);
  }
  if (unknown == 0 || !is_readable) return is_readable;
  reporter_.error(codes::value_unknown, line_.column(Group::scaling),
                  "G51 scales about the present position, which is unknown here",
                  "give the centre with X, Y and Z");
  return false;
}

/// G51 X2 Y2: factors of the axes (Mach3); G50 ends it.
void Coordinates::scale_program() {
  Point3 factors{1.0, 1.0, 1.0}, centre;
  const bool starts = line_.code(Group::scaling) == 510;
  if (starts && is_fanuc(program_.dialect)) {
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

/// G68 A B R (Mach3; Fanuc, Haas: X Y R): rotates the coordinates about a point; G69 ends it. Without X and Y
/// that is the present position on Fanuc's and Haas' controls, the zero on Mach3. Source: Fanuc, B-63194EN,
/// "Coordinate system rotation".
void Coordinates::rotate_program() {
  program_rotation_ = 0.0;
  program_rotation_centre_ = {};
  if (line_.code(Group::rotation) == 680) {
    update_frame();
    const bool here = is_fanuc(program_.dialect);
    const unsigned stated = (line_.unused('X') ? 1u : 0u) | (line_.unused('Y') ? 2u : 0u);
    if (here && (position_.unknown & 3u & ~stated) != 0) {
      reporter_.error(codes::value_unknown, line_.column(Group::rotation),
                      "G68 rotates about the present position, which is unknown here",
                      "give the centre with X and Y");
      return line_.use(kAllLetters);
    }
    const Point3 centre = here ? frame_.to_program(position_.at) : Point3{};
    const auto word = [this](char a, char b) {
      const std::optional<double> first = line_.take(a);
      return first ? first : line_.take(b);
    };
    const auto x = word('A', 'X'), y = word('B', 'Y');
    program_rotation_centre_ = {x ? *x * modes_.scale : centre.x, y ? *y * modes_.scale : centre.y, 0.0};
    program_rotation_ = std::fmod(line_.take('R').value_or(0.0), 360.0);
    if (!reachable(program_rotation_centre_)) program_rotation_ = 0.0;
  }
  update_frame();
}

}  // namespace kerf::gcode
