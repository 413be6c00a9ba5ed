// Rings of a pocket. Each is made from the one before, at the distance of the spacing, so a point between two
// rings is less than one spacing from the outer one: with a spacing up to the radius all is covered. With a
// larger one, what is left between two rings is computed, and a ring inserted there.
#include "op/mill/pocket_rings.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/reach.h"

#include "kerf/geom/fit.h"
#include "kerf/geom/offset.h"

namespace kerf::op_detail {
namespace {

constexpr double kMaxRings = 20'000.0;
constexpr double kShort = 20.0;  // times the tolerance of chords, on average: such segments are fitted

class RingBuilder {
 public:
  RingBuilder(const CutOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}

  bool run(const Region& axis, double spacing, double radius) {
    add(axis);
    Region last = axis;
    while (!last.empty()) {
      if (stop_requested(options_.progress)) return false;
      // Not from `axis`, whose small arcs would overlap each other by a multiple of their length.
      auto next = shrunk(last, spacing);
      if (!next || !simplify(*next)) return false;
      if (spacing > radius) {
        const std::optional<bool> gaps = leaves(last, *next, radius);
        if (!gaps) return false;
        if (*gaps) {
          auto between = shrunk(last, 0.5 * spacing);
          if (!between) return false;
          add(*between);
        }
      }
      add(*next);
      last = std::move(*next);
    }
    return true;
  }
  Rings rings;

 private:
  std::optional<Region> shrunk(const Region& region, double by) {
    auto made = offset(region, mm(-by), region_options(options_), diagnostics_);
    if (!made) return std::nullopt;
    return std::move(made->region);
  }
  /// Arcs fitted to segments so short that rounding gives them corners, more from ring to ring.
  bool simplify(Region& region) {
    std::size_t segments = 0;
    for (const Outline& loop : region.loops) segments += loop.segments.size();
    const Length chord = options_.tolerance.chord;
    if (length(region).mm() >= static_cast<double>(segments) * kShort * chord.mm()) return true;
    std::vector<Outline> loops;
    for (const Outline& loop : region.loops) {
      auto fitted = fit_arcs(flattened(loop, 0.5 * chord), 0.5 * chord, {}, diagnostics_);
      if (!fitted) return false;
      loops.push_back(std::move(*fitted));
    }
    auto made = make_region(loops, FillRule::nonzero, region_options(options_), diagnostics_);
    if (made) region = std::move(*made);
    return made.has_value();
  }
  /// Whether material remains between the boundary of `outer` and that of `inner`.
  std::optional<bool> leaves(const Region& outer, const Region& inner, double radius) {
    auto beyond = shrunk(outer, radius);
    auto near = inner.empty() ? std::optional(inner) : shrunk(inner, -radius);
    if (!beyond || !near) return std::nullopt;
    if (beyond->empty()) return false;
    auto rest = combine(*beyond, *near, Boolean::subtract, region_options(options_), diagnostics_);
    if (!rest) return std::nullopt;
    return area(rest->region) > options_.tolerance.chord.mm() * length(rest->region).mm();
  }

  /// The cells of the next region, each inside one of the last.
  void add(const Region& region) {
    std::vector<std::uint32_t> present;
    std::vector<Box2> boxes;
    for (Region& piece : connected_pieces(region)) {
      const auto index = static_cast<std::uint32_t>(rings.cells.size());
      const Point2 point = piece.loops.front().start;
      const Box2 box = bounds(piece);
      present.push_back(index), boxes.push_back(box);
      if (last_.empty())
        rings.roots.push_back(index);
      else
        rings.cells[parent_of(point, box)].inner.push_back(index);
      rings.cells.push_back({std::move(piece.loops), {}});
    }
    last_ = std::move(present), last_boxes_ = std::move(boxes);
  }
  std::uint32_t parent_of(Point2 point, const Box2& box) const {
    const double weld = options_.tolerance.weld.mm();
    std::uint32_t only = last_.front();
    int candidates = 0;
    for (std::size_t i = 0; i < last_.size(); ++i)
      if (last_boxes_[i].grown(weld).contains(box)) only = last_[i], ++candidates;
    if (candidates <= 1) return only;
    for (std::size_t i = 0; i < last_.size(); ++i) {
      if (!last_boxes_[i].grown(weld).contains(box)) continue;
      const RegionSearch search(Region{rings.cells[last_[i]].loops});
      if (search.locate(point, mm(weld)) != Location::outside) return last_[i];
    }
    return only;
  }

  const CutOptions& options_;
  Diagnostics& diagnostics_;
  std::vector<std::uint32_t> last_;
  std::vector<Box2> last_boxes_;
};

}  // namespace

std::optional<Rings> pocket_rings(const Region& axis, Length spacing, double radius,
                                  const CutOptions& options, Diagnostics& diagnostics) {
  const Box2 box = bounds(axis);
  const double width = std::min(box.high.x - box.low.x, box.high.y - box.low.y);
  if (width / spacing.mm() > 2.0 * kMaxRings) {
    diagnostics.error(codes::op_limit, options.where,
                      fmt::format("{}a stepover of {:g} mm needs more than {:g} rings", prefix(options),
                                  spacing.mm(), kMaxRings));
    return std::nullopt;
  }
  RingBuilder builder(options, diagnostics);
  if (!builder.run(axis, spacing.mm(), radius)) return std::nullopt;
  return std::move(builder.rings);
}

Rings outer_rings(const Region& axis) {
  Rings rings;
  for (Region& piece : connected_pieces(axis)) {
    rings.roots.push_back(static_cast<std::uint32_t>(rings.cells.size()));
    rings.cells.push_back({std::move(piece.loops), {}});
  }
  return rings;
}

}  // namespace kerf::op_detail
