// Checks of outlines that come from users.
#include "outline_check.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "segment.h"

namespace kerf::outline_detail {

bool check_outline(const Outline& outline, const std::string& name, const Origin& where,
                   Diagnostics& diagnostics) {
  const auto refuse = [&](Code code, std::size_t element, std::string_view what) {
    diagnostics.error(code, where, fmt::format("outline \"{}\", element {}: {}", name, element, what));
    return false;
  };
  constexpr std::string_view kNumbers = "a number is not finite or beyond 1e60";
  if (outline.segments.empty()) return refuse(codes::outline_malformed, 0, "at least one segment is needed");
  if (outline.segments.size() == 1 && outline.closed())
    return refuse(codes::outline_malformed, 1, "a closed outline needs at least two segments");
  if (outline.segments.size() > 0xfffffff0u / 4)
    return refuse(codes::outline_malformed, 0, "more than a thousand million segments");
  if (!usable(outline.start) || !(std::abs(outline.start_corner.mm()) <= kLargestCoordinate))
    return refuse(codes::outline_not_finite, 0, kNumbers);
  Point2 from = outline.start;
  std::size_t element = 0;
  for (const Segment& s : outline.segments) {
    ++element;
    if (!usable(s.to) || (s.via && !usable(*s.via)) || !(std::abs(s.corner.mm()) <= kLargestCoordinate))
      return refuse(codes::outline_not_finite, element, kNumbers);
    if (s.via && s.to == from)
      return refuse(codes::outline_arc_undetermined, element,
                    "the arc ends at its start; a full circle takes two arcs or a circle outline");
    from = s.to;
  }
  return true;
}

}  // namespace kerf::outline_detail
