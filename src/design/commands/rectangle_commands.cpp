// Rectangles and keyholes, drawn and cut.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "design/commands/entities.h"
#include "design/commands/rows.h"

namespace kerf::design {
namespace {

constexpr double kSame = 1e-5;  // mm
const double kQuarterBulge = std::tan(std::numbers::pi / 8);

void check_corners(const RectangleSize& size, double radius) {
  if (2 * radius > std::min(size.width, size.height) + kSame)
    refuse(fmt::format("radius: {:g} mm does not fit into {:g} x {:g} mm", radius, size.width, size.height));
}

drawing::Polyline rectangle(const RectangleSize& size, Corners corners, double r) {
  const double x = size.low.x, y = size.low.y, u = x + size.width, v = y + size.height;
  drawing::Polyline made;
  made.closed = true;
  if (corners == Corners::square) {
    made.vertices = {{x, y, 0, 0}, {u, y, 0, 0}, {u, v, 0, 0}, {x, v, 0, 0}};
    return made;
  }
  const double bulge = corners == Corners::fillet    ? kQuarterBulge
                       : corners == Corners::chamfer ? 0.0
                                                     : -kQuarterBulge;
  made.vertices = {{x + r, y, 0, 0}, {u - r, y, bulge, 0}, {u, y + r, 0, 0}, {u, v - r, bulge, 0},
                   {u - r, v, 0, 0}, {x + r, v, bulge, 0}, {x, v - r, 0, 0}, {x, y + r, bulge, 0}};
  return made;
}

// ---- rectangles

void dxfrectangle(Machine& machine, Call& call) {
  draw_rectangle(machine, tool_number(machine, call, 0), rectangle_given(call, 1, 3),
                 corners_named(call.text(5)), call.number(6));
}
template <Corners corners>
void dxfrectangle_with(Machine& machine, Call& call) {
  draw_rectangle(machine, tool_number(machine, call, 0), rectangle_given(call, 1, 3), corners,
                 call.number(5));
}

/// Down along the outline, once around it.
void ramp_around(Machine& machine, const RectangleSize& size, double top, double z) {
  const double around = 2 * (size.width + size.height);
  double done = 0.0;
  Point2 from = size.low;
  for (const Point2 to : {size.low + Point2{size.width, 0.0}, size.low + Point2{size.width, size.height},
                          size.low + Point2{0.0, size.height}, size.low}) {
    done += distance(from, to);
    machine.cut({to.x, to.y, top + (z - top) * done / around});
    from = to;
  }
}

/// tool_num, bx, by, bz, xwidth, yheight, zdepth, entry, slot
void cutrectangle(Machine& machine, Call& call) {
  tool_number(machine, call, 0);
  const RectangleSize size = rectangle_given(call, 1, 4);
  const double top = call.number(3), z = bottom_of(machine, top, call.number(6));
  const std::size_t entry = choice(call.text(7), {"plunge", "ramp", "trochoidal"}, "entry");
  const drawing::Polyline outline = rectangle(size, Corners::square, 0.0);
  if (entry == 2) {
    const double slot = not_negative(call.number(8), "slot");
    return cut_trochoidal(machine, outline_of(outline), {top, top - z}, slot);
  }
  machine.cut_at(size.low, top);
  if (entry == 1) ramp_around(machine, size, top, z);
  for (const drawing::Vertex& v : outline.vertices) machine.cut_at({v.x, v.y}, z);
  machine.cut_at(size.low, z);
}
void cutrectangledxf(Machine& machine, Call& call) {
  cutrectangle(machine, call);
  draw_rectangle(machine, tool_number(machine, call, 0), rectangle_given(call, 1, 4), Corners::square, 0.0);
}
void cutrectangleround(Machine& machine, Call& call) {
  tool_number(machine, call, 0);
  const double z = bottom_of(machine, call.number(3), call.number(6));
  cut_rectangle_round(machine, rectangle_given(call, 1, 4), z, positive(call.number(7), "radius"));
}
void cutrectanglerounddxf(Machine& machine, Call& call) {
  cutrectangleround(machine, call);
  draw_rectangle(machine, tool_number(machine, call, 0), rectangle_given(call, 1, 4), Corners::fillet,
                 call.number(7));
}

// ---- keyholes

struct Slot {
  Point2 entry;
  double angle = 0.0, length = 0.0;  // degrees, mm
  Point2 end() const {
    const double a = degrees(angle).rad();
    return {entry.x + length * std::cos(a), entry.y + length * std::sin(a)};
  }
};

/// The entry hole of a keyhole with the slot of the neck, and the neck's circle at the entry.
void draw_keyhole(Machine& machine, int number, const Slot& slot) {
  const Tool& tool = machine.tool_numbers().tool(number);
  if (kerf::name_of(tool.shape) != "keyhole")
    refuse(fmt::format("kh_tool_num: tool {} is not a keyhole cutter", number));
  const double head = diameter_at(tool, 0.0) / 2, neck = tool.silhouette.cutting.knots.back().r;
  draw_circle(machine, number, slot.entry, neck);
  const double a = degrees(slot.angle).rad();
  const Point2 along{std::cos(a), std::sin(a)};
  const auto vertex = [&](double u, double v, double bulge) {
    const Point2 p = slot.entry + u * along + v * left_of(along);
    return drawing::Vertex{p.x, p.y, bulge, 0.0};
  };
  const double out = std::sqrt(head * head - neck * neck);  // of the slot's start from the centre
  if (slot.length <= out)
    refuse(fmt::format("kh_distance: a slot of {:g} mm does not leave the entry hole", slot.length));
  const double round = 2 * std::numbers::pi - 2 * std::asin(neck / head);  // of the hole outside of the slot
  drawing::Polyline made;
  made.closed = true;
  made.vertices = {vertex(out, -neck, 0.0), vertex(slot.length, -neck, 1.0), vertex(slot.length, neck, 0.0),
                   vertex(out, neck, std::tan(round / 4))};
  machine.draw(number, std::move(made));
}

/// kh_tool_num, kh_start_depth, kh_max_depth, and the slot: plunge, along the slot and back, and up.
void cut_keyhole(Machine& machine, Call& call, double angle) {
  const double bottom = bottom_of(machine, 0.0, call.number(2));
  const double start = bottom_of(machine, 0.0, call.number(1));
  const Point3 at = machine.position();
  const Slot slot{at.xy(), angle, positive(call.number(4), "kh_distance")};
  machine.expect_tool("keyhole", "cutKHgcdxf");
  machine.expect_number(tool_number(machine, call, 0));
  draw_keyhole(machine, tool_number(machine, call, 0), slot);
  if (at.z > start) machine.rapid_z(start);
  machine.cut_at(slot.entry, bottom);
  machine.cut_at(slot.end(), bottom);
  machine.cut_at(slot.entry, bottom);
  machine.cut(at);
}

void cutKHgcdxf(Machine& machine, Call& call) { cut_keyhole(machine, call, call.number(3)); }

void cutkeyholegcdxf(Machine& machine, Call& call) {
  static const std::vector<std::string> directions{"E", "N", "W", "S"};
  const std::size_t direction = choice(call.text(3), directions, "kht_direction");
  cut_keyhole(machine, call, 90.0 * static_cast<double>(direction));
}

void dxfKH(Machine& machine, Call& call) {
  const Point2 at = call.point2(1);
  draw_keyhole(machine, tool_number(machine, call, 0),
               {{coordinate(at.x, "oXpos"), coordinate(at.y, "oYpos")},
                coordinate(call.number(5), "kh_angle"),
                positive(call.number(6), "kh_distance")});
}

}  // namespace

RectangleSize rectangle_given(Call& call, std::size_t position, std::size_t size) {
  const Point2 low = call.point2(position);
  return {{coordinate(low.x, "x"), coordinate(low.y, "y")},
          positive(call.number(size), call.name(size)),
          positive(call.number(size + 1), call.command().parameters[size + 1].name)};
}

Outline rectangle_outline(const RectangleSize& size, Corners corners, double radius) {
  check_corners(size, radius);
  return outline_of(rectangle(size, corners, radius));
}

Corners corners_named(std::string_view name) {
  return static_cast<Corners>(choice(name, {"Square", "Fillet", "Chamfer", "Flipped Fillet"}, "corners"));
}

void draw_rectangle(Machine& machine, int tool_number, const RectangleSize& size, Corners corners,
                    double radius) {
  const double r = corners == Corners::square ? 0.0 : positive(radius, "radius");
  check_corners(size, r);
  machine.draw(tool_number, rectangle(size, corners, r));
}

void cut_rectangle_round(Machine& machine, const RectangleSize& size, double z, double r) {
  check_corners(size, r);
  const double x = size.low.x, y = size.low.y, u = x + size.width, v = y + size.height;
  const auto corner = [&](Point2 centre, double start) {
    machine.arc({centre, r, start, start + 90, 0.0, Turn::ccw});
  };
  machine.cut_at({x + r, y}, z);
  machine.cut_at({u - r, y}, z);
  corner({u - r, y + r}, 270);
  machine.cut_at({u, v - r}, z);
  corner({u - r, v - r}, 0);
  machine.cut_at({x + r, v}, z);
  corner({x + r, v - r}, 90);
  machine.cut_at({x, y + r}, z);
  corner({x + r, y + r}, 180);
}

double bottom_of(Machine& machine, double top, double depth) {
  if (depth < 0.0) machine.warn(fmt::format("zdepth counts downwards: {:g} is taken as {:g}", depth, -depth));
  return coordinate(top, "bz") - std::abs(coordinate(depth, "zdepth"));
}

namespace {
void add_keyhole_commands(Rows& rows) {
  rows.push_back(motion<cutkeyholegcdxf>(
      "cutkeyholegcdxf", "kh_tool_num, kh_start_depth, kh_max_depth, kht_direction, kh_distance",
      "A keyhole slot towards 'N', 'S', 'E' or 'W'; see cutKHgcdxf."));
  rows.push_back(motion<cutKHgcdxf>(
      "cutKHgcdxf", "kh_tool_num, kh_start_depth, kh_max_depth, kh_angle, kh_distance",
      "Plunge at the current point, traverse at an angle, and return to the entry and its "
      "height.\n"
      "\n"
      "The depths count downwards from Z0; the slot starts at `kh_start_depth` and is cut at "
      "`kh_max_depth`."));
  rows.push_back(tool_may_be_left_out(
      row<dxfKH>("dxfKH", "kh_tool_num, oXpos, oYpos, kh_start_depth, kh_max_depth, kh_angle, kh_distance",
                 "Draw a keyhole: the entry hole with the slot of the neck, and the neck's circle at the "
                 "entry."),
      6));
}
}  // namespace

void add_rectangle_commands(Rows& rows) {
  constexpr const char* kDrawn = "tool_num, xorigin, yorigin, xwidth, yheight, radius";
  const auto add = [&](Command command, std::size_t numbers) {
    rows.push_back(tool_may_be_left_out(std::move(command), numbers));
  };
  for (const char* name : {"dxfrectangle", "dxfrectanglelwp"})
    add(row<dxfrectangle>(
            name, "tool_num, xorigin, yorigin, xwidth, yheight, corners=\"Square\", radius=6",
            "A rectangle by its lower left corner; corners: Square, Fillet, Chamfer, Flipped Fillet."),
        4);
  add(row<dxfrectangle_with<Corners::fillet>>("dxfrectangleround", kDrawn,
                                              "Draw a rectangle with round corners."),
      5);
  add(row<dxfrectangle_with<Corners::chamfer>>("dxfrectanglechamfer", kDrawn,
                                               "Draw a rectangle with chamfered corners."),
      5);
  add(row<dxfrectangle_with<Corners::flipped_fillet>>(
          "dxfrectangleflippedfillet", kDrawn, "Draw a rectangle with corners that are rounded inwards."),
      5);
  constexpr const char* kCut = "tool_num, bx, by, bz, xwidth, yheight, zdepth, entry=\"plunge\", slot=0";
  add(motion<cutrectangle>("cutrectangle", kCut,
                           "Cut along a rectangle, `zdepth` mm (above 0) below `bz`.\n"
                           "\n"
                           "`entry` 'ramp': down along the outline, once around it; 'trochoidal': by loops "
                           "within a slot of the width\n"
                           "`slot`, mm; 0: 1.5 times the diameter of the tool."),
      6);
  add(motion<cutrectangledxf>("cutrectangledxf", kCut, "As cutrectangle, and the rectangle in the drawing."),
      6);
  constexpr const char* kRound = "tool_num, bx, by, bz, xwidth, yheight, zdepth, radius";
  add(motion<cutrectangleround>(
          "cutrectangleround", kRound,
          "Cut along a rectangle with round corners, `zdepth` mm (above 0) below `bz`."),
      7);
  add(motion<cutrectanglerounddxf>("cutrectanglerounddxf", kRound,
                                   "As cutrectangleround, and the rectangle in the drawing."),
      7);
  add_keyhole_commands(rows);
}

}  // namespace kerf::design
