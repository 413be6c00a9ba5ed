// Loose lines and arcs joined end to end, as drawings have them, into outlines.
//
//   const Chained chained = chain(pieces, {.join = mm(0.01)});
//   // chained.outlines; chained.open_ends and chained.junctions are where a drawing needs corrections
//
// Frame as in outline.h: mm, y up. No position, order or direction is guessed: where more than two ends meet,
// none of them is joined.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/outline.h"

namespace kerf {

struct ChainOptions {
  /// Ends that are not farther apart than this are joined. Ends within `tolerance.weld` are one point; all
  /// others are joined only where exactly two are this close.
  Length join = mm(0.01);
  Tolerance tolerance{};
  /// Of open ends with pieces, in search of T-junctions; ends beyond that are reported as open.
  std::size_t max_comparisons = 5'000'000;
};

/// A piece of the input as part of an outline.
struct ChainPart {
  std::uint32_t piece = 0;  ///< index of the input
  bool reversed = false;
};

struct ChainedOutline {
  Outline outline;  ///< in the direction of its first piece; closed where its ends meet
  std::vector<ChainPart> parts;
};

/// An end that nothing is joined to.
struct OpenEnd {
  Point2 at;                        // mm
  std::uint32_t piece = 0;          ///< whose end it is
  std::optional<Point2> nearest;    ///< the nearest other open end
  std::uint32_t nearest_piece = 0;  ///< whose end that is
  Length distance;                  ///< from there
};

/// More than two ends in one position, or an end on another piece: a T-junction.
struct Junction {
  Point2 at;                          // mm
  std::vector<std::uint32_t> pieces;  ///< at most kNamedPieces of those that meet there
  std::size_t count = 0;              ///< how many ends and touched pieces there are
  static constexpr std::size_t kNamedPieces = 8;
};

/// A piece that lies on an earlier one and is ignored: a single segment, or the first piece of a closed
/// outline.
struct RepeatedPiece {
  std::uint32_t piece = 0, earlier = 0;
};

struct Chained {
  std::vector<ChainedOutline> outlines;  ///< in the order of their first pieces
  std::vector<OpenEnd> open_ends;
  std::vector<Junction> junctions;
  std::vector<RepeatedPiece> repeated;
  std::size_t empty_pieces = 0;  ///< pieces without a length, which are ignored
};

/// Joins open pieces. Closed pieces, and those whose ends are within `join` of each other, become outlines of
/// their own. Coordinates must be finite. Time n log n for n segments.
Chained chain(const std::vector<Outline>& pieces, const ChainOptions& options);

}  // namespace kerf
