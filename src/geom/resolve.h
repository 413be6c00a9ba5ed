// From chains of edges to the region that a rule picks among their winding numbers.
#pragma once

#include <string_view>

#include "arrangement.h"

#include "kerf/region.h"

namespace kerf::region_detail {

/// The tolerance to work with for coordinates of this size: the one asked for, and at least what rounding
/// needs.
double weld_for(const RegionOptions& options, double largest_coordinate);
/// The size of the largest coordinate of an outline; arcs reach at most twice their diameter further.
double largest_coordinate(const Outline& outline);

/// False, with an error appended, where a tolerance is not usable.
bool usable_options(const RegionOptions& options, Diagnostics& diagnostics);
/// False, with an error appended, where an outline is unusable or (if it has to be) not closed.
bool usable_loops(const std::vector<Outline>& outlines, const RegionOptions& options,
                  Diagnostics& diagnostics);

/// Works the arrangement out; nothing, with an error appended, where that cannot be done.
std::optional<Arrangement> arrange(const EdgeSet& set, const RegionOptions& options,
                                   Diagnostics& diagnostics);

/// Loops as outlines: pieces of one segment are one segment again, and slivers are left out.
Region region_of(const Arrangement& arrangement, const std::vector<Arrangement::Loop>& loops, double weld);

/// Ways one after the other, as an outline.
Outline chain_of(const Arrangement& arrangement, const Arrangement::Way* begin, const Arrangement::Way* end);

}  // namespace kerf::region_detail
