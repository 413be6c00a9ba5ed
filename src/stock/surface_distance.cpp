// The distance from a point to a mesh: a tree of boxes over the triangles; the nearer half is searched first.
#include <algorithm>
#include <limits>
#include <numeric>

#include "stock/body.h"

namespace kerf {
namespace {

constexpr std::size_t kLeaf = 8;  // triangles

double distance2_to_box(const Box3& box, Point3 p) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double d = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
    sum += d * d;
  }
  return sum;
}

double distance2_to_segment(Point3 a, Point3 b, Point3 p) {
  const Point3 ab = b - a, ap = p - a;
  const double length2 = dot(ab, ab);
  const double t = length2 > 0.0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0.0;
  const Point3 d = ap - t * ab;
  return dot(d, d);
}

double distance2_to_triangle(const std::array<Point3, 3>& t, Point3 p) {
  const Point3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double area2 = dot(normal, normal);
  bool above = area2 > 0.0;  // whether the foot of the perpendicular lies in the triangle
  for (std::size_t k = 0; k < 3 && above; ++k)
    above = dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) >= 0.0;
  if (above) {
    const double height = dot(p - t[0], normal);
    return height * height / area2;
  }
  return std::min({distance2_to_segment(t[0], t[1], p), distance2_to_segment(t[1], t[2], p),
                   distance2_to_segment(t[2], t[0], p)});
}

}  // namespace

struct SurfaceDistance::Tree {
  struct BoxNode {
    Box3 box;
    std::uint32_t first = 0, end = 0;  // triangles of a leaf
    std::uint32_t right = 0;           // the left child follows its parent; 0: a leaf
  };
  std::vector<BoxNode> nodes;
  std::vector<std::array<Point3, 3>> triangles;

  void build(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t node, Point3 p, double& best2) const;
};

void SurfaceDistance::Tree::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t number = nodes.size();
  nodes.emplace_back();
  Box3 box, centroids;
  for (std::uint32_t k = begin; k < end; ++k) {
    for (const Point3& corner : triangles[k]) box.add(corner);
    centroids.add(triangles[k][0] + triangles[k][1] + triangles[k][2]);
  }
  nodes[number].box = box;
  nodes[number].first = begin;
  nodes[number].end = end;
  if (end - begin <= kLeaf) return;
  const Point3 size = centroids.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t median = begin + (end - begin) / 2;
  std::nth_element(triangles.data() + begin, triangles.data() + median, triangles.data() + end,
                   [axis](const auto& a, const auto& b) {
                     return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
                   });
  build(begin, median);
  nodes[number].right = static_cast<std::uint32_t>(nodes.size());
  build(median, end);
}

void SurfaceDistance::Tree::search(std::uint32_t number, Point3 p, double& best2) const {
  const BoxNode& node = nodes[number];
  if (node.right == 0) {
    for (std::uint32_t k = node.first; k < node.end; ++k)
      best2 = std::min(best2, distance2_to_triangle(triangles[k], p));
    return;
  }
  std::uint32_t near = number + 1, far = node.right;
  double to_near = distance2_to_box(nodes[near].box, p), to_far = distance2_to_box(nodes[far].box, p);
  if (to_far < to_near) {
    std::swap(near, far);
    std::swap(to_near, to_far);
  }
  if (to_near < best2) search(near, p, best2);
  if (to_far < best2) search(far, p, best2);
}

SurfaceDistance::SurfaceDistance(const StockBody& body) : tree_(std::make_unique<Tree>()) {
  const auto* mesh = std::get_if<solid::MeshSolid>(&body.inside().what);
  if (mesh == nullptr || mesh->triangles.empty()) return;
  tree_->triangles.reserve(mesh->triangles.size());
  for (const auto& t : mesh->triangles)
    tree_->triangles.push_back({mesh->at(t[0]), mesh->at(t[1]), mesh->at(t[2])});
  tree_->build(0, static_cast<std::uint32_t>(tree_->triangles.size()));
}
SurfaceDistance::~SurfaceDistance() = default;

double SurfaceDistance::at(Point3 p, double limit) const {
  double best2 = limit * limit;
  if (!tree_->nodes.empty()) tree_->search(0, p, best2);
  return std::sqrt(best2);
}

}  // namespace kerf
