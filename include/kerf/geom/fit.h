// From points and free curves to lines and arcs, and from arcs to points, each within a tolerance.
//
//   const auto outline = fit_bezier({{0, 0}, {10, 20}, {30, -5}, {40, 0}}, mm(0.01), {}, diagnostics);
//
// Frame as in outline.h: mm, y up. Errors go to Diagnostics: too few points, numbers that are not finite,
// knots that fall (7012, 7002), a tolerance that is not above 0 (7043).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kerf/geom/outline.h"

namespace kerf {

/// Of the messages of the functions below.
struct FitOptions {
  std::string name{};
  Origin where{};
};

/// Lines and arcs (of at most half a turn) along a polyline. They start and end where it does, and pass
/// through some of its points; nothing of them is further than `within` from the polyline, and no point of it
/// further from them. A closed polyline repeats its first point at the end.
std::optional<Outline> fit_arcs(const std::vector<Point2>& points, Length within, const FitOptions& options,
                                Diagnostics& diagnostics);

/// A Bézier curve of a degree up to 25 as arcs in pairs that keep its direction where they meet. Each piece
/// is compared with the curve at 15 points; tolerances below 2^-40 of the largest coordinate count as that.
/// Pieces of a millionth of the curve's parameter become lines: the tip of a cusp.
std::optional<Outline> fit_bezier(const std::vector<Point2>& control, Length within,
                                  const FitOptions& options, Diagnostics& diagnostics);

/// A B-spline as DXF and STEP have it.
struct Spline {
  int degree = 3;
  std::vector<Point2> control;  ///< mm
  std::vector<double> knots;    ///< as many as control points and degree and 1; never falling
  std::vector<double> weights;  ///< none, or one from 0.001 to 1000 for each control point
};
/// A spline with evenly spaced knots that starts at its first control point and ends at its last one: a
/// Bézier curve where there is one more point than the degree.
Spline clamped_spline(int degree, std::vector<Point2> control, std::vector<double> weights = {});

/// As `fit_bezier`, piece by piece between the knots.
std::optional<Outline> fit_spline(const Spline& spline, Length within, const FitOptions& options,
                                  Diagnostics& diagnostics);

/// The points of a spline whose chords stay within `chord` of it, but at most `limit` chords (or one for each
/// piece between knots): the ends of its pieces, and equal steps of the parameter between them. The spline
/// must be valid, as `fit_spline` checks it (but with any weights above 0), and start and end at its first
/// and last control points.
std::vector<Point2> flattened(const Spline& spline, Length chord, int limit);
/// The arc of an ellipse centre + cos(t) * u + sin(t) * v, from t = `start` over `sweep` (below 0: falling t,
/// at most a full turn), as a spline: exact but for rounding.
Spline ellipse_spline(Point2 centre, Point2 u, Point2 v, Angle start, Angle sweep);

/// How a spline through points runs at its ends.
struct SplineEnds {
  std::optional<Point2> start, end;  ///< directions of travel; none, or a zero vector: without curvature
  bool closed = false;               ///< smooth where the last point meets the first; directions are ignored
};
/// The cubic spline through points, with the distances of neighbours as its parameter and continuous
/// curvature, as CAD programs draw a spline that is specified by fit points. Points equal to the one before
/// are ignored. Nothing, with an error appended, for fewer than two different points.
std::optional<Spline> spline_through(const std::vector<Point2>& points, const SplineEnds& ends,
                                     const FitOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
