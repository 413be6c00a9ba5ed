// Outlines of lines and arcs in the plane, and what a router bit can make of their corners.
//
// A router bit of radius r cannot cut a sharp inner corner. A list beside the outline therefore has a request
// for each corner:
//   0         leave it as it is
//   r > 0     smooth it: one arc of radius r, tangent to both neighbours
//   r < 0     enlarge it: clear the corner with a bit of radius |r|. Its centre is on the line from the
//   corner
//             to the centre of the arc that would smooth it, and its circle passes through the corner; in a
//             corner narrower than the bit, a channel as wide as the bit leads there.
// A corner is changed by its two segments alone.
//
// Frame: x to the right, y up, mm, counter-clockwise is positive. No function changes its argument. User
// errors go to Diagnostics (codes 7xxx); a corner that cannot be cut is a warning and stays sharp.
//
//   const Outline plate = rectangle({0, 0}, {40, 20});  // shapes.h
//   Diagnostics diagnostics;
//   const auto cut = cut_corners(plate, {Length(), mm(3), mm(-3)}, {.name = "plate"}, diagnostics);
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"

namespace kerf {

/// A line or an arc, from the end of the segment before (or the outline's start) to `to`.
struct Segment {
  Point2 to;                    // mm
  std::optional<Point2> via{};  // an arc passes through this point, anywhere between its ends; none: a line
  bool operator==(const Segment&) const = default;
};

/// A chain of segments. It is closed if its last end is exactly its start.
struct Outline {
  Point2 start;  // mm
  std::vector<Segment> segments{};

  bool closed() const { return !segments.empty() && segments.back().to == start; }
  /// Ends of segments by element number: 0 is the start, i the end of segment i - 1.
  Point2 point(std::size_t element) const { return element == 0 ? start : segments[element - 1].to; }
  std::size_t elements() const { return segments.size() + 1; }
  bool operator==(const Outline&) const = default;
};

/// The circle as a closed outline of two half circles, counter-clockwise from its right.
Outline as_outline(const Circle& circle);

/// The outlines of one part: the first is its outside, the others are holes.
using Figure = std::vector<std::variant<Outline, Circle>>;

/// The circle of an arc segment, and its sweep.
struct ArcCircle {
  Point2 centre;  // mm
  double radius = 0.0;
  Turn turn = Turn::ccw;
  Angle sweep;  // above 0, below a full turn
};
/// Nothing for a line, and for an arc so flat that it is one (its chords turn by less than 1e-6 rad).
std::optional<ArcCircle> arc_circle(Point2 from, const Segment& segment);

// ------------------------------------------------------------------------------------------------- corners

/// The distribution of an edge that is too short for the requests of both of its corners.
enum class EdgeSharing : std::uint8_t {
  in_order,  ///< the corner of the smaller element number, and element 0 before all: as Cnc25D does
  even  ///< half of the edge is each corner's own; beyond it only what the other leaves. Independent of the
        ///< start
};

/// Requests for the corners of an outline by element: 0 is its start, i the end of segment i - 1. Those
/// beyond the list are 0. The corner where a closed outline meets its start is element 0.
using CornerRequests = std::vector<Length>;

struct CornerOptions {
  Tolerance tolerance{};  ///< weld: points closer than this are one; a fit that misses by less is a fit
  /// Corners that turn by less are smooth; corners of two lines or two arcs that turn by more than half a
  /// turn less this are folds. Neither is changed.
  Angle straight = radians(std::numbers::pi / 1000.0);
  EdgeSharing sharing = EdgeSharing::in_order;
  std::string name{};  ///< a corner is called NAME.ELEMENT in messages
  Origin where{};      ///< of the messages
};

enum class CornerOutcome : std::uint8_t { smoothed, enlarged, sharp };
/// Why a corner with a request stays sharp.
enum class SharpReason : std::uint8_t {
  none,
  straight,       ///< the neighbours are tangent: there is no corner
  folded,         ///< the outline turns back on itself: no arc of any size touches both neighbours
  short_segment,  ///< a neighbour is too short, or taken already by the corner at its other end
  no_circle,      ///< no circle of this radius touches both neighbours
  no_neighbour,   ///< a neighbour has no length
  tiny,           ///< the radius is below the weld tolerance
  shared          ///< EdgeSharing::even: the corner at the other end needs the edge, too
};
std::string_view to_string(CornerOutcome outcome);
std::string_view to_string(SharpReason reason);

/// The result for one corner that had a request.
struct CornerReport {
  std::uint32_t element = 0;  ///< of the input
  CornerOutcome outcome = CornerOutcome::sharp;
  SharpReason reason = SharpReason::none;
  std::uint32_t first = 0;  ///< first element of the replacement in the result
  std::uint32_t count = 0;  ///< elements of the result that it consists of; 0 if sharp
  /// Where it stays sharp because the radius is too large or the edge is shared: the largest radius that can
  /// be cut here (0: none), given what the corners before it use; shared evenly: what the others request. A
  /// lower bound within 1e-6 of the request. 0 for corners that were cut.
  Length largest;
};

struct CutOutline {
  Outline outline;                    ///< the `via` of arcs is their midpoint
  std::vector<CornerReport> corners;  ///< one for each corner with a request, in order of elements
};

/// Replaces the corners of an outline as requested: corner 0 of a closed outline first, then by element; each
/// corner has what the one before left of the shared segment. A closed result starts with the replacement of
/// corner 0. Segments without length are left out. Nothing, with errors appended, for
/// an outline without a segment, a closed one of a single segment, numbers that are not finite or beyond
/// 1e60, and arcs that end at their start. Requests at the ends of an open outline (for a closed one: of its
/// last element) are ignored with a warning.
std::optional<CutOutline> cut_corners(const Outline& outline, const CornerRequests& requests,
                                      const CornerOptions& options, Diagnostics& diagnostics);

/// The text of a report: "corner plate.2 stays sharp: ...". `request` is the corner's.
std::string corner_message(const CornerReport& report, Length request, std::string_view name);

// -------------------------------------------------------------------------------------------------- curves

/// A sample of a curve with its direction of travel.
struct CurvePoint {
  Point2 at;      // mm
  Angle heading;  // from +x, counter-clockwise
  bool operator==(const CurvePoint&) const = default;
};
using Curve = std::vector<CurvePoint>;

struct CurveOptions {
  Tolerance tolerance{};
  /// A piece whose end tangents differ by less than this from its chord becomes a line.
  Angle straight = radians(std::numbers::pi / 1000.0);
  Length min_radius{};  ///< arcs of a smaller radius get a warning; 0: none does
  std::string name{};   ///< piece k is called NAME.k in messages
  Origin where{};
};

/// A chain of arcs through all samples with the samples' headings: two arcs per piece, which meet in the
/// incentre of the triangle of chord and tangents. Pieces with an inflexion and straight pieces become lines,
/// with a warning. Nothing, with errors appended, for fewer than two samples, for equal neighbours, for
/// numbers that are not finite, and where a heading is more than a right angle off the chord.
std::optional<Outline> smooth_curve(const Curve& curve, const CurveOptions& options,
                                    Diagnostics& diagnostics);

/// Estimates the heading of each point from its neighbours; exact for evenly sampled circles, closed ones
/// included. Two points give a line. Fails as `smooth_curve` does, and where an open
/// end turns by more than 60 degrees.
std::optional<Curve> guess_headings(const std::vector<Point2>& points, const CurveOptions& options,
                                    Diagnostics& diagnostics);

// ------------------------------------------------------------------------------------------------ measures

double area(const Outline& outline);  ///< square mm; above 0 for a simple counter-clockwise one
Length length(const Outline& outline);
Box2 bounds(const Outline& outline);
/// The point at a length from the start, with its direction of travel; the ends beyond the outline. In a
/// corner the direction is that of the segment before it. The outline must have a segment with a length.
CurvePoint at_length(const Outline& outline, Length from_start);

/// The points of an outline whose chords stay within `chord` of its arcs: its ends and points between, at
/// least 16 per full circle and at most 4096 per arc. A closed outline ends with its first point.
std::vector<Point2> flattened(const Outline& outline, Length chord);
/// Counter-clockwise from the right, without the first point repeated.
std::vector<Point2> flattened(const Circle& circle, Length chord);

// ---------------------------------------------------------------------------------------------- transforms

/// p -> offset + factor * p, each axis by itself. Mirroring (one factor negative) also reverses the order, so
/// that a closed outline keeps its direction. Requests are not scaled. Factors must not be 0; arcs stay arcs
/// through the transformed points, also where the factors differ.
struct Placement {
  Point2 offset;
  Point2 factor{1.0, 1.0};
  bool mirrors() const { return (factor.x < 0.0) != (factor.y < 0.0); }
};
Outline placed(const Outline& outline, const Placement& placement);
Curve placed(const Curve& curve, const Placement& placement);
/// The radius is scaled by the geometric mean of the factors' sizes.
Circle placed(const Circle& circle, const Placement& placement);

Outline rotated(const Outline& outline, Point2 centre, Angle angle);
Curve rotated(const Curve& curve, Point2 centre, Angle angle);
Circle rotated(const Circle& circle, Point2 centre, Angle angle);

/// In the opposite direction.
Outline reversed(const Outline& outline);
/// The requests of the reversed outline.
CornerRequests reversed(const CornerRequests& requests, const Outline& outline);
Curve reversed(const Curve& curve);
/// Neighbouring lines in one direction, and arcs of one circle, become one segment where all of them are
/// within `within` of it, up to about 2000 in one. A closed outline may get another start.
Outline merged(const Outline& outline, Length within);
/// Closed by a line where it is open.
Outline closed(const Outline& outline);

// Loose lines and arcs joined end to end, as drawings have them, into outlines.
//
//   const Chained chained = chain(pieces, {.join = mm(0.01)});
//   // chained.outlines; chained.open_ends and chained.junctions are where a drawing needs corrections
//
// Frame as in outline.h: mm, y up. No position, order or direction is guessed: where more than two ends meet,
// none of them is joined.

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
