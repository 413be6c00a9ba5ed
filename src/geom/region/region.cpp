// Regions from outlines, and regions from regions.
#include "kerf/geom/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "geom/outline/outline_check.h"
#include "resolve.h"

namespace kerf {
namespace {

using namespace region_detail;

double largest_of(const std::vector<Outline>& outlines) {
  double largest = 0.0;
  for (const Outline& outline : outlines) largest = std::max(largest, largest_coordinate(outline));
  return largest;
}

std::uint32_t add_all(EdgeSet& set, const std::vector<Outline>& outlines, std::uint32_t source,
                      std::uint32_t group) {
  for (const Outline& outline : outlines) {
    source = add_outline(set, outline, source, group);
    set.close();
  }
  return source;
}

template <class Inside>
std::optional<Region> pick(const EdgeSet& set, const RegionOptions& options, Diagnostics& diagnostics,
                           Inside inside) {
  const auto outlined = arrange(set, options, diagnostics, inside);
  if (!outlined) return std::nullopt;
  return region_of(*outlined, set.weld());
}

Relation relation_of(const Arrangement& arrangement) {
  bool both = false, only_first = false, only_second = false;
  const auto see = [&](const Winding& w) {
    both |= w.of[0] > 0 && w.of[1] > 0;
    only_first |= w.of[0] > 0 && w.of[1] <= 0;
    only_second |= w.of[0] <= 0 && w.of[1] > 0;
  };
  for (const Part& part : arrangement.parts()) {
    if (!part.kept) continue;
    see(part.left);
    see(part.right());
  }
  if (!both) return Relation::disjoint;
  if (only_first) return only_second ? Relation::overlapping : Relation::second_inside_first;
  return only_second ? Relation::first_inside_second : Relation::equal;
}

bool inside_combined(Boolean what, bool first, bool second) {
  switch (what) {
    case Boolean::unite: return first || second;
    case Boolean::intersect: return first && second;
    case Boolean::subtract: return first && !second;
    case Boolean::exclude: break;
  }
  return first != second;
}

}  // namespace

std::optional<Region> make_region(const std::vector<Outline>& outlines, FillRule rule,
                                  const RegionOptions& options, Diagnostics& diagnostics) {
  if (!usable_loops(outlines, options, diagnostics)) return std::nullopt;
  EdgeSet set(weld_for(options, largest_of(outlines)));
  add_all(set, outlines, 0, 0);
  return pick(set, options, diagnostics, [rule](const Winding& w) {
    if (rule == FillRule::positive) return w.of[0] > 0;
    return rule == FillRule::nonzero ? w.of[0] != 0 : (w.of[0] & 1) != 0;
  });
}

std::optional<Region> make_region(const Figure& figure, const RegionOptions& options,
                                  Diagnostics& diagnostics) {
  std::vector<Outline> outlines;
  for (const auto& shape : figure) {
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      if (!(circle->radius.mm() > 0.0))
        return diagnostics.error(codes::region_bad_argument, options.where,
                                 "a circle's radius must be above 0"),
               std::nullopt;
      outlines.push_back(as_outline(*circle));
    } else {
      outlines.push_back(std::get<Outline>(shape));
    }
  }
  if (!usable_loops(outlines, options, diagnostics)) return std::nullopt;
  EdgeSet set(weld_for(options, largest_of(outlines)));
  for (std::uint32_t i = 0, source = 0; i < outlines.size(); ++i) {
    source = add_outline(set, outlines[i], source, i == 0 ? 0 : 1);
    set.close();
  }
  return pick(set, options, diagnostics, [](const Winding& w) { return w.of[0] != 0 && w.of[1] == 0; });
}

std::optional<Combined> combine(const Region& first, const Region& second, Boolean what,
                                const RegionOptions& options, Diagnostics& diagnostics) {
  if (!usable_loops(first.loops, options, diagnostics) || !usable_loops(second.loops, options, diagnostics))
    return std::nullopt;
  EdgeSet set(weld_for(options, std::max(largest_of(first.loops), largest_of(second.loops))));
  add_all(set, second.loops, add_all(set, first.loops, 0, 0), 1);
  const auto outlined = arrange(set, options, diagnostics, [what](const Winding& w) {
    return inside_combined(what, w.of[0] > 0, w.of[1] > 0);
  });
  if (!outlined) return std::nullopt;
  return Combined{region_of(*outlined, set.weld()), relation_of(outlined->arrangement)};
}

std::optional<Region> unite(const std::vector<Region>& regions, const RegionOptions& options,
                            Diagnostics& diagnostics) {
  double largest = 0.0;
  for (const Region& region : regions) {
    if (!usable_loops(region.loops, options, diagnostics)) return std::nullopt;
    largest = std::max(largest, largest_of(region.loops));
  }
  EdgeSet set(weld_for(options, largest));
  std::uint32_t source = 0;
  for (const Region& region : regions) source = add_all(set, region.loops, source, 0);
  return pick(set, options, diagnostics, [](const Winding& w) { return w.of[0] > 0; });
}

}  // namespace kerf
