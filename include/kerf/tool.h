// A tool is its silhouette: the half profile of lines and arcs that, turned about the spindle's axis, gives
// the solid. Square, ball, V, keyhole, dovetail, roundover and shank are the same thing to every algorithm.
//
// Frame: r is the distance from the axis, z the height above the control point (the tip), both mm.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/units.h"

namespace kerf {

/// A corner of a half profile. `bulge` belongs to the segment from this knot to the next, as in DXF: tangent
/// of a quarter of the angle, 0 straight, positive counter-clockwise in the (r, z) plane, which bulges away
/// from the axis.
struct Knot {
  double r = 0.0;  // mm, >= 0
  double z = 0.0;  // mm
  double bulge = 0.0;
  bool operator==(const Knot&) const = default;
};

/// A half profile from bottom to top: z never falls (level segments are steps), r >= 0. Empty = there is no
/// such part. The solid is all that lies between the axis and the profile.
struct Profile {
  std::vector<Knot> knots;

  bool empty() const { return knots.size() < 2; }
  double bottom() const { return empty() ? 0.0 : knots.front().z; }  // mm
  double top() const { return empty() ? 0.0 : knots.back().z; }      // mm
  /// Largest radius in mm, arcs that swell between their ends included.
  double max_radius() const;
  /// Radius in mm at height z above the tip (the larger one at a step); 0 outside the profile.
  double radius_at(double z) const;
  bool operator==(const Profile&) const = default;
};

/// What a part of a tool does when it meets material: the cutting part cuts, all others collide.
enum class ToolPart : std::uint8_t { cutting, neck, shank, holder };
std::string_view to_string(ToolPart part);

/// The whole tool, each part where it stands: heights are above the tip, parts follow each other upwards.
struct Silhouette {
  Profile cutting;
  Profile neck;  // relief between the flutes and the shank; does not cut
  Profile shank;
  Profile holder;

  const Profile& part(ToolPart p) const;
  double max_radius() const;  // mm, of all parts
  double top() const;         // mm, of the highest part
};

/// Parameters of the known shapes. Lengths along the axis are measured from the tip. Where a shape says
/// "flute", it is the height of the cutting part. A measure of 0 is "not told" and filled in by make_tool
/// where that makes sense: a flute by `usual_flute` or, where the shape itself ends, by that end. Arcs of
/// these shapes' silhouettes never exceed a quarter circle.
namespace shape {
struct Square {
  Length diameter, flute;
};
struct Ball {
  Length diameter, flute;
};
/// Flat bottom with a quarter circle at the corner; `corner_radius` at most half the diameter.
struct BullNose {
  Length diameter, flute, corner_radius;
};
/// As BullNose; the name that bowl-and-tray bits go by.
struct Bowl {
  Length diameter, flute, corner_radius;
};
/// V groove. `tip_diameter` 0 is a point, else a flat; `tip_radius` above 0 rounds the point (and then the
/// flat is 0). The cone ends at `diameter`; a flute higher than the cone goes on as a cylinder.
struct Vee {
  Length diameter, flute;
  Angle included_angle;
  Length tip_diameter, tip_radius;
};
/// Ball of `tip_diameter` tangent to a cone of `included_angle` that reaches `diameter`; an angle of 0 is the
/// one that reaches it just at `flute`.
struct TaperedBall {
  Length diameter, flute;
  Angle included_angle;
  Length tip_diameter;
};
/// Head of `diameter` and height `head`; fluted neck of `neck_diameter` from there up to `flute`.
struct Keyhole {
  Length diameter, head, neck_diameter, flute;
};
/// Widest at the tip; the side leans inwards by `side_angle` from the axis.
struct Dovetail {
  Length diameter, flute;
  Angle side_angle;
};
/// Concave quarter circle of `radius` above a tip of `tip_diameter`; body diameter is tip + 2 radius.
struct Roundover {
  Length tip_diameter, radius, flute;
};
/// One tooth: minor to major to minor diameter within `cut_height`, then a neck (not cutting) of the minor
/// diameter up to `length`.
struct ThreadMill {
  Length minor_diameter, major_diameter, cut_height, length;
};
/// Ball of `diameter` on a neck of `neck_diameter`, which cuts up to `flute`; flute 0: only the ball cuts,
/// and a ToolBody::neck_length gives the neck.
struct Lollipop {
  Length diameter, neck_diameter, flute;
};
/// Disc of `diameter` and `thickness` on a neck of `neck_diameter`, as with Lollipop.
struct TSlot {
  Length diameter, thickness, neck_diameter, flute;
};
struct Drill {
  Length diameter, flute;
  Angle point_angle;
};
/// Centre drill: pilot of `pilot_diameter` and `pilot_angle`, `pilot_length` long, then a cone of
/// `body_angle` to `diameter`.
struct CentreDrill {
  Length pilot_diameter, pilot_length;
  Angle pilot_angle;
  Length diameter, flute;
  Angle body_angle;
};
/// Flat bottom of `tip_diameter`, straight flanks to `diameter` at `flute`.
struct FlatGroove {
  Length diameter, flute, tip_diameter;
};
/// Chamfer: `included_angle` cone between `tip_diameter` and `diameter`, then a cylinder to `flute`.
struct Chamfer {
  Length diameter, flute;
  Angle included_angle;
  Length tip_diameter;
};
/// Corner-rounding mill of CutViewer's CRMILL: `tip_diameter` D1, `diameter` D2, concave `radius`. The arc
/// ends where it meets D2; a larger D2 goes on from the arc's end in a step. Cuts up to the higher of
/// `height` and `flute`.
struct CornerRounding {
  Length tip_diameter, diameter, radius, height, flute;
};
/// Any half profile.
struct Drawn {
  Profile cutting;
};
}  // namespace shape

using ToolShape =
    std::variant<shape::Square, shape::Ball, shape::BullNose, shape::Bowl, shape::Vee, shape::TaperedBall,
                 shape::Keyhole, shape::Dovetail, shape::Roundover, shape::ThreadMill, shape::Lollipop,
                 shape::TSlot, shape::Drill, shape::CentreDrill, shape::FlatGroove, shape::Chamfer,
                 shape::CornerRounding, shape::Drawn>;
/// "square", "ball", "bull nose", "V" ...: the words of the tool files and of `kerf tools list`.
std::string_view name_of(const ToolShape& shape);

/// The measures of a shape by name, for readers, writers and messages: "diameter", "flute", "angle" ...
struct ShapeParameter {
  enum class Kind : std::uint8_t { length, angle };
  enum class Need : std::uint8_t { required, optional };
  std::string_view name;
  Kind kind = Kind::length;
  Need need = Need::required;
  double (*get)(const ToolShape&) = nullptr;        // mm or degrees
  void (*set)(ToolShape&, double value) = nullptr;  // mm or degrees
};
/// The parameters of a shape's kind; none for a drawn one.
const std::vector<ShapeParameter>& parameters_of(const ToolShape& shape);
/// The shape of a name with all measures 0; case, spaces and hyphens do not count, and some other names are
/// known
/// ("flat", "end mill", "vee", "ball nose").
std::optional<ToolShape> shape_named(std::string_view name);
/// What name_of can give, for messages.
const std::vector<std::string>& shape_names();

/// The flute of a mill of this diameter where none is told: that of the usual router bit of the size
/// (1/32" 1.5875 mm, 1/16" 6.35, 1/8" 12.7, 1/4" 19.05), else three times the diameter.
Length usual_flute(Length diameter);

/// How a shank wider than what is below it begins.
enum class Transition : std::uint8_t { step, cone };  // cone: at 45 degrees

/// What stands above the cutting part. A diameter of 0 leaves the part out.
struct ToolBody {
  Length neck_diameter, neck_length;
  Length shank_diameter, shank_length;  // length above the neck or the flute
  Length holder_diameter, holder_length;
  Transition transition = Transition::step;
};

/// A tool as the rest of Kerf uses it.
struct Tool {
  int number = 0;                  // as it stands in the program (T word)
  std::vector<std::string> names;  // vendor's and generated numbers, "Amana 46200-K"
  std::string description;
  ToolShape shape;             // with the measures that were not told filled in
  Silhouette silhouette;       // made from shape and body
  Length diameter;             // largest of the cutting part
  Length flute;                // height of the cutting part
  bool flute_assumed = false;  // nobody told the flute: it is usual_flute's
  int teeth = 2;
  bool plunges = true;  // cuts at its centre, so that it may go straight down
};

/// Makes the tool of a shape and what is above it. Appends errors (with `where`) for parameters that give no
/// solid (negative, not finite, a corner radius above half the diameter ...) and returns nothing then. All of
/// them are reported at once. A warning says that the flute ends before a cone has reached the diameter;
/// catalogues' rounding (0.01 mm) is made good silently.
std::optional<Tool> make_tool(int number, const ToolShape& shape, const ToolBody& body, const Origin& where,
                              Diagnostics& diagnostics);

/// Tools by program number. Vendor numbers, generated six-digit numbers and program numbers share one space
/// here (spec/gcodepreview.md section 3: a two-way map).
class ToolTable {
 public:
  /// The tool of a number, or nullptr.
  const Tool* find(int number) const;
  void set(int number, Tool tool);
  /// The tool that carries a name ("Amana 46200-K"), compared by fold_name; nullptr if none does.
  const Tool* find_name(std::string_view name) const;
  const std::map<int, Tool>& tools() const { return tools_; }

 private:
  std::map<int, Tool> tools_;
};

/// The six-digit number that gcodepreview's scheme gives a tool's shape, e.g. 100036 for a square mill
/// of 3.175 mm with a 1/2" flute; nothing where the scheme has no code. spec/gcodepreview.md section 3.
std::optional<int> encode_tool_number(const Tool& tool);
/// What a six-digit number says: a shape with the sizes its digits name. Nothing (with an error) for numbers
/// that are not of the scheme.
std::optional<ToolShape> decode_tool_number(int number, const Origin& where, Diagnostics& diagnostics);

/// Reads the text of a comment (without its brackets) such as "TOOL/MILL, 3.175, 0.00, 12.7, 0.00" into a
/// shape. Nothing without a message where the comment is no tool comment (or one that names no shape:
/// TOOL/ID, COLOR); nothing with an error where it is one but wrong, and with a warning for measures known
/// from programs that fill in the fields in another order (corner radius above half the diameter). Lengths
/// are in mm times `scale` (25.4 in a program in inches). A height of 0 is "not told": usual_flute, and with
/// a taper the cone up to 12.7 mm diameter.
std::optional<ToolShape> read_tool_comment(std::string_view comment, double scale, const Origin& where,
                                           Diagnostics& diagnostics);
/// The comment that describes a shape, without brackets; nothing for shapes that CutViewer cannot say
/// (undercut ones).
std::optional<std::string> write_tool_comment(const ToolShape& shape);

/// Which tool a program means whose comment describes `from_comment` under a number that the table knows as
/// `from_table`; either may be nullptr, and so is the answer if both are. Where the two agree within what
/// comments round (see docs/manual/tools.md), the table's, which is exact; else the comment's, with a warning
/// that names both.
const Tool* choose_tool(const Tool* from_table, const Tool* from_comment, const Origin& where,
                        Diagnostics& diagnostics);

}  // namespace kerf
