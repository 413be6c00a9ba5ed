// DXF files as plain structs: the content of the file, in its own coordinates and unit, and the placement of
// blocks.
//
// R12 to R2018 (and older files of the same form) are read, ASCII and binary. A broken file is read as far as
// possible: errors are appended to the diagnostics with their line, and reading continues at the next entity.
//
//   Diagnostics diagnostics;
//   const auto file = dxf::read_dxf(bytes, "part.dxf", diagnostics);
//   dxf::for_each_placed(*file, {}, diagnostics, [&](const dxf::Placed& placed) {
//     if (const auto* line = std::get_if<dxf::Line>(&placed.entity.shape))
//       use(placed.matrix * line->from, placed.matrix * line->to, file->layers[placed.style.layer].name);
//   });
//
// Coordinates: LINE, POINT, ELLIPSE, SPLINE, MTEXT and 3D polylines are in world coordinates (of the drawing,
// or of the block that they belong to); ARC, CIRCLE, TEXT, INSERT and 2D polylines are in object coordinates,
// which their extrusion direction defines (`object_axes`). Angles are degrees, counter-clockwise seen against
// the extrusion direction, as in the file. Numbers are finite. Texts are UTF-8.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"

namespace kerf::dxf {

/// A value on the heap that is copied with its owner; keeps large shapes out of small entities.
template <class Value>
class Boxed {
 public:
  Boxed() : value_(std::make_unique<Value>()) {}
  Boxed(Value value) : value_(std::make_unique<Value>(std::move(value))) {}  // NOLINT: converts on purpose
  Boxed(const Boxed& other) : value_(std::make_unique<Value>(*other)) {}
  Boxed(Boxed&&) noexcept = default;
  Boxed& operator=(const Boxed& other) {
    value_ = std::make_unique<Value>(*other);
    return *this;
  }
  Boxed& operator=(Boxed&&) noexcept = default;
  ~Boxed() = default;
  Value& operator*() { return *value_; }
  const Value& operator*() const { return *value_; }
  Value* operator->() { return value_.get(); }
  const Value* operator->() const { return value_.get(); }

 private:
  std::unique_ptr<Value> value_;
};

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Point&) const = default;
};

// --------------------------------------------------------------------------------------------------- tables

// The first line types of every file, whether it declares them or not.
inline constexpr std::uint32_t kByLayer = 0, kByBlock = 1, kContinuous = 2;
// Colour indices with a meaning; 1 to 255 are colours.
inline constexpr int kColourByBlock = 0, kColourByLayer = 256;
inline constexpr int kNoTrueColour = -1;
inline constexpr std::uint32_t kLayerZero = 0;  ///< layer "0", which every file has

/// Tables hold what the file declares and what entities refer to without a declaration (`declared` is false).
/// Names are compared without regard to the case of ASCII letters and spelled as declared.
struct Layer {
  std::string name;
  int colour = 7;
  int true_colour = kNoTrueColour;  ///< 0xRRGGBB
  std::uint32_t linetype = kContinuous;
  bool off = false, frozen = false, locked = false;
  bool plotted = true;
  bool declared = false;
};
struct Linetype {
  std::string name, description;
  std::vector<double> pattern;  ///< drawing units: dashes above 0, gaps below 0, dots 0
  bool declared = false;
};
struct TextStyle {
  std::string name, font;
  double height = 0.0;  ///< 0: not fixed
  double width_factor = 1.0;
  bool declared = false;
};
struct HeaderVariable {
  std::string name;                                 ///< "$INSUNITS"
  std::vector<std::pair<int, std::string>> values;  ///< group code and text
};

// ------------------------------------------------------------------------------------------------- entities

struct Line {
  Point from, to;
};
struct Dot {  ///< POINT
  Point at;
};
struct Circle {
  Point centre;
  double radius = 0.0;
};
struct Arc {
  Point centre;
  double radius = 0.0, start = 0.0, end = 0.0;
};
/// centre + cos(t) * major + sin(t) * minor, t from `start` to `end` in radians; minor is the cross product
/// of extrusion direction and major axis, times the ratio.
struct Ellipse {
  Point centre, major;
  double ratio = 1.0, start = 0.0, end = 0.0;
};
struct Vertex {
  Point at;
  double bulge = 0.0;  ///< tangent of a quarter of the sweep to the next vertex, above 0 counter-clockwise
};
struct Polyline {
  std::vector<Vertex> vertices;               ///< without the control points of curves that are drawn
  std::vector<std::array<double, 2>> widths;  ///< at the start and end of each segment; empty: all are 0
  bool closed = false;
  bool spatial = false;      ///< a 3D polyline, in world coordinates
  bool lightweight = false;  ///< LWPOLYLINE
};
struct Spline {
  int degree = 3;
  bool closed = false, periodic = false;
  std::vector<Point> control;
  std::vector<double> knots, weights;  ///< weights: none, or one for each control point
  std::vector<Point> fit;
  std::optional<Point> start_tangent, end_tangent;
};
enum class TextKind : std::uint8_t { text, mtext, attribute, attribute_definition };
struct Text {
  TextKind kind = TextKind::text;
  std::string text;  ///< with its control codes: see plain_text and plain_mtext
  std::string tag;   ///< of attributes
  Point at;
  std::optional<Point> second;  ///< group 11: the anchor of TEXT with an alignment, the direction of MTEXT
  double height = 0.0, rotation = 0.0;
  double width_factor = 1.0, oblique = 0.0;
  double reference_width = 0.0;                ///< of MTEXT: of its lines; 0: they are not wrapped
  double line_spacing = 1.0;                   ///< of MTEXT: a multiple of 5/3 of the height
  std::uint32_t style = 0;                     ///< index into Drawing::styles
  int horizontal = 0, vertical = 0;            ///< groups 72 and 73 (attributes: 74)
  int attachment = 0;                          ///< of MTEXT: 1 top left to 9 bottom right
  bool backward = false, upside_down = false;  ///< of TEXT
};
struct Insert {
  std::uint32_t block = 0;  ///< index into Drawing::blocks
  Point at;
  Point scale{1.0, 1.0, 1.0};
  double rotation = 0.0;
  int columns = 1, rows = 1;
  double column_spacing = 0.0, row_spacing = 0.0;  ///< turned with the insert, not scaled
};
/// A filled area. Its edges are in object coordinates; those of one loop follow each other.
struct Hatch {
  using Edge = std::variant<Line, Arc, Boxed<Polyline>, Boxed<Ellipse>, Boxed<Spline>>;
  struct Loop {
    std::vector<Edge> edges;
  };
  /// Of loops inside of others: every second area, the outermost area alone, or all that the outer ones
  /// bound.
  enum class Islands : std::uint8_t { alternate, outer, ignored };
  std::vector<Loop> loops;
  Islands islands = Islands::alternate;
  std::string_view name = "HATCH";  ///< or SOLID, TRACE
};
/// A text element of an SVG. Coordinates are those of the element, y down; `matrix` (a, b, c, d, e, f as in
/// SVG's matrix()) gives the drawing's.
struct StyledText {
  enum class Anchor : std::uint8_t { start, centre, end };
  struct Style {
    std::vector<std::string> families;  ///< in the order of preference; none: the browser's default
    int weight = 400;
    bool italic = false;
    double size = 16.0;  ///< of an em
    double letter_spacing = 0.0, word_spacing = 0.0;
    Anchor anchor = Anchor::start;
  };
  struct Character {
    char32_t code = 0;
    std::uint32_t style = 0;
    std::optional<double> x, y;  ///< absolute positions start a chunk, which is aligned by itself
    double dx = 0.0, dy = 0.0;
    double turn = 0.0;  ///< degrees, clockwise as SVG has it
  };
  std::array<double, 6> matrix{1, 0, 0, 1, 0, 0};
  std::vector<Style> styles;
  std::vector<Character> characters;
};
/// The characters of one style of a text; entities of the same text follow each other.
struct TextPart {
  std::shared_ptr<const StyledText> text;
  std::uint32_t style = 0;
};
/// An entity that is kept without its shape: a HATCH without a boundary, DIMENSION, a polyface mesh, ...
struct Other {
  std::uint32_t type = 0;  ///< index into Drawing::others
};

struct Entity {
  std::uint64_t handle = 0;  ///< 0: none
  std::size_t position = 0;  ///< line of its first tag; in binary files the byte offset
  std::uint32_t layer = kLayerZero;
  std::uint32_t linetype = kByLayer;
  std::uint32_t extrusion = 0;  ///< index into Drawing::extrusions
  int true_colour = kNoTrueColour;
  std::int16_t colour = kColourByLayer;
  std::int16_t lineweight = -1;  ///< 1/100 mm; -1 by layer, -2 by block, -3 default
  bool paper = false;            ///< on a layout, not in the model
  bool hidden = false;
  double linetype_scale = 1.0;
  std::uint32_t chain = 0;  ///< not 0: a piece of one path of an SVG, in order; joined only with the others
  std::uint32_t paint = 0;  ///< not 0: index into Drawing::paints
  std::variant<Line, Circle, Arc, Dot, Boxed<Polyline>, Boxed<Text>, Boxed<Insert>, Boxed<Ellipse>,
               Boxed<Spline>, Boxed<Hatch>, TextPart, Other>
      shape;
};
/// "LINE", "LWPOLYLINE", "HATCH".
std::string_view type_name(const struct Drawing& drawing, const Entity& entity);

enum class StrokeEnds : std::uint8_t { butt, round, square };
enum class StrokeCorners : std::uint8_t { mitre, round, bevel };
/// How an element of an SVG is painted. The subpaths of one element have the same.
struct Paint {
  std::string element;                    ///< its name, and its id if it has one: "path", "path outer"
  std::uint32_t line = 0, column = 0;     ///< of its start
  bool filled = false, even_odd = false;  ///< even_odd: else nonzero
  bool stroked = false;
  std::uint32_t clip = 0;  ///< not 0: index into Drawing::clips
  /// Of the stroke: a, b, c, d as in SVG's matrix(), from the coordinates of its width and dashes to the
  /// drawing's.
  std::array<double, 4> frame{1, 0, 0, 1};
  bool uneven = false;         ///< the frame scales differently in x and y
  double width = 0.0;          ///< of the stroke
  std::vector<double> dashes;  ///< and gaps in turn; none: a whole line
  double dash_offset = 0.0;
  double path_length = 0.0;  ///< not 0: what the length of the path counts as, for dashes
  StrokeEnds ends = StrokeEnds::butt;
  StrokeCorners corners = StrokeCorners::mitre;
  double mitre_limit = 4.0;
};

/// What an SVG shows of elements, by the edge of a viewport or a clipPath: the area of these shapes.
struct Clip {
  std::uint32_t outer = 0;  ///< not 0: index of one that holds as well
  std::vector<Entity> entities;
};

struct Block {
  std::string name;
  Point base;
  bool declared = false;
  bool external = false;  ///< its content is in another file
  std::string file;       ///< that file
  std::vector<Entity> entities;
};

struct OtherType {
  std::string name;
  std::size_t count = 0;
  std::size_t first = 0;  ///< position of the first one
};
/// A tag of a known entity that the reader does not use.
struct UnusedTag {
  std::string_view type;  ///< of the entity
  int group = 0;
  std::size_t count = 0;
};

enum class Format { dxf, svg };

struct Drawing {
  std::string file;
  Format format = Format::dxf;
  bool binary = false;
  std::string version;      ///< "AC1015"; empty: not specified, or not a DXF
  std::string code_page;    ///< as specified; empty: not specified
  std::optional<int> unit;  ///< $INSUNITS; see mm_per_unit
  std::vector<HeaderVariable> header;
  std::vector<Layer> layers;
  std::vector<Linetype> linetypes;
  std::vector<TextStyle> styles;
  std::vector<Point> extrusions;  ///< the first is (0, 0, 1)
  std::vector<Block> blocks;
  std::vector<Paint> paints;     ///< of an SVG; the first is that of no element
  std::vector<Clip> clips;       ///< of an SVG; the first is none
  std::vector<Entity> entities;  ///< of model and paper space, in the order of the file
  std::vector<OtherType> others;
  std::vector<UnusedTag> unused_tags;
  std::size_t comments = 0;
  std::size_t repeated_handles = 0;  ///< entities with the handle of an earlier one
};

/// Reads the bytes of a DXF file; `file_name` is for messages. Nothing, with an error appended, if it is not
/// a DXF file; nothing, without an error, if stopped. Time and memory are proportional to the number of
/// bytes.
std::optional<Drawing> read_dxf(std::string_view bytes, const std::string& file_name,
                                Diagnostics& diagnostics, Progress* progress = nullptr);

// ------------------------------------------------------------------------------------------------ queries

/// Without regard to the case of ASCII letters.
std::optional<std::uint32_t> find_layer(const Drawing& drawing, std::string_view name);
std::optional<std::uint32_t> find_block(const Drawing& drawing, std::string_view name);

/// mm of one unit of $INSUNITS: 1 inch, 4 mm, ...; nothing for 0 (not specified) and unknown numbers.
std::optional<double> mm_per_unit(int insunits);
/// "mm", "inch", "foot"; "unit 99" if unknown.
std::string unit_name(int insunits);

/// Hexadecimal, in capitals; empty for none.
std::string handle_text(std::uint64_t handle);
/// The file; an entity's line in it; an entity at a position in mm.
Origin origin_of(const Drawing& drawing);
Origin origin_of(const Drawing& drawing, const Entity& entity);
Origin origin_at(const Drawing& drawing, std::uint32_t layer, std::uint64_t handle, double x_mm, double y_mm);

/// The point that a text is aligned to: the second point of TEXT with an alignment.
Point anchor(const Text& text);
/// Degrees; of MTEXT the angle of its direction if it has one.
double rotation(const Text& text);
/// Text of TEXT and attributes without control codes: %%d, %%c, %%p, %%nnn, %%%; ^I and the like; underlines
/// and overlines (%%u, %%o, %%k) are removed.
std::string plain_text(std::string_view text);
/// Text of MTEXT without formatting codes; paragraphs and lines are separated by '\n', fractions written with
/// a slash or a blank.
std::string plain_mtext(std::string_view text);
/// plain_mtext() or plain_text(), by the kind of text.
std::string plain(const Text& text);

/// Transforms points: m[row][0..2] are the images of the axes, m[row][3] is that of the origin.
struct Matrix {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  Point operator*(Point p) const;
  /// Without the shift.
  Point direction(Point d) const;
  Matrix operator*(const Matrix& first) const;
};
/// From the object coordinates of an extrusion direction to world coordinates (the arbitrary axis algorithm).
Matrix object_axes(Point extrusion);

// ------------------------------------------------------------------------------------------- placed entities

/// The resolved style of one entity at one insertion: BYLAYER and BYBLOCK replaced by their values.
struct Style {
  std::uint32_t layer = kLayerZero;  ///< that of the insertion for entities of blocks on layer 0
  std::uint32_t linetype = kContinuous;
  int colour = 7;
  int true_colour = kNoTrueColour;
  double linetype_scale = 1.0;
  bool visible = true;  ///< neither hidden nor on a layer that is off or frozen, nor is an insert around it
};
struct Placed {
  const Entity& entity;
  const Matrix& matrix;  ///< to the drawing's world coordinates; object_axes of the entity's not included
  const Style& style;
  const std::vector<const Entity*>& inserts;  ///< that it is part of, the outermost first
};
struct VisitOptions {
  bool paper = false;                     ///< the layouts' entities instead of the model's
  std::size_t max_entities = 10'000'000;  ///< visited in all, inserts included
  std::size_t max_depth = 64;             ///< of blocks in blocks
  Progress* progress = nullptr;           ///< may stop the visit: false then, without an error
};
/// Calls `visit` for each entity of the model, those of blocks at every insertion, in the order of the file.
/// Inserts themselves are not visited. Blocks that contain themselves, undeclared and external ones are
/// skipped with a diagnostic; false, with an error, if a limit is exceeded.
bool for_each_placed(const Drawing& drawing, const VisitOptions& options, Diagnostics& diagnostics,
                     const std::function<void(const Placed&)>& visit);

}  // namespace kerf::dxf
