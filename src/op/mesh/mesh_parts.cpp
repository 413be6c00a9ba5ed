// Parts of meshes and their contact with a tool from above.
#include "op/mesh/mesh_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"

namespace kerf::op_detail {
namespace {

constexpr std::size_t kPart = 4096;   // triangles that a thread takes at once
constexpr double kSteepest = 1e12;    // slope of what is vertical
constexpr double kSlopeSlack = 1e-6;  // of a slope and of 1, for rounding
constexpr double kSlack = 4e-6;       // of the tool's radius and of 1 mm, for the same in the offset
constexpr double kNoExtent = 1e-7;    // mm: an offset of a smaller range is that of the neighbours
constexpr double kSameSlope = 1e-9;   // relative, where the profile has a cone
constexpr double kThinnest = 1e7;     // of the rounding of coordinates, altitude of a triangle
constexpr double kAbove = 1e-7;       // mm, that something surely is higher
constexpr std::uint32_t kUnused = 0xffffffffu;

/// A convex region of slopes.
class Slopes {
 public:
  Slopes()
      : points_{{{-kSteepest, -kSteepest},
                 {kSteepest, -kSteepest},
                 {kSteepest, kSteepest},
                 {-kSteepest, kSteepest}}} {}
  bool empty() const { return count_ == 0; }
  /// Keeps those that rise by at least `rise` towards `to`.
  void cut(Point2 to, double rise) {
    // With more corners than there is room for it stays larger than it is.
    if (count_ + 1 > kMax) return;
    std::array<Point2, kMax> left;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Point2 a = points_[i], b = points_[(i + 1) % count_];
      const double da = dot(a, to) - rise, db = dot(b, to) - rise;
      if (da >= 0.0) left[kept++] = a;
      if ((da < 0.0) != (db < 0.0) && kept < kMax) left[kept++] = a + (da / (da - db)) * (b - a);
    }
    points_ = left, count_ = kept;
  }
  Box2 box() const {
    Box2 box;
    for (std::size_t i = 0; i < count_; ++i) box.add(points_[i]);
    return box;
  }

 private:
  static constexpr std::size_t kMax = 24;
  std::array<Point2, kMax> points_;
  std::size_t count_ = 4;
};

struct Range {
  double low = 0.0, high = 0.0;
};
/// Distances from the axis at which the profile has a slope.
Range contacts(const SurfaceTool& tool, double slope) {
  if (slope <= kSameSlope) return {0.0, tool.contact(kSameSlope)};
  if (tool.cone > 0.0 && std::abs(slope - tool.cone) <= kSameSlope * tool.cone)
    return {tool.edge, tool.radius};
  const double r = tool.contact(slope);
  return {r, r};
}

/// The largest cosine of the direction of slopes u (along) from `low` to `high`, v (across) with a magnitude
/// from `least` to `greatest`.
double largest_cosine(double high, double least, double greatest) {
  const double v = high > 0.0 ? least : greatest;
  return high == 0.0 && v == 0.0 ? 1.0 : high / std::hypot(high, v);
}
Range magnitudes(double low, double high) {
  return {low > 0.0 ? low : high < 0.0 ? -high : 0.0, std::max(-low, high)};
}
/// A component of the offset: the distance times the cosine of its direction.
Range component(Range u, Range v, Range r) {
  const Range across = magnitudes(v.low, v.high);
  const double high = largest_cosine(u.high, across.low, across.high);
  const double low = -largest_cosine(-u.low, across.low, across.high);
  return {low * (low >= 0.0 ? r.low : r.high), high * (high >= 0.0 ? r.high : r.low)};
}

/// Offsets from the axis at which the tool has slopes in a box.
Box2 offsets(const SurfaceTool& tool, const Box2& slopes) {
  const Range x{slopes.low.x, slopes.high.x}, y{slopes.low.y, slopes.high.y};
  const Range ax = magnitudes(x.low, x.high), ay = magnitudes(y.low, y.high);
  const Range r{contacts(tool, std::hypot(ax.low, ay.low)).low,
                contacts(tool, std::hypot(ax.high, ay.high)).high};
  const Range cx = component(x, y, r), cy = component(y, x, r);
  return {{cx.low, cy.low}, {cx.high, cy.high}};
}
bool is_small(const Box2& box) {
  return box.high.x - box.low.x < kNoExtent && box.high.y - box.low.y < kNoExtent;
}

std::uint64_t hash_of(const Point3& p) {
  std::uint64_t h = 0;
  for (const double v : {p.x, p.y, p.z}) {
    const double positive = v + 0.0;  // no negative zero
    std::uint64_t bits = 0;
    std::memcpy(&bits, &positive, sizeof bits);  // libc++ 13 has no std::bit_cast
    h = (h ^ bits) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return h;
}

}  // namespace

double contact_slack(const SurfaceTool& tool) { return kSlack * std::max(1.0, tool.radius); }

MeshParts::MeshParts(const SurfaceMesh& mesh, const SurfaceTool& tool, unsigned threads, Progress* progress)
    : tool_(tool) {
  Pace pace(progress, "joining the mesh");
  weld(mesh, pace);
  if (pace.asks()) return;
  plane_facets(threads);
  if (!pace.asks()) sort_triangles();
}

/// Gives points at the same position one number.
void MeshParts::weld(const SurfaceMesh& mesh, Pace& pace) {
  const std::size_t room = std::bit_ceil(2 * mesh.points.size() + 2);
  std::vector<std::uint32_t> table(room, kUnused), number(mesh.points.size(), kUnused);
  double largest = 1.0;
  triangles_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    if (pace.stops(triangles_.size(), mesh.triangles.size())) return;
    std::array<std::uint32_t, 3> made{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& known = number[t[k]];
      if (known == kUnused) {
        const Point3& p = mesh.points[t[k]];
        std::size_t slot = hash_of(p) & (room - 1);
        while (table[slot] != kUnused && points_[table[slot]] != p) slot = (slot + 1) & (room - 1);
        if (table[slot] == kUnused) {
          table[slot] = static_cast<std::uint32_t>(points_.size());
          points_.push_back(p);
          largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
        known = table[slot];
      }
      made[k] = known;
    }
    triangles_.push_back(made);
  }
  thinnest_ = kThinnest * std::numeric_limits<double>::epsilon() * largest;
}

void MeshParts::plane_facets(unsigned threads) {
  facets_.resize(triangles_.size());
  const auto plane = [&](std::size_t i) {
    const auto& t = triangles_[i];
    const Point3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const Point2 ab = b.xy() - a.xy(), ac = c.xy() - a.xy(), bc = c.xy() - b.xy();
    const Point3 n = cross(b - a, c - a);
    Facet& made = facets_[i];
    made.at = a.xy();
    const double longest = std::sqrt(std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)}));
    made.is_steep = !(std::abs(n.z) > thinnest_ * longest);
    if (made.is_steep) return;
    made.rise_x = -n.x / n.z, made.rise_y = -n.y / n.z;
    const double slope = std::sqrt(made.rise_x * made.rise_x + made.rise_y * made.rise_y);
    const double r = tool_.contact(slope <= kSameSlope ? 0.0 : slope);
    made.height = a.z + slope * r - tool_.height(r);
    if (slope > 0.0) made.contact = (r / slope) * Point2{made.rise_x, made.rise_y};
  };
  const auto part = [&](std::size_t n) {
    for (std::size_t i = n * kPart; i < std::min(facets_.size(), (n + 1) * kPart); ++i) plane(i);
  };
  parallel_for(threads, (facets_.size() + kPart - 1) / kPart, part, [] { return false; });
}

void MeshParts::sort_triangles() {
  first_.assign(points_.size() + 1, 0);
  for (const auto& t : triangles_)
    for (const std::uint32_t v : t) ++first_[v + 1];
  for (std::size_t i = 0; i < points_.size(); ++i) first_[i + 1] += first_[i];
  around_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (const std::uint32_t v : triangles_[t]) around_[next[v]++] = t;
}

void MeshParts::parts_at(std::uint32_t point, std::vector<MeshPart>& parts) const {
  thread_local std::vector<Spoke> spokes;
  spokes.clear();
  for (std::uint32_t k = first_[point]; k < first_[point + 1]; ++k)
    for (const std::uint32_t v : triangles_[around_[k]])
      if (v != point) spokes.push_back({v, around_[k]});
  std::sort(spokes.begin(), spokes.end());
  add_vertex(point, spokes, parts);
  const Spoke* const end = spokes.data() + spokes.size();
  for (const Spoke* first = spokes.data(); first != end;) {
    const Spoke* last = first;
    while (last != end && last->to == first->to) ++last;
    if (first->to > point) add_edge(point, first, last, parts);
    first = last;
  }
}

/// Whether a point is inside of an area with the same slopes everywhere: what touches it also touches the
/// border of the area, or a facet.
bool MeshParts::has_one_plane(const std::vector<Spoke>& spokes) const {
  const Facet& first = facets_[spokes.front().triangle];
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    const Facet& facet = facets_[spokes[i].triangle];
    if (facet.is_steep || facet.rise_x != first.rise_x || facet.rise_y != first.rise_y) return false;
    // Each side belongs to two facets.
    if (i % 2 == 0 && (i + 1 == spokes.size() || spokes[i + 1].to != spokes[i].to)) return false;
  }
  return true;
}

void MeshParts::add_vertex(std::uint32_t point, const std::vector<Spoke>& spokes,
                           std::vector<MeshPart>& parts) const {
  const Point3& p = points_[point];
  Slopes slopes;
  if (!spokes.empty() && has_one_plane(spokes)) return;
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    if (i > 0 && spokes[i].to == spokes[i - 1].to) continue;
    const Point3 along = points_[spokes[i].to] - p;
    const double run = std::sqrt(dot(along.xy(), along.xy()));
    if (run <= thinnest_) {
      if (along.z > kAbove + run) return;
      continue;
    }
    const double rise = along.z / run;
    slopes.cut((1.0 / run) * along.xy(), rise - kSlopeSlack * (1.0 + std::abs(rise)));
    if (slopes.empty()) return;
  }
  parts.push_back({MeshPart::Kind::vertex, point, point, offsets(tool_, slopes.box())});
}

void MeshParts::add_edge(std::uint32_t from, const Spoke* first, const Spoke* last,
                         std::vector<MeshPart>& parts) const {
  const Point3 &a = points_[from], along = points_[first->to] - a;
  const double run = std::sqrt(dot(along.xy(), along.xy()));
  if (run <= thinnest_) return;  // vertical: its upper end is a vertex
  const Point2 unit = (1.0 / run) * along.xy(), left = left_of(unit);
  const double rise = along.z / run;
  double low = -kSteepest, high = kSteepest;  // slopes to the left
  for (const Spoke* spoke = first; spoke != last; ++spoke) {
    const auto& t = triangles_[spoke->triangle];
    const Facet& facet = facets_[spoke->triangle];
    const auto other = std::find_if(t.begin(), t.end(), [&](auto v) { return v != from && v != first->to; });
    if (other == t.end()) continue;
    const Point3 to = points_[*other] - a;
    if (facet.is_steep) {
      if (to.z > rise * dot(unit, to.xy()) + kAbove) return;  // the facet is above the edge
      continue;
    }
    const double slope = facet.rise_x * left.x + facet.rise_y * left.y;
    if (cross(unit, to.xy()) > 0.0)
      low = std::max(low, slope);
    else
      high = std::min(high, slope);
  }
  const double slack = kSlopeSlack * (1.0 + std::min(std::abs(low), std::abs(high)));
  if (low > high + slack) return;
  const auto offset_of = [&](double least, double greatest) {
    Box2 slopes;
    slopes.add(rise * unit + least * left), slopes.add(rise * unit + greatest * left);
    return offsets(tool_, slopes);
  };
  // The facets at both sides touch the tool with the same offset, and meet at the edge.
  if (is_small(offset_of(low, high))) return;
  parts.push_back({MeshPart::Kind::edge, from, first->to, offset_of(low - slack, high + slack)});
}

}  // namespace kerf::op_detail
