// The table of G and M codes: the modal group each belongs to, and how far Kerf reads it.
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
  reference,  // not modal: G4, G53, and what uses the line's axis words itself
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
  read,     // has its meaning
  idle,     // known, and of no effect on a milling path: nothing is said
  ignored,  // known, left out with a note
  missing,  // known, would change the path, not read yet: an error
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

/// "G38.2", "M30".
std::string code_text(char letter, Tenths number);

}  // namespace kerf::gcode
