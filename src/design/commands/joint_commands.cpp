// Joints: half-blind dovetails, finger joints and full-blind box joints.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/names.h"
#include "design/commands/entities.h"
#include "design/commands/rows.h"

#include "kerf/base/limits.h"

namespace kerf::design {
namespace {

constexpr double kPitch = 1.1;      // distance of fingers as a multiple of the smaller tool's diameter
constexpr double kSpeed = 17000.0;  // rpm
constexpr int kMaxParts = 10'000;   // dovetails or pins of a joint

// ---- half-blind dovetails

/// The figures of a dovetail joint, mm.
struct Dovetail {
  double width = 0.0, thickness = 0.0, spacing = 0.0, diameter = 0.0, fit = 0.0;
  int count = 1;
  double depth = 0.0, taper = 0.0;
  double neck = 0.0;  // radius of the tool at the surface
  double step = 0.0;  // half of the distance of dovetails

  /// Distance of the tool's axis from the centre of a tail.
  double tail_radius() const { return diameter - taper - fit; }
  double centre(int i) const { return (2 * i + 1) * step; }
  double boundary(int i) const { return (2 * i + 2) * step; }
};

/// Refuses joints of which one board cannot be cut, for both commands alike.
void check_boards(const Dovetail& j) {
  if (j.fit >= std::min(j.neck, j.depth - j.taper))
    refuse(fmt::format("fit: a tail with a clearance of {:g} mm on each side has no material left", j.fit));
  if (j.tail_radius() > j.step)
    refuse(fmt::format("Number_of_Dovetails: the tool does not fit between {} tails", j.count));
  const double lost = (j.diameter - j.spacing) / 2;  // of the pins, by the groove before them
  if (lost >= j.depth + std::min(j.fit, 0.0))
    refuse(fmt::format("Spacing: the groove between the boards, {:g} mm wide, leaves nothing of the pins",
                       j.diameter));
}

/// Joint_Width, stockZthickness, Number_of_Dovetails, Spacing, Proportion, DTT_diameter, DTT_angle, fit
Dovetail dovetail_given(Call& call) {
  Dovetail j;
  j.width = positive(call.number(0), "Joint_Width");
  j.thickness = positive(call.number(1), "stockZthickness");
  j.count = whole(call.number(2), "Number_of_Dovetails", 1, kMaxParts);
  j.spacing = positive(call.number(3), "Spacing");
  const double proportion = positive(call.number(4), "Proportion");
  if (proportion >= 1.0)
    refuse(fmt::format("Proportion of a half-blind joint is below 1, not {:g}", proportion));
  j.diameter = positive(call.number(5), "DTT_diameter");
  const double angle = positive(call.number(6), "DTT_angle");
  j.fit = coordinate(call.number(7), "fit");
  j.depth = j.thickness * proportion;
  j.taper = angle < 90.0 ? std::tan(degrees(angle).rad()) * j.depth : j.diameter;
  j.neck = j.diameter / 2 - j.taper;
  if (j.neck <= 0.0) refuse(fmt::format("DTT_angle: at {:g} mm depth the tool has no neck left", j.depth));
  j.step = j.width / (2 * j.count);
  check_boards(j);
  return j;
}

/// Refuses sizes that are not those of the tool in use, if it is a dovetail.
void check_dovetail_tool(Machine& machine, const Dovetail& j, std::string_view command) {
  constexpr double kEqual = 0.02;  // mm: the rounding of makers' tables
  machine.expect_tool("dovetail", command);
  if (machine.tool().shape() != "dovetail") return;
  const Tool& tool = machine.tool().tool;
  const double tip = machine.tool().diameter();
  if (std::abs(tip - j.diameter) > kEqual)
    refuse(fmt::format("DTT_diameter: the tool in use has {:g} mm, not {:g} mm", tip, j.diameter));
  if (j.depth > tool.silhouette.cutting.knots.back().z + kEqual)
    refuse(fmt::format("Proportion: the tool in use does not cut {:g} mm deep", j.depth));
  if (std::abs(diameter_at(tool, j.depth) - 2 * j.neck) > 2 * kEqual)
    refuse(
        fmt::format("DTT_angle: {:g} mm above its tip the tool in use has a diameter of {:g} mm, not {:g} mm",
                    j.depth, diameter_at(tool, j.depth), 2 * j.neck));
}

void cut_pins(Machine& machine, Call& call) {
  const Dovetail j = dovetail_given(call);
  const int tool = machine.tool().given;
  check_dovetail_tool(machine, j, call.command().name);
  const double z = -j.depth, row = j.thickness + j.spacing / 2;
  const double end = j.thickness + j.spacing + j.depth - j.diameter / 2 + j.fit;
  machine.rapid_xy({0.0, row});
  cut_and_draw(machine, {0.0, row, z});
  for (int i = 0; i < j.count; ++i) {
    const double x = j.centre(i);
    cut_and_draw(machine, {x, row, z});
    cut_and_draw(machine, {x, end, z});
    cut_and_draw(machine, {x, row, z});
    cut_and_draw(machine, {j.boundary(i), row, z});
    const double height = j.depth + j.spacing / 2 + 2 * j.neck - j.diameter / 2 + j.fit;
    draw_rectangle(machine, tool, {{x - j.neck, row - j.neck}, 2 * j.neck, positive(height, "yheight")},
                   Corners::fillet, j.neck);
  }
  machine.rapid_z(0.0);
}

/// The closed outline of the tails: round ends of the width between two sockets.
void draw_tails(Machine& machine, const Dovetail& j) {
  const double r = j.step - j.neck, y = j.depth - j.diameter / 2;
  const double bulge = -std::tan(degrees(22.5).rad());
  for (int i = 0; i < j.count; ++i) {
    const double x = j.centre(i);
    drawing::Polyline tail;
    tail.closed = true;
    tail.vertices = {
        {x - r, 0, 0, 0}, {x - r, y, bulge, 0}, {x, y + r, bulge, 0}, {x + r, y, 0, 0}, {x + r, 0, 0, 0}};
    machine.draw(machine.tool().given, std::move(tail));
  }
}

/// Positions of passes in X, from the side of a tail on to the boundary of the next one.
struct Flank {
  double tail = 0.0, boundary = 0.0;  // of the tool's axis
  double round = 0.0;                 // how far the pass around the end of the tail withdraws from `tail`
};
/// Passes between two that are so far from each other that the neck of the tool leaves a rib.
std::vector<double> passes_between(const Dovetail& j, const Flank& flank) {
  const double sense = flank.boundary > flank.tail ? 1.0 : -1.0;
  const double span = std::abs(flank.boundary - flank.tail) + flank.round;
  const double count = std::ceil(span / (2 * j.neck)) - 1;
  if (count > kMaxParts)
    refuse(fmt::format("Number_of_Dovetails: more than {} passes between two tails", kMaxParts));
  std::vector<double> passes;
  for (double k = 1; k <= count; ++k)
    passes.push_back(flank.tail + sense * std::max(0.0, span * k / (count + 1) - flank.round));
  return passes;
}

/// Between the tails, which are `radius` from the tool's axis, and along the back of the sockets.
void clean_sockets(Machine& machine, const Dovetail& j, double radius) {
  // In thin boards further away, so that it does not shorten the tails.
  const double z = -j.depth, back = std::max(j.thickness + j.taper, j.depth + j.neck - j.fit);
  // Of the pass around a tail's end, up to what the one along the back removes.
  const double up = std::clamp(back - j.neck - (j.depth - j.diameter / 2), 0.0, radius);
  const double round = radius - std::sqrt(radius * radius - up * up);
  const auto clear = [&](const std::vector<double>& passes) {
    for (const double x : passes) {
      machine.cut({x, back, z});
      machine.cut({x, 0.0, z});
      machine.cut({x, back, z});
    }
  };
  machine.rapid_z(0.0);
  machine.rapid_xy({0.0, 0.0});
  machine.cut({0.0, 0.0, z});
  machine.cut({0.0, back, z});
  for (int i = 0; i < j.count; ++i) {
    clear(passes_between(j, {j.centre(i) - radius, j.boundary(i) - 2 * j.step, round}));
    clear(passes_between(j, {j.centre(i) + radius, j.boundary(i), round}));
    machine.cut({j.boundary(i), back, z});
    machine.cut({j.boundary(i), 0.0, z});
    if (i + 1 < j.count) machine.cut({j.boundary(i), back, z});
  }
  // Beyond the ends of the tails, where the back is further away than the neck of the tool is wide.
  const double end = j.depth - j.diameter / 2 + radius;
  const double rows = std::ceil((back - end) / j.neck) - 1;
  if (rows > kMaxParts)
    refuse(fmt::format("stockZthickness: more than {} passes behind the tails", kMaxParts));
  bool from_end = true;
  for (double k = 1; k <= rows; ++k, from_end = !from_end) {
    const double y = end + (back - end) * k / (rows + 1);
    machine.cut({from_end ? j.width : 0.0, y, z});
    machine.cut({from_end ? 0.0 : j.width, y, z});
  }
}

void cut_tails(Machine& machine, Call& call) {
  const Dovetail j = dovetail_given(call);
  const double z = -j.depth, top = j.depth - j.diameter / 2;
  const double radius = j.tail_radius();
  check_dovetail_tool(machine, j, call.command().name);
  machine.rapid_xy({0.0, 0.0});
  cut_and_draw(machine, {0.0, 0.0, z});
  for (int i = 0; i < j.count; ++i) {
    const double x = j.centre(i);
    cut_and_draw(machine, {x - radius, 0.0, z});
    cut_and_draw(machine, {x - radius, top, z});
    cut_and_draw_arc(machine, {{x, top}, radius, 180, 90, 0.0, Turn::cw});
    cut_and_draw_arc(machine, {{x, top}, radius, 90, 0, 0.0, Turn::cw});
    cut_and_draw(machine, {x + radius, 0.0, z});
    cut_and_draw(machine, {j.boundary(i) + j.step - radius, 0.0, z});
  }
  clean_sockets(machine, j, radius);
  draw_tails(machine, j);
}

// ---- full-blind box joints

enum class BoardSide : unsigned char { first, second, both };

/// The figures of a box joint, mm.
struct BoxJoint {
  Point2 corner;
  bool vertical = false;
  BoardSide side = BoardSide::both;
  double width = 0.0, thickness = 0.0, small = 0.0;
  int pins = 1;
  double origin = 0.0;  // of the fingers along the joint
  bool odd = false;

  /// A position along the joint and across it. Left is -X and Lower is -Y of the line of the joint.
  Point2 at(double along, double across) const {
    return vertical ? Point2{corner.x + across, corner.y + along}
                    : Point2{corner.x + along, corner.y + across};
  }
  double sign() const { return side == BoardSide::second ? -1.0 : 1.0; }
  /// The side of the line on which slot i is.
  double direction(int i) const {
    if (side != BoardSide::both) return sign();
    return (i % 2 == 0) != odd ? 1.0 : -1.0;
  }
  bool cuts(int i) const { return side == BoardSide::both || (i % 2 == 1) == odd; }
};

/// The indices of the arguments of a joint that differ between commands.
struct BoxArguments {
  std::optional<std::size_t> pins, large_diameter;
  std::size_t small_diameter = 0, mirror = 0;
};

/// bx, by, orientation, side, width, thickness, and those of `where`.
BoxJoint box_joint_given(Call& call, const BoxArguments& where) {
  BoxJoint j;
  j.corner = call.point2(0);
  j.vertical = choice(call.text(2), {"Vertical", "Horizontal"}, "orientation") == 0;
  const std::vector<std::string> sides = j.vertical ? std::vector<std::string>{"Left", "Right", "Both"}
                                                    : std::vector<std::string>{"Lower", "Upper", "Both"};
  j.side = static_cast<BoardSide>(choice(call.text(3), sides, "side"));
  j.width = positive(call.number(4), "width");
  j.thickness = positive(call.number(5), "thickness");
  j.small = positive(call.number(where.small_diameter), "smallDiameter");
  if (where.large_diameter) positive(call.number(*where.large_diameter), "largeVdiameter");
  // The joint's line and the round ends of the slots take a radius each: what is between them holds.
  if (j.thickness <= 1.5 * j.small)
    refuse(fmt::format("smallDiameter: the boards must be thicker than {:g} mm", 1.5 * j.small));
  const double pairs = std::trunc((j.width - 2 * j.thickness) / (2 * kPitch * j.small) / 2);
  j.pins = where.pins ? whole(call.number(*where.pins), "Number_of_Pins", 1, kMaxParts)
                      : whole(pairs * 2 + 1, "the number of pins", 1, kMaxParts);
  const double fingers = (2 * j.pins - 1) * j.small * kPitch;
  if (fingers > j.width) refuse(fmt::format("Number_of_Pins: {} pins are longer than the joint", j.pins));
  j.origin = j.width / 2 - fingers / 2;
  const std::size_t kind = choice(call.text(where.mirror), {"Default", "Even", "Odd"}, "normalormirror");
  j.odd = kind == 2 || (kind == 0 && j.side == BoardSide::second);
  return j;
}

/// The colour of the following entities, and that before it at the end of its life.
class Coloured {
 public:
  Coloured(Machine& machine, std::string_view name) : machine_(machine), before_(machine.colour) {
    machine.set_colour(name);
  }
  ~Coloured() { machine_.colour = before_; }
  Coloured(const Coloured&) = delete;
  Coloured& operator=(const Coloured&) = delete;

 private:
  Machine& machine_;
  DrawingColour before_;
};

/// A straight groove along the joint at a distance from its line.
struct Groove {
  const char* colour;
  double start = 0.0, end = 0.0, across = 0.0, depth = 0.0;
};
void cut_groove(Machine& machine, const BoxJoint& j, const Groove& groove) {
  const Coloured coloured(machine, groove.colour);
  const Point2 start = j.at(groove.start, groove.across), end = j.at(groove.end, groove.across);
  machine.rapid_z(0.0);
  machine.rapid_xy(start);
  machine.cut_at(start, -groove.depth);
  cut_and_draw(machine, {end.x, end.y, -groove.depth});
  machine.rapid_z(0.0);
}

/// Slots across the joint line, on one side of it or on both in turns.
void cut_fingers(Machine& machine, const BoxJoint& j, double origin, double fit) {
  const double low = j.small * (1 - kPitch), high = j.small * kPitch;
  if (fit < low || fit >= high)
    refuse(fmt::format("fit must be from {:g} to below {:g} mm with a tool of {:g} mm, not {:g}", low, high,
                       j.small, fit));
  const Coloured coloured(machine, "Blue");
  const double s = j.small, gap = s / 10 + fit, reach = j.thickness - s, z = -(j.thickness - s / 2);
  const int tool = machine.tool().given, slots = 2 * j.pins - 1;
  const double pitch = s * kPitch;
  const Point2 start = j.at(origin, 0.0);
  machine.rapid_xy(start);
  machine.rapid_z(0.0);
  machine.cut_at(start, z);
  start_polyline(machine);
  add_vertex(machine, start);
  const auto vertex = [&](double along, double across) {
    const Point2 p = j.at(along, across);
    cut_vertex(machine, {p.x, p.y, z});
  };
  for (int i = 0; i < slots; ++i) {
    if (!j.cuts(i)) continue;
    const double first = origin + i * pitch + s / 2 - (gap - s / 10) / 2, up = reach * j.direction(i);
    vertex(first, 0.0);
    vertex(first, up);
    vertex(first + gap, up);
    vertex(first + gap, 0.0);
  }
  vertex(origin + slots * pitch, 0.0);
  close_polyline(machine, tool);
  machine.lift();
}

/// The fingers and the frame around them, with the square tool.
void cut_square_part(Machine& machine, const BoxJoint& j, double fit) {
  cut_fingers(machine, j, j.origin, fit);
  machine.lift();
  const Coloured coloured(machine, "Cyan");
  const double s = j.small, t = j.thickness;
  const double low = j.side == BoardSide::first ? -s / 2 : -(t - s / 2);
  const double across = j.side == BoardSide::both ? 2 * t - s : t;
  const Point2 a = j.at(-s / 2, low), b = j.at(j.width + s / 2, low + across);
  const RectangleSize frame{
      {std::min(a.x, b.x), std::min(a.y, b.y)}, std::abs(b.x - a.x), std::abs(b.y - a.y)};
  machine.rapid_xy({frame.low.x + s / 2, frame.low.y});
  machine.rapid_z(0.0);
  cut_rectangle_round(machine, frame, -s / 2, s / 2);
  draw_rectangle(machine, machine.tool().given, frame, Corners::fillet, s / 2);
  machine.lift();
}

/// The line of the joint to its full depth, with the small V.
void cut_small_v_part(Machine& machine, const BoxJoint& j) {
  cut_groove(machine, j, {"Red", -j.small / 6, j.width + j.small / 6, 0.0, j.thickness});
}

/// The mitres, with the large V: the ends of the line to full depth, the edges, and the ends of the boards.
void cut_large_v_part(Machine& machine, const BoxJoint& j) {
  const double s = j.small, t = j.thickness, w = j.width;
  cut_groove(machine, j, {"Blue", 0.0, j.origin, 0.0, t});
  cut_groove(machine, j, {"Blue", w - j.origin, w, 0.0, t});
  for (const double sign : {1.0, -1.0}) {
    if (j.side != BoardSide::both && sign != j.sign()) continue;
    cut_groove(machine, j, {"Dark Gray", -s / 2, w + s / 2, sign * (t - s / 2), s / 2});
    cut_groove(machine, j, {"Green", w, w - t, sign * t / 2, t / 2});
    cut_groove(machine, j, {"Green", 0.0, t, sign * t / 2, t / 2});
  }
}

// bx, by, orientation, side, width, thickness, Number_of_Pins, largeVdiameter, smallDiameter, normalormirror
constexpr BoxArguments kPart{6, 7, 8, 9};

void full_blind_square(Machine& machine, Call& call) {
  cut_square_part(machine, box_joint_given(call, kPart), coordinate(call.number(10), "fit"));
}
void full_blind_small_v(Machine& machine, Call& call) {
  cut_small_v_part(machine, box_joint_given(call, kPart));
}
void full_blind_large_v(Machine& machine, Call& call) {
  cut_large_v_part(machine, box_joint_given(call, kPart));
}
/// ... Number_of_Pins, Finger_Origin, smallDiameter, normalormirror, fit
void finger_joint_square(Machine& machine, Call& call) {
  const BoxJoint j = box_joint_given(call, {6, {}, 8, 9});
  const double origin = coordinate(call.number(7), "Finger_Origin");
  const double fingers = j.width - 2 * j.origin;
  if (origin < -kFar || origin + fingers > j.width + kFar)
    refuse(fmt::format("Finger_Origin: fingers from {:g} to {:g} mm are not within the joint, 0 to {:g} mm",
                       origin, origin + fingers, j.width));
  cut_fingers(machine, j, origin, coordinate(call.number(10), "fit"));
}
/// ... largeVdiameter, smallDiameter, normalormirror, squaretool, smallV, largeV, fit
void full_blind_joint(Machine& machine, Call& call) {
  const BoxJoint j = box_joint_given(call, {{}, 6, 7, 8});
  const double reach = call.number(6) / 2, fit = coordinate(call.number(12), "fit");
  if (reach < j.thickness)
    machine.warn(fmt::format("largeVdiameter: a 90 degree V of {:g} mm cuts {:g} mm deep, not {:g} mm",
                             2 * reach, reach, j.thickness));
  const auto change = [&](std::size_t argument) {
    machine.lift();
    machine.change_tool(tool_number(machine, call, argument), kSpeed);
  };
  change(9);
  cut_square_part(machine, j, fit);
  change(10);
  cut_small_v_part(machine, j);
  change(11);
  cut_large_v_part(machine, j);
  machine.lift();
}

}  // namespace

void add_joint_commands(Rows& rows) {
  constexpr const char* kDovetail =
      "Joint_Width, stockZthickness, Number_of_Dovetails, Spacing, Proportion, DTT_diameter, DTT_angle, "
      "fit=0";
  rows.push_back(
      motion<cut_pins>("cut_pins", kDovetail,
                       "The pin board of a half-blind dovetail joint, cut with the dovetail tool in use.\n"
                       "\n"
                       "`fit` is the clearance of the joint, mm: the sockets are lengthened by it."));
  rows.push_back(motion<cut_tails>(
      "cut_tails", kDovetail,
      "The tail board of a half-blind dovetail joint, cut with the dovetail tool in use.\n"
      "\n"
      "`fit` is the clearance of the joint, mm: the tails are narrower by it on each side."));
  rows.push_back(motion<full_blind_joint>(
      "Full_Blind_Finger_Joint",
      "bx, by, orientation, side, width, thickness, largeVdiameter, "
      "smallDiameter, normalormirror=\"Default\", "
      "squaretool=102, smallV=390, largeV=301, fit=0",
      "A full-blind box joint with its three tools: a square tool, a small and a large V."));
  rows.push_back(motion<full_blind_square>(
      "Full_Blind_Finger_Joint_square",
      "bx, by, orientation, side, width, thickness, Number_of_Pins, largeVdiameter, smallDiameter, "
      "normalormirror=\"Default\", fit=0",
      "The fingers and the frame around them, with the square tool."));
  rows.push_back(motion<finger_joint_square>(
      "Finger_Joint_square",
      "bx, by, orientation, side, width, thickness, Number_of_Pins, Finger_Origin, smallDiameter, "
      "normalormirror=\"Default\", fit=0",
      "The fingers of a joint: slots across the joint line, on one side of it or on both in "
      "turns.\n"
      "\n"
      "`fit` is the clearance of the joint, mm: each slot is wider by it."));
  constexpr const char* kV =
      "bx, by, orientation, side, width, thickness, Number_of_Pins, largeVdiameter, smallDiameter, "
      "normalormirror=\"Default\"";
  rows.push_back(motion<full_blind_small_v>("Full_Blind_Finger_Joint_smallV", kV,
                                            "The line of the joint to its full depth, with the small V."));
  rows.push_back(motion<full_blind_large_v>(
      "Full_Blind_Finger_Joint_largeV", kV,
      "The mitres: the ends of the line to full depth, the edges, and the ends of the boards, "
      "with the\n"
      "large V."));
}

}  // namespace kerf::design
