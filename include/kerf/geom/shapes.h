// Shapes of the plane by name and dimensions, as closed outlines: circles, ovals, triangles, hearts, stars.
//
//   const auto ring = make_region({circle({0, 0}, mm(20)), circle({0, 0}, mm(8))}, FillRule::even_odd, {},
//                                 diagnostics);
//   const PlaneShape* lens = plane_shape("lens");
//   const auto outline = make_plane_shape(*lens, {0, 0, 10, 10}, {}, diagnostics);
//
// Frame as in outline.h: mm, y up; counter-clockwise. Angles are degrees, counter-clockwise from +x. Errors
// (op_option) name the shape and the argument.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/geom/outline.h"
#include "kerf/geom/region.h"

namespace kerf {

/// Closed outlines: a circle, counter-clockwise from its right; a rectangle, counter-clockwise from `low`; a
/// polygon, in the order of its corners, the last joined to the first.
Outline circle(Point2 centre, Length radius);
Outline rectangle(Point2 low, Point2 high);
Outline polygon(const std::vector<Point2>& corners);

/// An argument of a shape.
struct ShapeArgument {
  std::string_view name;
  enum class Kind : std::uint8_t { any, size } kind = Kind::any;  ///< a size is above 0
  std::optional<double> fallback{};                               ///< nothing: required
};

struct PlaneShape {
  std::string_view name, meaning;
  std::vector<ShapeArgument> arguments;
  Outline (*make)(const double* values) = nullptr;
  /// What is wrong with values that are all allowed alone; empty: nothing.
  std::string (*problem)(const double* values) = nullptr;
};

/// All shapes, by name.
const std::vector<PlaneShape>& plane_shapes();
/// nullptr if there is none of this name.
const PlaneShape* plane_shape(std::string_view name);
/// The outline; missing values at the end are the fallbacks. Nothing, with errors, if a value is missing or
/// wrong.
std::optional<Outline> make_plane_shape(const PlaneShape& shape, const std::vector<double>& values,
                                        const Origin& where, Diagnostics& diagnostics);

/// The area below a Bezier surface of degree 3 in both directions over a rectangle: its height above a point.
/// `heights` are those of the four rows of four control points, evenly spaced, from the lower left corner
/// along X. Points outside have the height of the nearest point of the edge.
struct BezierSurface {
  Point2 corner;
  double width = 0.0, height = 0.0;
  double heights[4][4] = {};
  double at(Point2 p) const;
};

// Joints of boards: slots of finger joints, and corners that a round tool can clear.
//
//   const auto slots = finger_slots({.width = mm(100), .depth = mm(12), .count = 5}, {}, diagnostics);
//   const auto cut = relieve_corners(*slots, {.diameter = mm(6)}, {}, diagnostics);
//
// Frame and units as in region.h. Errors: options out of range (op_option), and those of region.h.

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
