// The order of closed paths: inner ones before those around them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "op/base/track.h"

#include "kerf/geom/geometry.h"

namespace kerf::op_detail {

/// A path and its box.
struct Loop {
  Track track;
  Box2 box;
};

/// Indices in the order of short rapids, in which every path comes after those inside of its box. Of a very
/// large number of paths the smaller ones come first.
class InnerFirst {
 public:
  explicit InnerFirst(const std::vector<Loop>& loops);
  bool done() const { return ready_.empty(); }
  /// The next one; `here` is where the tool is.
  std::uint32_t take(std::optional<Point2> here);

 private:
  bool holds(std::uint32_t outer, std::uint32_t inner) const;
  const std::vector<Loop>& loops_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<std::uint32_t> waits_, ready_;
};

/// What can be cut of outlines, with their boxes; those without a length are left out.
std::vector<Loop> loops_of(const std::vector<Outline>& outlines, Length weld);

}  // namespace kerf::op_detail
