// Tools: changes, diameters, tools of the program's own, and descriptions by shape or CutViewer comment.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "base/names.h"
#include "base/number.h"
#include "design/commands/rows.h"
#include "design/commands/tool_pictures.h"

#include "kerf/base/limits.h"

namespace kerf::design {
namespace {

constexpr double kMaxRpm = limits::kMaxSpeed;

/// A tool of a shape; its errors end the command.
Tool made_tool(Machine& machine, int number, const ToolShape& shape, const ToolBody& body) {
  auto tool = make_tool(number, shape, body, machine.where(), machine.diagnostics());
  if (!tool) throw Reported{};
  return std::move(*tool);
}

void toolchange(Machine& machine, Call& call) {
  const double speed = not_negative(call.number(1), "speed");
  if (speed > kMaxRpm) refuse(fmt::format("speed is at most {:g} rpm, not {:g}", kMaxRpm, speed));
  machine.change_tool(tool_number(machine, call, 0), speed);
}

Value currenttool(Machine& machine, Call&) { return machine.tool().given; }

Value tool_diameter(Machine& machine, Call& call) {
  const double height = call.number(1);
  if (height < 0.0) refuse(fmt::format("ptd_depth is a height above the tip: 0 or more, not {:g}", height));
  return diameter_at(machine.tool_numbers().tool(tool_number(machine, call, 0)), height);
}
Value tool_radius(Machine& machine, Call& call) { return tool_diameter(machine, call).number() / 2; }

// ---- tools of the program's own

/// The dimensions of all shapes by name, and those of the parts above the flute.
std::vector<std::string_view> size_names() {
  std::vector<std::string_view> names;
  const auto add = [&](std::string_view name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const std::string& name : shape_names())
    if (const auto shape = shape_named(name))
      for (const ShapeParameter& parameter : kerf::parameters_of(*shape)) add(parameter.name);
  for (const char* name : {"neck_diameter", "neck_length", "shank_diameter", "shank_length"}) add(name);
  return names;
}

/// The dimension of the parts above the flute that a name means; nullptr if it means none.
Length* body_size(ToolBody& body, std::string_view name) {
  if (name == "neck_diameter") return &body.neck_diameter;
  if (name == "neck_length") return &body.neck_length;
  if (name == "shank_diameter") return &body.shank_diameter;
  if (name == "shank_length") return &body.shank_length;
  return nullptr;
}

/// Sets a dimension of a tool; false if it has none of that name.
bool set_size(ToolShape& shape, ToolBody& body, std::string_view name, double value) {
  for (const ShapeParameter& parameter : kerf::parameters_of(shape))
    if (parameter.name == name) {
      parameter.set(shape, value);
      return true;
    }
  Length* part = body_size(body, name);
  if (part != nullptr) *part = mm(value);
  return part != nullptr;
}

void addtool(Machine& machine, Call& call) {
  const int number_given = whole(call.number(0), "tool_number", 1, limits::kMaxToolNumber);
  const std::string name = call.text(1);
  auto shape = shape_named(name);
  if (!shape)
    refuse(
        fmt::format("shape: \"{}\" is unknown; known: {}", clipped(name, 60), joined(shape_names(), ", ")));
  ToolBody body;
  for (std::size_t i = 2; i < call.size(); ++i) {
    const auto value = call.optional_number(i);
    const std::string_view size = call.name(i);
    if (value && !set_size(*shape, body, size, *value))
      refuse(fmt::format("a tool \"{}\" has no {}", kerf::name_of(*shape), size));
  }
  machine.add_tool(number_given, made_tool(machine, number_given, *shape, body));
}

/// The tool of a comment such as "TOOL/MILL, 6, 0, 20, 0".
void settoolparameters(Machine& machine, Call& call) {
  static const std::vector<std::string> kinds{"mill", "crmill", "chamfer", "drill"};
  const std::size_t kind = choice(call.text(0), kinds, "tooltype");
  std::string comment = "TOOL/" + kinds[kind];
  std::transform(comment.begin(), comment.end(), comment.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const std::size_t given = kind == 3 ? 3 : 4;  // a drill has three numbers
  // A mill with a taper is a V whose flat tip is as wide as the first number.
  const bool is_v = kind == 0 && call.number(4) > 0.0;
  for (std::size_t i = 1; i <= given; ++i)
    comment += ", " + exact_text(i == 2 && is_v ? 0.0 * call.number(i) : call.number(i));
  if (kind == 1) comment += ", " + exact_text(call.number(4));  // the length is the height
  const auto shape = read_tool_comment(comment, 1.0, machine.where(), machine.diagnostics());
  if (!shape) throw Reported{};
  ToolBody body;
  if (const double length = call.number(5); length != 0.0) body.shank_length = mm(positive(length, "length"));
  machine.describe_tool(made_tool(machine, machine.tool().number, *shape, body));
}

// ---- descriptions

/// The tool in use as described by a shape, with a shank.
void describe(Machine& machine, const ToolShape& shape, double shank_diameter, double shank_length) {
  ToolBody body;
  body.shank_diameter = mm(shank_diameter);
  body.shank_length = mm(shank_length);
  machine.describe_tool(made_tool(machine, machine.tool().number, shape, body));
}

Length size(Call& call, std::size_t i) { return mm(positive(call.number(i), call.name(i))); }

/// diameter, flute, shaft, offset
void definesquaretool(Machine& machine, Call& call) {
  const Length diameter = size(call, 0);
  describe(machine, shape::Square{diameter, size(call, 1)}, diameter.mm(), call.number(2));
}
void defineballnosetool(Machine& machine, Call& call) {
  const Length diameter = size(call, 0);
  describe(machine, shape::Ball{diameter, size(call, 1)}, diameter.mm(), call.number(2));
}
/// diameter, flute, shaft, shaftdiameter
void defineVtool(Machine& machine, Call& call) {
  const Length diameter = size(call, 0), flute = size(call, 1);
  const Angle angle = radians(2 * std::atan(diameter.mm() / 2 / flute.mm()));
  const double shaft = call.number(3);
  describe(machine, shape::Vee{diameter, flute, angle, {}, {}}, shaft > 0.0 ? shaft : diameter.mm(),
           call.number(2));
}
/// diameter, flute, narrowdiameter, narrowflute, shaftdiameter, shaftlength
void defineKeyholetool(Machine& machine, Call& call) {
  const Length head = size(call, 1);
  describe(machine, shape::Keyhole{size(call, 0), head, size(call, 2), head + size(call, 3)}, call.number(4),
           call.number(5));
}
/// diameter, flute, radius, shaftdiameter, shaftlength
void definebowltool(Machine& machine, Call& call) {
  describe(machine, shape::Bowl{size(call, 0), size(call, 1), size(call, 2)}, call.number(3), call.number(4));
}
/// diameter, tipdiameter, flute, radius, shaftdiameter, shaftlength
void defineRoundovertool(Machine& machine, Call& call) {
  size(call, 0);  // follows from the tip and the radius
  const Length radius = size(call, 3);
  describe(machine, shape::Roundover{size(call, 1), radius, std::max(size(call, 2), radius)}, call.number(4),
           call.number(5));
}

/// toolingdiameter, shaftdiameter, flute, transition, shaft: the part above the flute.
void defineshaft(Machine& machine, Call& call) {
  const double top = positive(call.number(0), "toolingdiameter") / 2;
  const double given = not_negative(call.number(1), "shaftdiameter") / 2;
  const double height = not_negative(call.number(2), "flute");
  const double cone = height + not_negative(call.number(3), "transition");
  const double end = cone + not_negative(call.number(4), "shaft");
  const double radius = given > 0.0 ? given : top;
  Tool tool = machine.tool().tool;
  tool.silhouette.shank.knots = {{top, height, 0.0}, {radius, cone, 0.0}, {radius, end, 0.0}};
  machine.describe_tool(std::move(tool));
}

// ---- pictures of the tool

void show_file(Machine& machine, std::string_view what, std::string_view ending, std::string bytes) {
  machine.add_file(fmt::format("{}_{}{}", machine.tool().number, what, ending), std::move(bytes));
}
std::string title(const Machine& machine, std::string_view what) {
  return fmt::format("{} {}", machine.tool().number, what);
}
void showtooloutline(Machine& machine, Call&) {
  show_file(machine, "outline", ".svg",
            tool_svg(machine.tool().tool, Sides::both, title(machine, "outline")));
}
void showtoolprofile(Machine& machine, Call&) {
  show_file(machine, "profile", ".svg", tool_svg(machine.tool().tool, Sides::one, title(machine, "profile")));
}
void showtoolshape(Machine& machine, Call&) {
  show_file(machine, "shape", ".stl", tool_stl(machine.tool().tool, std::to_string(machine.tool().number)));
}

}  // namespace

void add_tool_commands(Rows& rows) {
  rows.push_back(row<toolchange>("toolchange", "tool_number, speed=10000",
                                 "Change to a tool and start the spindle with `speed` rpm."));
  for (const char* name : {"currenttoolnumber", "currenttool"})
    rows.push_back(asking<currenttool>(
        name, "", "The tool number of the last change, as given: the maker's or the generated one."));
  rows.push_back(asking<tool_diameter>("tool_diameter", "ptd_tool, ptd_depth",
                                       "The diameter of a tool at a height above its tip, mm."));
  rows.push_back(asking<tool_radius>("tool_radius", "ptd_tool, ptd_depth", "Half of tool_diameter."));
  Command own =
      row<addtool>("addtool", "tool_number, shape",
                   "Add a tool of one's own, for toolchange: its shape and sizes as of kerf.Tool.make, mm "
                   "and degrees.\n"
                   "\n"
                   ">>> gcp.addtool(901, \"lollipop\", diameter=10, neck_diameter=4, flute=14)");
  for (const std::string_view name : size_names()) own.parameters.push_back({name, Value()});
  rows.push_back(std::move(own));
  rows.push_back(row<settoolparameters>(
      "settoolparameters", "tooltype, first, second, third, fourth, length=0",
      "Describe the tool of the following motions as a CutViewer comment does.\n"
      "\n"
      "'mill': diameter, corner radius, height, taper angle; 'crmill': two diameters, radius, "
      "height;\n"
      "'chamfer': diameter, point angle, height, length of the chamfer; 'drill': diameter, "
      "point angle,\n"
      "height. After cuts the tool gets a number of its own, and is changed to."));
}

void add_tool_descriptions(Rows& rows) {
  rows.push_back(row<definesquaretool>("definesquaretool", "diameter, flute, shaft, offset=0",
                                       "Make a square mill of the tool in use."));
  rows.push_back(row<defineballnosetool>("defineballnosetool", "diameter, flute, shaft, offset=0",
                                         "Make a ball nose of the tool in use."));
  rows.push_back(row<defineVtool>("defineVtool", "diameter, flute, shaft, shaftdiameter=0",
                                  "Make a V of the tool in use."));
  rows.push_back(row<defineKeyholetool>(
      "defineKeyholetool", "diameter, flute, narrowdiameter, narrowflute, shaftdiameter, shaftlength",
      "Make a keyhole cutter of the tool in use: the head, then the neck above it."));
  rows.push_back(row<definebowltool>("definebowltool", "diameter, flute, radius, shaftdiameter, shaftlength",
                                     "Make a mill with rounded corners of the tool in use."));
  rows.push_back(row<defineRoundovertool>("defineRoundovertool",
                                          "diameter, tipdiameter, flute, radius, shaftdiameter, shaftlength",
                                          "A concave quarter of `radius` from the tip's diameter outwards."));
  rows.push_back(row<defineshaft>(
      "defineshaft", "toolingdiameter, shaftdiameter, flute, transition, shaft",
      "The shaft above the flute: its diameter and length, and the height of the cone between "
      "them."));
  rows.push_back(row<showtooloutline>("showtooloutline", "", "Show the outline of tool and shaft."));
  rows.push_back(row<showtoolprofile>("showtoolprofile", "", "Show the half profile of tool and shaft."));
  rows.push_back(row<showtoolshape>("showtoolshape", "", "Show the solid of tool and shaft."));
}

}  // namespace kerf::design
