// Any bytes as outlines and operations: points on a grid (so that exact coincidences are frequent) and
// occasionally raw doubles, arcs of any bulge, and every operation of region.h and fit.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "kerf/geom/fit.h"
#include "kerf/geom/offset.h"

namespace {

using namespace kerf;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool left() const { return at_ != end_; }
  int next() { return left() ? *at_++ : 0; }
  double coordinate() {
    const int byte = next();
    if (byte != 255) return (byte - 127) * 0.25;
    double raw = 0.0;  // any bits
    const auto count = std::min<std::ptrdiff_t>(sizeof raw, end_ - at_);
    std::memcpy(&raw, at_, static_cast<std::size_t>(count));
    at_ += count;
    return raw;
  }
  Point2 point() {
    const double x = coordinate();
    return {x, coordinate()};
  }

 private:
  const std::uint8_t *at_, *end_;
};

Outline outline_from(Bytes& bytes) {
  Outline made;
  made.start = bytes.point();
  const int head = bytes.next();
  for (int i = 0; i < head % 16 + 1 && bytes.left(); ++i) {
    const int kind = bytes.next();
    Segment segment;
    if (kind % 2 == 1) segment.via = bytes.point();
    segment.to = bytes.point();
    made.segments.push_back(segment);
  }
  return head >= 64 ? closed(made) : made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 400) return 0;
  Bytes bytes(data, size);
  Diagnostics diagnostics;
  RegionOptions options;
  const int head = bytes.next();
  options.tolerance.weld = mm(std::pow(10.0, -(head % 10)));
  const double by = bytes.coordinate();
  std::vector<Outline> outlines[2];
  for (int i = 0; i < 4 && bytes.left(); ++i) outlines[i % 2].push_back(outline_from(bytes));
  const auto rule = static_cast<FillRule>(head / 10 % 3);
  const auto a = make_region(outlines[0], rule, options, diagnostics);
  const auto b = make_region(outlines[1], rule, options, diagnostics);
  if (a && b) {
    for (int what = 0; what < 4; ++what) combine(*a, *b, static_cast<Boolean>(what), options, diagnostics);
    const auto grown = offset(*a, mm(by), options, diagnostics);
    if (grown) figures(grown->region);
    RegionSearch(*a).nearest({by, 0.0});
    RegionSearch(*a).locate({by, 0.0}, mm(1e-6));
  }
  for (const Outline& outline : outlines[0]) {
    buffer(outline, mm(by), head % 2 == 0 ? PathEnds::round : PathEnds::butt, options, diagnostics);
    offset_path(outline, mm(by), options, diagnostics);
    self_intersections(outline, options, diagnostics);
    std::vector<Point2> points{outline.start};
    for (const Segment& s : outline.segments) points.push_back(s.to);
    fit_arcs(points, options.tolerance.weld, {}, diagnostics);
    points.resize(std::min<std::size_t>(points.size(), 5));
    fit_bezier(points, options.tolerance.weld, {}, diagnostics);
  }
  return 0;
}
