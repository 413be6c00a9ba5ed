// Unites the shapes of a drawing.
#include <map>

#include "kerf/geom/region.h"

namespace kerf {
std::optional<Combining> combining_of(std::string_view name) {
  if (name == "drawn") return Combining::drawn;
  if (name == "nested") return Combining::nested;
  if (name == "united") return Combining::united;
  return std::nullopt;
}

std::optional<Region> painted_region(const std::vector<PaintedOutline>& outlines, Combining combining,
                                     const RegionOptions& options, Diagnostics& diagnostics) {
  struct Group {
    FillRule rule = FillRule::even_odd;
    std::vector<Outline> outlines;
  };
  std::map<std::uint32_t, Group> figures;
  std::vector<Region> parts;
  const auto add = [&](const std::vector<Outline>& loops, FillRule rule) {
    auto region = make_region(loops, rule, options, diagnostics);
    if (region) parts.push_back(std::move(*region));
    return region.has_value();
  };
  for (const PaintedOutline& o : outlines) {
    if (o.fill.figure == 0 && !o.outline.closed()) continue;
    if (o.fill.figure == 0 && combining == Combining::united) {
      if (!add({o.outline}, FillRule::nonzero)) return std::nullopt;
      continue;
    }
    Group& group = figures[combining == Combining::nested ? 0 : o.fill.figure];
    if (combining != Combining::nested) group.rule = o.fill.rule;
    group.outlines.push_back(closed(o.outline));
  }
  for (const auto& [figure, group] : figures)
    if (!add(group.outlines, group.rule)) return std::nullopt;
  if (parts.size() == 1) return std::move(parts.front());
  return unite(parts, options, diagnostics);
}

}  // namespace kerf
