// Mesh files read back by small independent readers: counts, bounds, volumes, colours and steps.
#include "kerf/formats/mesh_files.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <zlib.h>

namespace kerf {
namespace {

using Triangle = std::array<std::array<double, 3>, 3>;

/// A box of 30 x 20 x 10 mm, lowest corner at (1, 2, -10); top in colour 1, the rest in colour 0.
struct Box {
  std::vector<float> positions;
  std::vector<std::uint32_t> triangles{0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                       1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  std::vector<std::uint8_t> colours = std::vector<std::uint8_t>(12, 0);
  std::vector<std::array<std::uint8_t, 3>> palette{{200, 170, 120}, {255, 0, 16}};
  std::vector<std::uint32_t> steps = std::vector<std::uint32_t>(12, 0xffffffffu);

  Box() {
    for (const float z : {-10.0f, 0.0f})
      for (const auto& [x, y] : {std::pair{1.0f, 2.0f}, {31.0f, 2.0f}, {31.0f, 22.0f}, {1.0f, 22.0f}})
        positions.insert(positions.end(), {x, y, z});
    colours[2] = colours[3] = 1;
    steps[2] = steps[3] = 42;
  }
  MeshView view() const { return {positions, triangles, colours, palette, steps, "box <1> & \"two\"", {}}; }
};

double volume(const std::vector<Triangle>& triangles) {
  double six = 0;
  for (const auto& [a, b, c] : triangles) {
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

void expect_box(const std::vector<Triangle>& triangles) {
  ASSERT_EQ(triangles.size(), 12u);
  EXPECT_NEAR(volume(triangles), 6000.0, 1e-6);
  std::array<double, 3> low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Triangle& t : triangles)
    for (const auto& p : t)
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
  EXPECT_EQ(low, (std::array<double, 3>{1, 2, -10}));
  EXPECT_EQ(high, (std::array<double, 3>{31, 22, 0}));
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) > bytes.size()) throw std::out_of_range("file ends early");
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/// Writes the file to the folder that KERF_KEEP names, if it is set, to open it in other programs.
void keep(const std::string& name, const std::string& bytes) {
  if (const char* folder = std::getenv("KERF_KEEP"))
    std::ofstream(std::string(folder).append("/").append(name), std::ios::binary) << bytes;
}

/// The parts of a zip by its central directory, inflated.
std::map<std::string, std::string> unzip(const std::string& zip) {
  std::map<std::string, std::string> parts;
  const std::size_t end = zip.rfind("PK\5\6");
  std::size_t at = number_at<std::uint32_t>(zip, end + 16);
  for (int n = number_at<std::uint16_t>(zip, end + 10); n > 0; --n) {
    const auto packed = number_at<std::uint32_t>(zip, at + 20), size = number_at<std::uint32_t>(zip, at + 24);
    const auto name_size = number_at<std::uint16_t>(zip, at + 28);
    const std::size_t local = number_at<std::uint32_t>(zip, at + 42);
    const std::size_t data =
        local + 30u + number_at<std::uint16_t>(zip, local + 26) + number_at<std::uint16_t>(zip, local + 28);
    std::string out(size, '\0');
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zip.data() + data));
    stream.avail_in = packed;
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = size;
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    inflateEnd(&stream);
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(out.data()), size),
              number_at<std::uint32_t>(zip, at + 16));
    parts[zip.substr(at + 46, name_size)] = out;
    at += 46u + name_size + number_at<std::uint16_t>(zip, at + 30) + number_at<std::uint16_t>(zip, at + 32);
  }
  return parts;
}

double attribute(const std::string& tag, const std::string& name) {
  std::string wanted(1, ' ');
  wanted.append(name).append("=\"");
  const std::size_t at = tag.find(wanted);
  return at == std::string::npos ? -1 : std::strtod(tag.c_str() + at + name.size() + 3, nullptr);
}

TEST(MeshFiles, FormatByEnding) {
  EXPECT_EQ(mesh_format_of("a/part.STL"), MeshFormat::stl);
  EXPECT_EQ(mesh_format_of("part.v2.3mf"), MeshFormat::three_mf);
  EXPECT_EQ(mesh_format_of("part.Glb"), MeshFormat::glb);
  EXPECT_EQ(mesh_format_of("part.obj"), MeshFormat::obj);
  EXPECT_EQ(mesh_format_of("part.png"), std::nullopt);
  EXPECT_EQ(mesh_format_of("stl"), std::nullopt);
}

TEST(MeshFiles, StlReadsBack) {
  const std::string bytes = write_mesh(Box().view(), MeshFormat::stl);
  keep("box.stl", bytes);
  ASSERT_EQ(bytes.size(), 84u + 12u * 50u);
  EXPECT_EQ(bytes.substr(0, 4), "Kerf");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 80), 12u);
  std::vector<Triangle> triangles(12);
  for (std::size_t t = 0; t < 12; ++t) {
    const std::size_t at = 84 + 50 * t;
    std::array<double, 3> n{};
    for (std::size_t k = 0; k < 3; ++k) n[k] = number_at<float>(bytes, at + 4 * k);
    EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1.0, 1e-6);
    for (std::size_t k = 0; k < 9; ++k) triangles[t][k / 3][k % 3] = number_at<float>(bytes, at + 12 + 4 * k);
    EXPECT_EQ(number_at<std::uint16_t>(bytes, at + 48), 0);
  }
  EXPECT_EQ(number_at<float>(bytes, 84 + 2 * 50 + 8), 1.0f);  // the normal of the top
  expect_box(triangles);
}

TEST(MeshFiles, ObjReadsBack) {
  const std::string bytes = write_mesh(Box().view(), MeshFormat::obj);
  keep("box.obj", bytes);
  std::istringstream in(bytes);
  std::vector<std::array<double, 3>> points;
  std::vector<Triangle> triangles;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      points.emplace_back();
      for (double& v : points.back()) words >> v;
    } else if (word == "f") {
      triangles.emplace_back();
      for (auto& p : triangles.back()) {
        std::size_t k = 0;
        words >> k;
        p = points.at(k - 1);
      }
    }
  }
  expect_box(triangles);
}

TEST(MeshFiles, ThreeMfReadsBack) {
  const std::string bytes = write_mesh(Box().view(), MeshFormat::three_mf);
  keep("box.3mf", bytes);
  const auto parts = unzip(bytes);
  ASSERT_TRUE(parts.count("[Content_Types].xml") == 1 && parts.count("_rels/.rels") == 1);
  const std::string& model = parts.at("3D/3dmodel.model");
  EXPECT_NE(model.find("unit=\"millimeter\""), std::string::npos);
  EXPECT_NE(model.find("name=\"box &lt;1&gt; &amp; &quot;two&quot;\""), std::string::npos);
  EXPECT_NE(model.find("displaycolor=\"#FF0010\""), std::string::npos);
  std::vector<std::array<double, 3>> points;
  std::vector<Triangle> triangles;
  int red = 0;
  std::istringstream in(model);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("<vertex ", 0) == 0)
      points.push_back({attribute(line, "x"), attribute(line, "y"), attribute(line, "z")});
    if (line.rfind("<triangle ", 0) != 0) continue;
    triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      triangles.back()[k] = points.at(
          static_cast<std::size_t>(attribute(line, std::string(1, 'v').append(std::to_string(k + 1)))));
    if (attribute(line, "p1") == 1) ++red;
  }
  EXPECT_EQ(points.size(), 8u);
  EXPECT_EQ(red, 2);
  expect_box(triangles);
}

TEST(MeshFiles, MaterialsHaveTheNamesOfTheColours) {
  const Box box;
  MeshView view = box.view();
  EXPECT_NE(write_mesh(view, MeshFormat::glb).find("\"colour 1\""), std::string::npos);
  const std::vector<std::string> names{"stock", "tool 102"};
  view.palette_names = names;
  const std::string named = write_mesh(view, MeshFormat::glb);
  EXPECT_NE(named.find("\"stock\""), std::string::npos);
  EXPECT_NE(named.find("\"tool 102\""), std::string::npos);
}

TEST(MeshFiles, GlbReadsBack) {
  const std::string bytes = write_mesh(Box().view(), MeshFormat::glb);
  keep("box.glb", bytes);
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
  const auto json_size = number_at<std::uint32_t>(bytes, 12);
  const auto json = nlohmann::json::parse(bytes.substr(20, json_size));
  const std::size_t binary = 20 + json_size + 8;
  std::vector<Triangle> triangles;
  ASSERT_EQ(json["meshes"][0]["primitives"].size(), 2u);
  for (const auto& primitive : json["meshes"][0]["primitives"]) {
    const auto& accessor = json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    const auto& steps = json["accessors"][primitive["attributes"]["_STEP"].get<std::size_t>()];
    const std::size_t at =
        binary +
        json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    const std::size_t steps_at =
        binary + json["bufferViews"][steps["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    const auto colour = json["materials"][primitive["material"].get<std::size_t>()]["pbrMetallicRoughness"]
                            ["baseColorFactor"];
    const auto count = accessor["count"].get<std::size_t>();
    EXPECT_EQ(count, steps["count"].get<std::size_t>());
    const bool top = count == 6;
    EXPECT_NEAR(colour[0].get<double>(), top ? 1.0 : std::pow((200 / 255.0 + 0.055) / 1.055, 2.4), 1e-9);
    for (std::size_t v = 0; v < count; ++v) {
      if (v % 3 == 0) triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        triangles.back()[v % 3][k] = number_at<float>(bytes, at + 12 * v + 4 * k);
      EXPECT_EQ(number_at<float>(bytes, steps_at + 4 * v), top ? 42.0f : -1.0f);
    }
  }
  expect_box(triangles);
  const auto m = json["nodes"][0]["matrix"];  // columns; a point on top (z = 10 mm) has y = 0.01 m
  EXPECT_DOUBLE_EQ(m[9].get<double>() * 10, 0.01);
  EXPECT_DOUBLE_EQ(m[6].get<double>() * 10, -0.01);
}

TEST(MeshFiles, SameMeshSameBytesAndEmptyMeshes) {
  for (const MeshFormat format : {MeshFormat::stl, MeshFormat::three_mf, MeshFormat::glb, MeshFormat::obj}) {
    EXPECT_EQ(write_mesh(Box().view(), format), write_mesh(Box().view(), format));
    const std::string empty = write_mesh(MeshView{}, format);
    EXPECT_FALSE(empty.empty());
    if (format == MeshFormat::glb) keep("empty.glb", empty);
    const Box box;
    MeshView plain = box.view();
    plain.palette = {};
    plain.step = {};
    EXPECT_LE(write_mesh(plain, format).size(), write_mesh(Box().view(), format).size());
    if (format == MeshFormat::glb) keep("plain.glb", write_mesh(plain, format));
    if (format == MeshFormat::three_mf) keep("plain.3mf", write_mesh(plain, format));
  }
}

}  // namespace
}  // namespace kerf
