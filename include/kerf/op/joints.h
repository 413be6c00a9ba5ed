// Joints of boards: slots of finger joints, and corners that a round tool can clear.
//
//   const auto slots = finger_slots({.width = mm(100), .depth = mm(12), .count = 5}, {}, diagnostics);
//   const auto cut = relieve_corners(*slots, {.diameter = mm(6)}, {}, diagnostics);
//
// Frame and units as in region.h. Errors: options out of range (op_option), and those of region.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "kerf/region.h"

namespace kerf {

struct FingerJoint {
  Length width{};  ///< of the boards, > 0
  Length depth{};  ///< of the slots, > 0: the thickness of the other board
  int count = 3;   ///< of fingers and slots together, odd: each is width / count wide
  /// The two boards of a joint are cut with different ends.
  enum class Ends : std::uint8_t { fingers, slots } ends = Ends::fingers;
  Length fit{};       ///< clearance between a finger and each side of its slot; below 0: pressed together
  Length overhang{};  ///< of the slots beyond the edge and the ends of the board: at least the tool's radius
};
/// The slots along the edge of a board. The edge is at y = 0 from x = 0, the board is above it.
std::optional<Region> finger_slots(const FingerJoint& joint, const RegionOptions& options,
                                   Diagnostics& diagnostics);

enum class ReliefStyle : std::uint8_t {
  dog_bone,  ///< along the bisector of the corner: the smallest relief
  t_bone     ///< into the shorter side alone, so that the longer one stays straight
};
/// "dog-bone" or "t-bone", in any case; nothing for other names.
std::optional<ReliefStyle> relief_style_named(std::string_view name);

struct ReliefOptions {
  Length diameter{};  ///< of the tool, > 0
  ReliefStyle style = ReliefStyle::dog_bone;
  /// Only corners inside of it are relieved, for slots that are open at the edge of a board: the board.
  const Region* limits = nullptr;
};
/// A region to be cut out, with room for a round tool in its inner corners between straight sides: a tool of
/// the diameter that clears the result clears the corners of `region`, so that a square part fits into it.
std::optional<Region> relieve_corners(const Region& region, const ReliefOptions& relief,
                                      const RegionOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
