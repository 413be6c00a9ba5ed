// A tool is its silhouette: the half profile of lines and arcs that gives the solid when turned about the
// spindle axis. Algorithms treat square, ball, V, keyhole, dovetail, roundover and shank alike.
//
// Frame: r is the distance from the axis, z the height above the tip, both mm.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"

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

/// A half profile from bottom to top: z never decreases (level segments are steps), r >= 0. Empty: no such
/// part. The solid lies between the axis and the profile.
struct Profile {
  std::vector<Knot> knots;

  bool empty() const { return knots.size() < 2; }
  double bottom() const { return empty() ? 0.0 : knots.front().z; }  // mm
  double top() const { return empty() ? 0.0 : knots.back().z; }      // mm
  /// Maximum radius in mm, including arcs that bulge between their ends.
  double max_radius() const;
  /// Radius in mm at height z above the tip (the larger one at a step); 0 outside the profile.
  double radius_at(double z) const;
  bool operator==(const Profile&) const = default;
};
/// Whether its knots are as described, no larger than the limits; also of an empty one.
bool is_valid(const Profile& profile);

/// Parts of a tool: the cutting part cuts, contact of the others with material is a collision.
enum class ToolPart : std::uint8_t { cutting, neck, shank, holder };
std::string_view to_string(ToolPart part);

/// The whole tool: heights are above the tip, parts follow each other upwards.
struct Silhouette {
  Profile cutting;
  Profile neck;  // relief between the flutes and the shank; does not cut
  Profile shank;
  Profile holder;

  const Profile& part(ToolPart p) const;
  double max_radius() const;  // mm, of all parts
  double top() const;         // mm, of the highest part
};

/// Parameters of the known shapes. Lengths along the axis are measured from the tip. `flute` is the
/// height of the cutting part. A dimension of 0 is unspecified; make_tool computes it where possible: a flute
/// by `usual_flute` or, for a shape with an end of its own, by that end. Arcs of these silhouettes never
/// exceed a quarter circle.
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
/// As BullNose; the name of bowl-and-tray bits.
struct Bowl {
  Length diameter, flute, corner_radius;
};
/// V groove. `tip_diameter` 0 is a point, otherwise a flat; `tip_radius` above 0 rounds the point (and then
/// the flat is 0). The cone ends at `diameter`; a flute higher than the cone continues as a cylinder.
struct Vee {
  Length diameter, flute;
  Angle included_angle;
  Length tip_diameter, tip_radius;
};
/// Ball of `tip_diameter` tangent to a cone of `included_angle` that reaches `diameter`; an angle of 0 means
/// the one that reaches it at `flute`.
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
/// ends where it meets D2; a larger D2 continues from the arc's end with a step. Cuts up to the higher of
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
/// "square", "ball", "bull nose", "V" ...: as in tool files and `kerf tools list`.
std::string_view name_of(const ToolShape& shape);

/// The dimensions of a shape by name, for readers, writers and messages: "diameter", "flute", "angle" ...
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
/// The shape of a name with all dimensions 0; case, spaces and hyphens are ignored, and there are synonyms
/// ("flat", "end mill", "vee", "ball nose").
std::optional<ToolShape> shape_named(std::string_view name);
/// All results of name_of, for messages.
const std::vector<std::string>& shape_names();

/// The default flute of a mill of this diameter: that of the common router bit of the size (1/32" 1.5875 mm,
/// 1/16" 6.35, 1/8" 12.7, 1/4" 19.05), otherwise three times the diameter.
Length usual_flute(Length diameter);

/// The lower end of a shank wider than the part below it.
enum class Transition : std::uint8_t { step, cone };  // cone: at 45 degrees

/// The parts above the flute. A diameter of 0 omits a part.
struct ToolBody {
  Length neck_diameter, neck_length;
  Length shank_diameter, shank_length;  // length above the neck or the flute
  Length holder_diameter, holder_length;
  Transition transition = Transition::step;
};

/// A complete tool.
struct Tool {
  int number = 0;                  // T word of the program
  std::vector<std::string> names;  // vendor and generated numbers, "Amana 46200-K"
  std::string description;
  ToolShape shape;             // complete: default dimensions filled in
  Silhouette silhouette;       // made from shape and body
  Length diameter;             // largest of the cutting part
  Length flute;                // height of the cutting part
  bool flute_assumed = false;  // the flute is usual_flute
  int teeth = 2;
  bool teeth_assumed = true;  // nothing states the number of teeth
  bool plunges = true;        // cuts at its centre, may plunge
};

/// Makes the tool of a shape and the parts above it. Appends errors (with `where`) for parameters that give
/// no solid (negative, not finite, a corner radius above half the diameter ...), all of them at once, and
/// returns nothing. A flute that ends before a cone reaches the diameter gives a warning; rounding of
/// catalogues (0.01 mm) is corrected silently.
std::optional<Tool> make_tool(int number, const ToolShape& shape, const ToolBody& body, const Origin& where,
                              Diagnostics& diagnostics);

/// "2 teeth", with "(assumed)" where nothing states the number.
std::string teeth_text(const Tool& tool);

/// Tools by program number. Vendor numbers, generated six-digit numbers and program numbers share one name
/// space.
class ToolTable {
 public:
  /// The tool of a number, or nullptr.
  const Tool* find(int number) const;
  void set(int number, Tool tool);
  /// The tool with a name ("Amana 46200-K"), compared by fold_name; nullptr if there is none.
  const Tool* find_name(std::string_view name) const;
  const std::map<int, Tool>& tools() const { return tools_; }

 private:
  std::map<int, Tool> tools_;
};

/// The six-digit number of a tool's shape in gcodepreview's scheme, e.g. 100036 for a square mill
/// of 3.175 mm with a 1/2" flute; nothing if the scheme has no code.
std::optional<int> encode_tool_number(const Tool& tool);
/// Decodes a six-digit number: a shape with the dimensions of its digits. Nothing, with an error, for numbers
/// outside of the scheme.
std::optional<ToolShape> decode_tool_number(int number, const Origin& where, Diagnostics& diagnostics);

/// Reads the text of a comment (without parentheses) such as "TOOL/MILL, 3.175, 0.00, 12.7, 0.00" into a
/// shape. Returns nothing without a message for other comments and those without a shape (TOOL/ID, COLOR);
/// nothing with an error for a malformed one, and with a warning for fields in another order, as some
/// programs write them (corner radius above half the diameter). Lengths are in mm times `scale` (25.4 in a
/// program in inches). A height of 0 is unspecified: usual_flute, and with a taper the cone up to 12.7 mm
/// diameter.
std::optional<ToolShape> read_tool_comment(std::string_view comment, double scale, const Origin& where,
                                           Diagnostics& diagnostics);
/// The comment that describes a shape, without parentheses; nothing for shapes that CutViewer cannot
/// describe (undercut ones).
std::optional<std::string> write_tool_comment(const ToolShape& shape);

/// The tool of a number that a comment describes as `from_comment` and the table as `from_table`; either may
/// be nullptr, and the result is nullptr if both are. If the two agree within the rounding of comments (see
/// docs/manual/tools.md), the table's exact tool; otherwise the comment's, with a warning that names both.
const Tool* choose_tool(const Tool* from_table, const Tool* from_comment, const Origin& where,
                        Diagnostics& diagnostics);

}  // namespace kerf
