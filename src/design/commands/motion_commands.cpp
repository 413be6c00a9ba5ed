// Rapids and straight cuts.
#include <fmt/format.h>

#include "design/commands/entities.h"
#include "design/commands/rows.h"

#include "kerf/base/limits.h"

namespace kerf::design {
namespace {

/// The end of a motion whose first arguments are the axes of `axes`: "XZ" has X and Z.
template <char... axes>
Point3 end_of(const Machine& machine, Call& call) {
  Point3 end = machine.position();
  std::size_t i = 0;
  ((end[axes - 'X'] = call.number(i++)), ...);
  return end;
}

template <char... axes>
void rapid(Machine& machine, Call& call) {
  machine.rapid(end_of<axes...>(machine, call));
}
template <char... axes>
void cut(Machine& machine, Call& call) {
  machine.cut(end_of<axes...>(machine, call));
}
template <char... axes>
void cut_with_feed(Machine& machine, Call& call) {
  machine.cut(end_of<axes...>(machine, call), call.number(sizeof...(axes)));
}

void rapid_or_reposition(Machine& machine, Call& call) {
  const Point3 to = call.point3(0);
  if (call[3].is_true())
    machine.reposition(to);
  else
    machine.rapid(to);
}
void setlaserpower(Machine& machine, Call& call) {
  const double power = not_negative(call.number(0), "power");
  if (power > limits::kMaxSpeed)
    refuse(fmt::format("power is at most {:g}, not {:g}", limits::kMaxSpeed, power));
  const bool dynamic = choice(call.text(1), {"dynamic", "constant"}, "mode") == 0;
  machine.set_beam({dynamic ? LaserMode::dynamic : LaserMode::constant, power});
}
void movetosafeZ(Machine& machine, Call&) { machine.move_to_safe_z(); }

void cutline(Machine& machine, Call& call) { machine.cut(call.point3(0), call.optional_number(3)); }
void cutlinedxf(Machine& machine, Call& call) { cut_and_draw(machine, call.point3(0)); }
void cutvertexdxf(Machine& machine, Call& call) { cut_vertex(machine, call.point3(0)); }

void moveatfeedrate(Machine& machine, Call& call) {
  const Point3 to = call.point3(0);
  machine.print.feed = positive(call.number(3), "f");
  machine.cut(to, machine.print.feed);
}

void begintoolpath(Machine& machine, Call& call) {
  const Point3 start = call.point3(0);
  machine.move_to_safe_z();
  machine.note("PREPOSITION FOR RAPID PLUNGE");
  machine.rapid_xy(start.xy());
  machine.rapid_z(start.z);
}
void endtoolpath(Machine& machine, Call&) { machine.lift(); }

void cutoneaxis(Machine& machine, Call& call) {
  const std::string axis = call.text(0);
  const double feed = positive(call.number(2), "feed");
  if (axis != "X" && axis != "Y" && axis != "Z") refuse("axis must be \"X\", \"Y\" or \"Z\"");
  (axis == "Z" ? machine.plunge : machine.feed) = feed;
  Point3 end = machine.position();
  end[axis[0] - 'X'] = call.number(1);
  machine.cut(end, feed);
}

/// Cuts that are described but not run: no step is added.
void movement(Machine&, Call& call) {
  call.point3(0);
  call.point3(3);
}

void setrotary(Machine& machine, Call& call) { machine.rotary = call.optional_number(0); }

constexpr const char* kEnd = "ex, ey, ez";

void add_rapids(Rows& rows) {
  rows.push_back(motion<rapid_or_reposition>(
      "rapid", "ex, ey, ez, laser=0",
      "Move at rapid speed. With a `laser` other than 0 the tool is off: a mill passes above "
      "the material, at the retract height."));
  rows.push_back(motion<rapid<'X', 'Y', 'Z'>>("rapidXYZ", kEnd, "Move at rapid speed in X, Y and Z."));
  rows.push_back(motion<rapid<'X', 'Y'>>("rapidXY", "ex, ey", "Move at rapid speed in X and Y."));
  rows.push_back(motion<rapid<'X', 'Z'>>("rapidXZ", "ex, ez", "Move at rapid speed in X and Z."));
  rows.push_back(motion<rapid<'Y', 'Z'>>("rapidYZ", "ey, ez", "Move at rapid speed in Y and Z."));
  rows.push_back(motion<rapid<'X'>>("rapidX", "ex", "Move at rapid speed in X."));
  rows.push_back(motion<rapid<'Y'>>("rapidY", "ey", "Move at rapid speed in Y."));
  rows.push_back(motion<rapid<'Z'>>("rapidZ", "ez", "Move at rapid speed in Z."));
  rows.push_back(motion<movetosafeZ>("movetosafeZ", "", "Move up to the retract height."));
}

void add_cuts_by_axes(Rows& rows) {
  rows.push_back(motion<cut<'X', 'Y', 'Z'>>("cutlineXYZ", kEnd, "Cut a straight line in X, Y and Z."));
  rows.push_back(motion<cut<'X', 'Y'>>("cutlineXY", "ex, ey", "Cut a straight line in X and Y."));
  rows.push_back(motion<cut<'X', 'Z'>>("cutlineXZ", "ex, ez", "Cut a straight line in X and Z."));
  rows.push_back(motion<cut<'Y', 'Z'>>("cutlineYZ", "ey, ez", "Cut a straight line in Y and Z."));
  rows.push_back(motion<cut<'X'>>("cutlineX", "ex", "Cut a straight line in X."));
  rows.push_back(motion<cut<'Y'>>("cutlineY", "ey", "Cut a straight line in Y."));
  rows.push_back(motion<cut<'Z'>>("cutlineZ", "ez", "Cut a straight line in Z."));
  rows.push_back(motion<cut_with_feed<'X', 'Y', 'Z'>>(
      "cutlineXYZwithfeed", "ex, ey, ez, feed", "Cut a straight line in X, Y and Z with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'X', 'Y'>>("cutlineXYwithfeed", "ex, ey, feed",
                                                 "Cut a straight line in X and Y with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'X', 'Z'>>("cutlineXZwithfeed", "ex, ez, feed",
                                                 "Cut a straight line in X and Z with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'Y', 'Z'>>("cutlineYZwithfeed", "ey, ez, feed",
                                                 "Cut a straight line in Y and Z with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'X'>>("cutlineXwithfeed", "ex, feed",
                                            "Cut a straight line in X with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'Y'>>("cutlineYwithfeed", "ey, feed",
                                            "Cut a straight line in Y with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'Z'>>("cutlineZwithfeed", "ez, feed",
                                            "Cut a straight line in Z with a feed, mm/min."));
  rows.push_back(
      motion<cut_with_feed<'Z'>>("cutlineZgcfeed", "ez, feed", "Cut in Z alone with a feed, mm/min."));
  rows.push_back(motion<cut_with_feed<'X', 'Y', 'Z'>>("cutwithfeed", "ex, ey, ez, feed",
                                                      "Cut a straight line with a feed, mm/min."));
}

}  // namespace

void add_motion_commands(Rows& rows) {
  add_rapids(rows);
  rows.push_back(
      motion<cutline>("cutline", "ex, ey, ez, feed=undef",
                      "Cut a straight line from the current position; the feed is that of the tool unless "
                      "given, mm/min."));
  rows.push_back(motion<cut<'X', 'Y', 'Z'>>("cutlinegc", kEnd, "As cutline."));
  rows.push_back(motion<cutlinedxf>("cutlinedxf", kEnd, "As cutline, and the line in the drawing."));
  rows.push_back(motion<cutlinedxf>("cutlinedxfgc", kEnd, "As cutlinedxf."));
  rows.push_back(motion<cutvertexdxf>(
      "cutvertexdxf", kEnd, "As cutline, and a vertex of the polyline started with beginpolyline."));
  rows.push_back(motion<cutvertexdxf>("cutvertexdxfgc", kEnd, "As cutvertexdxf."));
  rows.push_back(motion<cutvertexdxf>("cutpolylinedxf", kEnd, "As cutvertexdxf."));
  add_cuts_by_axes(rows);
  rows.push_back(motion<moveatfeedrate>("moveatfeedrate", "ex, ey, ez, f",
                                        "Move at a feed, which later extruding motions keep."));
  rows.push_back(motion<begintoolpath>(
      "begintoolpath", kEnd,
      "Position for a plunge: the retract height, a rapid above the point, a rapid down to it."));
  rows.push_back(motion<endtoolpath>("endtoolpath", "", "Move up to the retract height."));
  rows.push_back(motion<cutoneaxis>(
      "cutoneaxis_setfeed", "axis, depth, feed",
      "Cut along one axis, 'X', 'Y' or 'Z', to a position, and keep the feed for the following "
      "cuts."));
  rows.push_back(row<movement>(
      "toolmovement", "bx, by, bz, ex, ey, ez, step=0",
      "A cut between two points as a list of one `Move`, which is not run: no step is appended."));
  rows.push_back(row<movement>("shaftmovement", "bx, by, bz, ex, ey, ez",
                               "As toolmovement, for the shaft: what it touches is a hazard of `simulate`."));
  rows.push_back(row<setlaserpower>(
      "setlaserpower", "power, mode=\"dynamic\"",
      "Set the power of a laser, in the units of the S word, for the following cuts; 0: no laser.\n"
      "\n"
      "The beam is on during cuts alone. With the mode 'dynamic' (M4) the controller scales the power with "
      "the "
      "speed,\n"
      "with 'constant' (M3) it does not. The post must be one for lasers: `gcp.post = \"laser\"`."));
  rows.push_back(
      row<setrotary>("setrotary", "a",
                     "The angle of the A axis, degrees, at the end of the following motions; None: they have "
                     "no A word.\n"
                     "\n"
                     "The post must have an A axis: `gcp.post = \"linuxcnc\"`."));
}

}  // namespace kerf::design
