// The stock of a program that does not describe one: a block around its cuts, with the most likely top.
#pragma once

#include <cstdint>
#include <optional>

#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"

namespace kerf {

/// The basis of the top of an assumed stock.
enum class AssumedTop : std::uint8_t {
  zero,    // Z0, as in most programs: the cuts are below it
  passes,  // Z0 lies on the bed, as passes are cut above it; one more pass above the highest one
  plunge,  // the same, at the start of the plunges
  cuts,    // the same, at the highest cut
};

struct AssumedStock {
  Stock stock;
  AssumedTop top = AssumedTop::zero;
};

/// A block around the cuts of a toolpath, `margin` wider on each side. Feed motions that lift the
/// tool, and those above the stock, are ignored. The top is Z0, unless nothing is cut below Z0 or a good part
/// of the cuts lies above it; then Z0 is assumed to be the bed. The bottom is `floor` below the deepest cut,
/// or the bed. Nothing if a toolpath has no cut at a known position.
std::optional<AssumedStock> assume_stock(const Toolpath& path, Length margin, Length floor);

}  // namespace kerf
