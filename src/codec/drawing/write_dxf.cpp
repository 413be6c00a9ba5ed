// AutoCAD 2000 (AC1015) files, complete: strict readers refuse files without tables, owners and subclass
// markers.
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "kerf/drawing_files.h"
#include "kerf/number.h"

namespace kerf {
namespace {

constexpr int kDecimals = 10;

/// Letters that a reader may choke on in a symbol name become underscores.
std::string symbol(std::string_view name) {
  std::string made;
  for (const char c : name) {
    const bool unfit =
        static_cast<unsigned char>(c) < ' ' || std::string_view("<>/\\\":;?*|=`,").find(c) < 14;
    made += unfit ? '_' : c;
  }
  return made.empty() ? "_" : made;
}

class DxfWriter {
 public:
  explicit DxfWriter(const Drawing& drawing) : drawing_(drawing) {}
  std::string write();

 private:
  // Handles that other records refer to; the rest are counted on from kFirstFree.
  enum Handle : unsigned {
    kBlockRecords = 1,
    kModel = 2,
    kPaper = 3,
    kLayers = 4,
    kLinetypes = 5,
    kRoot = 6,
    kGroups = 7,
    kStyles = 8,
    kFirstFree = 0x20
  };
  void tag(int group, std::string_view value) {
    fmt::format_to(std::back_inserter(out_), "{:>3}\n{}\n", group, value);
  }
  void tag(int group, const std::string& value) { tag(group, std::string_view(value)); }
  void tag(int group, const char* value) { tag(group, std::string_view(value)); }
  void tag(int group, int value) { tag(group, std::to_string(value)); }
  void tag(int group, double value) { tag(group, number_text(value, kDecimals)); }
  void handle(unsigned value) { tag(5, fmt::format("{:X}", value)); }
  void owner(unsigned value) { tag(330, fmt::format("{:X}", value)); }
  void point(double x, double y) {
    tag(10, x);
    tag(20, y);
    tag(30, 0.0);
  }
  void section(std::string_view name) {
    tag(0, "SECTION");
    tag(2, name);
  }
  void header();
  void begin_table(std::string_view name, unsigned own, int count);
  void record(std::string_view type, std::string_view marker, unsigned own, unsigned table);
  void end_table() { tag(0, "ENDTAB"); }
  void tables();
  void linetypes();
  void layers();
  void other_tables();
  void block(unsigned own, std::string_view name);
  void entity(std::string_view type, std::string_view marker, std::size_t layer);
  void shape(const drawing::Line& line, std::size_t layer);
  void shape(const drawing::Arc& arc, std::size_t layer);
  void shape(const drawing::Circle& circle, std::size_t layer);
  void shape(const drawing::Polyline& line, std::size_t layer);
  void shape(const drawing::Text& text, std::size_t layer);
  void objects();

  const Drawing& drawing_;
  std::string out_;
  unsigned next_ = kFirstFree;
};

void DxfWriter::header() {
  const std::array<double, 4> bounds = drawing_bounds(drawing_);
  const bool inch = drawing_.unit == DrawingUnit::inch;
  section("HEADER");
  tag(9, "$ACADVER");
  tag(1, "AC1015");
  tag(9, "$HANDSEED");
  // Every handle is below this: the records, and one for each entity.
  tag(5, fmt::format("{:X}", kFirstFree + 64 + drawing_.layers.size() + drawing_.entities.size()));
  tag(9, "$INSUNITS");
  tag(70, drawing_.unit == DrawingUnit::none ? 0 : inch ? 1 : 4);
  tag(9, "$MEASUREMENT");
  tag(70, inch ? 0 : 1);
  tag(9, "$EXTMIN");
  point(bounds[0], bounds[1]);
  tag(9, "$EXTMAX");
  point(bounds[2], bounds[3]);
  tag(0, "ENDSEC");
  section("CLASSES");
  tag(0, "ENDSEC");
}

void DxfWriter::begin_table(std::string_view name, unsigned own, int count) {
  tag(0, "TABLE");
  tag(2, name);
  handle(own);
  owner(0);
  tag(100, "AcDbSymbolTable");
  tag(70, count);
}

void DxfWriter::record(std::string_view type, std::string_view marker, unsigned own, unsigned table) {
  tag(0, type);
  if (type == "DIMSTYLE")
    tag(105, fmt::format("{:X}", own));
  else
    handle(own);
  owner(table);
  tag(100, "AcDbSymbolTableRecord");
  tag(100, marker);
}

void DxfWriter::linetypes() {
  struct Type {
    const char* name;
    const char* picture;
    double dashes[2];
    int count;
  };
  static constexpr Type kTypes[] = {{"ByBlock", "", {}, 0},
                                    {"ByLayer", "", {}, 0},
                                    {"Continuous", "Solid line", {}, 0},
                                    {"DASHED", "Dashed __ __ __ __", {3.0, -1.5}, 2}};
  begin_table("LTYPE", kLinetypes, 4);
  for (const Type& type : kTypes) {
    record("LTYPE", "AcDbLinetypeTableRecord", next_++, kLinetypes);
    tag(2, type.name);
    tag(70, 0);
    tag(3, type.picture);
    tag(72, 65);
    tag(73, type.count);
    tag(40, type.count == 0 ? 0.0 : type.dashes[0] - type.dashes[1]);
    for (int i = 0; i < type.count; ++i) {
      tag(49, type.dashes[i]);
      tag(74, 0);
    }
  }
  end_table();
}

void DxfWriter::layers() {
  const bool has_zero = drawing_.layers.front().name == "0";
  begin_table("LAYER", kLayers, static_cast<int>(drawing_.layers.size()) + (has_zero ? 0 : 1));
  const auto one = [&](const std::string& name, int colour, LineKind line) {
    record("LAYER", "AcDbLayerTableRecord", next_++, kLayers);
    tag(2, name);
    tag(70, 0);
    tag(62, colour);
    tag(6, line == LineKind::dashed ? "DASHED" : "Continuous");
  };
  if (!has_zero) one("0", 7, LineKind::solid);
  for (const DrawingLayer& layer : drawing_.layers) one(symbol(layer.name), layer.colour, layer.line);
  end_table();
}

void DxfWriter::other_tables() {
  begin_table("STYLE", kStyles, 1);
  record("STYLE", "AcDbTextStyleTableRecord", next_++, kStyles);
  tag(2, "Standard");
  tag(70, 0);
  tag(40, 0.0);
  tag(41, 1.0);
  tag(50, 0.0);
  tag(71, 0);
  tag(42, 2.5);
  tag(3, "txt");
  tag(4, "");
  end_table();
  for (const char* empty : {"VIEW", "UCS", "VPORT"}) {
    begin_table(empty, next_++, 0);
    end_table();
  }
  const unsigned apps = next_++;
  begin_table("APPID", apps, 1);
  record("APPID", "AcDbRegAppTableRecord", next_++, apps);
  tag(2, "ACAD");
  tag(70, 0);
  end_table();
  const unsigned styles = next_++;
  begin_table("DIMSTYLE", styles, 1);
  tag(100, "AcDbDimStyleTable");
  record("DIMSTYLE", "AcDbDimStyleTableRecord", next_++, styles);
  tag(2, "Standard");
  tag(70, 0);
  end_table();
  begin_table("BLOCK_RECORD", kBlockRecords, 2);
  for (const auto& [own, name] : {std::pair(kModel, "*Model_Space"), std::pair(kPaper, "*Paper_Space")}) {
    record("BLOCK_RECORD", "AcDbBlockTableRecord", own, kBlockRecords);
    tag(2, name);
  }
  end_table();
}

void DxfWriter::tables() {
  section("TABLES");
  linetypes();
  layers();
  other_tables();
  tag(0, "ENDSEC");
}

void DxfWriter::block(unsigned own, std::string_view name) {
  const auto begin = [&](std::string_view type, std::string_view marker) {
    tag(0, type);
    handle(next_++);
    owner(own);
    tag(100, "AcDbEntity");
    tag(8, "0");
    tag(100, marker);
  };
  begin("BLOCK", "AcDbBlockBegin");
  tag(2, name);
  tag(70, 0);
  point(0.0, 0.0);
  tag(3, name);
  tag(1, "");
  begin("ENDBLK", "AcDbBlockEnd");
}

void DxfWriter::entity(std::string_view type, std::string_view marker, std::size_t layer) {
  tag(0, type);
  handle(next_++);
  owner(kModel);
  tag(100, "AcDbEntity");
  tag(8, symbol(drawing_.layers[layer].name));
  tag(100, marker);
}

void DxfWriter::shape(const drawing::Line& line, std::size_t layer) {
  entity("LINE", "AcDbLine", layer);
  point(line.x1, line.y1);
  tag(11, line.x2);
  tag(21, line.y2);
  tag(31, 0.0);
}

void DxfWriter::shape(const drawing::Arc& arc, std::size_t layer) {
  const auto turned = [](double degrees) {
    const double rest = std::fmod(degrees, 360.0);
    return rest < 0.0 ? rest + 360.0 : rest;
  };
  entity("ARC", "AcDbCircle", layer);
  point(arc.x, arc.y);
  tag(40, arc.radius);
  tag(100, "AcDbArc");
  tag(50, turned(arc.start));
  tag(51, turned(arc.end));
}

void DxfWriter::shape(const drawing::Circle& circle, std::size_t layer) {
  entity("CIRCLE", "AcDbCircle", layer);
  point(circle.x, circle.y);
  tag(40, circle.radius);
}

void DxfWriter::shape(const drawing::Polyline& line, std::size_t layer) {
  entity("LWPOLYLINE", "AcDbPolyline", layer);
  tag(90, static_cast<int>(line.vertices.size()));
  tag(70, line.closed ? 1 : 0);
  for (const drawing::Vertex& vertex : line.vertices) {
    tag(10, vertex.x);
    tag(20, vertex.y);
    if (vertex.bulge != 0.0) tag(42, vertex.bulge);
  }
}

void DxfWriter::shape(const drawing::Text& text, std::size_t layer) {
  std::string line = text.text;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  entity("TEXT", "AcDbText", layer);
  point(text.x, text.y);
  tag(40, text.height);
  tag(1, line);
  tag(100, "AcDbText");
}

void DxfWriter::objects() {
  const auto dictionary = [&](unsigned own, unsigned parent) {
    tag(0, "DICTIONARY");
    handle(own);
    owner(parent);
    tag(100, "AcDbDictionary");
    tag(281, 1);
  };
  section("OBJECTS");
  dictionary(kRoot, 0);
  tag(3, "ACAD_GROUP");
  tag(350, fmt::format("{:X}", static_cast<unsigned>(kGroups)));
  dictionary(kGroups, kRoot);
  tag(0, "ENDSEC");
}

std::string DxfWriter::write() {
  header();
  tables();
  section("BLOCKS");
  block(kModel, "*Model_Space");
  block(kPaper, "*Paper_Space");
  tag(0, "ENDSEC");
  section("ENTITIES");
  for (const DrawingEntity& e : drawing_.entities)
    std::visit([&](const auto& s) { shape(s, e.layer); }, e.shape);
  tag(0, "ENDSEC");
  objects();
  tag(0, "EOF");
  return std::move(out_);
}

}  // namespace

std::string write_dxf(const Drawing& drawing) { return DxfWriter(drawing).write(); }

}  // namespace kerf
