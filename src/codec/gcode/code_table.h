// The table of G and M codes, for readers and posts: the modal group of each, and how far Kerf reads it.
//
// Source: LinuxCNC's pages "G-Codes", "M-Codes" and "Modal groups"; GRBL's list of codes.
#pragma once

#include <cstdint>
#include <string>

namespace kerf::gcode {

/// Codes of one group exclude each other on a line.
enum class Group : std::uint8_t {
  motion,
  plane,
  distance,
  arc_distance,
  feed_mode,
  units,
  compensation,
  tool_length,
  retract,
  coordinates,
  path_control,
  spindle_mode,
  lathe,
  scaling,
  polar,
  rotation,
  dwell,
  machine_coordinates,
  reference,  // not modal: codes that use the line's axis words themselves
  stop,
  tool_change,
  spindle,
  mist,
  flood,
  no_coolant,
  override_switch,
  subroutine,
  saved_modes,
  other,
};
inline constexpr int kGroups = static_cast<int>(Group::other) + 1;

enum class Support : std::uint8_t {
  read,     // supported
  ignored,  // known, skipped with a note
  missing,  // known, would change the path, not supported: an error
};

/// A code's number in tenths: G38.2 is 382.
using Tenths = int;

struct CodeEntry {
  Tenths number;
  Group group;
  Support support;
};

/// Entry of a code, or nullptr for an unknown one.
const CodeEntry* find_g_code(Tenths number);
const CodeEntry* find_m_code(Tenths number);
/// The entry of a G code on Haas' mills.
const CodeEntry* find_haas_g_code(Tenths number);
/// Whether M code `number` is one of Haas' mills that moves neither tool nor work.
bool is_idle_on_haas(Tenths number);

constexpr bool is_arc(Tenths motion) { return motion == 20 || motion == 30; }
constexpr bool is_spline(Tenths motion) { return motion >= 50 && motion <= 53; }
constexpr bool is_circular_pocket(Tenths code) { return code == 120 || code == 130; }
constexpr bool is_macro_call(Tenths code) { return code >= 650 && code <= 670; }
constexpr bool is_hole_pattern(Tenths code) { return code == 700 || code == 710; }  // of Haas
constexpr Tenths kSkip = 310;  // G31 of Mach3, Fanuc and Haas, a probe
/// G38.2 to G38.5.
constexpr bool is_probe(Tenths motion) { return motion >= 382 && motion <= 385; }
constexpr bool is_thread(Tenths motion) { return motion == 330 || motion == 331; }
constexpr bool is_cycle(Tenths motion) {
  return motion == 730 || motion == 740 || (motion >= 810 && motion <= 890);
}
constexpr Tenths kThreadCycle = 760;
constexpr Tenths kNoMotion = 800;  // G80

/// The codes of the work offsets 1 to 9: G54 to G59, G59.1 to G59.3.
constexpr Tenths work_offset_code(int system) { return system <= 6 ? 530 + 10 * system : 584 + system; }
constexpr int work_offset_of(Tenths code) { return code <= 590 ? (code - 530) / 10 : code - 584; }

/// "G38.2", "M30".
std::string code_text(char letter, Tenths number);

}  // namespace kerf::gcode
