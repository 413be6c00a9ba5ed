// Rapids and straight cuts.
#include "front/scad/commands/bindings.h"
#include "front/scad/commands/entities.h"

namespace kerf::scad {
namespace {

/// The end of a motion whose first arguments are the axes of `axes`: "XZ" has X and Z.
template <char... axes>
Point3 end_of(const MachineState& machine, Call& call) {
  Point3 end = machine.position();
  std::size_t i = 0;
  ((end[axes - 'X'] = number(call, i++)), ...);
  return end;
}

template <char... axes>
void rapid(MachineState& machine, Call& call) {
  machine.rapid(end_of<axes...>(machine, call));
}
template <char... axes>
void cut(MachineState& machine, Call& call) {
  machine.cut(end_of<axes...>(machine, call));
}
template <char... axes>
void cut_with_feed(MachineState& machine, Call& call) {
  machine.cut(end_of<axes...>(machine, call), number(call, sizeof...(axes)));
}

void rapid_or_beamless(MachineState& machine, Call& call) {
  machine.rapid(point3(call, 0), call[3].is_true() ? Beam::off : Beam::as_it_is);
}
void movetosafeZ(MachineState& machine, Call&) { machine.move_to_safe_z(); }

void cutline(MachineState& machine, Call& call) { machine.cut(point3(call, 0), optional_number(call, 3)); }
void cutlinedxf(MachineState& machine, Call& call) { cut_and_draw(machine, point3(call, 0)); }
void cutvertexdxf(MachineState& machine, Call& call) { cut_vertex(machine, point3(call, 0)); }

void moveatfeedrate(MachineState& machine, Call& call) {
  const Point3 to = point3(call, 0);
  machine.print.feed = positive(number(call, 3), "f");
  machine.cut(to, machine.print.feed);
}

void begintoolpath(MachineState& machine, Call& call) {
  const Point3 start = point3(call, 0);
  machine.move_to_safe_z();
  machine.note("PREPOSITION FOR RAPID PLUNGE");
  machine.rapid_xy(start.xy());
  machine.rapid_z(start.z);
}
void endtoolpath(MachineState& machine, Call&) { machine.lift(); }

void cutoneaxis(MachineState& machine, Call& call) {
  const std::string axis = text(call, 0);
  const double feed = positive(number(call, 2), "feed");
  if (axis != "X" && axis != "Y" && axis != "Z") refuse("axis must be \"X\", \"Y\" or \"Z\"");
  (axis == "Z" ? machine.plunge : machine.feed) = feed;
  Point3 end = machine.position();
  end[axis[0] - 'X'] = number(call, 1);
  machine.cut(end, feed);
}

/// Cuts that are described but not run: no step is added.
void movement(MachineState&, Call& call) {
  point3(call, 0);
  point3(call, 3);
}

void setrotary(MachineState& machine, Call& call) { machine.rotary = optional_number(call, 0); }

constexpr const char* kEnd = "ex, ey, ez";

void add_rapids(Rows& rows) {
  rows.push_back(row<rapid_or_beamless>("rapid", "ex, ey, ez, laser=0"));
  rows.push_back(row<rapid<'X', 'Y', 'Z'>>("rapidXYZ", kEnd));
  rows.push_back(row<rapid<'X', 'Y'>>("rapidXY", "ex, ey"));
  rows.push_back(row<rapid<'X', 'Z'>>("rapidXZ", "ex, ez"));
  rows.push_back(row<rapid<'Y', 'Z'>>("rapidYZ", "ey, ez"));
  rows.push_back(row<rapid<'X'>>("rapidX", "ex"));
  rows.push_back(row<rapid<'Y'>>("rapidY", "ey"));
  rows.push_back(row<rapid<'Z'>>("rapidZ", "ez"));
  rows.push_back(row<movetosafeZ>("movetosafeZ", ""));
}

void add_cuts_by_axes(Rows& rows) {
  rows.push_back(row<cut<'X', 'Y', 'Z'>>("cutlineXYZ", kEnd));
  rows.push_back(row<cut<'X', 'Y'>>("cutlineXY", "ex, ey"));
  rows.push_back(row<cut<'X', 'Z'>>("cutlineXZ", "ex, ez"));
  rows.push_back(row<cut<'Y', 'Z'>>("cutlineYZ", "ey, ez"));
  rows.push_back(row<cut<'X'>>("cutlineX", "ex"));
  rows.push_back(row<cut<'Y'>>("cutlineY", "ey"));
  rows.push_back(row<cut<'Z'>>("cutlineZ", "ez"));
  rows.push_back(row<cut_with_feed<'X', 'Y', 'Z'>>("cutlineXYZwithfeed", "ex, ey, ez, feed"));
  rows.push_back(row<cut_with_feed<'X', 'Y'>>("cutlineXYwithfeed", "ex, ey, feed"));
  rows.push_back(row<cut_with_feed<'X', 'Z'>>("cutlineXZwithfeed", "ex, ez, feed"));
  rows.push_back(row<cut_with_feed<'Y', 'Z'>>("cutlineYZwithfeed", "ey, ez, feed"));
  rows.push_back(row<cut_with_feed<'X'>>("cutlineXwithfeed", "ex, feed"));
  rows.push_back(row<cut_with_feed<'Y'>>("cutlineYwithfeed", "ey, feed"));
  rows.push_back(row<cut_with_feed<'Z'>>("cutlineZwithfeed", "ez, feed"));
  rows.push_back(row<cut_with_feed<'Z'>>("cutlineZgcfeed", "ez, feed"));
  rows.push_back(row<cut_with_feed<'X', 'Y', 'Z'>>("cutwithfeed", "ex, ey, ez, feed"));
}

}  // namespace

void add_motion_commands(Rows& rows) {
  add_rapids(rows);
  rows.push_back(row<cutline>("cutline", "ex, ey, ez, feed=undef"));
  rows.push_back(row<cut<'X', 'Y', 'Z'>>("cutlinegc", kEnd));
  rows.push_back(row<cutlinedxf>("cutlinedxf", kEnd));
  rows.push_back(row<cutlinedxf>("cutlinedxfgc", kEnd));
  rows.push_back(row<cutvertexdxf>("cutvertexdxf", kEnd));
  rows.push_back(row<cutvertexdxf>("cutvertexdxfgc", kEnd));
  add_cuts_by_axes(rows);
  rows.push_back(row<moveatfeedrate>("moveatfeedrate", "ex, ey, ez, f"));
  rows.push_back(row<begintoolpath>("begintoolpath", kEnd));
  rows.push_back(row<endtoolpath>("endtoolpath", ""));
  rows.push_back(row<cutoneaxis>("cutoneaxis_setfeed", "axis, depth, feed"));
  rows.push_back(row<movement>("toolmovement", "bx, by, bz, ex, ey, ez, step=0"));
  rows.push_back(row<movement>("shaftmovement", "bx, by, bz, ex, ey, ez"));
  rows.push_back(row<setrotary>("setrotary", "a"));
}

}  // namespace kerf::scad
