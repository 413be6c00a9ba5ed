// GLB (glTF 2.0, binary): one primitive a colour, vertices of their own for each triangle, so that every
// vertex can carry the step of its triangle. Without normals viewers shade faces flat, as glTF asks, in half
// the bytes. The node turns Z up into Y up and mm into metres.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "codec/mesh/writers.h"

namespace kerf::mesh_format {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kArrayBuffer = 34962;
constexpr int kFloat = 5126;
constexpr double kMetres = 0.001;  // of a mm

/// sRGB 0 to 255 to linear light, as glTF wants colours of materials.
double linear(std::uint8_t value) {
  const double s = value / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// Collects the binary part and its descriptions.
class Asset {
 public:
  explicit Asset(const MeshView& mesh) : mesh_(mesh) {}
  /// Adds the triangles (numbers) as a primitive; no colour: the default material.
  void add_primitive(const std::vector<std::uint32_t>& triangles, std::size_t colour);
  std::string finish();

 private:
  std::size_t add_accessor(std::size_t offset, const char* type, std::size_t count);
  std::size_t add_material(std::size_t colour);

  const MeshView& mesh_;
  std::string binary_;
  Json accessors_ = Json::array(), views_ = Json::array(), materials_ = Json::array(),
       primitives_ = Json::array();
};

/// Describes what was appended to the binary part since `offset`.
std::size_t Asset::add_accessor(std::size_t offset, const char* type, std::size_t count) {
  views_.push_back({{"buffer", 0},
                    {"byteOffset", offset},
                    {"byteLength", binary_.size() - offset},
                    {"target", kArrayBuffer}});
  accessors_.push_back(
      {{"bufferView", views_.size() - 1}, {"componentType", kFloat}, {"count", count}, {"type", type}});
  return accessors_.size() - 1;
}

std::size_t Asset::add_material(std::size_t colour) {
  Json factor = {0.8, 0.8, 0.8, 1.0};
  if (colour < mesh_.palette.size())
    for (std::size_t k = 0; k < 3; ++k) factor[k] = linear(mesh_.palette[colour][k]);
  materials_.push_back({{"name", colour_name(mesh_, colour)},
                        {"pbrMetallicRoughness",
                         {{"baseColorFactor", factor}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.7}}}});
  return materials_.size() - 1;
}

void Asset::add_primitive(const std::vector<std::uint32_t>& triangles, std::size_t colour) {
  if (triangles.empty()) return;
  const std::size_t count = 3 * triangles.size();
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  const std::size_t positions_at = binary_.size();
  for (const std::uint32_t t : triangles) {
    for (std::size_t k = 0; k < 9; ++k) {
      const float v = mesh_.positions[std::size_t{3} * mesh_.triangles[std::size_t{3} * t + k / 3] + k % 3];
      append_little(binary_, v);
      low[k % 3] = std::min(low[k % 3], v);
      high[k % 3] = std::max(high[k % 3], v);
    }
  }
  const std::size_t positions = add_accessor(positions_at, "VEC3", count);
  accessors_[positions]["min"] = low;
  accessors_[positions]["max"] = high;

  Json attributes = {{"POSITION", positions}};
  if (!mesh_.step.empty()) {
    // Attributes of a mesh may not be 32-bit integers; a float holds steps up to 16 million exactly. -1: no
    // step.
    const std::size_t steps_at = binary_.size();
    for (const std::uint32_t t : triangles) {
      const bool known = t < mesh_.step.size() && mesh_.step[t] != std::numeric_limits<std::uint32_t>::max();
      for (int k = 0; k < 3; ++k) append_little(binary_, known ? static_cast<float>(mesh_.step[t]) : -1.0f);
    }
    attributes["_STEP"] = add_accessor(steps_at, "SCALAR", count);
  }
  primitives_.push_back({{"attributes", attributes}, {"material", add_material(colour)}, {"mode", 4}});
}

std::string Asset::finish() {
  // Lengths in a GLB have 32 bits; the description takes well under the last 16 MiB.
  if (binary_.size() > std::numeric_limits<std::uint32_t>::max() - (std::size_t{16} << 20)) return {};
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "Kerf"}}}};
  const std::string name = plain_name(mesh_);
  if (!primitives_.empty()) {
    // Columns of the matrix: x to x, y to -z, z to y, all in metres.
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["nodes"] =
        Json::array({{{"name", name},
                      {"mesh", 0},
                      {"matrix", {kMetres, 0, 0, 0, 0, 0, -kMetres, 0, 0, kMetres, 0, 0, 0, 0, 0, 1}}}});
    json["meshes"] = Json::array({{{"name", name}, {"primitives", primitives_}}});
    json["materials"] = materials_;
    json["accessors"] = accessors_;
    json["bufferViews"] = views_;
    json["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  }
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const bool has_binary = !binary_.empty();
  std::string out = "glTF";
  out.reserve(28 + text.size() + binary_.size());
  append_little(out, std::uint32_t{2});
  append_little(out, static_cast<std::uint32_t>(20 + text.size() + (has_binary ? 8 + binary_.size() : 0)));
  append_little(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  if (has_binary) {
    append_little(out, static_cast<std::uint32_t>(binary_.size()));
    out.append("BIN\0", 4);
    out += binary_;
  }
  return out;
}

}  // namespace

std::string write_glb(const MeshView& mesh) {
  std::vector<std::vector<std::uint32_t>> by_colour(mesh.palette.size() + 1);
  for (std::size_t t = 0; t < triangle_count(mesh); ++t)
    by_colour[colour_of(mesh, t)].push_back(static_cast<std::uint32_t>(t));
  Asset asset(mesh);
  for (std::size_t c = 0; c < by_colour.size(); ++c) asset.add_primitive(by_colour[c], c);
  return asset.finish();
}

}  // namespace kerf::mesh_format
