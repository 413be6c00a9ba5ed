// Building the tree: order along the Hilbert curve, then groups of groups.
#include "box_tree.h"

#include <algorithm>
#include <limits>

namespace kerf::region_detail {
namespace {

constexpr std::uint32_t kSide = 1u << 16;  // cells of the curve along one side of the whole

/// Where a cell stands along the Hilbert curve.
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t place = 0;
  for (std::uint32_t s = kSide / 2; s > 0; s /= 2) {
    const bool right = (x & s) != 0, up = (y & s) != 0;
    place += s * s * ((right ? 3u : 0u) ^ (up ? 1u : 0u));
    if (up) continue;
    if (right) {
      x = kSide - 1 - x;
      y = kSide - 1 - y;
    }
    std::swap(x, y);
  }
  return place;
}

Box around(const Box* begin, const Box* end) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box{kFar, kFar, -kFar, -kFar};
  for (; begin != end; ++begin) {
    box.low_x = std::min(box.low_x, begin->low_x);
    box.low_y = std::min(box.low_y, begin->low_y);
    box.high_x = std::max(box.high_x, begin->high_x);
    box.high_y = std::max(box.high_y, begin->high_y);
  }
  return box;
}

std::vector<Box> grouped(const std::vector<Box>& boxes, std::size_t size) {
  std::vector<Box> groups;
  groups.reserve(boxes.size() / size + 1);
  for (std::size_t i = 0; i < boxes.size(); i += size)
    groups.push_back(around(boxes.data() + i, boxes.data() + std::min(i + size, boxes.size())));
  return groups;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  if (boxes.empty()) return;
  const Box all = around(boxes.data(), boxes.data() + boxes.size());
  const double width = all.high_x - all.low_x, height = all.high_y - all.low_y;
  const auto cell = [](double at, double size) {
    const double share = size > 0.0 ? at / size : 0.0;
    return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * (kSide - 1));
  };
  std::vector<std::uint64_t> order(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& b = boxes[i];
    const std::uint32_t place = hilbert(cell(0.5 * (b.low_x + b.high_x) - all.low_x, width),
                                        cell(0.5 * (b.low_y + b.high_y) - all.low_y, height));
    order[i] = static_cast<std::uint64_t>(place) << 32 | i;
  }
  std::sort(order.begin(), order.end());
  boxes_.reserve(boxes.size());
  items_.reserve(boxes.size());
  for (const std::uint64_t key : order) {
    items_.push_back(static_cast<std::uint32_t>(key));
    boxes_.push_back(boxes[items_.back()]);
  }
  levels_.push_back(grouped(boxes_, kGroup));
  while (levels_.back().size() > 1) levels_.push_back(grouped(levels_.back(), kGroup));
}

BoxTree tree_of(const std::vector<Edge>& edges, double margin) {
  std::vector<Box> boxes;
  boxes.reserve(edges.size());
  for (const Edge& e : edges) boxes.push_back(e.box(margin));
  return BoxTree(boxes);
}

}  // namespace kerf::region_detail
