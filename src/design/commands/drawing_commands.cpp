// Entities of the drawing: lines, arcs, circles, polylines, layers and colours.
#include <algorithm>
#include <fmt/format.h>

#include "design/commands/entities.h"
#include "design/commands/rows.h"

namespace kerf::design {

namespace {
constexpr double kSame = 1e-5;  // mm: shorter lines are none
}

void draw_line(Machine& machine, int tool_number, Point2 from, Point2 to) {
  draw_line(machine, tool_number, Point3{from.x, from.y, 0.0}, Point3{to.x, to.y, 0.0});
}

void draw_line(Machine& machine, int tool_number, Point3 from, Point3 to) {
  coordinate(from.x, "xbegin"), coordinate(from.y, "ybegin"), coordinate(from.z, "zbegin");
  coordinate(to.x, "xend"), coordinate(to.y, "yend"), coordinate(to.z, "zend");
  if (distance(from, to) > kSame)
    machine.draw(tool_number, drawing::Line{from.x, from.y, to.x, to.y, from.z, to.z});
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

void add_vertex(Machine& machine, Point2 at) { add_vertex(machine, Point3{at.x, at.y, 0.0}); }

void add_vertex(Machine& machine, Point3 at) {
  if (!machine.polyline) refuse_now("beginpolyline must be called first");
  coordinate(at.x, "xend"), coordinate(at.y, "yend"), coordinate(at.z, "zend");
  std::vector<Point3>& points = machine.polyline->points;
  if (points.empty() || distance(at, points.back()) > kSame) points.push_back(at);
}

void close_polyline(Machine& machine, int tool_number) {
  if (!machine.polyline) refuse_now("beginpolyline must be called first");
  std::vector<Point3> points = std::move(machine.polyline->points);
  machine.polyline.reset();
  if (points.size() < 2) return;
  if (std::any_of(points.begin(), points.end(), [](Point3 p) { return p.z != 0.0; })) {
    for (std::size_t i = 1; i < points.size(); ++i) draw_line(machine, tool_number, points[i - 1], points[i]);
    return;  // a polyline has no heights
  }
  drawing::Polyline made;
  made.closed = points.size() > 2 && distance(points.front(), points.back()) <= kSame;
  if (made.closed) points.pop_back();
  for (const Point3 p : points) made.vertices.push_back({p.x, p.y, 0.0, 0.0});
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

/// Five numbers are a line with the number of a tool; a start with a height and an end without one is not.
void refuse_five_numbers(Machine& machine, Call& call) {
  const int number = tool_number(machine, call, 0);
  if (call[0].is(Type::undefined) || number == 0 || machine.tool_numbers().has(number)) return;
  refuse(fmt::format("there is no tool {}; the forms are {}", number, forms_of(call.command())));
}

void dxfline(Machine& machine, Call& call) {
  refuse_five_numbers(machine, call);
  const Point2 from = call.point2(1), to = call.point2(3);
  draw_line(machine, tool_number(machine, call, 0), Point3{from.x, from.y, call.number(5)},
            Point3{to.x, to.y, call.number(6)});
}
void dxfarc(Machine& machine, Call& call) {
  draw_arc(machine, tool_number(machine, call, 0), call.point2(1), call.number(3), call.number(4),
           call.number(5));
}
void dxfcircle(Machine& machine, Call& call) {
  draw_circle(machine, tool_number(machine, call, 0), call.point2(1), call.number(3));
}
/// With the number of a tool, or with the first vertex: the form of all calls until the polyline is closed.
void beginpolyline(Machine& machine, Call& call) {
  start_polyline(machine);
  machine.polyline->without_tool = call[0].is(Type::undefined);
  const auto x = call.optional_number(1), y = call.optional_number(2);
  if (x.has_value() != y.has_value()) refuse("xbegin and ybegin are given together");
  if (x) add_vertex(machine, Point3{*x, *y, call.number(3)});
}
void addvertex(Machine& machine, Call& call) {
  const bool three_numbers = !call[0].is(Type::undefined) && call.number(3) == 0.0;
  if (machine.polyline && machine.polyline->without_tool && three_numbers)
    add_vertex(machine, call.point3(0));
  else
    add_vertex(machine, Point3{call.number(1), call.number(2), call.number(3)});
}
void closepolyline(Machine& machine, Call& call) { close_polyline(machine, tool_number(machine, call, 0)); }

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
  rows.push_back(tool_may_be_left_out(
      row<dxfline>("dxfline", "tn, xbegin, ybegin, xend, yend, zbegin=0, zend=0", "Draw a line."), 4));
  rows.push_back(
      tool_may_be_left_out(row<dxfarc>("dxfarc", "tn, xcenter, ycenter, radius, anglebegin, endangle",
                                       "An arc counter-clockwise between two angles, degrees."),
                           5));
  rows.push_back(tool_may_be_left_out(
      row<dxfcircle>("dxfcircle", "tool_num, xcenter, ycenter, radius", "Draw a circle."), 3));
  for (const char* name : {"beginpolyline", "beginopenpolyline"})
    rows.push_back(tool_may_be_left_out(
        row<beginpolyline>(name, "tn, xbegin=undef, ybegin=undef, zbegin=0",
                           "Start a polyline; addvertex and cutvertexdxf add its vertices."),
        0));
  for (const char* name : {"addvertex", "addopline"})
    rows.push_back(tool_may_be_left_out(
        row<addvertex>(name, "tn, xend, yend, zend=0", "Add a vertex to the polyline that was started."), 2));
  for (const char* name : {"closepolyline", "finishopenpolyline"})
    rows.push_back(tool_may_be_left_out(
        row<closepolyline>(name, "tn", "End the polyline; it is closed if its last vertex is the first."),
        0));
  for (const char* name : {"writedxfcolor", "dxfpreamble", "dxfpostamble"})
    rows.push_back(tool_may_be_left_out(
        row<part_of_writer>(
            name, "tn", "Part of the original's text output; entities get their colour when they are drawn."),
        0));
  for (const char* name : {"writedxf", "writedxfs"})
    rows.push_back(
        with_further(row<writedxf>(name, "toolnumber", "Refused: text cannot be added to a drawing.")));
}

}  // namespace kerf::design
