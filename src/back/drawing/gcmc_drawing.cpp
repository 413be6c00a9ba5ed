// The drawings of the gcmc command: its SVG and DXF files, byte for byte.
#include "back/drawing/gcmc_drawing.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <utility>

#include "back/drawing/shapes.h"
#include "back/drawing/strokes.h"
#include "codec/drawing/forms.h"

#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"

namespace kerf {
namespace {

using drawings::Stroke;

constexpr double kSamePoint = 1e-12;  // drawing's unit; closer than this the ends of an arc are one point
constexpr int kMaxChords = 2000;      // of one arc
constexpr double kDotsPerInch = 90.0;
constexpr double kMoveWidth = 0.1;  // dots, of the line that shows a rapid

// Group codes with their values, see DxfForm.
constexpr std::string_view kHead = R"(
999 gcmc 1.0.0-oracle
0 SECTION|2 HEADER|9 $ACADVER|1 AC1015|9 $HANDSEED|5 FFFF|9 $INSUNITS|70 {UNITS}|9 $PLIMMAX|10 210.000000|
20 297.000000|9 $PLIMMIN|10 0.0|20 0.0
0 ENDSEC
0 SECTION|2 TABLES
0 TABLE|2 VPORT|5 8|100 AcDbSymbolTable|70 1
0 VPORT|5 30|100 AcDbSymbolTableRecord|100 AcDbViewportTableRecord|2 *Active|70 0|10 0.0|20 0.0|
11 1.0|21 1.0|12 286.3055555555554861|22 148.5|13 0.0|23 0.0|14 10.0|24 10.0|15 10.0|25 10.0|16 0.0|
26 0.0|36 1.0|17 0.0|27 0.0|37 0.0|40 297.0|41 1.92798353909465|42 50.0|43 0.0|44 0.0|50 0.0|51 0.0|
71 0|72 100|73 1|74 3|75 1|76 1|77 0|78 0|281 0|65 1|110 0.0|120 0.0|130 0.0|111 1.0|121 0.0|131 0.0|
112 0.0|122 1.0|132 0.0|79 0|146 0.0
0 ENDTAB
0 TABLE|2 LTYPE|5 5|100 AcDbSymbolTable|70 3
0 LTYPE|5 14|100 AcDbSymbolTableRecord|100 AcDbLinetypeTableRecord|2 ByBlock|70 0|3 |72 65|73 0|
40 0.0
0 LTYPE|5 15|100 AcDbSymbolTableRecord|100 AcDbLinetypeTableRecord|2 ByLayer|70 0|3 |72 65|73 0|
40 0.0
0 LTYPE|5 16|100 AcDbSymbolTableRecord|100 AcDbLinetypeTableRecord|2 CONTINUOUS|70 0|3 Solid line|
72 65|73 0|40 0.0|74 0
0 ENDTAB
0 TABLE|2 LAYER|5 2|100 AcDbSymbolTable|70 {LAYER_COUNT}
{LAYERS}
0 ENDTAB
0 TABLE|2 STYLE|5 3|100 AcDbSymbolTable|70 1
0 STYLE|5 11|100 AcDbSymbolTableRecord|100 AcDbTextStyleTableRecord|2 Standard|70 0|40 0.0|41 0.75|
50 0.0|71 0|42 2.5|3 txt|4 
0 ENDTAB
0 TABLE|2 VIEW|5 6|100 AcDbSymbolTable|70 0
0 ENDTAB
0 TABLE|2 UCS|5 7|100 AcDbSymbolTable|70 0
0 ENDTAB
0 TABLE|2 APPID|5 9|100 AcDbSymbolTable|70 1
0 APPID|5 12|100 AcDbSymbolTableRecord|100 AcDbRegAppTableRecord|2 ACAD|70 0
0 ENDTAB
0 TABLE|2 DIMSTYLE|5 A|100 AcDbSymbolTable|70 1|100 AcDbDimStyleTable|71 0
0 DIMSTYLE|105 27|100 AcDbSymbolTableRecord|100 AcDbDimStyleTableRecord|2 Standard|41 2.5|42 0.625|
43 3.75|44 1.25|70 0|73 0|74 0|77 1|78 8|140 2.5|141 2.5|143 0.03937007874016|147 0.625|171 3|172 1|
271 2|272 2|274 3|278 44|283 0|284 8|340 11
0 ENDTAB
0 TABLE|2 BLOCK_RECORD|5 1|100 AcDbSymbolTable|70 1
0 BLOCK_RECORD|5 1F|100 AcDbSymbolTableRecord|100 AcDbBlockTableRecord|2 *Model_Space|340 22
0 BLOCK_RECORD|5 1B|100 AcDbSymbolTableRecord|100 AcDbBlockTableRecord|2 *Paper_Space|340 1E
0 ENDTAB
0 ENDSEC
0 SECTION|2 BLOCKS
0 BLOCK|5 20|100 AcDbEntity|8 0|100 AcDbBlockBegin|2 *Model_Space|70 0|10 0.0|20 0.0|30 0.0|
3 *Model_Space|1 
0 ENDBLK|5 21|100 AcDbEntity|8 0|100 AcDbBlockEnd
0 BLOCK|5 1C|100 AcDbEntity|67 1|8 0|100 AcDbBlockBegin|2 *Paper_Space|70 0|10 0.0|20 0.0|30 0.0|
3 *Paper_Space|1 
0 ENDBLK|5 1D|100 AcDbEntity|67 1|8 0|100 AcDbBlockEnd
0 ENDSEC
0 SECTION|2 ENTITIES
)";
constexpr std::string_view kTail = R"(
0 ENDSEC
0 SECTION|2 OBJECTS
0 DICTIONARY|5 C|100 AcDbDictionary|280 0|281 1|3 ACAD_GROUP|350 D|3 ACAD_LAYOUT|350 1A|
3 ACAD_MLINESTYLE|350 17|3 ACAD_PLOTSETTINGS|350 19|3 ACAD_PLOTSTYLENAME|350 E|
3 AcDbVariableDictionary|350 44
0 DICTIONARY|5 D|100 AcDbDictionary|280 0|281 1
0 ACDBDICTIONARYWDFLT|5 E|100 AcDbDictionary|281 1|3 Normal|350 F|100 AcDbDictionaryWithDefault|
340 F
0 ACDBPLACEHOLDER|5 F
0 DICTIONARY|5 17|100 AcDbDictionary|280 0|281 1|3 Standard|350 18
0 MLINESTYLE|5 18|100 AcDbMlineStyle|2 STANDARD|70 0|3 |62 256|51 90.0|52 90.0|71 2|49 0.5|62 256|
6 BYLAYER|49 -0.5|62 256|6 BYLAYER
0 DICTIONARY|5 19|100 AcDbDictionary|280 0|281 1
0 DICTIONARY|5 1A|100 AcDbDictionary|281 1|3 Layout1|350 1E|3 Layout2|350 26|3 Model|350 22
0 DICTIONARY|5 44|100 AcDbDictionary|281 1|3 DIMASSOC|350 46|3 HIDETEXT|350 45
0 DICTIONARYVAR|5 45|100 DictionaryVariables|280 0|1 2
0 DICTIONARYVAR|5 46|100 DictionaryVariables|280 0|1 1
0 ENDSEC
0 EOF
)";

constexpr std::string_view kLayer =
    "0 LAYER|5 {HANDLE}|100 AcDbSymbolTableRecord|100 AcDbLayerTableRecord|2 {LAYER}|70 0|62 7|6 "
    "CONTINUOUS|370 0|"
    "390 F";
// As strict readers require it, and as the real program writes it.
constexpr std::string_view kStrictEntity =
    "0 {TYPE}|5 {HANDLE}|100 AcDbEntity|8 {LAYER}|62 256|370 -1|6 ByLayer|100 {SUBCLASS}";
constexpr std::string_view kEntity =
    "0 {TYPE}|5 {HANDLE}|100 AcDbEntity|100 {SUBCLASS}|8 {LAYER}|62 256|370 -1|6 ByLayer";
constexpr std::size_t kFirstLayerHandle = 0x100, kFirstHexHandle = 0x200;  // beyond those of the head

/// The base of both drawings: strokes in the drawing's unit, on the layers of the path. layers[0] is for
/// strokes before the first layer().
class Sketch : public drawings::StrokeSink {
 public:
  Sketch(const Toolpath& path, const GcmcDrawingOptions& options)
      : path_(path), options_(options), scale_(options.imperial ? 1.0 / kMmPerInch : 1.0) {
    drawing_.unit = options.imperial ? DrawingUnit::inch : DrawingUnit::mm;
    drawing_.layers.clear();
    add_layer("0");
    for (const std::string& name : options.layers) add_layer(name);
  }

  void draw() {
    drawings::StrokeOptions walk;
    walk.max_chords = kMaxChords;
    drawings::walk_strokes(path_, walk, *this);
  }

  void stroke(const Stroke& stroke) override {
    const bool rapid = path_[stroke.step].kind() == StepKind::rapid;
    if (stroke.arc == nullptr)
      line(scale_ * stroke.from, scale_ * stroke.to, rapid);
    else
      arc(stroke);
  }

  void setting(std::size_t step) override {
    if (path_[step].kind() == StepKind::layer) set_layer(path_.layer(step).name);
    if (path_[step].kind() == StepKind::close_path) close();
  }

 protected:
  struct Arc {
    Point3 from, to;
    Point2 centre;
    Turn turn = Turn::ccw;
    bool is_circle = false;
  };
  virtual void line(Point3 from, Point3 to, bool rapid) = 0;
  virtual void arc(const Arc& arc) = 0;
  virtual void close() {}
  virtual void layer_changed() {}

  const Toolpath& path_;
  const GcmcDrawingOptions& options_;
  double scale_;
  Drawing drawing_;
  std::size_t layer_ = 0;

 private:
  void add_layer(const std::string& name) { drawing_.layers.emplace_back().name = name; }

  void set_layer(const std::string& name) {
    auto& layers = drawing_.layers;
    const auto found = std::find_if(layers.begin() + 1, layers.end(),
                                    [&](const DrawingLayer& layer) { return layer.name == name; });
    layer_ = static_cast<std::size_t>(found - layers.begin());
    if (found == layers.end()) add_layer(name);
    layer_changed();
  }

  /// Whole turns become one circle, the rest an arc.
  void arc(const Stroke& stroke) {
    const step::Arc given = path_[stroke.step].arc();
    Arc piece;
    piece.from = scale_ * stroke.from;
    piece.to = scale_ * stroke.to;
    piece.centre = scale_ * given.centre;
    piece.turn = given.turn;
    const bool returns = distance(piece.from.xy(), piece.to.xy()) < kSamePoint;
    if (given.extra_turns > 0 && !returns) {
      Arc circle = piece;
      circle.to = circle.from;
      circle.is_circle = true;
      arc(circle);
    }
    piece.is_circle = returns;
    arc(piece);
  }
};

// ---- DXF

class DxfSketch final : public Sketch {
 public:
  using Sketch::Sketch;

  std::string write() {
    draw();
    drawings::DxfForm form;
    form.head = kHead;
    form.tail = kTail;
    form.layer = kLayer;
    form.entity = options_.hex_handles ? kStrictEntity : kEntity;
    form.arc_marker = options_.hex_handles;
    form.angles = drawings::DxfAngles::as_given;
    form.decimals = drawings::Decimals::fixed;
    form.digits = 16;
    form.layer_handle = [](std::size_t index) { return fmt::format("{:X}", kFirstLayerHandle + index); };
    form.entity_handle = [&](std::size_t count) {
      return options_.hex_handles ? fmt::format("{:X}", kFirstHexHandle + drawing_.layers.size() + count)
                                  : fmt::format("path{}", count);
    };
    return drawings::write_dxf(drawing_, form);
  }

 private:
  void line(Point3 from, Point3 to, bool rapid) override {
    if (!rapid) drawings::add(drawing_, layer_, drawing::Line{from.x, from.y, to.x, to.y, from.z, to.z});
  }

  /// Counter-clockwise, or a whole circle; the rise of a helix is not drawn.
  void arc(const Arc& arc) override {
    const double radius = distance(arc.from.xy(), arc.centre);
    if (arc.is_circle)
      return drawings::add(drawing_, layer_, drawing::Circle{arc.centre.x, arc.centre.y, radius, arc.from.z});
    const auto angle = [&](Point3 at) {
      const double degrees = std::atan2(at.y - arc.centre.y, at.x - arc.centre.x) * 180.0 / std::numbers::pi;
      return degrees < 0.0 ? degrees + 360.0 : degrees;
    };
    const bool ccw = arc.turn == Turn::ccw;
    drawings::add(drawing_, layer_,
                  drawing::Arc{arc.centre.x, arc.centre.y, radius, angle(ccw ? arc.from : arc.to),
                               angle(ccw ? arc.to : arc.from), arc.from.z});
  }
};

// ---- SVG

/// A path continues while the motions are all cuts or all rapids, up to a change of layer.
class SvgSketch final : public Sketch {
 public:
  SvgSketch(const Toolpath& path, const GcmcDrawingOptions& options) : Sketch(path, options) {
    dots_ = options.imperial ? kDotsPerInch : kDotsPerInch / kMmPerInch;
    tool_ = options.tool_width > 0.0 ? options.tool_width : options.imperial ? 0.125 : 3.0;
  }

  std::string write() {
    box_.add(Point3{0, 0, 0});
    draw();
    moves_ = drawing_.layers.size();
    if (options_.show_moves) drawing_.layers.emplace_back();
    std::erase_if(drawing_.entities,
                  [&](const DrawingEntity& e) { return !options_.show_moves && e.layer == kMoves; });
    bool first = true;
    for (std::size_t i = 0; i < drawing_.entities.size(); ++i) {
      if (drawing_.entities[i].layer != kMoves) continue;
      drawing_.entities[i].layer = moves_;
      if (std::exchange(first, false)) first_move_ = i;
    }
    drawings::SvgForm form;
    form.head = head();
    form.group = [&](std::size_t layer) { return group(layer); };
    form.attributes = [&](std::size_t entity, std::size_t count) { return attributes(entity, count); };
    form.y = drawings::SvgY::as_drawn;
    form.decimals = drawings::Decimals::fixed;
    form.command_gap = " ";
    form.flag_gap = ",";
    return drawings::write_svg(drawing_, form);
  }

 private:
  static constexpr std::size_t kMoves =
      std::numeric_limits<std::size_t>::max();  // the layer of rapids, before it is made
  enum class Last : std::uint8_t { none, cut, rapid };

  drawing::Polyline& chain(Point3 from, bool rapid) {
    const Last now = rapid ? Last::rapid : Last::cut;
    if (!rapid) uses_no_layer_ = uses_no_layer_ || layer_ == 0;
    if (last_ != now) {
      drawings::add(drawing_, rapid ? kMoves : layer_, drawing::Polyline{{{from.x, from.y}}, false});
      last_ = now;
    }
    return std::get<drawing::Polyline>(drawing_.entities.back().shape);
  }

  void line(Point3 from, Point3 to, bool rapid) override {
    chain(from, rapid).vertices.push_back({to.x, to.y});
    box_.add(Point3{to.x, to.y, 0});
  }

  void arc(const Arc& arc) override {
    std::vector<drawing::Vertex>& vertices = chain(arc.from, false).vertices;
    const double radius = distance(arc.from.xy(), arc.centre);
    const double sign = arc.turn == Turn::ccw ? 1.0 : -1.0;
    const auto bulge_to = [&](double bulge, Point2 to) {
      vertices.back().bulge = sign * bulge;
      vertices.back().radius = radius;
      vertices.push_back({to.x, to.y});
    };
    const ArcWalk walk = walk_arc(arc.from, arc.to, arc.centre, Plane::xy, arc.turn, 0);
    if (arc.is_circle) {  // two halves: one arc cannot end at its start point
      bulge_to(1.0, arc.centre + (arc.centre - arc.from.xy()));
      bulge_to(1.0, arc.to.xy());
    } else {
      const Point2 a = arc.from.xy() - arc.centre, b = arc.to.xy() - arc.centre;
      const bool left =
          cross(a, b) >= 0.0;  // the end is less than half a turn counter-clockwise of the start
      const double bulge = std::abs(std::tan(0.25 * walk.sweep));
      const bool is_large = left != (arc.turn == Turn::ccw);
      bulge_to(is_large ? std::max(bulge, std::nextafter(1.0, 2.0)) : std::min(bulge, 1.0), arc.to.xy());
    }
    box_.add(Point3{arc.to.x, arc.to.y, 0});
    Box3 reach = walk.bounds();
    reach.low.z = reach.high.z = 0;
    box_.add(reach);
  }

  void close() override {
    if (drawing_.entities.empty() || last_ == Last::rapid) return;
    if (last_ == Last::none) return;
    std::get<drawing::Polyline>(drawing_.entities.back().shape).closed = true;
    last_ = Last::none;
  }

  void layer_changed() override { last_ = Last::none; }

  std::string head() const {
    const double width = box_.size().x + tool_, height = box_.size().y + tool_;
    const char* unit = options_.imperial ? "in" : "mm";
    std::string text =
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>\n"
        "<!-- Created with Kerf -->\n"
        "<svg\n"
        "  xmlns=\"http://www.w3.org/2000/svg\"\n"
        "  xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\"\n"
        "  xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n"
        "  version=\"1.1\"\n";
    text += fmt::format("  width=\"{:f}{}\"\n  height=\"{:f}{}\"\n", width, unit, height, unit);
    text += fmt::format("  viewBox=\"0.0 0.0 {:f} {:f}\"\n>\n", width * dots_, height * dots_);
    text += fmt::format(
        "<sodipodi:namedview\n  inkscape:document-units=\"{0}\"\n  units=\"{0}\"\n  showgrid=\"{1}\">\n",
        unit, options_.show_grid ? "true" : "false");
    if (options_.show_grid) {
      text += fmt::format(
          "  <inkscape:grid\n    type=\"xygrid\"\n    units=\"{}\"\n    empspacing=\"4\"\n    "
          "visible=\"true\"\n"
          "    enabled=\"true\"\n    snapvisiblegridlinesonly=\"true\" />\n",
          unit);
    }
    return text + "</sodipodi:namedview>\n";
  }

  std::string group(std::size_t layer) const {
    if (layer == 0 && moves_ > 1 && !uses_no_layer_) return {};
    const bool is_moves = layer == moves_;
    const std::string name = layer == 0 ? "cutpath" : drawing_.layers[layer].name;
    const double x = tool_ / 2 - box_.low.x;
    const double y = tool_ / 2 + (options_.flip ? box_.high.y : -box_.low.y);
    return fmt::format(
        "<g inkscape:label=\"{}\" inkscape:groupmode=\"layer\" id=\"{}\" transform=\"scale({:f}) "
        "translate({:f} {:f}){}\">\n",
        is_moves ? "Move Path" : name, is_moves ? "movepath" : name, dots_, x, y,
        options_.flip ? " scale(1 -1)" : "");
  }

  std::string attributes(std::size_t entity, std::size_t count) const {
    if (drawing_.entities[entity].layer == moves_)
      return fmt::format("style=\"stroke:{};stroke-width:{:f};fill:none\" id=\"path{}\" ",
                         entity == first_move_ ? "#ff0000" : "#000000", kMoveWidth / dots_, count);
    return fmt::format(
        "style=\"stroke:#000000;stroke-width:{:f};fill:none;stroke-linecap:round;stroke-linejoin:round;"
        "stroke-opacity:{:f}\" id=\"path{}\" ",
        tool_, options_.opacity, count);
  }

  double dots_ = 1.0, tool_ = 0.0;  // dots per unit; width of cuts
  Box3 box_;
  Last last_ = Last::none;  // kind of the chain that the next stroke may continue
  bool uses_no_layer_ = false;
  std::size_t moves_ = 0, first_move_ = 0;
};

}  // namespace

std::string gcmc_svg(const Toolpath& path, const GcmcDrawingOptions& options) {
  return SvgSketch(path, options).write();
}

std::string gcmc_dxf(const Toolpath& path, const GcmcDrawingOptions& options) {
  return DxfSketch(path, options).write();
}

}  // namespace kerf
