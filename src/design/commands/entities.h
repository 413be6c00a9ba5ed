// Entities of the drawing with their checks, and cuts that are drawn as well.
#pragma once

#include "design/machine/machine.h"

namespace kerf::design {

void draw_line(Machine& machine, int tool_number, Point2 from, Point2 to);
/// With heights, which drawings in DXF have.
void draw_line(Machine& machine, int tool_number, Point3 from, Point3 to);
/// Counter-clockwise between two angles, degrees.
void draw_arc(Machine& machine, int tool_number, Point2 centre, double radius, double start, double end);
void draw_circle(Machine& machine, int tool_number, Point2 centre, double radius);
void draw_outline(Machine& machine, int tool_number, const Outline& outline);

void start_polyline(Machine& machine);
void add_vertex(Machine& machine, Point2 at);
void add_vertex(Machine& machine, Point3 at);
void close_polyline(Machine& machine, int tool_number);

/// A straight cut and its line in the drawing; a plunge has none.
void cut_and_draw(Machine& machine, Point3 to);
/// A straight cut and a vertex of the polyline.
void cut_vertex(Machine& machine, Point3 to);
/// An arc between two angles and that in the drawing.
void cut_and_draw_arc(Machine& machine, const Machine::ArcBetween& arc);

/// The shapes of a rectangle's corners.
enum class Corners : unsigned char { square, fillet, chamfer, flipped_fillet };
Corners corners_named(std::string_view name);
struct RectangleSize {
  Point2 low;
  double width = 0.0, height = 0.0;
};
/// x, y, then width and height.
RectangleSize rectangle_given(Call& call, std::size_t position, std::size_t size);
Outline rectangle_outline(const RectangleSize& size, Corners corners, double radius);
/// A slot along an outline by trochoidal loops; a width of 0: 1.5 times the diameter of the tool.
struct DepthBelow {
  double top = 0.0, depth = 0.0;
};
void cut_trochoidal(Machine& machine, const Outline& outline, DepthBelow depth, double width);
/// A rectangle; `radius` is that of its corners.
void draw_rectangle(Machine& machine, int tool_number, const RectangleSize& size, Corners corners,
                    double radius);
void cut_rectangle_round(Machine& machine, const RectangleSize& size, double z, double radius);

/// Z of the bottom of a cut `depth` below `top`; depths below 0 count as those above, with a warning.
double bottom_of(Machine& machine, double top, double depth);

}  // namespace kerf::design
