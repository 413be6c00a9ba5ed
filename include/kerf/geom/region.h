// Parts of the plane bounded by lines and arcs: Boolean operations and queries, and the region that a drawing
// shows. Offsets are in
// offset.h, the medial axis in medial_axis.h.
//
// Arcs stay arcs. Input may intersect itself, overlap, or touch; the loops of a result do not cross
// themselves or each other.
//
//   Diagnostics diagnostics;
//   const auto plate = make_region({outline}, FillRule::nonzero, {}, diagnostics);
//   const auto rest = combine(*plate, *slot, Boolean::subtract, {}, diagnostics);
//   const double left = area(rest->region);  // square mm
//
// Frame and units as in outline.h: mm, y up, counter-clockwise positive. Points closer than `Tolerance::weld`
// are one point (at least 2^-40 of the largest coordinate, which rounding needs); features smaller than that
// may vanish. Errors (codes 704x) go to Diagnostics: an outline that is not closed, numbers that are not
// finite, outlines that intersect in too many points (limits.h), and, rarely, input that
// cannot be resolved without contradiction. Then there is no value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/progress.h"
#include "kerf/geom/outline.h"

namespace kerf {

/// The inside is on the left of each loop: outer loops are counter-clockwise, holes clockwise. Loops are
/// closed and do not cross; they may touch in points.
struct Region {
  std::vector<Outline> loops;
  bool empty() const { return loops.empty(); }
  bool operator==(const Region&) const = default;
};

/// A segment of a region's boundary, or the corner at its end.
struct BoundaryElement {
  std::uint32_t loop = 0, segment = 0;
  bool corner = false;
  bool operator==(const BoundaryElement&) const = default;
};

struct RegionOptions {
  Tolerance tolerance{};         ///< only `weld` matters: arcs stay arcs
  std::string name{};            ///< of the region, in messages
  Origin where{};                ///< of messages
  Progress* progress = nullptr;  ///< may stop the work: then there is no value, and no error
};

/// Which winding numbers count as inside.
enum class FillRule : std::uint8_t {
  even_odd,  ///< odd ones: inside an odd number of the outlines
  nonzero,   ///< all but 0, for outlines of any direction
  positive   ///< above 0: counter-clockwise outlines add, clockwise ones subtract
};

/// The region inside closed outlines; requests for corners are ignored.
std::optional<Region> make_region(const std::vector<Outline>& outlines, FillRule rule,
                                  const RegionOptions& options, Diagnostics& diagnostics);
/// The region inside the first outline or circle of a figure and outside of the others.
std::optional<Region> make_region(const Figure& figure, const RegionOptions& options,
                                  Diagnostics& diagnostics);
/// Each outer loop with its holes, as a figure of its own; the smallest first.
std::vector<Figure> figures(const Region& region);

/// Transformed as outlines are (outline.h); a mirrored region keeps its inside on the left.
Region placed(const Region& region, const Placement& placement);
Region rotated(const Region& region, Point2 centre, Angle angle);
/// Loops with merged segments (outline.h).
Region merged(const Region& region, Length within);

/// The loops around each loop.
struct Nesting {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> parents;  ///< of each loop: the smallest loop around it, or kNone
  std::vector<std::uint32_t> depths;   ///< of each loop: the number of loops around it
};
Nesting nesting(const Region& region);

// ------------------------------------------------------------------------------------- Boolean operations

enum class Boolean : std::uint8_t {
  unite,      ///< in either
  intersect,  ///< in both
  subtract,   ///< in the first and not in the second
  exclude     ///< in exactly one
};
/// The relation of two regions.
enum class Relation : std::uint8_t { disjoint, first_inside_second, second_inside_first, equal, overlapping };

struct Combined {
  Region region;
  Relation relation = Relation::disjoint;  ///< regions that touch without a common area are disjoint
};
std::optional<Combined> combine(const Region& first, const Region& second, Boolean what,
                                const RegionOptions& options, Diagnostics& diagnostics);
/// The union of many regions at once.
std::optional<Region> unite(const std::vector<Region>& regions, const RegionOptions& options,
                            Diagnostics& diagnostics);

// ------------------------------------------------------------------------------------------------ queries

double area(const Region& region);    ///< square mm
Length length(const Region& region);  ///< of its whole boundary
Box2 bounds(const Region& region);

enum class Location : std::uint8_t { inside, outside, boundary };

/// A point of a boundary.
struct BoundaryPoint {
  Point2 at;
  std::uint32_t loop = 0;     ///< of the region
  std::uint32_t segment = 0;  ///< of the loop
  Length distance;            ///< from the query point
};

/// The angles from `start`, from 0 to a full turn counter-clockwise from +x, over `sweep`.
struct AngleRange {
  Angle start, sweep;
};

/// Queries of one region, each in the time of a search in a tree.
class RegionSearch {
 public:
  explicit RegionSearch(const Region& region);
  /// `boundary` within `weld` of it. On which side of a line another point lies is decided without rounding.
  Location locate(Point2 at, Length weld) const;
  /// The nearest point of the boundary; nothing for an empty region.
  std::optional<BoundaryPoint> nearest(Point2 at) const;
  /// The distance from the boundary, below 0 outside: for a point inside, the radius of the largest tool
  /// whose centre may be there. Nothing for an empty region.
  std::optional<Length> clearance(Point2 at) const;
  /// The angles at which a circle lies inside the region, in order.
  std::vector<AngleRange> inside(const Circle& circle) const;
  /// The engagement angle of a tool that moves in a direction, where the region is the material: how much of
  /// the leading half of its circle lies inside; from 0 to half a turn.
  Angle engagement(const Circle& tool, Point2 direction) const;

 private:
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// Points of two regions that are as near to each other as any are.
struct NearestPoints {
  Point2 first, second;
  Length distance;  ///< 0 where the regions overlap or touch; then the points are a common point
};
/// Nothing where a region is empty.
std::optional<NearestPoints> nearest_points(const Region& first, const Region& second);

/// A part of a path between points where it meets the boundary of a region.
struct PathPiece {
  Outline path;
  Location location = Location::outside;  ///< of all its points
  std::uint32_t first_segment = 0;        ///< the segment of the path on which it starts
};
/// A path, open or closed, divided where it enters and leaves a region, in its direction; pieces along the
/// boundary are pieces of their own. A closed path that does not meet the boundary stays closed, another one
/// starts where it enters or leaves. Pieces shorter than the tolerance become part of a neighbour.
std::optional<std::vector<PathPiece>> divide(const Outline& path, const Region& region,
                                             const RegionOptions& options, Diagnostics& diagnostics);
/// The pieces with one location.
std::optional<std::vector<Outline>> clip(const Outline& path, const Region& region, Location wanted,
                                         const RegionOptions& options, Diagnostics& diagnostics);

/// A point where an outline intersects or touches itself other than at the common end of neighbours.
struct SelfIntersection {
  Point2 at;
  std::uint32_t first = 0, second = 0;  ///< segments, from 0; first < second
};
/// All of them, in order of segments; overlaps show as their ends. Nothing, with an error appended, where
/// there are too many.
std::optional<std::vector<SelfIntersection>> self_intersections(const Outline& outline,
                                                                const RegionOptions& options,
                                                                Diagnostics& diagnostics);

// The region that a drawing shows: filled shapes each by their own rule, and outlines that bound areas.
//
//   const auto shown = painted_region(outlines, Combining::drawn, {}, diagnostics);
//
// Frame, units, tolerance and errors as in region.h.

/// How an outline of a drawing is filled.
struct OutlineFill {
  std::uint32_t figure = 0;  ///< outlines of one figure are filled together; 0: not filled
  FillRule rule = FillRule::even_odd;
  bool operator==(const OutlineFill&) const = default;
};
struct PaintedOutline {
  Outline outline;
  OutlineFill fill{};
};

/// What overlapping shapes make.
enum class Combining : std::uint8_t {
  drawn,   ///< filled figures by their rules, united with each other and with what the other outlines bound,
           ///< of which those inside of others are holes
  nested,  ///< all outlines alike: those inside of others are holes
  united   ///< the area inside any of them
};

/// By its name: drawn, nested or united.
std::optional<Combining> combining_of(std::string_view name);

/// Open outlines of figures are closed, as a fill does; other open ones are left out.
std::optional<Region> painted_region(const std::vector<PaintedOutline>& outlines, Combining combining,
                                     const RegionOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
