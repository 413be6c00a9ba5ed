// The DXF drawing: a skeleton that AutoCAD 2000 and later read, and an entity for each piece that is cut.
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numbers>

#include "back/gcmc/strokes.h"

#include "kerf/gcmc_drawing.h"

namespace kerf {
namespace {

using gcmc_drawing::Drawing;
using gcmc_drawing::Piece;

// Group codes with their values, '|' or a line between them. What stands in braces is filled in.
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

constexpr int kFirstHexHandle = 0x200;  // beyond those of the skeleton

class Writer {
 public:
  Writer(const Drawing& drawing, const GcmcDrawingOptions& options) : drawing_(drawing), options_(options) {}

  std::string run() {
    skeleton(kHead);
    for (const Piece& p : drawing_.pieces) {
      if (p.kind == Piece::Kind::line) line(p);
      if (p.kind == Piece::Kind::arc) arc(p);
    }
    skeleton(kTail);
    return std::move(out_);
  }

 private:
  void tag(std::string_view code, std::string_view value) {
    fmt::format_to(std::back_inserter(out_), "{:>3}\n{}\n", code, value);
  }
  void tag(int code, std::string_view value) { tag(std::to_string(code), value); }
  void tag(int code, double value) { tag(code, fmt::format("{:.16f}", value)); }

  void skeleton(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of("|\n"), text.size());
      const std::string_view item = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      if (item.empty()) continue;
      if (item == "{LAYERS}") {
        layer_table();
        continue;
      }
      const std::size_t space = item.find(' ');
      std::string_view value = item.substr(space + 1);
      const std::string count = std::to_string(drawing_.layers.size());
      if (value == "{UNITS}") value = options_.imperial ? "1" : "4";
      if (value == "{LAYER_COUNT}") value = count;
      tag(item.substr(0, space), value);
    }
  }

  void layer_table() {
    for (std::size_t i = 0; i < drawing_.layers.size(); ++i) {
      tag(0, "LAYER");
      tag(5, fmt::format("{:X}", 0x100 + i));
      tag(100, "AcDbSymbolTableRecord");
      tag(100, "AcDbLayerTableRecord");
      tag(2, drawing_.layers[i]);
      tag(70, "0");
      tag(62, "7");
      tag(6, "CONTINUOUS");
      tag(370, "0");
      tag(390, "F");
    }
  }

  void entity(std::string_view type, std::string_view subclass, const Piece& p) {
    ++count_;
    tag(0, type);
    tag(5, options_.hex_handles
               ? fmt::format("{:X}", kFirstHexHandle + static_cast<int>(drawing_.layers.size()) + count_)
               : fmt::format("path{}", count_));
    tag(100, "AcDbEntity");
    if (options_.hex_handles)
      tag(8, drawing_.layers[p.layer]);  // of the common part
    else
      tag(100, subclass), tag(8, drawing_.layers[p.layer]);
    tag(62, "256");
    tag(370, "-1");
    tag(6, "ByLayer");
    if (options_.hex_handles) tag(100, subclass);
  }

  void point(int code, Point3 p) {
    tag(code, p.x);
    tag(code + 10, p.y);
    tag(code + 20, p.z);
  }

  void line(const Piece& p) {
    entity("LINE", "AcDbLine", p);
    point(10, p.from);
    point(11, p.to);
  }

  /// An arc, always counter-clockwise, or a whole circle; the rise of a helix is not drawn.
  void arc(const Piece& p) {
    entity(p.full_circle ? "CIRCLE" : "ARC", "AcDbCircle", p);
    point(10, {p.centre.x, p.centre.y, p.from.z});
    tag(40, distance(p.from.xy(), p.centre));
    if (p.full_circle) return;
    if (options_.hex_handles) tag(100, "AcDbArc");
    const auto angle = [&](Point3 at) {
      const double degrees = std::atan2(at.y - p.centre.y, at.x - p.centre.x) * 180.0 / std::numbers::pi;
      return degrees < 0.0 ? degrees + 360.0 : degrees;
    };
    tag(50, angle(p.turn == Turn::ccw ? p.from : p.to));
    tag(51, angle(p.turn == Turn::ccw ? p.to : p.from));
  }

  const Drawing& drawing_;
  const GcmcDrawingOptions& options_;
  std::string out_;
  int count_ = 0;
};

}  // namespace

std::string gcmc_dxf(const Toolpath& path, const GcmcDrawingOptions& options) {
  const Drawing drawing = gcmc_drawing::drawing_of(path, options);
  return Writer(drawing, options).run();
}

}  // namespace kerf
