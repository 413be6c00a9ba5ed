// The mesh of single sweeps of every tool and every kind of motion against an independent reference: the
// errors of its surfaces and edges.
#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>
#include <initializer_list>
#include <string>

#include "../sim_cut/sweep_reference.h"

#include "kerf/sim/exact_mesh.h"

namespace kerf::test {
namespace {

constexpr double kPitch = 0.1;
constexpr std::size_t kSamples = 150;  // of each kind and job

// Limits at columns of 0.1 mm, see docs/decisions/0006-mesh.md: as extracted, with walls between columns and
// edges accurate to about half a pitch, and of the exact mesh.
constexpr double kSurfaceLimit = 0.018;  // mm
constexpr double kEdgeLimit = 1.1 * kPitch;
constexpr double kExactSurfaceLimit = 0.012;
// For tools without a sharp flank at constant height; elsewhere the reference has scallops itself. The 99th
// percentile, because a cusp has many small triangles.
constexpr double kExactEdgeLimit99 = 0.015;

struct Face {
  std::size_t number;  // of the triangle
  Point3 centre;
  double upright = 0.0;  // of its normal, 0 for a wall
};

/// The triangles made by cuts: walls, and faces without a vertex on a wall.
struct Faces {
  std::vector<Face> walls, surfaces;
};

Point3 corner_of(const Mesh& mesh, std::size_t corner) {
  const float* at = &mesh.positions[3 * static_cast<std::size_t>(mesh.triangles[corner])];
  return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

Face face_of(const Mesh& mesh, std::size_t number) {
  const Point3 a = corner_of(mesh, 3 * number), b = corner_of(mesh, 3 * number + 1),
               c = corner_of(mesh, 3 * number + 2);
  const Point3 u = b - a, v = c - a;
  const Point3 normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  return {number, (1.0 / 3.0) * (a + b + c), std::abs(normal.z) / length(normal)};
}

template <class Item>
std::vector<Item> thinned(const std::vector<Item>& all) {
  std::vector<Item> some;
  const std::size_t step = all.size() / kSamples + 1;
  for (std::size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

Faces faces_of(const Mesh& mesh) {
  constexpr double kUpright = 1e-3;
  const std::size_t count = mesh.triangles.size() / 3;
  std::vector<bool> on_wall(mesh.positions.size() / 3, false);
  Faces all;
  for (std::size_t n = 0; n < count; ++n) {
    const Face face = face_of(mesh, n);
    if (face.upright > kUpright) continue;
    for (std::size_t k = 3 * n; k < 3 * n + 3; ++k) on_wall[mesh.triangles[k]] = true;
    if (mesh.step[n] != kStockSurface) all.walls.push_back(face);
  }
  for (std::size_t n = 0; n < count; ++n) {
    const auto touches = [&](std::size_t k) { return on_wall[mesh.triangles[k]]; };
    if (mesh.step[n] == kStockSurface || touches(3 * n) || touches(3 * n + 1) || touches(3 * n + 2)) continue;
    all.surfaces.push_back(face_of(mesh, n));
  }
  return {thinned(all.walls), thinned(all.surfaces)};
}

/// The end of the intervals `left` that is nearest to z.
double nearest_end(const std::vector<Silhouette2::Run>& left, double z) {
  double nearest = 1e9;
  for (const auto& run : left)
    for (const double end : {run.low, run.high})
      if (std::abs(end - z) < std::abs(nearest - z)) nearest = end;
  return nearest;
}

/// True if the true surface has an edge so near that a vertex of the face lies between columns on both sides
/// of it: the heights are not continuous, or curve more than a smooth surface of these tools.
bool has_edge_near(const Remainder& left, const Face& face, double height) {
  constexpr double kReach = 1.5 * kPitch, kMaxCurve = 0.2 * kReach;
  if (std::abs(height - face.centre.z) > kPitch) return true;
  for (const Point2 offset :
       {Point2{kReach, 0}, Point2{0, kReach}, Point2{kReach, kReach}, Point2{kReach, -kReach}}) {
    const double before = nearest_end(left(face.centre.x - offset.x, face.centre.y - offset.y), height);
    const double after = nearest_end(left(face.centre.x + offset.x, face.centre.y + offset.y), height);
    if (std::abs(before + after - 2.0 * height) * face.upright > kMaxCurve) return true;
  }
  return false;
}

/// The distance of a point from the end of the material: the minimum of that in plan and in height.
double edge_error(const Remainder& left, Point3 at) {
  double error = std::abs(nearest_end(left(at.x, at.y), at.z) - at.z);
  const bool inside = left.is_removed(at);
  constexpr int kWays = 16;
  for (int k = 0; k < kWays; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kWays;
    const auto other = [&](double r) {
      return left.is_removed({at.x + r * std::cos(angle), at.y + r * std::sin(angle), at.z}) != inside;
    };
    double near = 0.0, far = std::min(error, 2.0 * kPitch);
    if (!other(far)) continue;
    for (int n = 0; n < 10; ++n) {
      const double half = 0.5 * (near + far);
      (other(half) ? far : near) = half;
    }
    error = far;
  }
  return error;
}

struct MeshErrors {
  Errors surfaces, edges;
};

MeshErrors errors_of(const Mesh& mesh, const Remainder& left) {
  const Faces faces = faces_of(mesh);
  std::vector<double> surfaces, edges;
  for (const Face& face : faces.surfaces) {
    const double height = nearest_end(left(face.centre.x, face.centre.y), face.centre.z);
    const double error = std::abs(height - face.centre.z) * face.upright;
    if (has_edge_near(left, face, height)) {
      edges.push_back(edge_error(left, face.centre));
    } else {
      surfaces.push_back(error);
    }
  }
  for (const Face& face : faces.walls) edges.push_back(edge_error(left, face.centre));
  return {summary_of(std::move(surfaces)), summary_of(std::move(edges))};
}

class MeshOfSweeps : public testing::TestWithParam<std::size_t> {};

void print(const char* what, const NamedProfile& tool, const Motion& motion, const MeshErrors& errors) {
  std::printf(
      "%s mesh, error in um  %-14s %-14s surface: largest %7.2f  99th percentile %7.2f  edges: largest %6.1f "
      " "
      "99th percentile %6.1f\n",
      what, tool.name.c_str(), motion.name.c_str(), errors.surfaces.largest * 1000,
      errors.surfaces.percentile_99 * 1000, errors.edges.largest * 1000, errors.edges.percentile_99 * 1000);
}

bool reference_is_sharp(const NamedProfile& tool, const Motion& motion) {
  const auto is_one_of = [](const std::string& name, std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return is_one_of(tool.name, {"square", "ball", "bull_nose"}) &&
         is_one_of(motion.name, {"level", "along_x", "plunge", "up", "dot", "arc_ccw_short", "arc_cw_long",
                                 "arc_cw_short", "circle", "small_circle"});
}

TEST_P(MeshOfSweeps, MatchesTheReference) {
  const NamedProfile tool = all_profiles()[GetParam()];
  for (const Motion& motion : motions()) {
    const auto result = cut(tool, motion, kPitch);
    ASSERT_TRUE(result);
    const Remainder left(tool, motion);
    Mesh mesh = extract_mesh(result->workpiece.grid());
    const MeshErrors rough = errors_of(mesh, left);
    print("rough", tool, motion, rough);
    EXPECT_LE(rough.surfaces.largest, kSurfaceLimit) << motion.name;
    EXPECT_LE(rough.edges.largest, kEdgeLimit) << motion.name;
    ASSERT_TRUE(make_mesh_exact(mesh, *result));
    EXPECT_EQ(check_mesh(mesh).bad_edges, 0u) << motion.name;
    const MeshErrors exact = errors_of(mesh, left);
    print("exact", tool, motion, exact);
    EXPECT_LE(exact.surfaces.largest, kExactSurfaceLimit) << motion.name;
    if (reference_is_sharp(tool, motion)) {
      EXPECT_LE(exact.edges.percentile_99, kExactEdgeLimit99) << motion.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllTools, MeshOfSweeps, testing::Range<std::size_t>(0, all_profiles().size()),
                         [](const auto& tool) { return all_profiles()[tool.param].name; });

}  // namespace
}  // namespace kerf::test
