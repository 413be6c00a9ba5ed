// From chains of edges to the region whose winding numbers a rule selects.
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>

#include "arrangement.h"

#include "kerf/geom/region.h"

namespace kerf::region_detail {

/// The tolerance for coordinates of this size: the given one, but at least what rounding needs.
double weld_for(const RegionOptions& options, double largest_coordinate);
/// The size of the largest coordinate of an outline; arcs reach at most twice their diameter further.
double largest_coordinate(const Outline& outline);

/// False, with an error appended, where a tolerance is not usable.
bool usable_options(const RegionOptions& options, Diagnostics& diagnostics);
/// Whether the last point of an outline is its first, up to the tolerance.
bool nearly_closed(const Outline& outline, double weld);
/// False, with an error appended, where an outline is unusable or (if it has to be) not closed.
bool usable_loops(const std::vector<Outline>& outlines, const RegionOptions& options,
                  Diagnostics& diagnostics);

/// An arrangement and the outline of what a rule selects.
struct Outlined {
  Arrangement arrangement;
  std::vector<Arrangement::Loop> loops;
};

/// Maximum work of an arrangement: pairs of edges whose boxes overlap.
struct Effort {
  std::size_t pairs, pairs_per_edge;
  std::size_t for_edges(std::size_t edges) const { return pairs + pairs_per_edge * edges; }
};
/// Beyond this, dividing a curve that often returns to itself is faster.
inline constexpr Effort kModerate{200'000, 60};
inline constexpr Effort kAll{std::numeric_limits<std::size_t>::max(), 0};

/// Attempts at an arrangement, until one is free of contradictions.
class Attempts {
 public:
  Attempts(const EdgeSet& set, const RegionOptions& options, Effort effort)
      : set_(set), options_(options), effort_(effort) {}
  /// The next arrangement without contradictions; null where no attempt is left, or none can help.
  Arrangement* next();
  /// Appends the error, unless the computation was stopped.
  void fail(Diagnostics& diagnostics) const;
  /// Whether the limit of work was exceeded.
  bool exceeded() const { return outcome_ == Arrangement::Outcome::exceeded; }

 private:
  const EdgeSet& set_;
  const RegionOptions& options_;
  Effort effort_;
  Arrangement arrangement_;
  std::size_t attempt_ = 0;
  Arrangement::Outcome outcome_ = Arrangement::Outcome::too_many;
};

template <class Inside>
std::optional<Outlined> attempt(Attempts& attempts, Inside inside) {
  while (Arrangement* made = attempts.next()) {
    std::vector<Arrangement::Loop> loops = made->loops(inside);
    if (made->confirms(loops)) return Outlined{std::move(*made), std::move(loops)};
  }
  return std::nullopt;
}

/// Computes the arrangement of `set`, which has to outlive it, and the outline of where inside(winding) is
/// true; nothing, with an error appended, where that cannot be done.
template <class Inside>
std::optional<Outlined> arrange(const EdgeSet& set, const RegionOptions& options, Diagnostics& diagnostics,
                                Inside inside) {
  Attempts attempts(set, options, kAll);
  auto made = attempt(attempts, inside);
  if (!made) attempts.fail(diagnostics);
  return made;
}

/// Loops as outlines: parts of one segment become one segment, and slivers are left out.
Region region_of(const Outlined& outlined, double weld);

/// A region with the source of each segment, by loop.
struct Traced {
  Region region;
  std::vector<std::vector<std::uint32_t>> sources;
};
Traced traced(const Outlined& outlined, double weld);
/// Appends the loops with their sources.
void add_traced(EdgeSet& set, const Traced& traced, std::uint32_t group);

}  // namespace kerf::region_detail
