// Checks of outlines that come from users.
#include "outline_check.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "segment.h"

namespace kerf::outline_detail {

namespace {

constexpr std::string_view kNumbers = "a number is not finite or beyond 1e60";

bool refuse(Code code, std::size_t element, std::string_view what, const std::string& name,
            const Origin& where, Diagnostics& diagnostics) {
  diagnostics.error(code, where, fmt::format("outline \"{}\", element {}: {}", name, element, what));
  return false;
}

}  // namespace

bool check_requests(const CornerRequests& requests, const std::string& name, const Origin& where,
                    Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < requests.size(); ++i)
    if (!(std::abs(requests[i].mm()) <= kLargestCoordinate))
      return refuse(codes::outline_not_finite, i, kNumbers, name, where, diagnostics);
  return true;
}

bool check_outline(const Outline& outline, const std::string& name, const Origin& where,
                   Diagnostics& diagnostics) {
  const auto refused = [&](Code code, std::size_t element, std::string_view what) {
    return refuse(code, element, what, name, where, diagnostics);
  };
  if (outline.segments.empty()) return refused(codes::outline_malformed, 0, "at least one segment is needed");
  if (outline.segments.size() == 1 && outline.closed())
    return refused(codes::outline_malformed, 1, "a closed outline needs at least two segments");
  if (outline.segments.size() > 0xfffffff0u / 4)
    return refused(codes::outline_malformed, 0, "more than a thousand million segments");
  if (!usable(outline.start)) return refused(codes::outline_not_finite, 0, kNumbers);
  Point2 from = outline.start;
  std::size_t element = 0;
  for (const Segment& s : outline.segments) {
    ++element;
    if (!usable(s.to) || (s.via && !usable(*s.via)))
      return refused(codes::outline_not_finite, element, kNumbers);
    if (s.via && s.to == from)
      return refused(codes::outline_arc_undetermined, element,
                     "the arc ends at its start; a full circle takes two arcs or a circle outline");
    from = s.to;
  }
  return true;
}

}  // namespace kerf::outline_detail
