// Contours of characters as loops of lines and arcs.
#include <algorithm>

#include "kerf/geom/region.h"
#include "kerf/geom/text.h"

namespace kerf {
namespace {

/// One contour, closed; without segments if it has no length.
std::optional<Outline> contour_outline(const GlyphContour& contour, Length within, const FitOptions& fit,
                                       Diagnostics& diagnostics) {
  Outline outline{contour.start, {}};
  const auto here = [&] { return outline.point(outline.segments.size()); };
  const auto line = [&](Point2 to) {
    if (distance(here(), to) > 0.0) outline.segments.push_back({to, {}});
  };
  for (const std::vector<Point2>& curve : contour.curves) {
    std::vector<Point2> control{here()};
    control.insert(control.end(), curve.begin(), curve.end());
    const Point2 to = control.back();
    if (std::all_of(control.begin(), control.end(), [&](Point2 p) { return p == to; })) continue;
    if (curve.size() == 1) {
      line(to);
      continue;
    }
    const auto arcs = fit_bezier(control, within, fit, diagnostics);
    if (!arcs) return std::nullopt;
    outline.segments.insert(outline.segments.end(), arcs->segments.begin(), arcs->segments.end());
  }
  line(outline.start);
  if (!outline.closed() || outline.segments.size() < 2) outline.segments.clear();
  return outline;
}

}  // namespace

std::optional<std::vector<Outline>> glyph_loops(const std::vector<GlyphContour>& contours, Length within,
                                                const FitOptions& fit, Diagnostics& diagnostics) {
  std::vector<Outline> outlines;
  for (const GlyphContour& contour : contours) {
    auto outline = contour_outline(contour, within, fit, diagnostics);
    if (!outline) return std::nullopt;
    if (!outline->segments.empty()) outlines.push_back(std::move(*outline));
  }
  if (outlines.empty()) return outlines;
  RegionOptions options;
  options.name = fit.name, options.where = fit.where;
  auto region = make_region(outlines, FillRule::nonzero, options, diagnostics);
  if (!region) return std::nullopt;
  return std::move(region->loops);
}

}  // namespace kerf
