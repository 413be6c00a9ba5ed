// Reading meshes: the output of write_mesh, short files in the forms of other programs, and damaged ones.
#include <cmath>
#include <gtest/gtest.h>
#include <minizip/zip.h>

#include "base/codes/stock.h"

#include "kerf/formats/mesh_files.h"

namespace kerf {
namespace {

/// A tetrahedron with corners that are exact in single precision.
struct Tetrahedron {
  std::vector<float> positions{0, 0, 0, 8, 0, 0, 0, 4, 0, 0.5f, 0.25f, -2};
  std::vector<std::uint32_t> triangles{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
  MeshView view() const { return {positions, triangles, {}, {}, {}, "tetrahedron"}; }
};

double volume(const MeshData& mesh) {
  double six = 0.0;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const double* p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.positions.data() + 3 * mesh.triangles[t + k];
    six += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
           p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
  }
  return six / 6.0;
}

std::optional<MeshData> read(const std::string& bytes, MeshFormat format, Diagnostics& diagnostics,
                             const MeshLimits& limits = {}) {
  return read_mesh(bytes, format, "body", diagnostics, limits);
}

void expect_code(const std::string& bytes, MeshFormat format, Code code, const std::string& part,
                 const MeshLimits& limits = {}) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read(bytes, format, diagnostics, limits)) << part;
  ASSERT_EQ(diagnostics.list().size(), 1u) << part;
  EXPECT_EQ(diagnostics.list()[0].code, code);
  EXPECT_NE(diagnostics.list()[0].message.find(part), std::string::npos) << diagnostics.list()[0].message;
}

TEST(ReadMesh, ReadsWhatWasWritten) {
  const Tetrahedron solid;
  for (const MeshFormat format : {MeshFormat::stl, MeshFormat::three_mf, MeshFormat::glb, MeshFormat::obj}) {
    Diagnostics diagnostics;
    const auto mesh = read(write_mesh(solid.view(), format), format, diagnostics);
    ASSERT_TRUE(mesh) << static_cast<int>(format);
    EXPECT_TRUE(diagnostics.list().empty());
    EXPECT_EQ(mesh->triangles.size(), 12u);
    EXPECT_NEAR(volume(*mesh), -8.0 * 4.0 * -2.0 / 6.0, 1e-6) << static_cast<int>(format);
    double low = 0.0, high = 0.0;
    for (std::size_t k = 2; k < mesh->positions.size(); k += 3) {
      low = std::min(low, mesh->positions[k]);
      high = std::max(high, mesh->positions[k]);
    }
    EXPECT_NEAR(low, -2.0, 1e-6);
    EXPECT_NEAR(high, 0.0, 1e-6);
  }
}

constexpr const char* kTextFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1e0 0 0\n  vertex 0 1.5 0\n "
    "endloop\nendfacet\n";

TEST(ReadMesh, TextStlWithAnyName) {
  Diagnostics diagnostics;
  const std::string text =
      std::string("solid vertex loop 7\r\n") + kTextFacet + kTextFacet + "endsolid vertex";
  const auto mesh = read(text, MeshFormat::stl, diagnostics);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->triangles.size(), 6u);
  EXPECT_EQ(mesh->positions[7], 1.5);
}

TEST(ReadMesh, BinaryStlWithATextHeader) {
  std::string bytes = write_mesh(Tetrahedron().view(), MeshFormat::stl);
  bytes.replace(0, 5, "solid");
  Diagnostics diagnostics;
  ASSERT_TRUE(read(bytes, MeshFormat::stl, diagnostics));
}

TEST(ReadMesh, ObjWithPolygonsAndNumbersFromTheEnd) {
  Diagnostics diagnostics;
  const auto mesh = read("# x\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 -2//1 -1//1\n",
                         MeshFormat::obj, diagnostics);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(ReadMesh, DamagedStl) {
  const std::string good = write_mesh(Tetrahedron().view(), MeshFormat::stl);
  expect_code(good.substr(0, good.size() - 1), MeshFormat::stl, codes::mesh_file, "4 triangles");
  expect_code("solid x\nfacet\nouter loop\nvertex 0 0\nendloop", MeshFormat::stl, codes::mesh_file,
              "three numbers");
  expect_code("solid x\nouter loop\nvertex 0 0 0\nendloop", MeshFormat::stl, codes::mesh_file,
              "three vertices");
  expect_code("solid x\nouter loop\nvertex 0 0 nan\nendloop", MeshFormat::stl, codes::mesh_file,
              "three numbers");
  expect_code("solid nothing\nendsolid", MeshFormat::stl, codes::mesh_no_volume, "no triangles");
  expect_code("short", MeshFormat::stl, codes::mesh_file, "too short");
  std::string far = good;
  far.replace(84 + 12, 4, std::string("\xff\xff\x7f\x7f", 4));  // the largest float
  expect_code(far, MeshFormat::stl, codes::mesh_file, "10 km");
}

TEST(ReadMesh, MoreThanTheLimit) {
  for (const MeshFormat format : {MeshFormat::stl, MeshFormat::three_mf, MeshFormat::glb, MeshFormat::obj})
    expect_code(write_mesh(Tetrahedron().view(), format), format, codes::mesh_too_large, "",
                {.triangles = 3});
  expect_code(write_mesh(Tetrahedron().view(), MeshFormat::three_mf), MeshFormat::three_mf,
              codes::mesh_too_large, "unpacked model", {.text_bytes = 100});
}

TEST(ReadMesh, DamagedObjAndGlb) {
  expect_code("v 0 0 0\nv 1 0 0\nf 1 2 3\n", MeshFormat::obj, codes::mesh_file, "does not exist");
  expect_code("v 0 0 0\nv 1 0 0\nf 1 2\n", MeshFormat::obj, codes::mesh_file, "fewer than three");
  expect_code("v 0 0 x\n", MeshFormat::obj, codes::mesh_file, "three numbers");
  expect_code("glTX", MeshFormat::glb, codes::mesh_file, "start as a GLB");
  std::string good = write_mesh(Tetrahedron().view(), MeshFormat::glb);
  expect_code(good.substr(0, good.size() - 8), MeshFormat::glb, codes::mesh_file, "within a chunk");
  const auto changed = [&good](const std::string& from, const std::string& to) {
    std::string bytes = good;
    bytes.replace(bytes.find(from), from.size(), to);
    return bytes;
  };
  expect_code(changed("\"asset\"", "\"asset'"), MeshFormat::glb, codes::mesh_file, "JSON part");
  expect_code(changed("\"count\":12", "\"count\":13"), MeshFormat::glb, codes::mesh_file, "beyond the end");
  expect_code(changed("\"meshes\"", "\"mashes\""), MeshFormat::glb, codes::mesh_file, "not valid glTF");
  expect_code(changed("\"mode\":4", "\"mode\":5"), MeshFormat::glb, codes::mesh_file, "strips");
}

/// A 3MF with the given model and nothing else.
std::string package(const std::string& model, const std::string& part = "3D/3dmodel.model",
                    const std::string& second = "") {
  const std::string path = testing::TempDir() + "/kerf_read_mesh.3mf";
  zipFile zip = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
  zip_fileinfo info{};
  zipOpenNewFileInZip(zip, part.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 6);
  zipWriteInFileInZip(zip, model.data(), static_cast<unsigned>(model.size()));
  zipCloseFileInZip(zip);
  if (!second.empty()) {
    zipOpenNewFileInZip(zip, "3D/second.model", &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 6);
    zipWriteInFileInZip(zip, second.data(), static_cast<unsigned>(second.size()));
    zipCloseFileInZip(zip);
  }
  zipClose(zip, nullptr);
  FILE* file = std::fopen(path.c_str(), "rb");
  std::string bytes(1 << 20, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
  std::fclose(file);
  return bytes;
}

std::string model_with(const std::string& build, const std::string& unit = "inch") {
  return "<model unit=\"" + unit +
         "\"><resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" "
         "y=\"0\" "
         "z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" "
         "v3=\"2\"/>"
         "</triangles></mesh></object><object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 "
         "0 0 1 "
         "0 0 0 1 0 0 2\"/><component objectid=\"1\"/></components></object><object id=\"3\"><components>"
         "<component objectid=\"3\"/></components></object></resources><build>" +
         build + "</build></model>";
}

TEST(ReadMesh, AssemblesThePartsOfA3mf) {
  Diagnostics diagnostics;
  const auto mesh = read(package(model_with("<item objectid=\"2\" transform=\"-1 0 0 0 1 0 0 0 1 5 0 0\"/>")),
                         MeshFormat::three_mf, diagnostics);
  ASSERT_TRUE(mesh);
  ASSERT_EQ(mesh->triangles.size(), 6u);
  EXPECT_EQ(mesh->triangles[1], 2u);  // mirroring reverses triangles
  EXPECT_DOUBLE_EQ(mesh->positions[3], 4.0 * 25.4);
  EXPECT_DOUBLE_EQ(mesh->positions[5], 2.0 * 25.4);
  EXPECT_DOUBLE_EQ(mesh->positions[14], 0.0);
}

TEST(ReadMesh, ThePartsOfA3mfAreThoseOfItsFirstModel) {
  const std::string first =
      "<model unit=\"millimeter\" "
      "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\">"
      "<resources/><build><item objectid=\"1\" p:path=\"/3D/second.model\"/></build></model>";
  // The second file has a build of its own, which slicers write and which does not count.
  const std::string second = model_with("<item objectid=\"1\"/><item objectid=\"2\"/>", "millimeter");
  Diagnostics diagnostics;
  const auto mesh = read(package(first, "3D/3dmodel.model", second), MeshFormat::three_mf, diagnostics);
  ASSERT_TRUE(mesh) << to_string(diagnostics.list().front());
  EXPECT_EQ(mesh->triangles.size(), 3u);
}

TEST(ReadMesh, Damaged3mf) {
  expect_code("PK nothing", MeshFormat::three_mf, codes::mesh_file, "not a zip");
  expect_code(package("<model/>", "other"), MeshFormat::three_mf, codes::mesh_file, "missing");
  expect_code(package("<model><unclosed></model>"), MeshFormat::three_mf, codes::mesh_file, "not valid XML");
  expect_code(package(model_with("<item objectid=\"9\"/>")), MeshFormat::three_mf, codes::mesh_file,
              "object 9");
  expect_code(package(model_with("<item objectid=\"3\"/>")), MeshFormat::three_mf, codes::mesh_file,
              "contain each other");
  expect_code(package(model_with("<item objectid=\"1\" transform=\"1 2\"/>")), MeshFormat::three_mf,
              codes::mesh_file, "twelve");
  expect_code(package(model_with("", "yard")), MeshFormat::three_mf, codes::mesh_file, "unit");
}

/// All three formats state their size, or have their directory at the end.
TEST(ReadMesh, EveryShortenedFileIsRefusedOrWhole) {
  for (const MeshFormat format : {MeshFormat::stl, MeshFormat::three_mf, MeshFormat::glb}) {
    const std::string good = write_mesh(Tetrahedron().view(), format);
    for (std::size_t size = 0; size < good.size(); ++size) {
      Diagnostics diagnostics;
      const auto mesh = read(good.substr(0, size), format, diagnostics);
      // The last bytes of an archive repeat where its directory is, and are the length of its comment.
      const bool complete = format == MeshFormat::three_mf && size + 8 >= good.size();
      EXPECT_TRUE(!mesh || complete) << size << " of " << good.size();
      EXPECT_EQ(mesh.has_value(), !diagnostics.has_errors()) << size;
      if (mesh) {
        EXPECT_NEAR(volume(*mesh), -8.0 * 4.0 * -2.0 / 6.0, 1e-6);
      }
    }
  }
}

TEST(ReadMesh, TextStlThatEndsWithinAFacet) {
  const std::string whole = std::string("solid x\n") + kTextFacet, facet = kTextFacet;
  for (const std::string last : {"vertex 0 0 0\n", "vertex 1e0 0 0\n"})
    expect_code(whole + facet.substr(0, facet.find(last) + last.size()), MeshFormat::stl, codes::mesh_file,
                "ends within a facet");
}

}  // namespace
}  // namespace kerf
