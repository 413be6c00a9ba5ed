// Cutting jobs: which operations to run on which outlines, with which tools. The input of `kerf cut`.
//
//   art = "plate.dxf"
//
//   [tools]
//   1 = "square d=6"
//
//   [[operation]]
//   op = "pocket"
//   layers = ["POCKET"]
//   tool = 1
//   depth = 6
//   stepdown = 2
//   feed = 900
//
// Keys of [defaults] apply to all operations that do not have them. Lengths in mm, feeds in mm/min, angles in
// degrees. docs/manual/operations.md describes every key. The table of keys below is the only one: the
// reader, the options of the command, the example and the schema are made from it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/drawing/svg.h"
#include "kerf/geom/outline.h"
#include "kerf/geom/painted.h"
#include "kerf/geom/text.h"
#include "kerf/op/contour.h"
#include "kerf/op/holes.h"
#include "kerf/op/laser.h"
#include "kerf/op/pocket.h"
#include "kerf/op/surface.h"
#include "kerf/op/threads.h"
#include "kerf/op/undercut.h"
#include "kerf/op/v_carve.h"
#include "kerf/path/toolpath.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// A picture with its position and width on the board.
struct PlacedPicture {
  GreyPicture picture;
  Point2 at;  ///< lower left corner, mm
  Length width;
};

/// A closed or open outline, circle, point or picture of the art or of a job file.
struct ArtShape {
  std::string name, layer;
  std::optional<Outline> outline;
  std::optional<Circle> circle;  ///< of an outline that is one
  std::optional<Point2> point;
  std::shared_ptr<const PlacedPicture> picture = {};
  OutlineFill fill = {};  ///< of the outline
};

/// A text of a job, which becomes shapes of its own.
struct TextShape {
  std::string name = "text", layer;
  std::string text;           ///< UTF-8
  std::string font = "sans";  ///< a built-in font of single strokes, or the name of a font file
  TextOptions options{};
};

/// A picture of a job, which becomes a shape.
struct PictureShape {
  std::string name = "picture", layer;
  std::string file;                 ///< PNG, relative to that of the job; empty: `pixels`
  std::vector<std::string> pixels;  ///< rows of digits from 0, white, to 9, black
  Point2 at{};                      ///< lower left corner, mm
  Length width{};                   ///< 0: as the file says
  Origin where{};
};

/// The mesh that operations on surfaces cut.
struct CutSurface {
  std::string file;    ///< relative to that of the job; empty: `mesh`
  SurfaceMesh mesh{};  ///< of heights in the job itself
  double scale = 1.0;  ///< about the origin, then moved
  Point3 move{};       ///< mm
};

enum class CutKind : std::uint8_t {
  pocket,
  contour,
  engrave,
  face,
  drill,
  bore,
  keyhole,
  slot,
  trochoidal_slot,
  thread,
  countersink,
  vcarve,
  vcarve_floor,
  raster,
  waterline,
  project,
  laser,
  laser_cut,
  laser_fill,
  laser_picture,
  laser_test,
  laser_frame
};
/// Whether an operation is a laser's, without a tool.
constexpr bool is_laser(CutKind kind) { return kind >= CutKind::laser; }

/// Of laser operations: what their options do not have in common with those of mills.
struct LaserKeys {
  LaserOptions laser{};  ///< without feed, name and origin
  ScanOptions scan{};
  Length kerf{};
  PictureTones tones = PictureTones::grey;
  double min_power = 0.0, gamma = 1.0;
  bool negative = false;
  double power_to = -1.0;  ///< of the last column of a test; below 0: `laser.power`
  Feed feed_to{};          ///< of the last row; 0: that of the first
  int columns = 1, rows = 1;
  Length cell_width = mm(10), cell_height{}, gap = mm(4), label_height{};
};
/// The two parts of an inlay.
enum class InlayPart : std::uint8_t { pocket, plug };

/// The keys of an operation with their values; a key that was not given is empty.
struct CutOperation {
  CutKind kind = CutKind::pocket;
  std::string name;                           ///< "pocket 1" unless given
  std::vector<std::string> layers, outlines;  ///< both empty: all shapes
  int tool = 0;
  SpindleSpeed speed{};      ///< 0: no spindle word
  bool choose_feed = false;  ///< none is given: it is chosen by the chip load in `material`
  std::string material;
  std::string machine;  ///< file of the machine whose limits a chosen feed keeps; empty: none
  CutOptions cut{};
  double stepover = 0.4;
  PocketPattern pattern = PocketPattern::offset;
  Combining combining = Combining::drawn;  ///< of overlapping shapes
  Angle engagement = degrees(60);          ///< of an adaptive pocket or a trochoidal slot
  Angle angle{};
  ContourSide side = ContourSide::outside;
  LeadKind lead_kind = LeadKind::arc;
  Length lead{}, overlap{}, finish{};
  std::optional<Length> lead_out;  ///< nothing: as `lead`
  TabOptions tabs{};
  DrillKind cycle = DrillKind::plain;
  Length peck{};
  Duration dwell{};
  Length length{}, slot_clearance{}, width{};
  ThreadOptions thread{};                   ///< without `cut`
  std::optional<Angle> cone{};              ///< of a countersink; nothing: 90 degrees
  InlayPart part = InlayPart::pocket;       ///< of a V-carving
  Length glue_gap{}, base_gap{}, margin{};  ///< of a plug
  std::optional<int> rest_tool;             ///< of a pocket or a mesh: only what this tool has left
  Length rest_thickness = mm(0.1);          ///< of a mesh: what is thinner is not cut
  int carve_tool = 0;                       ///< of a vcarve_floor: the tool of the walls
  LaserKeys beam{};
  std::optional<double> retract;        ///< Z; nothing: 5 mm above the highest surface
  bool top_given = false;               ///< otherwise the top of a mesh is its highest point
  Length line_distance{}, overhang{};   ///< of a raster
  Length surface_tolerance = mm(0.01);  ///< of what follows a mesh
};

struct CutJob {
  std::string art;               ///< file, relative to that of the job; may be empty
  std::vector<ArtShape> shapes;  ///< of the job itself, besides those of `art`
  std::vector<TextShape> texts;
  std::vector<PictureShape> pictures;
  std::optional<CutSurface> surface;
  std::optional<Length> unit;                  ///< of one unit of the drawing, if it specifies none
  StrokeShapes strokes = StrokeShapes::lines;  ///< of the drawing
  std::string stock;                           ///< as for --stock; may be empty
  std::map<int, std::string> tools;            ///< by number, as for --tool
  std::map<int, Tool> made_tools;              ///< precede `tools`
  std::vector<CutOperation> operations;
};

/// Text of a value in the command line, or a value of a job file.
using CutValue = std::variant<double, std::string, std::vector<std::string>>;
/// A key of an operation.
struct CutKey {
  std::string_view name;
  enum class Type : std::uint8_t { number, text, list } type = Type::number;
  std::string_view unit;     ///< "mm", or the names that a text may have: "climb, conventional"
  std::string_view meaning;  ///< one line
  std::string_view example;  ///< a value as in a job file
  /// Stores a value; false if it is none of the allowed ones.
  bool (*set)(CutOperation& operation, const CutValue& value) = nullptr;
};
const std::vector<CutKey>& cut_keys();
/// "pocket", "contour", ...
const std::vector<std::string>& cut_kind_names();
/// Whether a key has an effect on operations of this name, and whether they cannot do without it.
bool cut_key_applies(std::string_view kind, std::string_view key);
bool cut_key_is_required(std::string_view kind, std::string_view key);

/// A key of a text or a picture: in a [[shape]], and an option of the command.
template <class Shape>
struct CutShapeKey {
  std::string_view name;
  CutKey::Type type = CutKey::Type::number;
  std::string_view unit, meaning, example;  ///< as of CutKey
  bool (*set)(Shape& shape, const CutValue& value) = nullptr;
};
using CutTextKey = CutShapeKey<TextShape>;
using CutPictureKey = CutShapeKey<PictureShape>;
const std::vector<CutTextKey>& cut_text_keys();
const std::vector<CutPictureKey>& cut_picture_keys();
/// Sets the keys of a text from a list that may have others as well; a text requires its characters and a
/// height. False, with errors, if one is invalid or missing.
bool read_text_keys(const std::vector<std::pair<std::string, std::string>>& values, TextShape& shape,
                    Diagnostics& diagnostics);
/// Whether the font of a text is a file.
bool has_font_file(const TextShape& shape);
/// The outlines of a text; `font` is the content of its font file, if it has one. Nothing, with errors, if
/// invalid.
std::optional<std::vector<ArtShape>> shapes_of_text(const TextShape& shape, std::string_view font,
                                                    Diagnostics& diagnostics);

/// The shape of a picture; `read` are the pixels of its file, if it has one, and `per_mm` their number per mm
/// there, if known. Nothing, with an error, if the width is missing or `pixels` are invalid.
std::optional<ArtShape> shape_of_picture(const PictureShape& shape, GreyPicture read,
                                         std::optional<double> per_mm, Diagnostics& diagnostics);

/// Reads the text of a job file. Nothing, with errors that name line and key, if it is invalid.
std::optional<CutJob> read_cut_job(std::string_view text, const std::string& file_name,
                                   Diagnostics& diagnostics);
/// A job of one operation from keys and their texts, as the command line has them.
std::optional<CutJob> cut_job_of(const std::vector<std::pair<std::string, std::string>>& values,
                                 Diagnostics& diagnostics);
/// A job file to start from, with all keys of an operation.
std::optional<std::string> cut_job_example(std::string_view kind);
/// The JSON schema of job files.
std::string cut_job_schema();

/// Whether an operation of a kind cuts a mesh.
bool cuts_mesh(CutKind kind);

/// The program of a job: tool changes, spindle, the operations in their order. Nothing, with errors, if one
/// of them cannot be cut; tools that do not fit everywhere are warnings. `mesh` is that of the job's surface,
/// as it is moved and scaled; it may be null.
std::optional<Toolpath> compile_cut_job(const CutJob& job, const std::vector<ArtShape>& art,
                                        const std::map<int, Tool>& tools, Diagnostics& diagnostics,
                                        Progress* progress = nullptr, const SurfaceMesh* mesh = nullptr);

}  // namespace kerf
