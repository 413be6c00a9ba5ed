// Reads 3MF: a zip of XML parts, read as streams; the items of the build are combined. Objects may be in
// other parts of the same file (the production extension); other extensions are ignored.
#if KERF_WITH_3MF

#include <algorithm>
#include <cmath>
#include <expat.h>
#include <fmt/format.h>
#include <map>
#include <set>
#include <vector>

#include "base/number.h"
#include "codec/mesh/readers.h"
#include "codec/zip/zip.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"

namespace kerf::mesh_format {
namespace {

// Beyond kAnyRatio bytes an archive may unpack to kMaxRatio times its size: XML of coordinates packs to a
// tenth, and a bomb to a thousandth.
constexpr std::size_t kAnyRatio = std::size_t{64} << 20;
constexpr std::size_t kMaxRatio = 400;

// ---- the XML

/// An element's attributes by their local names.
class Attributes {
 public:
  explicit Attributes(const XML_Char** list) : list_(list) {}
  std::string_view text(std::string_view name) const {
    for (const XML_Char** a = list_; *a != nullptr; a += 2)
      if (local(a[0]) == name) return a[1];
    return {};
  }
  std::optional<double> number(std::string_view name) const { return parse_number(text(name)); }
  /// A non-negative integer.
  std::optional<std::uint64_t> index(std::string_view name) const {
    const auto value = number(name);
    if (!value || !(*value >= 0.0) || !(*value < 4.0e9) || std::floor(*value) != *value) return std::nullopt;
    return static_cast<std::uint64_t>(*value);
  }
  static std::string_view local(std::string_view name) {
    const std::size_t colon = name.rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
  }

 private:
  const XML_Char** list_;
};

using Key = std::pair<std::string, std::string>;  // part and object's id

struct Use {
  Key object;
  Affine transform;
};
struct Object {
  MeshData mesh;
  std::vector<Use> components;
  bool is_solid = true;  // not a support
};

/// The contents of all parts.
struct Model {
  std::map<Key, Object> objects;
  std::vector<Use> build;  // of the first part
  double unit = 1.0;       // mm
  std::size_t vertices = 0, triangles = 0, uses = 0;
};

std::string part_name(std::string_view path) {
  while (!path.empty() && path.front() == '/') path.remove_prefix(1);
  return std::string(path);
}

std::optional<double> unit_of(std::string_view name) {
  const std::map<std::string_view, double> units{
      {"", 1.0},       {"millimeter", 1.0}, {"micron", 0.001}, {"centimeter", 10.0}, {"inch", kMmPerInch},
      {"foot", 304.8}, {"meter", 1000.0}};
  const auto it = units.find(name);
  return it == units.end() ? std::nullopt : std::optional(it->second);
}

/// "m00 m01 m02 m10 ... m32": rows of a matrix that multiplies a row vector from the right.
bool read_transform(std::string_view text, Affine& transform) {
  if (text.empty()) return true;
  for (std::size_t k = 0; k < 12; ++k) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return false;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    const auto number = parse_number(text.substr(0, end));
    if (!number) return false;
    transform.m[k % 3][k / 3] = *number;
    text.remove_prefix(end);
  }
  return true;
}

/// Reads the XML of one part into the model.
class PartReader {
 public:
  PartReader(Model& model, std::string part, bool is_first, MeshMaker& out)
      : model_(model),
        part_(std::move(part)),
        is_first_(is_first),
        out_(out),
        parser_(XML_ParserCreate(nullptr)) {
    XML_SetUserData(parser_, this);
    XML_SetElementHandler(
        parser_,
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          static_cast<PartReader*>(self)->begin(Attributes::local(name), Attributes(attributes));
        },
        [](void* self, const XML_Char* name) {
          static_cast<PartReader*>(self)->end(Attributes::local(name));
        });
  }
  ~PartReader() { XML_ParserFree(parser_); }
  PartReader(const PartReader&) = delete;
  PartReader& operator=(const PartReader&) = delete;

  bool take(std::string_view piece, bool is_last) {
    bytes_ += piece.size();
    if (!out_.goes_on_at(bytes_, stated_bytes_)) return false;
    if (bytes_ > out_.limits().text_bytes || bytes_ > max_bytes_)
      return out_.too_large("the unpacked model is larger than the limit");
    if (XML_Parse(parser_, piece.data(), static_cast<int>(piece.size()), is_last ? 1 : 0) == XML_STATUS_ERROR)
      return fail(fmt::format("the model is not valid XML ({})", XML_ErrorString(XML_GetErrorCode(parser_))));
    return !out_.failed();
  }
  void set_max_bytes(std::size_t bytes) { max_bytes_ = bytes; }
  /// As the archive states them, for the progress.
  void set_stated_bytes(std::size_t bytes) { stated_bytes_ = bytes; }
  /// Other parts that contain objects of this one.
  const std::set<std::string>& other_parts() const { return other_parts_; }

 private:
  bool fail(const std::string& message) {
    return out_.fail(message, static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser_)));
  }
  void begin(std::string_view name, const Attributes& attributes);
  void end(std::string_view name) {
    if (name == "object") object_ = nullptr;
  }
  void start_object(const Attributes& attributes);
  void add_vertex(const Attributes& attributes);
  void add_triangle(const Attributes& attributes);
  void add_use(const Attributes& attributes, std::vector<Use>& uses);

  Model& model_;
  std::string part_;
  bool is_first_;
  MeshMaker& out_;
  XML_Parser parser_;
  Object* object_ = nullptr;
  std::set<std::string> other_parts_;
  std::size_t bytes_ = 0, max_bytes_ = SIZE_MAX, stated_bytes_ = 0;
};

void PartReader::begin(std::string_view name, const Attributes& attributes) {
  if (out_.failed()) return;
  if (name == "vertex" && object_ != nullptr) return add_vertex(attributes);
  if (name == "triangle" && object_ != nullptr) return add_triangle(attributes);
  if (name == "object") return start_object(attributes);
  if (name == "component" && object_ != nullptr) return add_use(attributes, object_->components);
  if (name == "item" && is_first_) return add_use(attributes, model_.build);
  if (name != "model" || !is_first_) return;
  const auto unit = unit_of(attributes.text("unit"));
  if (!unit) fail("the model's unit is not one of 3MF");
  model_.unit = unit.value_or(1.0);
}

void PartReader::start_object(const Attributes& attributes) {
  if (model_.objects.size() >= limits::kMaxMeshParts) {
    out_.too_large("the file has more objects than the limit");
    return;
  }
  object_ = &model_.objects[{part_, std::string(attributes.text("id"))}];
  const std::string_view type = attributes.text("type");
  object_->is_solid = type.empty() || type == "model";
}

void PartReader::add_vertex(const Attributes& attributes) {
  const auto x = attributes.number("x"), y = attributes.number("y"), z = attributes.number("z");
  if (!x || !y || !z) {
    fail("x, y or z of a vertex is missing or not a number");
    return;
  }
  if (++model_.vertices > 3 * out_.limits().triangles) {
    out_.too_large("the file has more vertices than the limit");
    return;
  }
  object_->mesh.positions.insert(object_->mesh.positions.end(), {*x, *y, *z});
}

void PartReader::add_triangle(const Attributes& attributes) {
  const auto a = attributes.index("v1"), b = attributes.index("v2"), c = attributes.index("v3");
  if (!a || !b || !c) {
    fail("v1, v2 or v3 of a triangle is missing or not an index");
    return;
  }
  if (++model_.triangles > out_.limits().triangles) {
    out_.too_large(fmt::format("the mesh has more than {} triangles", out_.limits().triangles));
    return;
  }
  for (const std::uint64_t v : {*a, *b, *c}) object_->mesh.triangles.push_back(static_cast<std::uint32_t>(v));
}

void PartReader::add_use(const Attributes& attributes, std::vector<Use>& uses) {
  if (++model_.uses > limits::kMaxMeshParts) {
    out_.too_large("the file has more components and build items than the limit");
    return;
  }
  Use use;
  const std::string_view path = attributes.text("path");
  use.object = {path.empty() ? part_ : part_name(path), std::string(attributes.text("objectid"))};
  if (!path.empty()) other_parts_.insert(use.object.first);
  if (!read_transform(attributes.text("transform"), use.transform))
    fail("a transform does not have twelve numbers");
  uses.push_back(std::move(use));
}

// ---- the file

/// The part that _rels/.rels names as the model; by default the usual one.
std::string model_part(zip::Reader& package) {
  struct Found {
    std::string target = "3D/3dmodel.model";
  } found;
  const XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &found);
  XML_SetElementHandler(
      parser,
      [](void* to, const XML_Char* name, const XML_Char** list) {
        const Attributes attributes(list);
        const std::string_view type = attributes.text("Type"), target = attributes.text("Target");
        const bool is_model = type.size() > 8 && type.substr(type.size() - 8) == "/3dmodel";
        if (Attributes::local(name) == "Relationship" && is_model && !target.empty())
          static_cast<Found*>(to)->target = part_name(target);
      },
      nullptr);
  std::size_t bytes = 0;
  package.unpack("_rels/.rels", [&](std::string_view piece, bool is_last) {
    bytes += piece.size();
    return bytes <= kAnyRatio && XML_Parse(parser, piece.data(), static_cast<int>(piece.size()),
                                           is_last ? 1 : 0) != XML_STATUS_ERROR;
  });
  XML_ParserFree(parser);
  return found.target;
}

/// Adds an object with its components, transformed as used.
bool add_object(const Model& model, const Use& use, const Affine& outer, int depth, std::size_t& visits,
                MeshMaker& out) {
  if (depth > limits::kMaxMeshPartDepth || ++visits > limits::kMaxMeshParts)
    return out.fail("objects are nested too deeply, or contain each other");
  const auto it = model.objects.find(use.object);
  if (it == model.objects.end())
    return out.fail(
        fmt::format("object {} is used, but is not in the file", use.object.second.substr(0, 20)));
  const Object& object = it->second;
  if (!object.is_solid) return true;
  const Affine transform = outer.after(use.transform);
  const std::size_t first = out.vertices();
  const MeshData& mesh = object.mesh;
  for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
    if (!out.goes_on(out.vertices(), model.vertices)) return false;
    double p[3] = {mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]};
    transform.apply(p[0], p[1], p[2]);
    if (!out.add_vertex(p[0], p[1], p[2])) return false;
  }
  const std::size_t second = transform.mirrors() ? 2 : 1;
  for (std::size_t k = 0; k + 2 < mesh.triangles.size(); k += 3)
    if (!out.goes_on(out.vertices(), model.vertices) ||
        !out.add_triangle(first + mesh.triangles[k], first + mesh.triangles[k + second],
                          first + mesh.triangles[k + 3 - second]))
      return false;
  for (const Use& component : object.components)
    if (!add_object(model, component, transform, depth + 1, visits, out)) return false;
  return true;
}

}  // namespace

bool read_three_mf(std::string_view bytes, MeshMaker& out) {
  zip::Reader package(bytes);
  if (!package.is_zip()) return out.fail("the file is not a zip, which a 3MF is");
  constexpr double kXmlPart = 0.9;  // of the time
  out.part(0.0, kXmlPart);
  Model model;
  std::set<std::string> done, open{model_part(package)};
  while (!open.empty()) {
    const std::string part = *open.begin();
    open.erase(open.begin());
    PartReader reader(model, part, done.empty(), out);
    reader.set_max_bytes(std::max(kAnyRatio, kMaxRatio * bytes.size()));
    reader.set_stated_bytes(package.size_of(part));
    const bool whole = package.unpack(
        part, [&](std::string_view piece, bool is_last) { return reader.take(piece, is_last); });
    if (out.failed()) return false;
    if (!whole) return out.fail(fmt::format("the part {} is missing or damaged", part.substr(0, 80)));
    done.insert(part);
    for (const std::string& other : reader.other_parts())
      if (done.count(other) == 0) open.insert(other);
  }
  Affine scale;
  for (int k = 0; k < 3; ++k) scale.m[k][k] = model.unit;
  std::size_t visits = 0;
  out.part(kXmlPart, 1.0);
  for (const Use& use : model.build)
    if (!add_object(model, use, scale, 0, visits, out)) return false;
  return true;
}

}  // namespace kerf::mesh_format

#endif
