// Coordinate systems: G54 to G59.3, G10, and the homes that the program sets.
//
// The coordinates of the toolpath are those of G54 at the start of the program, whose offset counts as 0.
// What the program sets shifts and rotates its coordinates relative to these. Source: LinuxCNC's page "G10".
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/codes/gcode.h"
#include "front/gcode/run/coordinates.h"

namespace kerf::gcode {
namespace {

constexpr int kFirstSystem = 5221, kPerSystem = 20, kRotationOfSystem = 9;  // parameters of G54's offsets
constexpr double kDegree = std::numbers::pi / 180.0;

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
void Coordinates::update_frame() {
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

void Coordinates::use_coordinates() {
  if (is_fanuc(program_.dialect) && line_.code(Group::coordinates) == 540 && line_.unused('P'))
    return use_extended_offset("G54", line_.column(Group::coordinates));  // the same as G54.1 P3
  note_zeros();
  zero_location_ = reporter_.location(line_.column(Group::coordinates));
  select_system(work_offset_of(line_.code(Group::coordinates)));
}

void Coordinates::use_extended_offset(std::string_view selection, std::uint32_t column) {
  std::string code(selection);
  if (const auto number = line_.take('P')) code += fmt::format(" P{:g}", *number);
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

/// G54.1 P3, G154 P3, and G110 to G129 of older Haas controls: an offset of the control that programs do not
/// set. The words of its line stay those of the line's motion.
bool Coordinates::selects_extended_offset() {
  const std::string& code = line_.unknown_g_code();
  if (line_.unknown_g_column() == 0) return false;
  const bool old_haas = code.size() == 4 && (code.starts_with("G11") || code.starts_with("G12"));
  if (!old_haas && code != "G54.1" && code != "G154") return false;
  if (is_fanuc(program_.dialect)) return true;
  reporter_.unusual(codes::unknown_g_code, line_.unknown_g_column(),
                    fmt::format("unknown code {}; skipped", code),
                    "it selects a work offset on Fanuc and Haas: --dialect");
  return false;
}

/// Offsets that the program has written into parameters take effect where their system is selected; the
/// selection of the present one changes nothing.
void Coordinates::select_system(int system) {
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
void Coordinates::load_offsets() {
  const int first = first_parameter(modes_.system);
  for (int axis = 0; axis < 3; ++axis) offsets_.in_effect[axis] = parameters_.slot(first + axis);
  offsets_.rotation = parameters_.slot(first + kRotationOfSystem);
  update_frame();
}

void Coordinates::lose(unsigned axes) {
  position_.unknown |= axes;
  home_28_.unknown |= axes;
  home_30_.unknown |= axes;
}

/// Called where the zero changes: the motions since the last call belong to the present one. All zeros with
/// motions must have a known distance. Motions in machine coordinates (G53, G28) and probes do not count;
/// of zeros set by touching off, only cuts count.
void Coordinates::note_zeros() {
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
void Coordinates::report_unknown_zero(const Zero& first, const Zero& now) {
  unknown_offset_reported_ = true;
  if (first.system == now.system) {
    reporter_.unusual_at(zero_location_, codes::offset_unknown,
                         "the work zero changes here by an unknown distance; assuming that it stays",
                         "split the program here");
    return;
  }
  const auto name = [](int system) { return code_text('G', work_offset_code(system)); };
  reporter_.unusual_at(
      zero_location_, codes::offset_unknown,
      fmt::format("the program uses several work offsets, and the distance between {} and {} is unknown; "
                  "an offset that it does not set counts as 0",
                  name(first.system), name(now.system)),
      fmt::format("set both in the program (G10 L2 P{} X... Y... Z... and P{}), or split it by work offset",
                  first.system, now.system));
}

/// G10: L2 and L20 set a coordinate system, L1, L10 and L11 a tool.
void Coordinates::set_data() {
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
  if (tool) return diameters_.set_data(static_cast<int>(number));
  reporter_.error(codes::word_out_of_range, line_.column(Group::reference),
                  "G10 needs L2 or L20 and P0 to P9, or L1, L10 or L11 and a tool number P; skipped");
  line_.use(kAllLetters);
}

/// G10 L2: the offset itself, also in G91.
void Coordinates::set_system(int system) {
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
void Coordinates::touch_off(int system) {
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
    const bool stays = known || (axis == 2 && std::exchange(modes_.zero_stays, false));
    offsets_.base[n][k] =
        stays ? offsets_.base[static_cast<std::size_t>(modes_.system)][k] : offsets_.next_base++;
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
void Coordinates::add_touch_off(int system, unsigned axes, unsigned located, Point3 at) {
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

/// G28.1, G30.1: stores the current position.
void Coordinates::set_home(Reference home) {
  const int first = home == Reference::home ? kHome28 : kHome30;
  (home == Reference::home ? home_28_ : home_30_) = position_;
  add(step::StoreHome{home});
  for (int axis = 0; axis < 3; ++axis) parameters_.store(first + axis, position_.at[axis]);
}

void Coordinates::return_to_system(int system) {
  zero_location_ = reporter_.location(line_.column());
  select_system(system);
}

void Coordinates::end_program(AfterEnd after) {
  note_zeros();
  if (after == AfterEnd::read_on && offsets_.selected > 1) return_to_system(1);
  modes_.system = 1;
  load_offsets();
}

}  // namespace kerf::gcode
