// What the axis of a tool can reach inside or outside of a region, and which parts are too narrow for it.
#pragma once

#include <optional>
#include <vector>

#include "kerf/geom/offset.h"
#include "kerf/op/operation.h"

namespace kerf::op_detail {

struct Reach {
  double radius = 0.0;  // of the tool with the allowance, less the slack by which a slot may be too narrow
  Region axis;          // inside: where the axis may be; outside: where it may not be
  Region unreached;     // left of the region (outside: in its concave corners and holes)
  std::vector<NarrowPart> narrow;
};

enum class ReachSide : bool { inside, outside };
/// Nothing, with an error, where the region cannot be computed; also with an error where a tool does not fit
/// into an inside at all. Narrow parts of the rest are warnings.
std::optional<Reach> reach(const Region& region, const Tool& tool, ReachSide side, const CutOptions& options,
                           Diagnostics& diagnostics);

/// Without the parts that rounding leaves along boundaries.
Region without_slivers(const Region& region, Length chord);

/// The largest circle with its centre in each connected piece of `narrow` that does not cross the boundary of
/// `region`.
std::vector<NarrowPart> narrow_parts(const Region& narrow, const Region& region, double weld);

/// The part of the smallest diameter; `parts` is not empty.
const NarrowPart& narrowest(const std::vector<NarrowPart>& parts);
/// "a slot", "8 slots, the narrowest", in messages about parts that are narrow.
std::string counted(std::size_t parts, std::string_view noun);

/// Each outer loop with its holes, as a region of its own.
std::vector<Region> connected_pieces(const Region& region);

/// False, with an error, where the region is empty, open or beyond the limit for coordinates.
bool usable(const Region& region, const CutOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
