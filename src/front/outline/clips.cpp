// The areas of clips, each once, and their intersections with outlines.
#include "front/outline/clips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::outline_front {
namespace {

struct Limits {
  Point2 low, high;
};
/// A box that contains the outline: arcs of up to half a turn are within the circle over their chord.
Limits limits_of(const Outline& outline) {
  Limits box{outline.start, outline.start};
  const auto add = [&](Point2 p, double r) {
    box.low = {std::min(box.low.x, p.x - r), std::min(box.low.y, p.y - r)};
    box.high = {std::max(box.high.x, p.x + r), std::max(box.high.y, p.y + r)};
  };
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    const Point2 from = outline.point(i), to = outline.segments[i].to;
    const auto circle = arc_circle(from, outline.segments[i]);
    add(to, 0.0);
    if (!circle) continue;
    if (std::abs(circle->sweep.rad()) < std::numbers::pi)
      add(0.5 * (from + to), 0.5 * distance(from, to));
    else
      add(circle->centre, circle->radius);
  }
  return box;
}

std::optional<Region> intersected(const Region& a, const Region& b, const RegionOptions& options,
                                  Diagnostics& diagnostics) {
  auto made = combine(a, b, Boolean::intersect, options, diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->region);
}

/// The rectangle that a region is; nothing if it is none parallel to the axes.
std::optional<Limits> rectangle_of(const Region& region) {
  if (region.loops.size() != 1 || region.loops[0].segments.size() != 4) return std::nullopt;
  const Outline& loop = region.loops[0];
  for (std::size_t i = 0; i < 4; ++i) {
    const Point2 way = loop.segments[i].to - loop.point(i);
    if (loop.segments[i].via || std::min(std::abs(way.x), std::abs(way.y)) > 1e-9) return std::nullopt;
  }
  return limits_of(loop);
}

}  // namespace

/// The area of the shapes of one clip, each cut by its own.
std::optional<Region> Clips::own_region(const dxf::Clip& clip) {
  static const dxf::Matrix kHere;
  static const dxf::Style kStyle;
  static const std::vector<const dxf::Entity*> kNone;
  std::vector<Region> parts;
  std::vector<PaintedOutline> figure;
  std::uint32_t paint = 0, chain = 0;
  const auto finish = [&]() -> bool {
    if (figure.empty()) return true;
    const std::uint32_t inner = paint == 0 ? 0 : drawing_.paints[paint].clip;
    auto made =
        inner == 0 ? painted_region(figure, Combining::drawn, options_, diagnostics_) : area(inner, figure);
    figure.clear();
    if (made) parts.push_back(std::move(*made));
    return made.has_value();
  };
  for (const dxf::Entity& entity : clip.entities) {
    if (entity.hidden) continue;
    auto shape = maker_.make({entity, kHere, kStyle, kNone});
    if (!shape) continue;
    if (entity.paint != paint && !finish()) return std::nullopt;
    const bool is_same = !figure.empty() && entity.chain != 0 && entity.chain == chain;
    paint = entity.paint, chain = entity.chain;
    if (is_same) {
      auto& segments = figure.back().outline.segments;
      segments.insert(segments.end(), shape->outline.segments.begin(), shape->outline.segments.end());
      continue;
    }
    const bool is_even_odd = paint != 0 && drawing_.paints[paint].even_odd;
    figure.push_back(
        {std::move(shape->outline), {paint + 1, is_even_odd ? FillRule::even_odd : FillRule::nonzero}});
  }
  if (!finish()) return std::nullopt;
  return parts.size() == 1 ? std::move(parts.front()) : unite(parts, options_, diagnostics_);
}

const Region* Clips::region(std::uint32_t clip) {
  const auto known = regions_.find(clip);
  if (known != regions_.end()) return known->second ? &*known->second : nullptr;
  const dxf::Clip& own = drawing_.clips[clip];
  auto made = own_region(own);
  if (made && own.outer != 0) {
    const Region* outer = region(own.outer);
    if (outer == nullptr)
      made.reset();
    else
      made = intersected(*made, *outer, options_, diagnostics_);
  }
  const auto& kept = regions_.emplace(clip, std::move(made)).first->second;
  return kept ? &*kept : nullptr;
}

bool Clips::holds(std::uint32_t clip, const Outline& outline) {
  const Region* whole = region(clip);
  const auto edge = whole == nullptr ? std::nullopt : rectangle_of(*whole);
  if (!edge) return false;
  const Limits box = limits_of(outline);
  const double slack = options_.tolerance.weld.mm();
  return box.low.x >= edge->low.x - slack && box.low.y >= edge->low.y - slack &&
         box.high.x <= edge->high.x + slack && box.high.y <= edge->high.y + slack;
}

std::optional<Region> Clips::area(std::uint32_t clip, const std::vector<PaintedOutline>& figure) {
  const Region* whole = region(clip);
  const auto shown = painted_region(figure, Combining::drawn, options_, diagnostics_);
  if (whole == nullptr || !shown) return std::nullopt;
  return intersected(*shown, *whole, options_, diagnostics_);
}

std::optional<std::vector<Outline>> Clips::pieces(std::uint32_t clip, const Outline& line) {
  const Region* whole = region(clip);
  if (whole == nullptr) return std::nullopt;
  if (whole->empty()) return std::vector<Outline>{};
  return kerf::clip(line, *whole, Location::inside, options_, diagnostics_);
}

}  // namespace kerf::outline_front
