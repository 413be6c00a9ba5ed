// Entities of the drawing: lines, arcs, circles, polylines, layers and colours.
#include "design/commands/entities.h"
#include "design/commands/rows.h"

namespace kerf::design {

namespace {
constexpr double kSame = 1e-5;  // mm: shorter lines are none
}

void draw_line(Machine& machine, int tool_number, Point2 from, Point2 to) {
  coordinate(from.x, "xbegin"), coordinate(from.y, "ybegin");
  coordinate(to.x, "xend"), coordinate(to.y, "yend");
  if (distance(from, to) > kSame) machine.draw(tool_number, drawing::Line{from.x, from.y, to.x, to.y});
}

void draw_arc(Machine& machine, int tool_number, Point2 centre, double radius, double start, double end) {
  coordinate(centre.x, "xcenter"), coordinate(centre.y, "ycenter");
  coordinate(start, "anglebegin"), coordinate(end, "endangle");
  machine.draw(tool_number, drawing::Arc{centre.x, centre.y, positive(radius, "radius"), start, end});
}

void draw_circle(Machine& machine, int tool_number, Point2 centre, double radius) {
  coordinate(centre.x, "xcenter"), coordinate(centre.y, "ycenter");
  machine.draw(tool_number, drawing::Circle{centre.x, centre.y, positive(radius, "radius")});
}

void draw_outline(Machine& machine, int tool_number, const Outline& outline) {
  machine.draw(tool_number, polyline_of(outline));
}

void start_polyline(Machine& machine) { machine.polyline.emplace(); }

void add_vertex(Machine& machine, Point2 at) {
  if (!machine.polyline) refuse_now("beginpolyline must be called first");
  coordinate(at.x, "xend"), coordinate(at.y, "yend");
  if (machine.polyline->empty() || distance(at, machine.polyline->back()) > kSame)
    machine.polyline->push_back(at);
}

void close_polyline(Machine& machine, int tool_number) {
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

void cut_and_draw(Machine& machine, Point3 to) {
  const Point3 from = machine.position();
  machine.cut(to);
  if (distance(from.xy(), to.xy()) > kFar) draw_line(machine, machine.tool().given, from.xy(), to.xy());
}

void cut_vertex(Machine& machine, Point3 to) {
  add_vertex(machine, to.xy());
  machine.cut(to);
}

void cut_and_draw_arc(Machine& machine, const Machine::ArcBetween& arc) {
  machine.arc(arc);
  const bool left = arc.turn == Turn::ccw;
  draw_arc(machine, machine.tool().given, arc.centre, arc.radius, left ? arc.start : arc.end,
           left ? arc.end : arc.start);
}

namespace {

void setdxfcolor(Machine& machine, Call& call) { machine.set_colour(call.text(0)); }

void setdxflayer(Machine& machine, Call& call) {
  machine.layer = call.optional_text(0);
  if (machine.layer && machine.layer->empty()) refuse("layer must be a name");
}

void dxfline(Machine& machine, Call& call) {
  draw_line(machine, tool_number(call, 0), call.point2(1), call.point2(3));
}
void dxfarc(Machine& machine, Call& call) {
  draw_arc(machine, tool_number(call, 0), call.point2(1), call.number(3), call.number(4), call.number(5));
}
void dxfcircle(Machine& machine, Call& call) {
  draw_circle(machine, tool_number(call, 0), call.point2(1), call.number(3));
}
void beginpolyline(Machine& machine, Call&) { start_polyline(machine); }
void addvertex(Machine& machine, Call& call) { add_vertex(machine, call.point2(1)); }
void closepolyline(Machine& machine, Call& call) { close_polyline(machine, tool_number(call, 0)); }

/// Parts of the original's text output, which the writer of the drawing does.
void part_of_writer(Machine&, Call&) {}

void writedxf(Machine&, Call&) { refuse_now("text cannot be added to a drawing; use the dxf... commands"); }

}  // namespace

void add_drawing_commands(Rows& rows) {
  rows.push_back(
      row<setdxfcolor>("setdxfcolor", "color",
                       "Set the colour of the following entities, a drawing or web colour, in any case."));
  rows.push_back(
      row<setdxflayer>("setdxflayer", "layer=undef",
                       "Set the layer of the following entities by name; None: a layer for each colour."));
  rows.push_back(row<dxfline>("dxfline", "tn, xbegin, ybegin, xend, yend", "Draw a line."));
  rows.push_back(row<dxfarc>("dxfarc", "tn, xcenter, ycenter, radius, anglebegin, endangle",
                             "An arc counter-clockwise between two angles, degrees."));
  rows.push_back(row<dxfcircle>("dxfcircle", "tool_num, xcenter, ycenter, radius", "Draw a circle."));
  for (const char* name : {"beginpolyline", "beginopenpolyline"})
    rows.push_back(
        row<beginpolyline>(name, "tn", "Start a polyline; addvertex and cutvertexdxf add its vertices."));
  for (const char* name : {"addvertex", "addopline"})
    rows.push_back(row<addvertex>(name, "tn, xend, yend", "Add a vertex to the polyline that was started."));
  for (const char* name : {"closepolyline", "finishopenpolyline"})
    rows.push_back(
        row<closepolyline>(name, "tn", "End the polyline; it is closed if its last vertex is the first."));
  for (const char* name : {"writedxfcolor", "dxfpreamble", "dxfpostamble"})
    rows.push_back(row<part_of_writer>(
        name, "tn", "Part of the original's text output; entities get their colour when they are drawn."));
  for (const char* name : {"writedxf", "writedxfs"})
    rows.push_back(
        with_further(row<writedxf>(name, "toolnumber", "Refused: text cannot be added to a drawing.")));
}

}  // namespace kerf::design
