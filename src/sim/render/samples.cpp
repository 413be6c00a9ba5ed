// Finds what the samples of a band show. Normals are interpolated between the vertices of a triangle.
#include "sim/render/samples.h"

#include <cmath>
#include <utility>

namespace kerf::rendering {
namespace {

constexpr double kSmoothCosine = 0.82;    // faces at smaller angles (35 degrees) are shaded as one surface
constexpr double kFlatCosine = 0.999999;  // a face with vertex normals at smaller angles has one normal
constexpr double kCreaseCosine = 0.6;     // faces at larger angles are separated by a line
constexpr double kPlainCosine = 0.99;     // a pixel of samples at smaller angles is shaded once
constexpr double kLineJump = 0.012;   // larger steps in depth have a line, as a fraction of the part's size
constexpr double kGroundReach = 4.0;  // of the ground from the centre, in sizes of the part
constexpr double kHorizon = 0.999;    // of the largest depth: where the ground ends
constexpr std::uint32_t kRecent = 1024;  // triangles with known normals

}  // namespace

std::vector<std::array<float, 3>> smooth_normals(const Mesh& mesh) {
  std::vector<std::array<float, 3>> normals;
  fill(normals, mesh.positions.size() / 3, {});
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const Point3 a = vertex(mesh, mesh.triangles[t]);
    const Point3 n = cross(vertex(mesh, mesh.triangles[t + 1]) - a, vertex(mesh, mesh.triangles[t + 2]) - a);
    for (std::size_t k = 0; k < 3; ++k) {
      auto& sum = normals[mesh.triangles[t + k]];
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += static_cast<float>(n[static_cast<int>(axis)]);
    }
  }
  in_bands(static_cast<int>(normals.size()), [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      auto& n = normals[static_cast<std::size_t>(v)];
      const Point3 u = unit({n[0], n[1], n[2]});
      n = {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
    }
  });
  return normals;
}

Samples::Samples(const Scene& scene, const Drawing& drawing,
                 const std::vector<std::array<float, 3>>& vertex_normals)
    : scene_(scene),
      drawing_(drawing),
      vertex_normals_(vertex_normals),
      ground_({{0, 0, 1}, scene.box.low.z}, scene.eye),
      recent_(kRecent),
      recent_triangle_(kRecent, kNothing) {
  target_.width = scene.width * scene.fine;
}

void Samples::draw(std::size_t band) {
  target_.rows = drawing_.rows_with_extra(band);
  const std::size_t count = target_.index(0, target_.rows.last);
  target_.depth.assign(count, kFarDepth);
  target_.triangle.assign(count, kNothing);
  normals_.resize(count);
  differs_.resize(count);
  drawing_.draw(band, target_);
  add_ground_and_normals();
  compare_neighbours();
}

/// Of a triangle: interpolated between those of its vertices that are close to the face's.
Samples::NormalField Samples::normals_of(std::uint32_t triangle) const {
  const std::uint32_t* v = scene_.mesh.triangles.data() + std::size_t{3} * triangle;
  const Point3 a = vertex(scene_.mesh, v[0]);
  const Point3 face = unit(cross(vertex(scene_.mesh, v[1]) - a, vertex(scene_.mesh, v[2]) - a));
  const auto& screen = drawing_.vertices();
  const ScreenVertex &p = screen[v[0]], &q = screen[v[1]], &r = screen[v[2]];
  const double qx = static_cast<double>(q.x) - p.x, qy = static_cast<double>(q.y) - p.y;
  const double rx = static_cast<double>(r.x) - p.x, ry = static_cast<double>(r.y) - p.y;
  const double area = qx * ry - qy * rx;
  std::array<Point3, 3> n;
  bool flat = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& mean = vertex_normals_[v[k]];
    const Point3 smooth{mean[0], mean[1], mean[2]};
    const double cosine = dot(smooth, face);
    n[k] = cosine > kSmoothCosine ? smooth : face;
    flat = flat && (cosine <= kSmoothCosine || cosine > kFlatCosine);
  }
  NormalField field;
  field.packed = PackedNormal::of(face);
  field.is_flat = flat || area == 0.0;
  if (field.is_flat) return field;
  const Point3 along_q = (1.0 / area) * (n[1] - n[0]), along_r = (1.0 / area) * (n[2] - n[0]);
  field.dx = ry * along_q - qy * along_r;
  field.dy = qx * along_r - rx * along_q;
  field.origin = n[0] - static_cast<double>(p.x) * field.dx - static_cast<double>(p.y) * field.dy;
  return field;
}

/// The depth of the ground in samples of a row without a surface; kFarDepth remains far away and above the
/// horizon.
void Samples::add_ground(int y, int first, int last) {
  const Projection& eye = scene_.eye;
  const double per_scale = 1.0 / eye.scale, reach = kGroundReach * scene_.size;
  const double up = (eye.y0 - (y + 0.5)) * per_scale, square_up = up * up;
  const double at_left = ground_.depth_at(0.5, y + 0.5), by_x = ground_.depth_at(1.5, y + 0.5) - at_left;
  float* depths = target_.depth.data() + target_.index(0, y);
  for (int x = first; x < last; ++x) {
    const double depth = at_left + by_x * x, right = (x + 0.5 - eye.x0) * per_scale;
    const double near = 1.0 - eye.nearness * depth;  // the distance from the centre is divided by it
    const bool is_near =
        near > 1.0 - kHorizon && right * right + square_up + depth * depth <= reach * reach * near * near;
    depths[x] = is_near ? static_cast<float>(depth) : kFarDepth;
  }
}

void Samples::add_ground_and_normals() {
  const PackedNormal up = PackedNormal::of({0, 0, 1});
  const PackedNormal cut = scene_.section ? PackedNormal::of(scene_.section->normal) : up;
  for (int y = target_.rows.first; y < target_.rows.last; ++y) {
    const std::size_t row = target_.index(0, y);
    for (int x = 0; x < target_.width;) {
      const int first = x;
      const std::uint32_t triangle = target_.triangle[row + static_cast<std::size_t>(x)];
      while (x < target_.width && target_.triangle[row + static_cast<std::size_t>(x)] == triangle) ++x;
      const auto normals = normals_.begin() + static_cast<std::ptrdiff_t>(row);
      if (triangle == kNothing || triangle == kCutFace) {
        std::fill(normals + first, normals + x, triangle == kNothing ? up : cut);
        if (triangle == kNothing && scene_.ground) add_ground(y, first, x);
        continue;
      }
      NormalField& field = recent_[triangle % kRecent];
      if (std::exchange(recent_triangle_[triangle % kRecent], triangle) != triangle)
        field = normals_of(triangle);
      for (int k = first; k < x; ++k) normals[k] = field.at(k + 0.5, y + 0.5);
    }
  }
}

/// Whether two neighbouring samples show different things, or have a line between them.
bool Samples::differ(std::size_t a, std::size_t b) const {
  const std::uint32_t s = target_.triangle[a], t = target_.triangle[b];
  // The difference of the distances of two samples is that of their depths, divided by both factors.
  const double depth_a = target_.depth[a], depth_b = target_.depth[b], nearness = scene_.eye.nearness;
  if (std::abs(depth_a - depth_b) >
      kLineJump * scene_.size * (1.0 - nearness * depth_a) * (1.0 - nearness * depth_b))
    return true;
  if (s != t) {
    if (s >= kCutFace || t >= kCutFace) return true;
    const auto& colours = scene_.colours;
    if ((s < colours.size()) != (t < colours.size())) return true;
    if (s < colours.size() && colours[s] != colours[t]) return true;
  }
  if (normals_[a] == normals_[b]) return false;
  const auto &m = normals_[a].n, &n = normals_[b].n;
  const int cosine = (m[0] * n[0] >> 1) + (m[1] * n[1] >> 1) + (m[2] * n[2] >> 1);
  return cosine < static_cast<int>(kPlainCosine * 32767.0 * 32767.0 / 2.0);
}

void Samples::compare_neighbours() {
  const auto width = static_cast<std::size_t>(target_.width);
  for (int y = target_.rows.first; y < target_.rows.last; ++y) {
    const bool has_lower = y + 1 < target_.rows.last;
    const std::size_t row = target_.index(0, y);
    for (std::size_t at = row; at < row + width; ++at) {
      const int right = at + 1 < row + width && differ(at, at + 1) ? with_right : 0;
      const int lower = has_lower && differ(at, at + width) ? with_lower : 0;
      differs_[at] = static_cast<std::uint8_t>(right | lower);
    }
  }
}

bool Samples::is_plain(int x, int y) const {
  const int fine = scene_.fine, x0 = x * fine, y0 = y * fine;
  int bits = 0;
  for (int k = 0; k < fine; ++k) {
    for (int j = 0; j < fine; ++j) bits |= differs_[target_.index(x0 + j, y0 + k)];
    if (x0 > 0) bits |= differs_[target_.index(x0 - 1, y0 + k)] & with_right;
    if (y0 > 0) bits |= differs_[target_.index(x0 + k, y0 - 1)] & with_lower;
  }
  return bits == 0;
}

double Samples::line_at(int x, int y) const {
  const std::size_t at = target_.index(x, y);
  if (target_.triangle[at] == kNothing) return 1.0;
  const Projection& eye = scene_.eye;
  const Point3 n = normals_[at].get();
  const Point3 p = eye.point(x + 0.5, y + 0.5, target_.depth[at]);
  double line = 1.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    const int qx = x + dx, qy = y + dy;
    if (qx < 0 || qy < target_.rows.first || qx >= target_.width || qy >= target_.rows.last) continue;
    const std::size_t other = target_.index(qx, qy);
    if (target_.triangle[other] == kNothing) {
      line = std::min(line, 0.45);
      continue;
    }
    if ((target_.triangle[other] == kCutFace) != (target_.triangle[at] == kCutFace))
      line = std::min(line, 0.6);
    const Point3 step = eye.point(qx + 0.5, qy + 0.5, target_.depth[other]) - p;
    const double jump = std::abs(dot(step, eye.into));
    // A line on the nearer side of a step in depth that exceeds that of a steep slope.
    if (jump > kLineJump * scene_.size && target_.depth[other] > target_.depth[at])
      line = std::min(line, 0.6);
    if ((dx > 0 || dy > 0) && dot(n, normals_[other].get()) < kCreaseCosine) line = std::min(line, 0.8);
  }
  return line;
}

}  // namespace kerf::rendering
