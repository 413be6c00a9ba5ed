// Building the tree: order along the Hilbert curve, then groups of groups.
#include "box_tree.h"

#include <algorithm>

namespace kerf {
namespace {

constexpr std::uint32_t kSide = 1u << 16;  // cells of the curve along one side of the whole

/// The position of a cell along the Hilbert curve.
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t position = 0;
  for (std::uint32_t s = kSide / 2; s > 0; s /= 2) {
    const bool right = (x & s) != 0, up = (y & s) != 0;
    position += s * s * ((right ? 3u : 0u) ^ (up ? 1u : 0u));
    if (up) continue;
    if (right) {
      x = kSide - 1 - x;
      y = kSide - 1 - y;
    }
    std::swap(x, y);
  }
  return position;
}

Box2 around(const Box2* first, const Box2* last) {
  Box2 box;
  for (; first != last; ++first) box.add(*first);
  return box;
}

std::vector<Box2> grouped(const std::vector<Box2>& boxes, std::size_t size) {
  std::vector<Box2> groups;
  groups.reserve(boxes.size() / size + 1);
  for (std::size_t i = 0; i < boxes.size(); i += size)
    groups.push_back(around(boxes.data() + i, boxes.data() + std::min(i + size, boxes.size())));
  return groups;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box2>& boxes) {
  if (boxes.empty()) return;
  const Box2 all = around(boxes.data(), boxes.data() + boxes.size());
  const double width = all.high.x - all.low.x, height = all.high.y - all.low.y;
  const auto cell = [](double at, double size) {
    const double fraction = size > 0.0 ? at / size : 0.0;
    return static_cast<std::uint32_t>(std::clamp(fraction, 0.0, 1.0) * (kSide - 1));
  };
  std::vector<std::uint64_t> order(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box2& b = boxes[i];
    const std::uint32_t position = hilbert(cell(0.5 * (b.low.x + b.high.x) - all.low.x, width),
                                           cell(0.5 * (b.low.y + b.high.y) - all.low.y, height));
    order[i] = static_cast<std::uint64_t>(position) << 32 | i;
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

}  // namespace kerf
