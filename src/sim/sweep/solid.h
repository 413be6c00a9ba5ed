// A part of a tool as convex pieces, from which the sweeps of the simulator are computed.
//
// A convex piece turned about the spindle axis intersects every vertical line in one interval, and so does
// the solid that it sweeps along a straight line. Pieces are cylinders, cone frusta and zones of spheres and
// tori; a concave arc becomes frusta. Heights are above the tip, mm.
#pragma once

#include <cstdint>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/tool/tool.h"

namespace kerf::sim {

enum class CapCurve : std::uint8_t { flat, cone, ball, torus };

/// The underside of a convex piece as a function of the distance rho from the axis: `height` up to `flat`;
/// from there to the rim a line of the given slope, or an arc about (centre_r, centre_z), which lies above
/// the curve. Never falling, and convex. A ball is a torus with its centre on the axis; it has a closed form.
struct Cap {
  CapCurve curve = CapCurve::flat;
  double flat = 0.0;
  double height = 0.0;
  double slope = 0.0;
  double centre_r = 0.0, centre_z = 0.0, radius = 0.0;

  double at(double rho) const;
};

/// One convex piece. The upper side is stored upside down (heights negated), so that one algorithm serves
/// both.
struct ConvexPiece {
  double rim = 0.0;  // largest radius
  Cap lower;
  Cap upper;
};

/// A line below the underside of a whole solid: height >= offset + slope * rho. Culling uses the maximum of a
/// few such lines.
struct CullLine {
  double offset = 0.0, slope = 0.0;
};
inline constexpr int kCullLines = 6;

/// A part of a tool as convex pieces with bounds.
struct Solid {
  std::vector<ConvexPiece> pieces;
  /// The radius never decreases upwards: the lower sides of the pieces form one underside, the top is flat
  /// and full.
  bool one_envelope = false;
  double rim = 0.0, bottom = 0.0, top = 0.0;
  CullLine lines[kCullLines];

  bool empty() const { return pieces.empty(); }
  /// Maximum distance from the axis at which the solid reaches below a height.
  double reach_below(double height) const;
};

/// The convex pieces of a profile. Concave arcs become frusta within `chord` of the arc. All surfaces but
/// level ones are moved inwards by `shrink`, so that touching sideways is not a contact.
Solid make_solid(const Profile& profile, Length chord, Length shrink);

/// A cylinder from `bottom` to `top`.
Solid make_cylinder(double radius, double bottom, double top);

/// Height of the assumed extension above a tool: higher than any stock that is accepted, mm.
inline constexpr double kAboveAll = 1e6;
/// Radius above the flutes, mm: that of the next part, but no more than that of the flutes at their end, so
/// that a thicker shank is reported as a shank. If nothing is drawn above the flutes: their own radius.
double radius_above_flutes(const Silhouette& tool);
/// The tool with its highest part extended upwards by kAboveAll, as something must hold it; if there are only
/// flutes, a shank of their radius follows.
Silhouette held(Silhouette tool);

}  // namespace kerf::sim
