// Parts of the plane bounded by lines and arcs: union, difference, offset, and questions about them.
//
// Arcs stay arcs throughout. Input may cross itself, overlap, or touch: it is cut where it meets, and what
// has a given winding number is kept. The outlines that come out do not cross themselves or each other.
//
//   Diagnostics diagnostics;
//   const auto plate = make_region({outline}, FillRule::nonzero, {}, diagnostics);
//   const auto smaller = offset(*plate, mm(-3), {}, diagnostics);       // where the centre of a 6 mm mill
//   may be const double left = area(smaller->region);                          // square mm
//
// Frame and units as in outline.h: mm, y up, counter-clockwise positive. Points closer than `Tolerance::weld`
// are one point (at least 2^-40 of the largest coordinate, which is what rounding needs); features smaller
// than that may vanish. Errors (codes 704x) go to Diagnostics: an outline that is not closed, numbers that
// are not finite, outlines that meet in more than some ten million places, and, should it ever happen, input
// that cannot be worked out without contradiction. Then there is no value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kerf/outline.h"
#include "kerf/progress.h"

namespace kerf {

/// The inside is on the left of each loop: outer loops run counter-clockwise, holes clockwise. Loops are
/// closed and do not cross; they may touch in points.
struct Region {
  std::vector<Outline> loops;
  bool empty() const { return loops.empty(); }
  bool operator==(const Region&) const = default;
};

struct RegionOptions {
  Tolerance tolerance{};         ///< only `weld` matters: arcs stay arcs
  std::string name{};            ///< of the region in messages
  Origin where{};                ///< of the messages
  Progress* progress = nullptr;  ///< may stop the work: then there is no value, and no error
};

/// Which winding numbers count as inside.
enum class FillRule : std::uint8_t {
  even_odd,  ///< odd ones: what lies inside an odd number of the outlines
  nonzero,   ///< all but 0, whatever the sense of the outlines
  positive   ///< above 0: counter-clockwise outlines add, clockwise ones take away
};

/// The region inside closed outlines; requests for corners are ignored.
std::optional<Region> make_region(const std::vector<Outline>& outlines, FillRule rule,
                                  const RegionOptions& options, Diagnostics& diagnostics);
/// The region inside the first outline or circle of a figure and outside of the others.
std::optional<Region> make_region(const Figure& figure, const RegionOptions& options,
                                  Diagnostics& diagnostics);
/// Each outer loop with its holes, as a figure of its own.
std::vector<Figure> figures(const Region& region);

// ------------------------------------------------------------------------------------------- boolean
// operations

enum class Boolean : std::uint8_t {
  unite,      ///< in either
  intersect,  ///< in both
  subtract,   ///< in the first and not in the second
  exclude     ///< in exactly one
};
/// How two regions lie to each other.
enum class Relation : std::uint8_t { disjoint, first_inside_second, second_inside_first, equal, overlapping };

struct Combined {
  Region region;
  Relation relation = Relation::disjoint;  ///< touching without common area is disjoint
};
std::optional<Combined> combine(const Region& first, const Region& second, Boolean what,
                                const RegionOptions& options, Diagnostics& diagnostics);
/// The union of many regions at once.
std::optional<Region> unite(const std::vector<Region>& regions, const RegionOptions& options,
                            Diagnostics& diagnostics);

// ----------------------------------------------------------------------------------------------------
// questions

double area(const Region& region);    ///< square mm
Length length(const Region& region);  ///< of its whole boundary
Box2 bounds(const Region& region);

enum class Location : std::uint8_t { inside, outside, boundary };

/// A point of a boundary.
struct BoundaryPoint {
  Point2 at;
  std::uint32_t loop = 0;     ///< of the region
  std::uint32_t segment = 0;  ///< of the loop
  Length distance;            ///< from the point asked for
};

/// Answers questions about one region, each in the time of a search in a tree.
class RegionSearch {
 public:
  explicit RegionSearch(const Region& region);
  /// `boundary` where the point is within `weld` of it. On which side of a line it is, is decided without
  /// rounding.
  Location locate(Point2 at, Length weld) const;
  /// The nearest point of the boundary; nothing for an empty region.
  std::optional<BoundaryPoint> nearest(Point2 at) const;

 private:
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// A place where an outline meets itself other than at the common end of neighbours.
struct SelfIntersection {
  Point2 at;
  std::uint32_t first = 0, second = 0;  ///< segments, from 0; first < second
};
/// All of them, in order of segments; overlaps show as their ends. Nothing, with an error appended, where
/// there are too many.
std::optional<std::vector<SelfIntersection>> self_intersections(const Outline& outline,
                                                                const RegionOptions& options,
                                                                Diagnostics& diagnostics);

}  // namespace kerf
