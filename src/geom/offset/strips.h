// The band of a path: a strip for each of its segments, sectors at outer corners, half discs at its ends.
#pragma once

#include "geom/region/resolve.h"
#include "run.h"

namespace kerf::region_detail {

/// False, with an error appended, where a length is not finite or beyond 1e60; `what` names it.
bool usable_distance(double value, const char* what, const RegionOptions& options, Diagnostics& diagnostics);

/// What an edge of a strip follows: a run or the corner at its end, on one side of the path, or the tangent
/// of an arc before or after a mitre's tip; seams and ends follow none. The source of an edge is this and the
/// number of the run.
enum class Beside : std::uint8_t {
  none,
  right,
  left,
  right_corner,
  left_corner,
  tangent_before,
  tangent_after,
  second_seam  // where two seams meet: edges of one source become one segment
};
inline std::uint32_t source_of(const Run& run, Beside what) {
  return 8 * run.number + static_cast<std::uint32_t>(what);
}
inline std::uint32_t run_of_source(std::uint32_t source) { return source / 8; }
inline Beside beside(std::uint32_t source) { return static_cast<Beside>(source % 8); }
inline bool is_corner(std::uint32_t source) {
  return beside(source) >= Beside::right_corner && beside(source) != Beside::second_seam;
}
/// The tangents of a line's mitre continue the line beside it.
inline CornerSources corner_sources(const Run& run, const Run& next, Beside side, Beside corner) {
  return {source_of(run, corner), source_of(run, run.is_arc() ? Beside::tangent_before : side),
          next.is_arc() ? source_of(run, Beside::tangent_after) : source_of(next, side)};
}
inline bool is_beside(std::uint32_t source, bool left) {
  const Beside what = beside(source);
  return left ? what == Beside::left || what == Beside::left_corner
              : what == Beside::right || what == Beside::right_corner;
}

/// A path's segments with the sides on which its outer corners may be other than round.
struct Chain {
  std::vector<Run> runs;
  bool closed = false;
  bool round_ends = false;
  Corner right, left;
};

/// All points within `width` of a path. The sources of the boundary's segments are numbers as above.
std::optional<Traced> band_of(const Chain& chain, double width, const RegionOptions& options, double weld,
                              Diagnostics& diagnostics);
/// The union of two bands.
std::optional<Traced> unite(const Traced& first, const Traced& second, const RegionOptions& options,
                            double weld, Diagnostics& diagnostics);

}  // namespace kerf::region_detail
