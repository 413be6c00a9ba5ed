// Regions in Python: the class, and helpers of functions that return regions.
#pragma once

#include <memory>
#include <utility>

#include "bindings.h"

#include "kerf/offset.h"

namespace kerf::python {

inline constexpr double kDefaultTolerance = 1e-6;  // mm, as Tolerance::weld

/// Calls `work` without the GIL and raises its errors; returns its result.
template <class Work>
auto compute(Work work) {
  Diagnostics diagnostics;
  auto made = [&] {
    const pybind11::gil_scoped_release release;
    return work(diagnostics);
  }();
  raise_or_warn(diagnostics);
  return std::move(*made);
}

/// A region, and the search tree for its queries, which is made by the first one.
class PyRegion {
 public:
  explicit PyRegion(Region made) : region(std::move(made)) {}
  const RegionSearch& search() const {
    if (!search_) search_ = std::make_shared<RegionSearch>(region);
    return *search_;
  }
  Region region;

 private:
  mutable std::shared_ptr<RegionSearch> search_;  // made with the GIL held
};

/// A list of points (x, y) and arcs (via x, via y, x, y).
pybind11::list rows_of(const Outline& outline);
/// The options of a call; `call` is its name in messages.
RegionOptions options_of(double tolerance, const char* call);
/// Raises ValueError for an unknown name.
FillRule rule_of(const std::string& name);

}  // namespace kerf::python
