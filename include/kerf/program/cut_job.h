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
// degrees. docs/manual/operations.md describes every key. The rows of the operations (kerf/op/rows.h) have
// them: the reader, the options of the command, the example and the schema are made from these.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/drawing/svg.h"
#include "kerf/geom/geometry.h"
#include "kerf/geom/outline.h"
#include "kerf/geom/region.h"
#include "kerf/geom/text.h"
#include "kerf/op/laser.h"
#include "kerf/op/rows.h"
#include "kerf/op/surface.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

// The layout of the shapes of a cutting job: mirrored, turned, scaled, repeated in a grid, then moved so that
// work zero is where the job wants it.

struct ArtShape;  // program/cut_job.h

/// Which axis changes its sign.
enum class ArtMirror : std::uint8_t { none, x, y };

/// The order of the operations. In all but `as_written`, what is cut out comes after the work inside of it.
enum class CutOrder : std::uint8_t {
  inner_first,  ///< otherwise as written
  by_tool,      ///< few tool changes
  by_part,      ///< all operations on one part, then on the next one
  as_written
};

/// How the length of a further tool becomes known on a machine without tool lengths.
enum class TouchOff : std::uint8_t {
  none,
  message,  ///< the operator sets the zero in Z
  probe     ///< G38.2 finds where the tool is, and the zero is set
};
/// Where and how tools are changed, but for the first one.
struct ChangePosition {
  std::optional<double> height;  ///< Z; nothing: that of rapids
  std::optional<Point2> at;      ///< nothing: where the tool is
  TouchOff touch_off = TouchOff::none;
  std::optional<Point2> probe_at;  ///< nothing: where tools are changed
  double probe_height = 0.0;       ///< Z of what is touched
};

struct CutLayout {
  ArtMirror mirror = ArtMirror::none;
  Angle rotate{};
  double scale = 1.0;
  Length fit_width{}, fit_height{};  ///< of all copies together; 0: not fitted. With both the smaller scale
  int columns = 1, rows = 1;
  Length gap{};     ///< between copies
  Length margin{};  ///< around the shapes
  /// The point of the box around the shapes and the margin that becomes work zero; nothing: the drawing's
  /// own, or `zero`.
  std::optional<ZeroCorner> origin;
  std::optional<Point2> zero;  ///< the point of the drawing that becomes work zero
  Point2 move{};               ///< at last
  Length thickness{};          ///< of a block below the shapes and their margin; 0: none
  Length spoilboard{};         ///< thickness of the board below the stock, into which cuts may go
  CutOrder order = CutOrder::inner_first;
  ChangePosition change;
  std::optional<Point2> park;  ///< where the tool is at the end; nothing: where it was
  std::string wrap;            ///< of ReworkOptions; empty: the job stays flat
};
using CutLayoutKey = CutKeyOf<CutLayout>;
/// Keys of a job, and options of the command.
const std::vector<CutLayoutKey>& cut_layout_keys();

/// Lays out the shapes. Nothing, with an error, if they cannot be laid out so; else the box around them and
/// the margin.
std::optional<Box2> lay_out(const CutLayout& layout, std::vector<ArtShape>& shapes, const Origin& where,
                            Diagnostics& diagnostics);

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

/// A number of an operation that depends on the stock: "stock.z + 0.2".
struct CutFormula {
  std::size_t operation = 0;
  const CutKey* key = nullptr;
  std::string text;
  Origin where{};
};

struct CutJob {
  std::string art;               ///< file, relative to that of the job; may be empty
  std::vector<ArtShape> shapes;  ///< of the job itself, besides those of `art`
  std::vector<TextShape> texts;
  std::vector<PictureShape> pictures;
  std::optional<CutSurface> surface;
  CutLayout layout;
  std::optional<Length> unit;                  ///< of one unit of the drawing, if it specifies none
  StrokeShapes strokes = StrokeShapes::lines;  ///< of the drawing
  std::vector<std::string> stroke_layers;      ///< layers whose strokes are areas; the others are `strokes`
  std::string drawing_texts = "drawn";         ///< DrawingOutlineOptions::texts
  std::string stock;                           ///< as for --stock; may be empty
  std::map<int, std::string> tools;            ///< by number, as for --tool
  std::map<int, Tool> made_tools;              ///< precede `tools`
  std::vector<CutOperation> operations;
  std::vector<CutFormula> formulas;  ///< of `operations`
  std::optional<Box3> stock_box;     ///< once it is known, by resolve_formulas
};

/// Sets the numbers of a job that depend on the stock: stock.x, stock.y and stock.z are its sizes,
/// stock.left, stock.right, stock.front, stock.back, stock.bottom and stock.top its faces; and the depth of
/// what goes through the stock. The job keeps the stock. Nothing: there is none. False, with errors, if a
/// number is missing or not allowed.
bool resolve_formulas(CutJob& job, const std::optional<Box3>& stock, Diagnostics& diagnostics);

/// The rows of all operations.
const std::vector<CutRow>& cut_rows();
/// The row of "pocket", in any spelling of it; null: there is none.
const CutRow* cut_row(std::string_view name);
/// "pocket", "contour", ...
std::vector<std::string> cut_operation_names();

/// A key of any operation as an option: where operations differ, its texts say so.
struct CutOption {
  const CutRow* row = nullptr;  ///< the first operation that has it
  const CutKey* key = nullptr;  ///< there
  std::string meaning, usual;   ///< "below the surface"; "0.4; 0.1 for raster": the default, if there is one
};
const std::vector<CutOption>& cut_options();

/// Keys of a text and a picture: in a [[shape]], and options of the command.
using CutTextKey = CutKeyOf<TextShape>;
using CutPictureKey = CutKeyOf<PictureShape>;
const std::vector<CutTextKey>& cut_text_keys();
const std::vector<CutPictureKey>& cut_picture_keys();
using CutValues = std::vector<std::pair<std::string, CutValue>>;
/// Sets the keys of a text from a list that may have others as well; a text requires its characters and a
/// height. False, with errors, if one is invalid or missing.
bool read_text_keys(const CutValues& values, TextShape& shape, Diagnostics& diagnostics);
/// Whether the font of a text is a file, not a name.
bool has_font_file(const TextShape& shape);
struct TextFontFile {
  std::string file;  ///< empty: a built-in font
  int face = 0;      ///< in the file
};
/// Where the font of a text is: the file that it names, or that of the installed font of this family and
/// style
/// ("DejaVu Sans:bold"). Nothing, with an error that names similar fonts, if there is none.
std::optional<TextFontFile> font_file_of(const TextShape& shape, Diagnostics& diagnostics);
/// The characters of a text in a font file, whose bytes are `font`.
std::optional<TextFont> font_of_file(const TextShape& shape, std::string_view font, Diagnostics& diagnostics,
                                     int face = 0);
/// The outlines of a text; `font` is the content of its font file, if it has one. Nothing, with errors, if
/// invalid.
std::optional<std::vector<ArtShape>> shapes_of_text(const TextShape& shape, std::string_view font,
                                                    Diagnostics& diagnostics, int face = 0);

/// The shape of a picture; `read` are the pixels of its file, if it has one, and `per_mm` their number per mm
/// there, if known. Nothing, with an error, if the width is missing or `pixels` are invalid.
std::optional<ArtShape> shape_of_picture(const PictureShape& shape, GreyPicture read,
                                         std::optional<double> per_mm, Diagnostics& diagnostics);

/// Values for what a job does not state.
struct CutDefaults {
  std::string machine, material;  ///< of operations without a feed
  Length spoilboard{};
};

/// Reads the text of a job file. Nothing, with errors that name line and key, if it is invalid.
/// Points, shapes and the layout may depend on the stock as formulas of operations do, if `stock_of` finds
/// that of the key "stock".
std::optional<CutJob> read_cut_job(
    std::string_view text, const std::string& file_name, Diagnostics& diagnostics,
    const std::function<std::optional<Box3>(const std::string& stock)>& stock_of = {},
    const CutDefaults& defaults = {});
/// A job of one operation, which has the key "op", from keys and their values. Numbers, points and lists may
/// be texts, as the command line has them.
std::optional<CutJob> cut_job_of(const CutValues& values, Diagnostics& diagnostics,
                                 const std::optional<Box3>& stock = std::nullopt,
                                 const CutDefaults& defaults = {});
/// A job file to start from, with all keys of an operation.
std::optional<std::string> cut_job_example(std::string_view operation);
/// The JSON schema of job files.
std::string cut_job_schema();

/// The program of a job: tool changes, spindle, the operations in their order. Nothing, with errors, if one
/// of them cannot be cut; tools that do not fit everywhere are warnings. `mesh` is that of the job's surface,
/// as it is moved and scaled; it may be null.
std::optional<Toolpath> compile_cut_job(const CutJob& job, const std::vector<ArtShape>& art,
                                        const std::map<int, Tool>& tools, Diagnostics& diagnostics,
                                        Progress* progress = nullptr, const SurfaceMesh* mesh = nullptr);

}  // namespace kerf
