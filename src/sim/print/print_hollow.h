// The space below material: its height by layer, and the part that is enclosed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kerf/geom/geometry.h"
#include "kerf/sim/print.h"

namespace kerf::printing {

/// The columns whose gaps are the volumes, mm2 each. They may lie anywhere in the grid: `each` calls visit(mm
/// from the centre of the grid's first column, intervals) for those with material.
struct HollowSamples {
  using Visit = std::function<void(Point2 at, std::span<const Interval> runs)>;
  double area = 0.0;
  std::function<void(const Visit& visit)> each;
};

/// Sets `hollow` and `enclosed` of every layer (lowest first), and of `total`: the gaps of the samples, of
/// which those are enclosed that are not connected with the outside by gaps of neighbouring columns of the
/// grid. `touch`: gaps up to this height are none. False if stopped.
bool measure_hollow(const ColumnGrid& grid, double touch, const HollowSamples& samples,
                    std::vector<PrintLayer>& layers, PrintVolumes& total, Progress* progress);

}  // namespace kerf::printing
