// A part of a tool as convex pieces: what the sweeps of the simulator are computed from.
//
// A convex piece that is turned about the spindle's axis meets every vertical line in one interval, and so
// does the solid that it sweeps along a straight line. Pieces are cylinders, cone frusta and zones of spheres
// and tori; an arc that is hollow seen from outside becomes frusta. Heights are above the tip, mm.
#pragma once

#include <cstdint>
#include <vector>

#include "kerf/tool.h"
#include "kerf/units.h"

namespace kerf::sim {

enum class CapCurve : std::uint8_t { flat, cone, ball, torus };

/// The underside of a convex piece as a function of the distance rho from the axis: `height` up to `flat`,
/// from there to the piece's rim a line of the given slope, or an arc about (centre_r, centre_z) with its
/// centre above the curve. It never falls and is convex. A ball is a torus whose centre lies on the axis and
/// which has the closed form.
struct Cap {
  CapCurve curve = CapCurve::flat;
  double flat = 0.0;
  double height = 0.0;
  double slope = 0.0;
  double centre_r = 0.0, centre_z = 0.0, radius = 0.0;

  double at(double rho) const;
};

/// One convex piece. The upper side is kept upside down (heights negated), so that one algorithm serves both.
struct ConvexPiece {
  double rim = 0.0;  // largest radius
  Cap lower;
  Cap upper;
};

/// A line below the underside of a whole solid: height >= offset + slope * rho. The highest of a few such
/// lines is what culling compares with.
struct CullLine {
  double offset = 0.0, slope = 0.0;
};
inline constexpr int kCullLines = 6;

/// A part of a tool, ready to be swept.
struct Solid {
  std::vector<ConvexPiece> pieces;
  /// The radius never shrinks upwards: the pieces' lower sides make one underside, the top is flat and full.
  bool one_envelope = false;
  double rim = 0.0, bottom = 0.0, top = 0.0;
  CullLine lines[kCullLines];

  bool empty() const { return pieces.empty(); }
  /// Largest distance from the axis at which the solid reaches below a height.
  double reach_below(double height) const;
};

/// Pieces of a profile. Hollow arcs become frusta that stray at most `chord` from the arc. All surfaces but
/// level ones are moved inwards by `shrink`: what only touches sideways then meets nothing.
Solid make_solid(const Profile& profile, Length chord, Length shrink);

/// A cylinder from `bottom` to `top`.
Solid make_cylinder(double radius, double bottom, double top);

/// How far what holds a tool reaches upwards: higher than any stock that is accepted, mm.
inline constexpr double kAboveAll = 1e6;
/// Half the width of what follows the flutes, mm; no more than theirs at their end, so that a thicker shank
/// is told of as a shank. Nothing drawn above the flutes: their own width goes on.
double radius_above_flutes(const Silhouette& tool);
/// The tool and what holds it, which nobody draws but which is surely there: its highest part goes on
/// upwards; if there are only flutes, a shank of their width follows.
Silhouette held(Silhouette tool);

}  // namespace kerf::sim
