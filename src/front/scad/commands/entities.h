// Entities of the drawing with their checks, and cuts that are drawn as well.
#pragma once

#include "front/scad/commands/machine_state.h"

namespace kerf::scad {

void draw_line(MachineState& machine, int tool_number, Point2 from, Point2 to);
/// Counter-clockwise between two angles, degrees.
void draw_arc(MachineState& machine, int tool_number, Point2 centre, double radius, double start, double end);
void draw_circle(MachineState& machine, int tool_number, Point2 centre, double radius);
void draw_outline(MachineState& machine, int tool_number, const Outline& outline);

void start_polyline(MachineState& machine);
void add_vertex(MachineState& machine, Point2 at);
void close_polyline(MachineState& machine, int tool_number);

/// A straight cut and its line in the drawing; a plunge has none.
void cut_and_draw(MachineState& machine, Point3 to);
/// A straight cut and a vertex of the polyline.
void cut_vertex(MachineState& machine, Point3 to);
/// An arc between two angles and that in the drawing.
void cut_and_draw_arc(MachineState& machine, const MachineState::ArcBetween& arc);

/// The shapes of a rectangle's corners.
enum class Corners : unsigned char { square, fillet, chamfer, flipped_fillet };
Corners corners_named(std::string_view name);
struct RectangleSize {
  Point2 low;
  double width = 0.0, height = 0.0;
};
/// A rectangle; `radius` is that of its corners.
void draw_rectangle(MachineState& machine, int tool_number, const RectangleSize& size, Corners corners,
                    double radius);
void cut_rectangle_round(MachineState& machine, const RectangleSize& size, double z, double radius);

/// Z of the bottom of a cut `depth` below `top`; depths below 0 count as those above, with a warning.
double bottom_of(MachineState& machine, double top, double depth);

}  // namespace kerf::scad
