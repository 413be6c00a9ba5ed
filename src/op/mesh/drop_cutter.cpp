// Drop-cutter by cells of positions.
#include "op/mesh/drop_cutter.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace kerf::op_detail {
namespace {

constexpr std::size_t kBatch = 16384;  // points or triangles that a thread takes at once
constexpr double kTrianglesPerCell = 2.0;
constexpr double kMinCells = 4096.0, kMaxCells = 4e6;
constexpr double kAround = 4.0;      // cells, with those around the mesh, as a multiple
constexpr double kSmall = 6.0;       // cells that a region may have without regard to its shape
constexpr double kMaxEntries = 2e6;  // of all regions together, but at least kSmall for each
constexpr double kMaxOfOne = 1024.0;
constexpr int kKindShift = 30;
constexpr std::uint32_t kNumber = (1u << kKindShift) - 1;

/// Between two boxes.
double gap(const Box2& a, const Box2& b) {
  return std::hypot(std::max({a.low.x - b.high.x, b.low.x - a.high.x, 0.0}),
                    std::max({a.low.y - b.high.y, b.low.y - a.high.y, 0.0}));
}

}  // namespace

DropCutter::DropCutter(const SurfaceMesh& mesh, const SurfaceTool& tool, unsigned wanted, Progress* progress)
    : tool_(tool), parts_(mesh, tool, thread_count(wanted), progress), slack_(contact_slack(tool)) {
  const std::size_t facets = parts_.facets().size(), points = parts_.points().size();
  if (facets == 0 || stop_requested(progress)) return;
  const unsigned threads = thread_count(wanted);
  choose_levels();
  const std::size_t of_facets = (facets + kBatch - 1) / kBatch, of_points = (points + kBatch - 1) / kBatch;
  std::vector<Batch> batches(of_facets + of_points);
  const auto make = [&](std::size_t n) {
    Batch& batch = batches[n];
    if (n < of_facets) {
      for (std::size_t i = n * kBatch; i < std::min(facets, (n + 1) * kBatch); ++i) {
        const Facet& facet = parts_.facets()[i];
        const auto number = static_cast<std::uint32_t>(i);
        if (!facet.is_steep)
          add({MeshPart::Kind::facet, number, 0, {facet.contact, facet.contact}}, number, batch);
      }
      return;
    }
    std::vector<MeshPart> parts;
    for (std::size_t i = (n - of_facets) * kBatch; i < std::min(points, (n - of_facets + 1) * kBatch); ++i) {
      parts.clear();
      parts_.parts_at(static_cast<std::uint32_t>(i), parts);
      for (const MeshPart& part : parts)
        if (part.kind == MeshPart::Kind::vertex) {
          add(part, part.a, batch);
        } else {
          add(part, static_cast<std::uint32_t>(batch.edges.size()), batch);
          batch.edges.push_back({part.a, part.b});
        }
    }
  };
  std::atomic<std::size_t> done{0};
  const auto counted = [&](std::size_t n) {
    make(n);
    ++done;
  };
  if (progress != nullptr) progress->phase("sorting the mesh");
  parallel_for(threads, batches.size(), counted, [&] {
    report(progress, static_cast<double>(done) / static_cast<double>(batches.size()));
    return stop_requested(progress);
  });
  if (!stop_requested(progress)) sort(batches, threads);
}

/// Levels up to one cell.
void DropCutter::choose_levels() {
  for (const Point3& p : parts_.points()) box_.add(p.xy());
  const double inner = std::max(box_.high.x - box_.low.x, 1e-3) * std::max(box_.high.y - box_.low.y, 1e-3);
  box_ = box_.grown(tool_.radius + 2.0 * slack_);
  const double wide = box_.high.x - box_.low.x, high = box_.high.y - box_.low.y;
  const double triangles = static_cast<double>(parts_.facets().size());
  max_cells_ = static_cast<std::size_t>(std::clamp(kMaxEntries / triangles, kSmall, kMaxOfOne));
  const double cells = std::clamp(triangles / kTrianglesPerCell, kMinCells, kMaxCells);
  // Neither a small mesh under a large tool nor a long strip has many more cells.
  const double size_of_all = std::sqrt(wide * high / (kAround * cells));
  double size = std::max({std::sqrt(inner / cells), size_of_all, std::max(wide, high) / kMaxCells * 8.0});
  std::size_t count = 0;
  for (;; size *= 2.0) {
    const int nx = std::max(1, static_cast<int>(std::ceil(wide / size))),
              ny = std::max(1, static_cast<int>(std::ceil(high / size)));
    levels_.push_back({size, nx, ny, count, false});
    count += static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
    if (nx == 1 && ny == 1) break;
  }
  first_.assign(count + 1, 0);
}

DropCutter::Region DropCutter::region_of(const MeshPart& part) const {
  const std::vector<Point3>& points = parts_.points();
  Region made;
  made.offset = part.offset;
  if (part.kind == MeshPart::Kind::facet) {
    const auto& t = parts_.triangles()[part.a];
    made.points = {points[t[0]], points[t[1]], points[t[2]]}, made.count = 3;
  } else {
    made.points = {points[part.a], points[part.b], {}};
    made.count = part.kind == MeshPart::Kind::edge ? 2 : 1;
  }
  for (int k = 0; k < made.count; ++k) {
    const Point2 p = made.points[static_cast<std::size_t>(k)].xy();
    made.box.add(p - part.offset.low), made.box.add(p - part.offset.high);
  }
  made.box = made.box.grown(slack_);
  return made;
}

/// The level of the smallest cells of which a region does not have too many.
std::size_t DropCutter::level_of(const Region& region) const {
  const double wide = region.box.high.x - region.box.low.x, high = region.box.high.y - region.box.low.y;
  double within = 0.0;  // what each row of cells has, beside its ends
  if (region.count < 3) within = region.offset.high.x - region.offset.low.x;
  double area = 0.0;
  if (region.count == 3)
    area = 0.5 * std::abs(cross(region.points[1].xy() - region.points[0].xy(),
                                region.points[2].xy() - region.points[0].xy()));
  std::size_t level = 0;
  for (; level + 1 < levels_.size(); ++level) {
    const double size = levels_[level].size, rows = high / size + 1.0;
    if ((wide / size + 1.0) * rows <= kSmall) break;
    const double shaped = rows * (2.0 + within / size) + 2.0 * wide / size + area / (size * size);
    if (shaped <= static_cast<double>(max_cells_)) break;
  }
  return level;
}

DropCutter::Columns DropCutter::columns_in_row(const Region& region, const Level& level, int row) const {
  const double low = box_.low.y + level.size * row - slack_ + region.offset.low.y;
  const double high = box_.low.y + level.size * (row + 1) + slack_ + region.offset.high.y;
  double x0 = INFINITY, x1 = -INFINITY;
  const auto add = [&](double x) { x0 = std::min(x0, x), x1 = std::max(x1, x); };
  for (int k = 0; k < region.count; ++k) {
    const Point3 &a = region.points[static_cast<std::size_t>(k)],
                 &b = region.points[static_cast<std::size_t>((k + 1) % region.count)];
    if (a.y >= low && a.y <= high) add(a.x);
    for (const double y : {low, high})
      if ((a.y < y) != (b.y < y)) add(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
  }
  if (x0 > x1) return {0, -1};
  const auto column = [&](double x) {
    return std::clamp(static_cast<int>((x - box_.low.x) / level.size), 0, level.nx - 1);
  };
  return {column(x0 - region.offset.high.x - slack_), column(x1 - region.offset.low.x + slack_)};
}

/// No tip with the axis in a cell is higher on a part; -infinity where it cannot touch it.
double DropCutter::bound(const MeshPart& part, const Region& region, const Box2& cell) const {
  Box2 box;
  double top = -INFINITY;
  for (int k = 0; k < region.count; ++k) {
    const Point3& p = region.points[static_cast<std::size_t>(k)];
    box.add(p.xy()), top = std::max(top, p.z);
  }
  const double away = gap(box, cell.grown(slack_));
  if (away > tool_.radius) return -INFINITY;
  double highest = top - tool_.height(away);
  if (part.kind == MeshPart::Kind::facet) {
    const Facet& facet = parts_.facets()[part.a];
    const Point2 from = 0.5 * (cell.low + cell.high) - facet.at;
    highest = std::min(highest, facet.height + facet.rise_x * from.x + facet.rise_y * from.y +
                                    (0.5 * (cell.high.x - cell.low.x) + slack_) *
                                        (std::abs(facet.rise_x) + std::abs(facet.rise_y)));
  }
  return highest + slack_;
}

void DropCutter::add(const MeshPart& part, std::uint32_t number, Batch& batch) const {
  const Region region = region_of(part);
  const Level& level = levels_[level_of(region)];
  const auto row = [&](double y) {
    return std::clamp(static_cast<int>((y - box_.low.y) / level.size), 0, level.ny - 1);
  };
  const std::uint32_t code = (static_cast<std::uint32_t>(part.kind) << kKindShift) | number;
  for (int j = row(region.box.low.y), last = row(region.box.high.y); j <= last; ++j) {
    const Columns columns = columns_in_row(region, level, j);
    for (int i = columns.first; i <= columns.last; ++i) {
      const double highest = bound(part, region, level.box(box_.low, i, j));
      if (highest == -INFINITY) continue;
      const std::size_t cell = level.start +
                               static_cast<std::size_t>(j) * static_cast<std::size_t>(level.nx) +
                               static_cast<std::size_t>(i);
      const float above = std::nextafter(static_cast<float>(highest), std::numeric_limits<float>::infinity());
      batch.found.push_back({static_cast<std::uint32_t>(cell), {above, code}});
    }
  }
}

void DropCutter::sort(std::vector<Batch>& batches, unsigned threads) {
  for (const Batch& batch : batches)
    for (const Found& found : batch.found) ++first_[found.cell + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  constexpr auto kEdge = static_cast<std::uint32_t>(MeshPart::Kind::edge);
  for (Batch& batch : batches) {
    const auto before = static_cast<std::uint32_t>(edges_.size());
    for (const Found& found : batch.found) {
      Entry entry = found.entry;
      if (entry.part >> kKindShift == kEdge) entry.part += before;
      entries_[next[found.cell]++] = entry;
    }
    edges_.insert(edges_.end(), batch.edges.begin(), batch.edges.end());
    batch = {};
  }
  const auto sort_rows = [&](std::size_t n) {
    for (std::size_t cell = n * kBatch; cell < std::min(first_.size() - 1, (n + 1) * kBatch); ++cell)
      std::sort(entries_.data() + first_[cell], entries_.data() + first_[cell + 1],
                [](const Entry& a, const Entry& b) {
                  return a.bound != b.bound ? a.bound > b.bound : a.part < b.part;
                });
  };
  parallel_for(threads, (first_.size() + kBatch - 2) / kBatch, sort_rows, [] { return false; });
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    const std::size_t end = k + 1 < levels_.size() ? levels_[k + 1].start : first_.size() - 1;
    levels_[k].is_used = first_[end] > first_[levels_[k].start];
  }
}

double DropCutter::touch_facet(std::uint32_t triangle, Point2 p, double best) const {
  const Facet& facet = parts_.facets()[triangle];
  const double height = facet.height + facet.rise_x * (p.x - facet.at.x) + facet.rise_y * (p.y - facet.at.y);
  if (height <= best) return best;
  const auto& t = parts_.triangles()[triangle];
  const std::vector<Point3>& points = parts_.points();
  const Point2 q = p + facet.contact;
  const Point2 a = points[t[0]].xy(), b = points[t[1]].xy(), c = points[t[2]].xy();
  const double turn = cross(b - a, c - a) > 0.0 ? 1.0 : -1.0;
  const std::array<Point2, 4> corners{a, b, c, a};
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point2 along = corners[k + 1] - corners[k];
    const double beyond = turn * cross(along, q - corners[k]);
    if (beyond >= 0.0) continue;
    if (beyond * beyond > slack_ * slack_ * dot(along, along)) return best;
    inside = false;
  }
  if (inside) return height;
  // At a side, where rounding decides whether it is inside.
  const Point3 axis{p.x, p.y, 0.0};
  for (std::size_t k = 0; k < 3; ++k)
    best = std::max(best, touch_line(tool_, points[t[k]] - axis, points[t[(k + 1) % 3]] - axis));
  return best;
}

double DropCutter::touch(std::uint32_t part, Point2 p, double best) const {
  const std::uint32_t number = part & kNumber;
  const Point3 axis{p.x, p.y, 0.0};
  switch (static_cast<MeshPart::Kind>(part >> kKindShift)) {
    case MeshPart::Kind::facet: return touch_facet(number, p, best);
    case MeshPart::Kind::edge: {
      const auto& [a, b] = edges_[number];
      return std::max(best, touch_line(tool_, parts_.points()[a] - axis, parts_.points()[b] - axis));
    }
    case MeshPart::Kind::vertex: {
      const Point3 at = parts_.points()[number] - axis;
      const double away = dot(at.xy(), at.xy());
      if (away > tool_.radius * tool_.radius) return best;
      return std::max(best, at.z - tool_.height(std::sqrt(away)));
    }
  }
  return best;
}

double DropCutter::at(Point2 p, double floor) const {
  double best = floor;
  if (!(p.x >= box_.low.x && p.x <= box_.high.x && p.y >= box_.low.y && p.y <= box_.high.y)) return best;
  for (const Level& level : levels_) {
    if (!level.is_used) continue;
    const int i = std::min(static_cast<int>((p.x - box_.low.x) / level.size), level.nx - 1);
    const int j = std::min(static_cast<int>((p.y - box_.low.y) / level.size), level.ny - 1);
    const std::size_t cell = level.start + static_cast<std::size_t>(j) * static_cast<std::size_t>(level.nx) +
                             static_cast<std::size_t>(i);
    for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
      if (entries_[k].bound <= best) break;
      best = touch(entries_[k].part, p, best);
    }
  }
  return best;
}

}  // namespace kerf::op_detail
