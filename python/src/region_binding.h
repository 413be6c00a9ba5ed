// Regions in Python: the class, and what functions that make regions share.
#pragma once

#include <memory>
#include <utility>

#include "bindings.h"

#include "kerf/region.h"

namespace kerf::python {

inline constexpr double kDefaultTolerance = 1e-6;  // mm, as Tolerance::weld

/// Runs work without Python's lock, and raises what it has to say.
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

/// A region, with the tree for questions made when first asked.
class PyRegion {
 public:
  explicit PyRegion(Region made) : region(std::move(made)) {}
  const RegionSearch& search() const {
    if (!search_) search_ = std::make_shared<RegionSearch>(region);
    return *search_;
  }
  Region region;

 private:
  mutable std::shared_ptr<RegionSearch> search_;  // made with Python's lock held
};

/// A list of points (x, y) and arcs (via x, via y, x, y).
pybind11::list rows_of(const Outline& outline);
/// The options of a call, which is named in messages.
RegionOptions options_of(double tolerance, const char* call);
/// Raises ValueError for an unknown name.
FillRule rule_of(const std::string& name);

}  // namespace kerf::python
