// Writes GLB (glTF 2.0, binary): one primitive per colour, and separate vertices for each triangle, so that
// each vertex can have the step of its triangle. There are no normals: glTF requires flat shading then, and
// the file has half the size. The node converts Z up to Y up and mm to metres.
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/huge_pages.h"
#include "base/parallel.h"
#include "codec/mesh/writers.h"

namespace kerf::mesh_format {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kArrayBuffer = 34962;
constexpr int kFloat = 5126;
constexpr double kMetres = 0.001;  // per mm

/// sRGB 0 to 255 to linear light, as glTF requires for colours of materials.
double linear(std::uint8_t value) {
  const double s = value / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// The triangles of one colour, or all.
class Triangles {
 public:
  Triangles() = default;
  explicit Triangles(std::size_t all) : count_(all) {}
  void reserve(std::size_t count) { numbers_.reserve(count); }
  void add(std::uint32_t triangle) {
    numbers_.push_back(triangle);
    ++count_;
  }
  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t n) const {
    return numbers_.empty() ? static_cast<std::uint32_t>(n) : numbers_[n];
  }

 private:
  std::size_t count_ = 0;
  std::vector<std::uint32_t> numbers_;  // empty: all
};

/// Triangles per work item of a thread.
constexpr std::size_t kPiece = std::size_t{1} << 14;

/// Calls work(piece, first, end) for pieces of the triangles, on several threads.
template <class Work>
void in_pieces(std::size_t triangles, const Work& work) {
  parallel_for(
      thread_count(0), (triangles + kPiece - 1) / kPiece,
      [&](std::size_t n) { work(n, n * kPiece, std::min((n + 1) * kPiece, triangles)); },
      [] { return false; });
}

/// The JSON part of a GLB, which precedes the binary part that it describes.
class Asset {
 public:
  explicit Asset(const MeshView& mesh) : mesh_(mesh) {}
  /// Adds triangles as a primitive; without a colour they get the default material.
  void add_primitive(const Triangles& triangles, std::size_t colour);
  /// Bytes of all primitives' numbers, in the order in which they were added: positions, then steps.
  std::size_t binary_size() const { return binary_size_; }
  std::string json() const;

 private:
  std::size_t add_accessor(std::size_t numbers, const char* type, std::size_t count);
  std::size_t add_material(std::size_t colour);

  const MeshView& mesh_;
  std::size_t binary_size_ = 0;
  Json accessors_ = Json::array(), views_ = Json::array(), materials_ = Json::array(),
       primitives_ = Json::array();
};

/// Describes the next numbers of the binary part.
std::size_t Asset::add_accessor(std::size_t numbers, const char* type, std::size_t count) {
  const std::size_t bytes = numbers * sizeof(float);
  views_.push_back(
      {{"buffer", 0}, {"byteOffset", binary_size_}, {"byteLength", bytes}, {"target", kArrayBuffer}});
  binary_size_ += bytes;
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

/// The position of a corner of a triangle.
const float* position_of(const MeshView& mesh, std::uint32_t triangle, std::size_t corner) {
  return mesh.positions.data() + std::size_t{3} * mesh.triangles[std::size_t{3} * triangle + corner];
}

/// Attributes of a mesh may not be 32-bit integers; a float holds steps up to 16 million exactly. -1: no
/// step.
float step_of(const MeshView& mesh, std::uint32_t triangle) {
  const bool known =
      triangle < mesh.step.size() && mesh.step[triangle] != std::numeric_limits<std::uint32_t>::max();
  return known ? static_cast<float>(mesh.step[triangle]) : -1.0f;
}

struct Bounds {
  Bounds() {
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
  }
  void add(const float* lowest, const float* highest) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], lowest[k]);
      high[k] = std::max(high[k], highest[k]);
    }
  }
  std::array<float, 3> low, high;
};

Bounds bounds_of(const MeshView& mesh, const Triangles& triangles) {
  std::vector<Bounds> pieces(triangles.size() / kPiece + 1);
  in_pieces(triangles.size(), [&](std::size_t piece, std::size_t first, std::size_t end) {
    Bounds bounds;
    for (std::size_t n = first; n < end; ++n) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const float* const p = position_of(mesh, triangles[n], corner);
        bounds.add(p, p);
      }
    }
    pieces[piece] = bounds;
  });
  Bounds all;
  for (const Bounds& piece : pieces) all.add(piece.low.data(), piece.high.data());
  return all;
}

void Asset::add_primitive(const Triangles& triangles, std::size_t colour) {
  if (triangles.size() == 0) return;
  const std::size_t count = 3 * triangles.size();
  const Bounds bounds = bounds_of(mesh_, triangles);
  const std::size_t positions = add_accessor(3 * count, "VEC3", count);
  accessors_[positions]["min"] = bounds.low;
  accessors_[positions]["max"] = bounds.high;
  Json attributes = {{"POSITION", positions}};
  if (!mesh_.step.empty()) attributes["_STEP"] = add_accessor(count, "SCALAR", count);
  primitives_.push_back({{"attributes", attributes}, {"material", add_material(colour)}, {"mode", 4}});
}

std::string Asset::json() const {
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
    json["buffers"] = Json::array({{{"byteLength", binary_size_}}});
  }
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return text;
}

/// Writes the positions and the steps of the triangles, and returns where they end.
char* put_primitive(const MeshView& mesh, const Triangles& triangles, char* out) {
  constexpr std::size_t kCorner = 3 * sizeof(float);  // bytes of a position, or of a triangle's steps
  char* const steps = out + 3 * kCorner * triangles.size();
  in_pieces(triangles.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t n = first; n < end; ++n) {
      for (std::size_t corner = 0; corner < 3; ++corner)
        put_little(std::span(position_of(mesh, triangles[n], corner), 3), out + (3 * n + corner) * kCorner);
      if (mesh.step.empty()) continue;
      std::array<float, 3> step;
      step.fill(step_of(mesh, triangles[n]));
      put_little(step, steps + n * kCorner);
    }
  });
  return mesh.step.empty() ? steps : steps + kCorner * triangles.size();
}

/// The triangles of each colour, those without one last.
std::vector<Triangles> sort_by_colour(const MeshView& mesh) {
  if (mesh.palette.empty()) return {Triangles(triangle_count(mesh))};
  std::vector<std::size_t> counts(mesh.palette.size() + 1, 0);
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) ++counts[colour_of(mesh, t)];
  std::vector<Triangles> by_colour(counts.size());
  for (std::size_t c = 0; c < counts.size(); ++c) by_colour[c].reserve(counts[c]);
  for (std::size_t t = 0; t < triangle_count(mesh); ++t)
    by_colour[colour_of(mesh, t)].add(static_cast<std::uint32_t>(t));
  return by_colour;
}

}  // namespace

std::string write_glb(const MeshView& mesh) {
  const std::vector<Triangles> by_colour = sort_by_colour(mesh);
  Asset asset(mesh);
  for (std::size_t c = 0; c < by_colour.size(); ++c) asset.add_primitive(by_colour[c], c);
  // Lengths in a GLB have 32 bits; 16 MiB are reserved for the JSON part, which is much smaller.
  if (asset.binary_size() > std::numeric_limits<std::uint32_t>::max() - (std::size_t{16} << 20)) return {};
  const std::string json = asset.json();
  const bool has_binary = asset.binary_size() != 0;
  const std::size_t size = 20 + json.size() + (has_binary ? 8 + asset.binary_size() : 0);
  std::string out = "glTF";
  out.reserve(size);
  prepare_pages(out.data(), size, thread_count(0));
  append_little(out, std::uint32_t{2});
  append_little(out, static_cast<std::uint32_t>(size));
  append_little(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  if (has_binary) {
    append_little(out, static_cast<std::uint32_t>(asset.binary_size()));
    out.append("BIN\0", 4);
    char* at = out.data() + out.size();
    out.resize(size);
    for (const Triangles& triangles : by_colour) at = put_primitive(mesh, triangles, at);
  }
  return out;
}

}  // namespace kerf::mesh_format
