// Buffers of paths, and offset paths, which are parts of a buffer's boundary.
#include <algorithm>
#include <cmath>

#include "base/codes/outline.h"
#include "geom/outline/outline_check.h"
#include "strips.h"

namespace kerf {
namespace {

using namespace region_detail;

bool usable_path(const Outline& path, double width, const char* wanted, const RegionOptions& options,
                 Diagnostics& diagnostics) {
  if (!usable_distance(width, "distance from a path", options, diagnostics) ||
      !usable_options(options, diagnostics) ||
      !outline_detail::check_outline(path, options.name, options.where, diagnostics))
    return false;
  if (width > 0.0) return true;
  diagnostics.error(codes::region_bad_argument, options.where,
                    std::string("the distance from a path must ") + wanted);
  return false;
}

std::optional<Traced> swept_by(const Outline& path, double width, PathEnds ends, const RegionOptions& options,
                               Diagnostics& diagnostics) {
  const double weld = weld_for(options, std::max(width, largest_coordinate(path)));
  Chain chain;
  chain.runs = runs_of(path);
  chain.closed = nearly_closed(path, weld);
  chain.round_ends = ends == PathEnds::round;
  return band_of(chain, width, options, weld, diagnostics);
}

/// Appends the parts of a loop on one side of the path.
void append_stretches(std::vector<Outline>& out, const Outline& loop,
                      const std::vector<std::uint32_t>& sources, bool left) {
  const std::size_t n = sources.size();
  const auto wanted = [&](std::size_t i) { return is_beside(sources[i % n], left); };
  std::size_t first = 0;  // where one starts
  while (first < n && !(wanted(first) && !wanted(first + n - 1))) ++first;
  if (first == n && !wanted(0)) return;
  first %= n;
  for (std::size_t i = first; i < first + n; ++i) {
    if (!wanted(i)) continue;
    if (i == first || !wanted(i - 1)) out.push_back({loop.point(i % n), {}});
    out.back().segments.push_back(loop.segments[i % n]);
  }
}

}  // namespace

std::optional<Region> buffer(const Outline& path, Length half_width, PathEnds ends,
                             const RegionOptions& options, Diagnostics& diagnostics) {
  const double width = half_width.mm();
  if (!usable_path(path, width, "be above 0", options, diagnostics)) return std::nullopt;
  auto made = swept_by(path, width, ends, options, diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->region);
}

std::optional<std::vector<Outline>> offset_path(const Outline& path, Length to_left,
                                                const RegionOptions& options, Diagnostics& diagnostics) {
  const double width = std::abs(to_left.mm());
  if (!usable_path(path, width, "not be 0", options, diagnostics)) return std::nullopt;
  const auto made = swept_by(path, width, PathEnds::round, options, diagnostics);
  if (!made) return std::nullopt;
  const bool left = to_left.mm() > 0.0;
  std::vector<Outline> beside;
  for (std::size_t i = 0; i < made->sources.size(); ++i)
    append_stretches(beside, made->region.loops[i], made->sources[i], left);
  // The boundary has the path on its left: on the path's left side it has the opposite direction.
  if (left)
    for (Outline& outline : beside) outline = reversed(outline);
  return beside;
}

}  // namespace kerf
