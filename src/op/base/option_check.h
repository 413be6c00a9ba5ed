// Checks of the options of operations.
#pragma once

#include <fmt/format.h>
#include <string_view>

#include "base/codes/op.h"
#include "op/base/cutter.h"

namespace kerf::op_detail {

/// Appends an error for each option that is out of range.
class OptionCheck {
 public:
  OptionCheck(const CutOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}
  /// An error unless `holds`; comparisons with NaN do not hold.
  void expect(bool holds, std::string_view what, double value, std::string_view rule) {
    if (holds) return;
    valid_ = false;
    diagnostics_.error(codes::op_option, options_.where,
                       fmt::format("{}{} is {:g}; it must be {}", prefix(options_), what, value, rule));
  }
  bool valid() const { return valid_; }

 private:
  const CutOptions& options_;
  Diagnostics& diagnostics_;
  bool valid_ = true;
};

}  // namespace kerf::op_detail
