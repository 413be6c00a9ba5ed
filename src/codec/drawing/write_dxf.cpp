// Writes complete AutoCAD 2000 files (AC1015), because strict readers reject files without tables, owners and
// subclass markers; and R12 (AC1009), which has none of these, no lightweight polylines, and restricted
// names.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/number.h"
#include "codec/drawing/forms.h"

#include "kerf/drawing/drawing_files.h"

namespace kerf {
namespace {

using drawings::Decimals;
using drawings::DxfForm;

/// Text in ASCII, independent of the code page: other characters as \U+00E9, those above U+FFFF and invalid
/// UTF-8 as '?'.
std::string ascii(std::string_view text) {
  constexpr unsigned kLastWritten = 0xffff;  // \U+ has four digits
  std::string made;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t more = byte < 0x80   ? 0
                             : byte < 0xc0 ? 9
                             : byte < 0xe0 ? 1
                             : byte < 0xf0 ? 2
                             : byte < 0xf8 ? 3
                                           : 9;
    if (more == 0) made += text[i];
    const std::size_t length = more == 9 ? 1 : 1 + more;
    unsigned number = more == 1 ? byte & 0x1fu : more == 2 ? byte & 0x0fu : byte & 0x07u;
    bool whole = more != 9 && i + length <= text.size();
    for (std::size_t k = 1; whole && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      whole = (next & 0xc0u) == 0x80u;
      number = (number << 6) | (next & 0x3fu);
    }
    if (more != 0) made += whole && number <= kLastWritten ? fmt::format("\\U+{:04X}", number) : "?";
    i += whole ? length : 1;
  }
  return made;
}

/// Replaces the characters that are not allowed in symbol names by underscores.
std::string symbol(std::string_view name) {
  std::string made;
  for (const char c : name) {
    const bool unfit =
        static_cast<unsigned char>(c) < ' ' || std::string_view("<>/\\\":;?*|=`,").find(c) < 14;
    made += unfit ? '_' : c;
  }
  made = ascii(made);
  std::replace(made.begin(), made.end(), '?', '_');
  return made.empty() ? "_" : made;
}

/// A name for R12: capitals, digits, '$', '-' and '_', at most 31.
std::string symbol_r12(std::string_view name) {
  constexpr std::size_t kMaxBytes = 31;  // of a layer's name in R12
  std::string made;
  for (const char c : name.substr(0, kMaxBytes)) {
    const bool small = c >= 'a' && c <= 'z';
    const bool fit = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '$' || c == '-';
    made += small ? static_cast<char>(c - 'a' + 'A') : fit ? c : '_';
  }
  return made.empty() ? "_" : made;
}

class DxfWriter {
 public:
  DxfWriter(const Drawing& drawing, DxfVersion version, const DxfForm& form)
      : drawing_(drawing), form_(form), r12_(version == DxfVersion::r12) {
    for (const DrawingLayer& layer : drawing.layers)
      layers_.push_back(r12_ ? symbol_r12(layer.name) : symbol(layer.name));
  }
  std::string write();
  /// With head, tail and starts of entities from the form.
  std::string write_form();

 private:
  // Handles that other records refer to; the others are numbered from kFirstFree.
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
  void tag(int group, double value) {
    tag(group, form_.decimals == Decimals::fixed ? fmt::format("{:.{}f}", value, form_.digits)
                                                 : number_text(value, form_.digits));
  }
  // R12 has neither of these three.
  void handle(unsigned value) {
    if (!r12_) tag(5, fmt::format("{:X}", value));
  }
  void owner(unsigned value) {
    if (!r12_) tag(330, fmt::format("{:X}", value));
  }
  void subclass(std::string_view marker) {
    if (!r12_) tag(100, marker);
  }
  void point(double x, double y, double z = 0.0) {
    tag(10, x);
    tag(20, y);
    tag(30, z);
  }
  void section(std::string_view name) {
    tag(0, "SECTION");
    tag(2, name);
  }
  void header();
  void start_table(std::string_view name, unsigned own, int count);
  void record(std::string_view type, std::string_view marker, unsigned own, unsigned table);
  void end_table() { tag(0, "ENDTAB"); }
  void tables();
  void linetypes();
  void layers();
  void text_styles();
  void other_tables();
  void block(unsigned own, std::string_view name);
  void entity(std::string_view type, std::string_view marker, std::size_t layer);
  void shape(const drawing::Line& line, std::size_t layer);
  void shape(const drawing::Arc& arc, std::size_t layer);
  void shape(const drawing::Circle& circle, std::size_t layer);
  void shape(const drawing::Polyline& line, std::size_t layer);
  void shape(const drawing::Text& text, std::size_t layer);
  void old_polyline(const drawing::Polyline& line, std::size_t layer);
  void objects();
  template <class ValueOf>
  void fill_in(std::string_view text, ValueOf&& value_of);
  void form_layers();

  const Drawing& drawing_;
  const DxfForm& form_;
  const bool r12_;
  std::vector<std::string> layers_;  // their names as symbols
  std::string out_;
  unsigned next_ = kFirstFree;
  std::size_t count_ = 0;  // of entities in a form
};

void DxfWriter::header() {
  const std::array<double, 4> bounds = drawing_bounds(drawing_);
  const bool inch = drawing_.unit == DrawingUnit::inch;
  section("HEADER");
  tag(9, "$ACADVER");
  tag(1, r12_ ? "AC1009" : "AC1015");
  tag(9, "$DWGCODEPAGE");
  tag(3, "ANSI_1252");
  if (!r12_) {
    tag(9, "$HANDSEED");
    // An upper bound of the handles of records and entities.
    tag(5, fmt::format("{:X}", kFirstFree + 64 + drawing_.layers.size() + drawing_.entities.size()));
  }
  tag(9, "$INSUNITS");
  tag(70, drawing_.unit == DrawingUnit::none ? 0 : inch ? 1 : 4);
  tag(9, "$MEASUREMENT");
  tag(70, inch ? 0 : 1);
  tag(9, "$EXTMIN");
  point(bounds[0], bounds[1]);
  tag(9, "$EXTMAX");
  point(bounds[2], bounds[3]);
  tag(0, "ENDSEC");
  if (r12_) return;
  section("CLASSES");
  tag(0, "ENDSEC");
}

void DxfWriter::start_table(std::string_view name, unsigned own, int count) {
  tag(0, "TABLE");
  tag(2, name);
  handle(own);
  owner(0);
  subclass("AcDbSymbolTable");
  tag(70, count);
}

void DxfWriter::record(std::string_view type, std::string_view marker, unsigned own, unsigned table) {
  tag(0, type);
  if (type == "DIMSTYLE")
    tag(105, fmt::format("{:X}", own));
  else
    handle(own);
  owner(table);
  subclass("AcDbSymbolTableRecord");
  subclass(marker);
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
  start_table("LTYPE", kLinetypes, 4);
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
      if (!r12_) tag(74, 0);
    }
  }
  end_table();
}

void DxfWriter::layers() {
  // Names may have become equal; each is written once.
  std::map<std::string, std::pair<int, LineKind>> table;
  for (std::size_t i = 0; i < layers_.size(); ++i)
    table.try_emplace(layers_[i], drawing_.layers[i].colour, drawing_.layers[i].line);
  table.try_emplace("0", 7, LineKind::solid);
  start_table("LAYER", kLayers, static_cast<int>(table.size()));
  for (const auto& [name, look] : table) {
    record("LAYER", "AcDbLayerTableRecord", next_++, kLayers);
    tag(2, name);
    tag(70, 0);
    tag(62, look.first);
    tag(6, look.second == LineKind::dashed ? "DASHED" : "Continuous");
  }
  end_table();
}

void DxfWriter::text_styles() {
  start_table("STYLE", kStyles, 1);
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
}

void DxfWriter::other_tables() {
  for (const char* empty : {"VIEW", "UCS", "VPORT"}) {
    start_table(empty, next_++, 0);
    end_table();
  }
  const unsigned apps = next_++;
  start_table("APPID", apps, 1);
  record("APPID", "AcDbRegAppTableRecord", next_++, apps);
  tag(2, "ACAD");
  tag(70, 0);
  end_table();
  const unsigned styles = next_++;
  start_table("DIMSTYLE", styles, 1);
  subclass("AcDbDimStyleTable");
  record("DIMSTYLE", "AcDbDimStyleTableRecord", next_++, styles);
  tag(2, "Standard");
  tag(70, 0);
  end_table();
  start_table("BLOCK_RECORD", kBlockRecords, 2);
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
  text_styles();
  if (!r12_) other_tables();
  tag(0, "ENDSEC");
}

void DxfWriter::block(unsigned own, std::string_view name) {
  const auto start = [&](std::string_view type, std::string_view marker) {
    tag(0, type);
    handle(next_++);
    owner(own);
    subclass("AcDbEntity");
    tag(8, "0");
    subclass(marker);
  };
  start("BLOCK", "AcDbBlockBegin");
  tag(2, name);
  tag(70, 0);
  point(0.0, 0.0);
  tag(3, name);
  tag(1, "");
  start("ENDBLK", "AcDbBlockEnd");
}

void DxfWriter::entity(std::string_view type, std::string_view marker, std::size_t layer) {
  if (!form_.entity.empty()) {
    ++count_;
    return fill_in(form_.entity, [&](std::string_view key) -> std::string {
      if (key == "{TYPE}") return std::string(type);
      if (key == "{SUBCLASS}") return std::string(marker);
      return key == "{LAYER}" ? layers_[layer] : form_.entity_handle(count_);
    });
  }
  tag(0, type);
  handle(next_++);
  owner(kModel);
  subclass("AcDbEntity");
  tag(8, layers_[layer]);
  subclass(marker);
}

void DxfWriter::shape(const drawing::Line& line, std::size_t layer) {
  entity("LINE", "AcDbLine", layer);
  point(line.x1, line.y1, line.z1);
  tag(11, line.x2);
  tag(21, line.y2);
  tag(31, line.z2);
}

void DxfWriter::shape(const drawing::Arc& arc, std::size_t layer) {
  const auto turned = [&](double degrees) {
    if (form_.angles == drawings::DxfAngles::as_given) return degrees;
    const double rest = std::fmod(degrees, 360.0);
    return rest < 0.0 ? rest + 360.0 : rest;
  };
  entity("ARC", "AcDbCircle", layer);
  point(arc.x, arc.y, arc.z);
  tag(40, arc.radius);
  if (form_.arc_marker) subclass("AcDbArc");
  tag(50, turned(arc.start));
  tag(51, turned(arc.end));
}

void DxfWriter::shape(const drawing::Circle& circle, std::size_t layer) {
  entity("CIRCLE", "AcDbCircle", layer);
  point(circle.x, circle.y, circle.z);
  tag(40, circle.radius);
}

/// A polyline of R12: each vertex is an entity.
void DxfWriter::old_polyline(const drawing::Polyline& line, std::size_t layer) {
  entity("POLYLINE", "", layer);
  tag(66, 1);
  point(0.0, 0.0);
  tag(70, line.closed ? 1 : 0);
  for (const drawing::Vertex& vertex : line.vertices) {
    entity("VERTEX", "", layer);
    point(vertex.x, vertex.y);
    if (vertex.bulge != 0.0) tag(42, vertex.bulge);
  }
  entity("SEQEND", "", layer);
}

void DxfWriter::shape(const drawing::Polyline& line, std::size_t layer) {
  if (r12_) return old_polyline(line, layer);
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
  std::string line = ascii(text.text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  entity("TEXT", "AcDbText", layer);
  point(text.x, text.y);
  tag(40, text.height);
  tag(1, line);
  subclass("AcDbText");
}

void DxfWriter::objects() {
  const auto dictionary = [&](unsigned own, unsigned parent) {
    tag(0, "DICTIONARY");
    handle(own);
    owner(parent);
    subclass("AcDbDictionary");
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
  if (!r12_) {
    block(kModel, "*Model_Space");
    block(kPaper, "*Paper_Space");
  }
  tag(0, "ENDSEC");
  section("ENTITIES");
  for (const DrawingEntity& e : drawing_.entities)
    std::visit([&](const auto& s) { shape(s, e.layer); }, e.shape);
  tag(0, "ENDSEC");
  if (!r12_) objects();
  tag(0, "EOF");
  return std::move(out_);
}

// ---- forms

/// Writes group codes with their values from a text. Values in braces are from value_of(key); {LAYERS} is the
/// records of all layers.
template <class ValueOf>
void DxfWriter::fill_in(std::string_view text, ValueOf&& value_of) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("|\n"), text.size());
    const std::string_view item = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (item.empty()) continue;
    if (item == "{LAYERS}") {
      form_layers();
      continue;
    }
    const std::size_t space = item.find(' ');
    const std::string_view value = item.substr(space + 1);
    fmt::format_to(std::back_inserter(out_), "{:>3}\n{}\n", item.substr(0, space),
                   !value.empty() && value.front() == '{' ? value_of(value) : std::string(value));
  }
}

void DxfWriter::form_layers() {
  for (std::size_t i = 0; i < layers_.size(); ++i)
    fill_in(form_.layer,
            [&](std::string_view key) { return key == "{LAYER}" ? layers_[i] : form_.layer_handle(i); });
}

std::string DxfWriter::write_form() {
  const auto value_of = [&](std::string_view key) {
    if (key == "{UNITS}") return std::string(drawing_.unit == DrawingUnit::inch ? "1" : "4");
    return std::to_string(layers_.size());
  };
  fill_in(form_.head, value_of);
  for (const DrawingEntity& e : drawing_.entities)
    std::visit([&](const auto& s) { shape(s, e.layer); }, e.shape);
  fill_in(form_.tail, value_of);
  return std::move(out_);
}

}  // namespace

std::string drawings::write_dxf(const Drawing& drawing, const DxfForm& form) {
  return DxfWriter(drawing, DxfVersion::r2000, form).write_form();
}

std::string write_dxf(const Drawing& drawing, DxfVersion version) {
  return DxfWriter(drawing, version, {}).write();
}

}  // namespace kerf
