// The entities of a DXF file: which group codes each kind uses, and shapes from them.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <utility>

#include "base/codes/outline.h"
#include "codec/drawing/dxf_reader.h"

namespace kerf::dxf {
namespace {

struct KindInfo {
  std::string_view name;
  std::initializer_list<int> used;  // numbers besides those of common_tag
  std::initializer_list<int> required;
};

/// In the order of Kind.
const KindInfo kInfo[kKinds] = {
    {"LINE", {10, 20, 30, 11, 21, 31}, {10, 20, 11, 21}},
    {"CIRCLE", {10, 20, 30, 40}, {10, 20, 40}},
    {"ARC", {10, 20, 30, 40, 50, 51}, {10, 20, 40, 50, 51}},
    {"POINT", {10, 20, 30}, {10, 20}},
    {"LWPOLYLINE", {38, 43, 70, 90}, {}},
    {"POLYLINE", {10, 20, 30, 40, 41, 66, 70, 71, 72, 73, 74, 75}, {}},
    {"VERTEX", {10, 20, 30, 40, 41, 42, 50, 70, 71, 72, 73, 74, 91}, {10, 20}},
    {"TEXT", {10, 20, 30, 11, 21, 31, 40, 41, 50, 51, 71, 72, 73}, {10, 20, 40}},
    {"ATTRIB", {10, 20, 30, 11, 21, 31, 40, 41, 50, 51, 70, 71, 72, 73, 74}, {10, 20, 40}},
    {"ATTDEF", {10, 20, 30, 11, 21, 31, 40, 41, 50, 51, 70, 71, 72, 73, 74}, {10, 20, 40}},
    {"MTEXT", {10, 20, 30, 11, 21, 31, 40, 41, 44, 50, 71}, {10, 20, 40}},
    {"INSERT", {10, 20, 30, 41, 42, 43, 44, 45, 50, 66, 70, 71}, {10, 20}},
    {"ELLIPSE", {10, 20, 30, 11, 21, 31, 40, 41, 42}, {10, 20, 11, 21, 40}},
    {"SPLINE", {70, 71, 72, 73, 74}, {}},
    {"HATCH", {}, {}},
    {"SOLID", {10, 20, 30, 11, 21, 31, 12, 22, 32, 13, 23, 33}, {10, 20, 11, 21, 12, 22}},
    {"TRACE", {10, 20, 30, 11, 21, 31, 12, 22, 32, 13, 23, 33}, {10, 20, 11, 21, 12, 22}},
    {"SEQEND", {}, {}},
    {"", {}, {}},
};
const KindInfo& info(Kind kind) { return kInfo[static_cast<std::size_t>(kind)]; }

using Used = std::array<std::bitset<Fields::kGroups>, kKinds>;
const Used& used_groups() {
  static const Used used = [] {
    Used made;
    for (std::size_t kind = 0; kind < kKinds; ++kind)
      for (const int group : kInfo[kind].used) made[kind].set(static_cast<std::size_t>(group));
    return made;
  }();
  return used;
}

Kind kind_of(std::string_view name) {
  static const std::unordered_map<std::string_view, Kind> kinds = [] {
    std::unordered_map<std::string_view, Kind> made;
    for (std::size_t kind = 0; kind + 1 < kKinds; ++kind)
      made.emplace(kInfo[kind].name, static_cast<Kind>(kind));
    return made;
  }();
  const auto found = kinds.find(name);
  return found == kinds.end() ? Kind::other : found->second;
}

/// Types at which a list of entities ends.
bool ends_entities(std::string_view name) {
  return name == "ENDSEC" || name == "ENDBLK" || name == "BLOCK" || name == "SECTION" || name == "EOF";
}

constexpr int kExtendedData = 1000;    // from here on: data of other programs
constexpr int kApplicationData = 102;  // {NAME ... }
constexpr int kEmbedded = 101;         // an object in the entity; its groups have other meanings

}  // namespace

std::string_view name_of(Kind kind) { return info(kind).name; }

int Fields::integer(int group, int otherwise) const {
  const double value = get(group, otherwise);
  return std::abs(value) <= 2147483647.0 ? static_cast<int>(value) : otherwise;
}

// ---------------------------------------------------------------------------------------------------- tags

/// Skips to the group that ends them: "}".
void DxfReader::skip_application_data() {
  if (!tags_.text().starts_with("{")) return;
  while (tags_.next()) {
    if (tags_.group() == 0) return tags_.repeat();
    if (tags_.group() == kApplicationData && tags_.text().starts_with("}")) return;
  }
}

/// Reads the current tag if it has the same meaning in all entities; else false.
bool DxfReader::common_tag(Kind kind, Entity& entity) {
  const auto integer = [&](auto use) {
    const auto value = tags_.integer();
    if (value) use(*value);
    return value.has_value();
  };
  switch (tags_.group()) {
    case 5: entity.handle = tags_.handle(); return true;
    case 6: entity.linetype = linetype_index(tags_.text()); return true;
    case 8: entity.layer = layer_index(tags_.text()); return true;
    case 48:
      if (const auto scale = tags_.number()) entity.linetype_scale = *scale;
      return true;
    case 60: return integer([&](int value) { entity.hidden = value != 0; });
    case 62:
      return integer(
          [&](int value) { entity.colour = static_cast<std::int16_t>(std::clamp(value, 0, 257)); });
    case 67: return integer([&](int value) { entity.paper = value == 1; });
    case 100: return true;
    case kApplicationData: skip_application_data(); return true;
    case 370:
      return integer(
          [&](int value) { entity.lineweight = static_cast<std::int16_t>(std::clamp(value, -3, 1000)); });
    case 410: return true;
    case 420: return integer([&](int value) { entity.true_colour = value; });
    default: break;
  }
  const int group = tags_.group();
  if ((group >= 320 && group < 370) || (group >= 390 && group < 400)) return true;  // references to objects
  return number_tag(kind);
}

/// Stores the number of a tag that the kind of entity uses; counts the others.
bool DxfReader::number_tag(Kind kind) {
  const int group = tags_.group();
  const auto k = static_cast<std::size_t>(kind);
  const auto g = static_cast<std::size_t>(group);
  const bool extrusion = group == 210 || group == 220 || group == 230;
  if (group < 0 || group >= kExtendedData || kind == Kind::other) return true;
  if (g < Fields::kGroups && (extrusion || used_groups()[k].test(g))) {
    const auto value = tags_.number();
    if (value) fields_.set(group, *value);
    return value.has_value();
  }
  if (unused_[k].empty()) unused_[k].resize(kExtendedData);
  ++unused_[k][g];
  return true;
}

/// Reads the tags of an entity, up to the next group code 0; `hook(group)` reads those with a special
/// meaning. False if a value is invalid or the tags are incomplete.
template <class Hook>
bool DxfReader::entity_tags(Kind kind, Entity& entity, Hook hook) {
  const std::size_t breaks = tags_.breaks();
  bool valid = true;
  fields_.clear();
  while (tags_.next()) {
    if (tags_.group() == 0) {
      tags_.repeat();
      break;
    }
    if (tags_.group() == kEmbedded) {
      skip_tags();
      break;
    }
    const std::optional<bool> taken = hook(tags_.group());
    if (!taken.value_or(true) || (!taken && !common_tag(kind, entity))) valid = false;
  }
  entity.extrusion = extrusion_of_fields();
  return valid && breaks == tags_.breaks();
}

std::uint32_t DxfReader::extrusion_of_fields() {
  if (!fields_.has(210) && !fields_.has(220) && !fields_.has(230)) return 0;
  const Point e{fields_.get(210, 0.0), fields_.get(220, 0.0), fields_.get(230, 1.0)};
  const std::array<double, 3> key{e.x + 0.0, e.y + 0.0, e.z + 0.0};  // -0.0 becomes 0.0
  if (key == std::array<double, 3>{}) return 0;
  const auto found = extrusions_.emplace(key, static_cast<std::uint32_t>(drawing_.extrusions.size()));
  if (found.second) drawing_.extrusions.push_back({key[0], key[1], key[2]});
  return found.first->second;
}

bool DxfReader::refuse(const Entity& entity, Kind kind, const std::string& what) {
  tags_.error(codes::dxf_value, entity.position,
              fmt::format("{}{}{} on layer {}: {}; the entity is skipped", name_of(kind),
                          entity.handle != 0 ? " " : "", handle_text(entity.handle),
                          drawing_.layers[entity.layer].name, what));
  return false;
}

bool DxfReader::has_required(Kind kind, const Entity& entity) {
  for (const int group : info(kind).required)
    if (!fields_.has(group)) return refuse(entity, kind, fmt::format("group {} is missing", group));
  return true;
}

// -------------------------------------------------------------------------------------------------- entities

/// Reads entities up to the tag that ends a list, which is not consumed.
void DxfReader::entities(std::vector<Entity>& out) {
  while (tags_.next()) {
    if (tags_.group() != 0) {
      warn_structure(fmt::format("group {} before the first entity; skipped", tags_.group()));
      skip_tags();
      continue;
    }
    if (ends_entities(tags_.text())) return tags_.repeat();
    entity(out);
  }
}

void DxfReader::entity(std::vector<Entity>& out) {
  Entity made;
  made.position = tags_.position();
  const std::string_view name = tags_.text();
  const Kind kind = kind_of(name);
  switch (kind) {
    case Kind::line:
    case Kind::circle:
    case Kind::arc:
    case Kind::point:
    case Kind::ellipse: return simple_shape(kind, made, out);
    case Kind::lwpolyline: return lwpolyline(made, out);
    case Kind::polyline: return polyline(made, out);
    case Kind::text:
    case Kind::attribute:
    case Kind::attribute_definition:
    case Kind::mtext: return text(kind, made, out);
    case Kind::insert: return insert(made, out);
    case Kind::spline: return spline(made, out);
    case Kind::hatch: return hatch(made, out);
    case Kind::solid:
    case Kind::trace: return solid(kind, made, out);
    case Kind::vertex: warn_structure("VERTEX outside of a POLYLINE; skipped"); return skip_tags();
    case Kind::end_of_sequence: return skip_tags();
    case Kind::other: return other(name, made, out);
  }
}

std::uint32_t DxfReader::other_type(std::string_view name, std::size_t position) {
  const std::uint32_t index = others_.find(name, decoder_, [&](std::string decoded) {
    drawing_.others.push_back({std::move(decoded), 0, position});
    return static_cast<std::uint32_t>(drawing_.others.size() - 1);
  });
  ++drawing_.others[index].count;
  return index;
}

void DxfReader::other(std::string_view name, Entity& entity, std::vector<Entity>& out) {
  const bool valid = entity_tags(Kind::other, entity, [](int) { return std::optional<bool>(); });
  entity.shape = Other{other_type(name, entity.position)};
  if (valid) out.push_back(std::move(entity));
}

void DxfReader::simple_shape(Kind kind, Entity& entity, std::vector<Entity>& out) {
  const bool valid = entity_tags(kind, entity, [](int) { return std::optional<bool>(); });
  if (valid && has_required(kind, entity) && make_simple_shape(kind, entity))
    out.push_back(std::move(entity));
}

bool DxfReader::make_simple_shape(Kind kind, Entity& entity) {
  constexpr double kFullTurn = 6.283185307179586;
  const Point at = fields_.point(10);
  const double radius = fields_.get(40, 0.0);
  if (kind == Kind::line) {
    entity.shape = Line{at, fields_.point(11)};
  } else if (kind == Kind::point) {
    entity.shape = Dot{at};
  } else if (!(radius > 0.0)) {
    const char* const what = kind == Kind::ellipse ? "ratio of the axes" : "radius";
    return refuse(entity, kind, fmt::format("the {} must be above 0, not {:g}", what, radius));
  } else if (kind == Kind::circle) {
    entity.shape = Circle{at, radius};
  } else if (kind == Kind::arc) {
    entity.shape = Arc{at, radius, fields_.get(50, 0.0), fields_.get(51, 0.0)};
  } else {
    entity.shape = Ellipse{at, fields_.point(11), radius, fields_.get(41, 0.0), fields_.get(42, kFullTurn)};
  }
  return true;
}

// ------------------------------------------------------------------------------------------------- polylines

void DxfReader::lwpolyline(Entity& entity, std::vector<Entity>& out) {
  Polyline line;
  line.lightweight = true;
  std::size_t ys = 0;
  bool wide = false;
  const auto hook = [&](int group) -> std::optional<bool> {
    if (group != 10 && group != 20 && (group < 40 || group > 42) && group != 91) return std::nullopt;
    if (group == 91) return true;  // a number of the vertex
    const auto value = tags_.number();
    if (!value) return false;
    if (group == 10) {
      line.vertices.push_back({{*value, 0.0, 0.0}, 0.0});
      line.widths.push_back({0.0, 0.0});
    } else if (!line.vertices.empty()) {
      if (group == 20) line.vertices.back().at.y = *value, ++ys;
      if (group == 42) line.vertices.back().bulge = *value;
      if (group == 40 || group == 41) line.widths.back()[group == 40 ? 0 : 1] = *value;
    }
    wide = wide || ((group == 40 || group == 41) && *value != 0.0);
    return true;
  };
  if (!entity_tags(Kind::lwpolyline, entity, hook)) return;
  if (ys != line.vertices.size())
    return static_cast<void>(refuse(entity, Kind::lwpolyline, "a vertex lacks group 20"));
  if (line.vertices.empty()) return static_cast<void>(refuse(entity, Kind::lwpolyline, "it has no vertex"));
  const double width = fields_.get(43, 0.0);
  if (width != 0.0 && !wide) std::fill(line.widths.begin(), line.widths.end(), std::array{width, width});
  if (width == 0.0 && !wide) line.widths.clear();
  for (Vertex& v : line.vertices) v.at.z = fields_.get(38, 0.0);
  line.closed = (fields_.integer(70, 0) & 1) != 0;
  entity.shape = Boxed<Polyline>(std::move(line));
  out.push_back(std::move(entity));
}

/// Reads a VERTEX; false if it is invalid.
bool DxfReader::vertex(Polyline& polyline, double default_widths[2]) {
  constexpr int kControlPoint = 16;  // of a spline that the other vertices approximate
  Entity entity;
  entity.position = tags_.position();
  const bool valid = entity_tags(Kind::vertex, entity, [](int) { return std::optional<bool>(); });
  if (!valid || !has_required(Kind::vertex, entity)) return false;
  if ((fields_.integer(70, 0) & kControlPoint) != 0) return true;
  polyline.vertices.push_back({fields_.point(10), fields_.get(42, 0.0)});
  polyline.widths.push_back({fields_.get(40, default_widths[0]), fields_.get(41, default_widths[1])});
  return true;
}

void DxfReader::polyline(Entity& entity, std::vector<Entity>& out) {
  constexpr int kClosed = 1, kSpatial = 8, kMesh = 16 | 64;
  bool valid = entity_tags(Kind::polyline, entity, [](int) { return std::optional<bool>(); });
  const int flags = fields_.integer(70, 0);
  const double elevation = fields_.get(30, 0.0);
  double widths[2] = {fields_.get(40, 0.0), fields_.get(41, 0.0)};
  Polyline line;
  line.closed = (flags & kClosed) != 0;
  line.spatial = (flags & kSpatial) != 0;
  const bool mesh = (flags & kMesh) != 0;
  const std::size_t breaks = tags_.breaks();
  bool ended = false;
  while (!ended && tags_.next()) {
    if (tags_.is(0, "VERTEX")) {
      if (mesh)
        skip_tags();
      else
        valid = vertex(line, widths) && valid;
      continue;
    }
    ended = true;
    if (tags_.is(0, "SEQEND")) {
      skip_tags();
    } else {
      tags_.warning(codes::dxf_structure, entity.position, "POLYLINE without SEQEND");
      tags_.repeat();
    }
  }
  if (mesh) {
    entity.shape = Other{other_type("POLYLINE (mesh)", entity.position)};
    return out.push_back(std::move(entity));
  }
  if (!valid || breaks != tags_.breaks()) return;
  if (line.vertices.empty()) return static_cast<void>(refuse(entity, Kind::polyline, "it has no vertex"));
  if (!line.spatial)
    for (Vertex& v : line.vertices) v.at.z = elevation;
  const bool wide = std::any_of(line.widths.begin(), line.widths.end(),
                                [](const auto& w) { return w[0] != 0.0 || w[1] != 0.0; });
  if (!wide) line.widths.clear();
  entity.shape = Boxed<Polyline>(std::move(line));
  out.push_back(std::move(entity));
}

// ---------------------------------------------------------------------------------------- texts and inserts

void DxfReader::make_text(Kind kind, Text& text) {
  text.kind = kind == Kind::text        ? TextKind::text
              : kind == Kind::mtext     ? TextKind::mtext
              : kind == Kind::attribute ? TextKind::attribute
                                        : TextKind::attribute_definition;
  text.text = decoder_.decode(raw_text_);
  text.at = fields_.point(10);
  if (fields_.has(11) || fields_.has(21)) text.second = fields_.point(11);
  text.height = fields_.get(40, 0.0);
  text.rotation = fields_.get(50, 0.0);
  if (kind == Kind::mtext) {
    text.reference_width = fields_.get(41, 0.0);
    text.attachment = fields_.integer(71, 1);
    if (const double spacing = fields_.get(44, 1.0); spacing > 0.0) text.line_spacing = spacing;
    return;
  }
  constexpr int kBackward = 2, kUpsideDown = 4;
  const int generation = fields_.integer(71, 0);
  text.backward = (generation & kBackward) != 0;
  text.upside_down = (generation & kUpsideDown) != 0;
  text.width_factor = fields_.get(41, 1.0);
  text.oblique = fields_.get(51, 0.0);
  text.horizontal = fields_.integer(72, 0);
  text.vertical = fields_.integer(kind == Kind::text ? 73 : 74, 0);
}

void DxfReader::text(Kind kind, Entity& entity, std::vector<Entity>& out) {
  Text made;
  raw_text_.clear();
  const auto hook = [&](int group) -> std::optional<bool> {
    if (group == 1 || (group == 3 && kind == Kind::mtext))
      raw_text_ += tags_.text();
    else if (group == 7)
      made.style = style_index(tags_.text());
    else if (group == 2 && kind != Kind::text && kind != Kind::mtext)
      made.tag = text_value();
    else
      return std::nullopt;
    return true;
  };
  if (!entity_tags(kind, entity, hook) || !has_required(kind, entity)) return;
  make_text(kind, made);
  constexpr int kInvisible = 1;  // of an attribute
  if (kind == Kind::attribute && (fields_.integer(70, 0) & kInvisible) != 0) entity.hidden = true;
  entity.shape = Boxed<Text>(std::move(made));
  out.push_back(std::move(entity));
}

void DxfReader::insert(Entity& entity, std::vector<Entity>& out) {
  Insert made;
  bool named = false;
  const auto hook = [&](int group) -> std::optional<bool> {
    if (group != 2) return std::nullopt;
    made.block = block_index(tags_.text());
    if (first_use_[made.block] == 0) first_use_[made.block] = entity.position;
    return named = true;
  };
  const bool valid = entity_tags(Kind::insert, entity, hook);
  if (valid && !named) refuse(entity, Kind::insert, "group 2, the name of its block, is missing");
  const bool complete = valid && named && has_required(Kind::insert, entity);
  made.at = fields_.point(10);
  made.scale = {fields_.get(41, 1.0), fields_.get(42, 1.0), fields_.get(43, 1.0)};
  if (made.scale.z == 0.0) made.scale.z = 1.0;
  made.rotation = fields_.get(50, 0.0);
  made.columns = std::max(fields_.integer(70, 1), 1);
  made.rows = std::max(fields_.integer(71, 1), 1);
  made.column_spacing = fields_.get(44, 0.0);
  made.row_spacing = fields_.get(45, 0.0);
  const bool flat = made.scale.x == 0.0 || made.scale.y == 0.0;
  if (complete && flat) refuse(entity, Kind::insert, "a scale factor is 0");
  if (complete && !flat) {
    entity.shape = Boxed<Insert>(made);
    out.push_back(std::move(entity));
  }
  attributes(out);
}

/// The attributes after an INSERT, up to their SEQEND.
void DxfReader::attributes(std::vector<Entity>& out) {
  bool any = false;
  while (tags_.next()) {
    if (tags_.is(0, "ATTRIB")) {
      any = true;
      entity(out);
      continue;
    }
    if (any && tags_.is(0, "SEQEND")) return skip_tags();
    return tags_.repeat();
  }
}

// --------------------------------------------------------------------------------------------------- splines

void DxfReader::spline(Entity& entity, std::vector<Entity>& out) {
  Spline made;
  std::size_t ys[2] = {};
  const auto hook = [&](int group) -> std::optional<bool> {
    const bool point = group >= 10 && group <= 33 && group % 10 <= 3;
    if (!point && (group < 40 || group > 44)) return std::nullopt;
    const auto value = tags_.number();
    if (!value) return false;
    if (group == 40) made.knots.push_back(*value);
    if (group == 41) made.weights.push_back(*value);
    if (!point) return true;
    if (group % 10 >= 2) {
      std::optional<Point>& tangent = group % 10 == 2 ? made.start_tangent : made.end_tangent;
      if (!tangent) tangent.emplace();
      (group < 20 ? tangent->x : group < 30 ? tangent->y : tangent->z) = *value;
      return true;
    }
    std::vector<Point>& points = group % 10 == 0 ? made.control : made.fit;
    if (group < 20) points.push_back({*value, 0.0, 0.0});
    if (points.empty()) return true;
    if (group >= 20) (group < 30 ? points.back().y : points.back().z) = *value;
    if (group == 20 || group == 21) ++ys[group - 20];
    return true;
  };
  if (!entity_tags(Kind::spline, entity, hook)) return;
  const auto fail = [&](const char* what) { refuse(entity, Kind::spline, what); };
  if (ys[0] != made.control.size() || ys[1] != made.fit.size()) return fail("a point lacks its y");
  if (made.control.empty() && made.fit.size() < 2)
    return fail("it has neither control points nor fit points");
  if (!made.weights.empty() && made.weights.size() != made.control.size())
    return fail("the numbers of weights and of control points differ");
  constexpr int kClosed = 1, kPeriodic = 2;
  made.closed = (fields_.integer(70, 0) & kClosed) != 0;
  made.periodic = (fields_.integer(70, 0) & kPeriodic) != 0;
  made.degree = fields_.integer(71, 3);
  if (!made.control.empty() &&
      (made.degree < 1 ||
       made.knots.size() != made.control.size() + static_cast<std::size_t>(made.degree) + 1))
    return fail("the numbers of knots and control points do not match its degree");
  entity.shape = Boxed<Spline>(std::move(made));
  out.push_back(std::move(entity));
}

// -------------------------------------------------------------------------------------------------- hatches

namespace {

/// Collects the boundary of a HATCH from its tags, whose meaning depends on those before them.
class HatchBoundary {
 public:
  /// Takes a tag; false if it is not part of the boundary.
  bool take(int group, double value);
  Hatch finish() {
    end_edge();
    return std::move(hatch_);
  }

 private:
  enum class Part : std::uint8_t { before, polyline, edges, after };
  enum class EdgeKind : std::uint8_t { none, line, arc, ellipse, spline };
  bool take_vertex(int group, double value);
  bool take_edge(int group, double value);
  bool take_spline(int group, double value);
  void end_edge();

  Hatch hatch_;
  Part part_ = Part::before;
  EdgeKind kind_ = EdgeKind::none;
  Polyline polyline_;
  Spline spline_;
  Fields fields_;
  double elevation_ = 0.0;
};

bool HatchBoundary::take(int group, double value) {
  constexpr int kPolyline = 2;  // of group 92
  if (part_ == Part::after) return false;
  if (group == 92) {
    end_edge();
    hatch_.loops.emplace_back();
    part_ = (static_cast<int>(value) & kPolyline) != 0 ? Part::polyline : Part::edges;
    polyline_ = {};
    polyline_.closed = true;
    return true;
  }
  if (part_ == Part::before) {
    if (group == 30) elevation_ = value;
    return group == 10 || group == 20 || group == 30;
  }
  if (group == 75 || group == 76 || group == 98) {
    end_edge();
    if (group == 75 && value == 1.0) hatch_.islands = Hatch::Islands::outer;
    if (group == 75 && value == 2.0) hatch_.islands = Hatch::Islands::ignored;
    part_ = Part::after;
    return true;
  }
  return part_ == Part::polyline ? take_vertex(group, value) : take_edge(group, value);
}

bool HatchBoundary::take_vertex(int group, double value) {
  std::vector<Vertex>& vertices = polyline_.vertices;
  if (group == 10) {
    vertices.push_back({{value, 0.0, elevation_}, 0.0});
  } else if (group == 20 && !vertices.empty()) {
    vertices.back().at.y = value;
  } else if (group == 42 && !vertices.empty()) {
    vertices.back().bulge = value;
  } else {
    return group == 72 || group == 73 || group == 93 || group == 97;
  }
  return true;
}

bool HatchBoundary::take_edge(int group, double value) {
  if (group == 72) {
    end_edge();
    const int kind = static_cast<int>(value);
    kind_ = kind >= 1 && kind <= 4 ? static_cast<EdgeKind>(kind) : EdgeKind::none;
    fields_.clear();
    spline_ = {};
    return true;
  }
  if (group == 93 || group == 97) return true;  // numbers of edges, of fit points, of source entities
  if (kind_ == EdgeKind::spline) return take_spline(group, value);
  if (group < 10 || group > 73) return false;
  fields_.set(group, value);
  return true;
}

bool HatchBoundary::take_spline(int group, double value) {
  if (group == 94) spline_.degree = static_cast<int>(std::clamp(value, 0.0, 100.0));
  if (group == 40) spline_.knots.push_back(value);
  if (group == 42) spline_.weights.push_back(value);
  if (group == 10) spline_.control.push_back({value, 0.0, elevation_});
  if (group == 20 && !spline_.control.empty()) spline_.control.back().y = value;
  return (group >= 10 && group <= 23) || (group >= 40 && group <= 42) || (group >= 73 && group <= 74) ||
         (group >= 94 && group <= 96);
}

/// Appends the edge whose tags have been read to its loop. The angles of clockwise arcs are those of their
/// mirror image.
void HatchBoundary::end_edge() {
  const EdgeKind kind = std::exchange(kind_, EdgeKind::none);
  if (hatch_.loops.empty()) return;
  std::vector<Hatch::Edge>& edges = hatch_.loops.back().edges;
  if (part_ == Part::polyline && polyline_.vertices.size() > 1)
    edges.emplace_back(Boxed<Polyline>(std::move(polyline_)));
  polyline_ = {};
  const auto point = [&](int group) {
    return Point{fields_.get(group, 0.0), fields_.get(group + 10, 0.0), elevation_};
  };
  const bool clockwise = fields_.get(73, 1.0) == 0.0;
  double from = fields_.get(50, 0.0), to = fields_.get(51, 360.0);
  if (clockwise) from = -std::exchange(to, -from);
  const double size = fields_.get(40, 0.0);
  if (kind == EdgeKind::line) edges.emplace_back(Line{point(10), point(11)});
  if (kind == EdgeKind::arc && size > 0.0) edges.emplace_back(Arc{point(10), size, from, to});
  if (kind == EdgeKind::ellipse && size > 0.0) {
    constexpr double kDegree = 3.14159265358979323846 / 180.0;
    // From angles to the parameter of the ellipse.
    const auto parameter = [&](double angle) {
      const double a = angle * kDegree, t = std::atan2(std::sin(a), size * std::cos(a));
      return t + std::round((a - t) / (360.0 * kDegree)) * 360.0 * kDegree;
    };
    Ellipse ellipse{point(10), point(11), size, parameter(from), parameter(to)};
    ellipse.major.z = 0.0;
    edges.emplace_back(Boxed<Ellipse>(ellipse));
  }
  const bool is_complete =
      spline_.degree >= 1 && !spline_.control.empty() &&
      spline_.knots.size() == spline_.control.size() + static_cast<std::size_t>(spline_.degree) + 1 &&
      (spline_.weights.empty() || spline_.weights.size() == spline_.control.size());
  if (kind == EdgeKind::spline && is_complete) edges.emplace_back(Boxed<Spline>(std::move(spline_)));
}

}  // namespace

/// A filled triangle or quadrangle: its third corner is opposite to the second one.
void DxfReader::solid(Kind kind, Entity& entity, std::vector<Entity>& out) {
  const bool valid = entity_tags(kind, entity, [](int) { return std::optional<bool>(); });
  if (!valid || !has_required(kind, entity)) return;
  Polyline edge;
  edge.closed = true;
  for (const int group : {10, 11, 13, 12})
    if (group != 13 || fields_.has(13)) edge.vertices.push_back({fields_.point(group), 0.0});
  Hatch made;
  made.name = name_of(kind);
  made.loops.emplace_back().edges.emplace_back(Boxed<Polyline>(std::move(edge)));
  entity.shape = Boxed<Hatch>(std::move(made));
  out.push_back(std::move(entity));
}

void DxfReader::hatch(Entity& entity, std::vector<Entity>& out) {
  HatchBoundary boundary;
  const auto hook = [&](int group) -> std::optional<bool> {
    if (group < 10 || group > 98 || group == 48 || group == 60 || group == 62 || group == 67)
      return std::nullopt;
    const auto value = tags_.number();
    if (!value) return false;
    boundary.take(group, *value);
    return true;
  };
  if (!entity_tags(Kind::hatch, entity, hook)) return;
  Hatch made = boundary.finish();
  std::erase_if(made.loops, [](const Hatch::Loop& loop) { return loop.edges.empty(); });
  if (made.loops.empty())
    entity.shape = Other{other_type("HATCH", entity.position)};
  else
    entity.shape = Boxed<Hatch>(std::move(made));
  out.push_back(std::move(entity));
}

}  // namespace kerf::dxf
