// Reads GLB (glTF 2.0, binary): the triangles of the scene with the transforms of its nodes, converted from
// metres with Y up to mm with Z up. Positions that are not floats, buffers in other files and compressed
// meshes are errors.
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "codec/mesh/readers.h"

#include "kerf/base/limits.h"

namespace kerf::mesh_format {
namespace {

using Json = nlohmann::json;

constexpr int kTriangles = 4, kStrip = 5;                               // modes of a primitive
constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;  // component types
constexpr double kMillimetres = 1000.0;                                 // per metre

/// A range of the binary part that holds `count` values `stride` bytes apart.
struct Accessor {
  std::size_t at = 0, count = 0, stride = 0;
  int component = 0;
};

/// Reads the JSON part. Values of unexpected types throw; read_glb catches the exception.
class Scene {
 public:
  Scene(const Json& json, std::string_view binary, MeshMaker& out)
      : json_(json), binary_(binary), out_(out) {}

  bool read() {
    if (json_.contains("extensionsRequired") && !json_["extensionsRequired"].empty())
      return out_.fail(fmt::format("the file requires the extension {}, which is not supported",
                                   json_["extensionsRequired"].at(0).get<std::string>()));
    Affine upright;  // glTF's x, y, z in metres to x, -z, y in mm
    const double turned[3][4] = {{kMillimetres, 0, 0, 0}, {0, 0, -kMillimetres, 0}, {0, kMillimetres, 0, 0}};
    std::memcpy(upright.m, turned, sizeof turned);
    if (!json_.contains("scenes")) return true;
    const Json& scene = json_["scenes"].at(json_.value("scene", std::size_t{0}));
    if (!scene.contains("nodes")) return true;
    for (const Json& node : scene["nodes"])
      if (!visit(node.get<std::size_t>(), upright, 0)) return false;
    return true;
  }

 private:
  bool visit(std::size_t number, const Affine& parent, int depth);
  bool add_primitive(const Json& primitive, const Affine& transform);
  std::optional<Accessor> accessor(std::size_t number, const char* type);
  std::uint64_t index_at(const Accessor& a, std::size_t k) const;
  bool add_triangles(const std::optional<Accessor>& indices, std::size_t first, std::size_t count, bool turn);

  const Json& json_;
  std::string_view binary_;
  MeshMaker& out_;
  std::size_t visits_ = 0;
  std::size_t read_ = 0;  // bytes of the binary part
};

/// The map of a node: its matrix, or its scale, rotation and translation.
Affine transform_of(const Json& node) {
  Affine transform;
  if (node.contains("matrix")) {
    for (std::size_t k = 0; k < 12; ++k)
      transform.m[k % 3][k / 3] = node["matrix"].at(k / 3 * 4 + k % 3).get<double>();
    return transform;
  }
  const auto numbers = [&node](const char* key, std::vector<double> usual) {
    if (!node.contains(key)) return usual;
    for (std::size_t k = 0; k < usual.size(); ++k) usual[k] = node[key].at(k).get<double>();
    return usual;
  };
  const auto q = numbers("rotation", {0, 0, 0, 1});
  const auto s = numbers("scale", {1, 1, 1});
  const auto t = numbers("translation", {0, 0, 0});
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double turned[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      transform.m[row][column] = turned[row][column] * s[column];
    transform.m[row][3] = t[row];
  }
  return transform;
}

bool Scene::visit(std::size_t number, const Affine& parent, int depth) {
  if (depth > limits::kMaxSceneDepth || ++visits_ > limits::kMaxSceneNodes)
    return out_.fail("the scene's nodes are nested too deeply, or contain each other");
  const Json& node = json_.at("nodes").at(number);
  const Affine transform = parent.after(transform_of(node));
  if (node.contains("mesh"))
    for (const Json& primitive : json_.at("meshes").at(node["mesh"].get<std::size_t>()).at("primitives"))
      if (!add_primitive(primitive, transform)) return false;
  if (node.contains("children"))
    for (const Json& child : node["children"])
      if (!visit(child.get<std::size_t>(), transform, depth + 1)) return false;
  return true;
}

std::optional<Accessor> Scene::accessor(std::size_t number, const char* type) {
  const Json& a = json_.at("accessors").at(number);
  const auto refuse = [this](const char* why) {
    out_.fail(why);
    return std::nullopt;
  };
  if (a.contains("sparse") || !a.contains("bufferView")) return refuse("sparse accessors are not supported");
  if (a.at("type").get<std::string>() != type)
    return refuse("an accessor has a type that does not fit its use");
  const Json& view = json_.at("bufferViews").at(a["bufferView"].get<std::size_t>());
  const Json& buffer = json_.at("buffers").at(view.at("buffer").get<std::size_t>());
  if (buffer.contains("uri") || view["buffer"].get<std::size_t>() != 0)
    return refuse("a buffer is in another file, which is not supported");
  Accessor out;
  out.component = a.at("componentType").get<int>();
  const std::size_t width = out.component == kByte ? 1 : out.component == kShort ? 2 : 4;
  const std::size_t size = width * (type[0] == 'V' ? 3u : 1u);
  out.count = a.at("count").get<std::size_t>();
  out.stride = view.value("byteStride", size);
  const std::size_t in_view = a.value("byteOffset", std::size_t{0});
  const std::size_t begin = view.value("byteOffset", std::size_t{0});
  const std::size_t length = view.at("byteLength").get<std::size_t>();
  // Each test bounds the numbers, so that the next one does not overflow.
  const std::size_t available = binary_.size();
  const bool fits = begin <= available && length <= available - begin && in_view <= length &&
                    out.stride <= available && out.stride >= size && out.count <= available / size &&
                    (out.count == 0 || (out.count - 1) * out.stride + size <= length - in_view);
  if (!fits) return refuse("an accessor extends beyond the end of the data");
  out.at = begin + in_view;
  return out;
}

std::uint64_t Scene::index_at(const Accessor& a, std::size_t k) const {
  const std::size_t at = a.at + k * a.stride;
  if (a.component == kByte) return little_at<std::uint8_t>(binary_, at);
  if (a.component == kShort) return little_at<std::uint16_t>(binary_, at);
  return little_at<std::uint32_t>(binary_, at);
}

bool Scene::add_primitive(const Json& primitive, const Affine& transform) {
  const int mode = primitive.value("mode", kTriangles);
  if (mode < kTriangles) return true;  // points and lines are ignored
  if (mode >= kStrip) return out_.fail("strips and fans of triangles are not supported");
  const auto positions = accessor(primitive.at("attributes").at("POSITION").get<std::size_t>(), "VEC3");
  if (!positions) return false;
  if (positions->component != kFloat) return out_.fail("positions that are not floats are not supported");
  const std::size_t first = out_.vertices();
  for (std::size_t k = 0; k < positions->count; ++k, read_ += 3 * sizeof(float)) {
    if (!out_.goes_on(read_, binary_.size())) return false;
    const std::size_t at = positions->at + k * positions->stride;
    double p[3] = {};
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = static_cast<double>(little_at<float>(binary_, at + 4 * axis));
    transform.apply(p[0], p[1], p[2]);
    if (!out_.add_vertex(p[0], p[1], p[2])) return false;
  }
  std::optional<Accessor> indices;
  if (primitive.contains("indices")) {
    indices = accessor(primitive["indices"].get<std::size_t>(), "SCALAR");
    if (!indices) return false;
    if (indices->component != kByte && indices->component != kShort && indices->component != kInt)
      return out_.fail("indices have an invalid type");
  }
  return add_triangles(indices, first, indices ? indices->count : positions->count, transform.mirrors());
}

bool Scene::add_triangles(const std::optional<Accessor>& indices, std::size_t first, std::size_t count,
                          bool turn) {
  const std::size_t width = !indices                       ? 0
                            : indices->component == kByte  ? 1
                            : indices->component == kShort ? 2
                                                           : 4;
  for (std::size_t k = 0; k + 2 < count; k += 3, read_ += 3 * width) {
    if (!out_.goes_on(read_, binary_.size())) return false;
    std::uint64_t v[3] = {};
    for (std::size_t n = 0; n < 3; ++n) v[n] = first + (indices ? index_at(*indices, k + n) : k + n);
    if (!out_.add_triangle(v[0], v[turn ? 2 : 1], v[turn ? 1 : 2])) return false;
  }
  return true;
}

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

bool is_binary_chunk(std::string_view bytes, std::size_t at) {
  return at + 8 <= bytes.size() && little_at<std::uint32_t>(bytes, at + 4) == kBinaryChunk;
}

}  // namespace

bool read_glb(std::string_view bytes, MeshMaker& out) {
  if (bytes.size() < 20 || bytes.substr(0, 4) != "glTF")
    return out.fail("the file does not start as a GLB does");
  if (little_at<std::uint32_t>(bytes, 4) != 2) return out.fail("the file is not glTF version 2");
  std::string_view chunks[2];
  for (std::size_t at = 12, n = 0; n < 2 && at + 8 <= bytes.size(); ++n) {
    const std::size_t length = little_at<std::uint32_t>(bytes, at);
    const auto kind = little_at<std::uint32_t>(bytes, at + 4);
    if (kind != (n == 0 ? kJsonChunk : kBinaryChunk)) break;
    if (length > bytes.size() - at - 8) return out.fail("the file ends within a chunk");
    chunks[n] = bytes.substr(at + 8, length);
    const std::size_t end = at + 8 + length, padded = at + 8 + (length + 3) / 4 * 4;
    // Some programs do not pad the JSON part to four bytes, as the format requires.
    at = n == 0 && is_binary_chunk(bytes, end) ? end : padded;
  }
  const Json json = Json::parse(chunks[0], nullptr, false);
  if (json.is_discarded() || !json.is_object()) return out.fail("the JSON part of the file is not an object");
  try {
    return Scene(json, chunks[1], out).read();
  } catch (const Json::exception& problem) {
    return out.fail(fmt::format("the JSON part of the file is not valid glTF ({})", problem.what()));
  }
}

}  // namespace kerf::mesh_format
