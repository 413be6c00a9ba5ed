// What the parts of the poster have in common.
#include "back/gcode/post_part.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

namespace kerf::gcode {

PostUnits::PostUnits(const PostProfile& profile, LengthUnit written)
    : unit(written),
      unit_mm(unit == LengthUnit::mm ? 1.0 : kMmPerInch),
      decimals(unit == LengthUnit::mm ? profile.decimals.mm : profile.decimals.inch),
      counts_per_feed(std::pow(10.0, profile.decimals.feed) / unit_mm) {
  grid.counts_per_mm = std::pow(10.0, decimals) / unit_mm;
}

bool PostPart::can_m(std::size_t i, int tenths, std::string_view what) {
  if (profile_.has_m(tenths)) return true;
  report_unsupported(i, fmt::format("the controller has no M{}, which {} needs", tenths / 10, what));
  return false;
}

void PostPart::report_unsupported(std::size_t i, std::string message) {
  diagnostics_.error(codes::post_cannot, path_.origin_of(i), std::move(message));
}

void PostPart::report_skipped(std::size_t i, std::string message) {
  diagnostics_.warning(codes::post_left_out, path_.origin_of(i), std::move(message) + " is skipped");
}

}  // namespace kerf::gcode
