// Entities of the drawing: lines, arcs, circles, polylines, layers and colours.
#include "front/scad/commands/bindings.h"
#include "front/scad/commands/entities.h"

namespace kerf::scad {

namespace {
constexpr double kSame = 1e-5;  // mm: shorter lines are none
}

void draw_line(MachineState& machine, int tool_number, Point2 from, Point2 to) {
  coordinate(from.x, "xbegin"), coordinate(from.y, "ybegin");
  coordinate(to.x, "xend"), coordinate(to.y, "yend");
  if (distance(from, to) > kSame) machine.draw(tool_number, drawing::Line{from.x, from.y, to.x, to.y});
}

void draw_arc(MachineState& machine, int tool_number, Point2 centre, double radius, double start,
              double end) {
  coordinate(centre.x, "xcenter"), coordinate(centre.y, "ycenter");
  coordinate(start, "anglebegin"), coordinate(end, "endangle");
  machine.draw(tool_number, drawing::Arc{centre.x, centre.y, positive(radius, "radius"), start, end});
}

void draw_circle(MachineState& machine, int tool_number, Point2 centre, double radius) {
  coordinate(centre.x, "xcenter"), coordinate(centre.y, "ycenter");
  machine.draw(tool_number, drawing::Circle{centre.x, centre.y, positive(radius, "radius")});
}

void draw_outline(MachineState& machine, int tool_number, const Outline& outline) {
  machine.draw(tool_number, polyline_of(outline));
}

void start_polyline(MachineState& machine) { machine.polyline.emplace(); }

void add_vertex(MachineState& machine, Point2 at) {
  if (!machine.polyline) refuse_now("beginpolyline must be called first");
  coordinate(at.x, "xend"), coordinate(at.y, "yend");
  if (machine.polyline->empty() || distance(at, machine.polyline->back()) > kSame)
    machine.polyline->push_back(at);
}

void close_polyline(MachineState& machine, int tool_number) {
  if (!machine.polyline) refuse_now("beginpolyline must be called first");
  std::vector<Point2> points = std::move(*machine.polyline);
  machine.polyline.reset();
  if (points.size() < 2) return;
  drawing::Polyline made;
  made.closed = points.size() > 2 && distance(points.front(), points.back()) <= kSame;
  if (made.closed) points.pop_back();
  for (const Point2 p : points) made.vertices.push_back({p.x, p.y, 0.0, 0.0});
  machine.draw(tool_number, std::move(made));
}

void cut_and_draw(MachineState& machine, Point3 to) {
  const Point3 from = machine.position();
  machine.cut(to);
  if (distance(from.xy(), to.xy()) > kFar) draw_line(machine, machine.tool().given, from.xy(), to.xy());
}

void cut_vertex(MachineState& machine, Point3 to) {
  add_vertex(machine, to.xy());
  machine.cut(to);
}

void cut_and_draw_arc(MachineState& machine, const MachineState::ArcBetween& arc) {
  machine.arc(arc);
  const bool left = arc.turn == Turn::ccw;
  draw_arc(machine, machine.tool().given, arc.centre, arc.radius, left ? arc.start : arc.end,
           left ? arc.end : arc.start);
}

namespace {

void setdxfcolor(MachineState& machine, Call& call) { machine.set_colour(text(call, 0)); }

void setdxflayer(MachineState& machine, Call& call) {
  machine.layer = optional_text(call, 0);
  if (machine.layer && machine.layer->empty()) refuse("layer must be a name");
}

void dxfline(MachineState& machine, Call& call) {
  draw_line(machine, tool_number(call, 0), point2(call, 1), point2(call, 3));
}
void dxfarc(MachineState& machine, Call& call) {
  draw_arc(machine, tool_number(call, 0), point2(call, 1), number(call, 3), number(call, 4), number(call, 5));
}
void dxfcircle(MachineState& machine, Call& call) {
  draw_circle(machine, tool_number(call, 0), point2(call, 1), number(call, 3));
}
void beginpolyline(MachineState& machine, Call&) { start_polyline(machine); }
void addvertex(MachineState& machine, Call& call) { add_vertex(machine, point2(call, 1)); }
void closepolyline(MachineState& machine, Call& call) { close_polyline(machine, tool_number(call, 0)); }

/// Parts of the original's text output, which the writer of the drawing does.
void part_of_writer(MachineState&, Call&) {}

void writedxf(MachineState&, Call&) { refuse("text cannot be added to a drawing; use the dxf... commands"); }

}  // namespace

void add_drawing_commands(Rows& rows) {
  rows.push_back(row<setdxfcolor>("setdxfcolor", "color"));
  rows.push_back(row<setdxflayer>("setdxflayer", "layer=undef"));
  rows.push_back(row<dxfline>("dxfline", "tn, xbegin, ybegin, xend, yend"));
  rows.push_back(row<dxfarc>("dxfarc", "tn, xcenter, ycenter, radius, anglebegin, endangle"));
  rows.push_back(row<dxfcircle>("dxfcircle", "tool_num, xcenter, ycenter, radius"));
  for (const char* name : {"beginpolyline", "beginopenpolyline"})
    rows.push_back(row<beginpolyline>(name, "tn"));
  for (const char* name : {"addvertex", "addopline"}) rows.push_back(row<addvertex>(name, "tn, xend, yend"));
  for (const char* name : {"closepolyline", "finishopenpolyline"})
    rows.push_back(row<closepolyline>(name, "tn"));
  for (const char* name : {"writedxfcolor", "dxfpreamble", "dxfpostamble"})
    rows.push_back(row<part_of_writer>(name, "tn"));
  for (const char* name : {"writedxf", "writedxfs"}) {
    Command refused = row<writedxf>(name, "toolnumber");
    refused.further = FurtherArguments::taken;
    rows.push_back(std::move(refused));
  }
}

}  // namespace kerf::scad
