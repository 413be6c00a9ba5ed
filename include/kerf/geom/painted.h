// The region that a drawing shows: filled shapes each by their own rule, and outlines that bound areas.
//
//   const auto shown = painted_region(outlines, Combining::drawn, {}, diagnostics);
//
// Frame, units, tolerance and errors as in region.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf {

/// How an outline of a drawing is filled.
struct OutlineFill {
  std::uint32_t figure = 0;  ///< outlines of one figure are filled together; 0: not filled
  FillRule rule = FillRule::even_odd;
  bool operator==(const OutlineFill&) const = default;
};
struct PaintedOutline {
  Outline outline;
  OutlineFill fill{};
};

/// What overlapping shapes make.
enum class Combining : std::uint8_t {
  drawn,   ///< filled figures by their rules, united with each other and with what the other outlines bound,
           ///< of which those inside of others are holes
  nested,  ///< all outlines alike: those inside of others are holes
  united   ///< the area inside any of them
};

/// By its name: drawn, nested or united.
std::optional<Combining> combining_of(std::string_view name);

/// Open outlines of figures are closed, as a fill does; other open ones are left out.
std::optional<Region> painted_region(const std::vector<PaintedOutline>& outlines, Combining combining,
                                     const RegionOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
