// The stock of a program that does not tell one: a block around its cuts, with its top where the cuts say it
// most likely is.
#pragma once

#include <cstdint>
#include <optional>

#include "kerf/stock.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

/// What told the top of an assumed stock.
enum class AssumedTop : std::uint8_t {
  zero,    // Z0, as with most programs: what is cut lies below it
  passes,  // Z0 lies on the bed, as passes are cut above it; one more pass above the highest one
  plunge,  // the same, where the plunges begin
  cuts,    // the same, at the highest cut
};

struct AssumedStock {
  Stock stock;
  AssumedTop top = AssumedTop::zero;
};

/// A block around the cuts of a toolpath, `margin` wider on each side. Feed moves that lift the tool, and
/// those above the stock, count for nothing. The top is Z0, unless nothing is cut below Z0 or a good part of
/// the cuts lies above it; then Z0 is taken for the bed. The bottom is `floor` below the deepest cut, or the
/// bed. Nothing where a toolpath has no cut whose place is known.
std::optional<AssumedStock> assume_stock(const Toolpath& path, Length margin, Length floor);

}  // namespace kerf
