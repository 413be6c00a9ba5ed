// The table of G and M codes: the modal group of each, and how far Kerf supports it.
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
  idle,     // known, without effect on a milling path: skipped silently
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

/// "G38.2", "M30".
std::string code_text(char letter, Tenths number);

}  // namespace kerf::gcode
