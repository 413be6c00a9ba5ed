// The adaptor to Boost.Polygon, whose results have relative errors of a few 1e-16.
#include "voronoi.h"

#include <algorithm>
#include <boost/polygon/segment_data.hpp>
#include <boost/polygon/voronoi.hpp>

#include "geom/base/box_tree.h"

namespace kerf::medial_detail {
namespace {

using boost::polygon::point_data;
using boost::polygon::segment_data;
using Diagram = boost::polygon::voronoi_diagram<double>;

Site site_of(const Diagram::cell_type& cell) {
  const auto chord = static_cast<std::uint32_t>(cell.source_index());
  switch (cell.source_category()) {
    case boost::polygon::SOURCE_CATEGORY_SEGMENT_START_POINT: return {chord, Site::Kind::start};
    case boost::polygon::SOURCE_CATEGORY_SEGMENT_END_POINT: return {chord, Site::Kind::end};
    default: return {chord, Site::Kind::chord};
  }
}

std::int64_t side_of(GridPoint a, GridPoint b, GridPoint p) {
  const auto wide = [](std::int32_t from, std::int32_t to) { return std::int64_t{to} - from; };
  return wide(a.x, b.x) * wide(a.y, p.y) - wide(a.y, b.y) * wide(a.x, p.x);
}

bool within(std::int32_t a, std::int32_t b, std::int32_t at) {
  return std::min(a, b) <= at && at <= std::max(a, b);
}

/// Whether a point is on a chord, its ends included.
bool has(const GridChord& c, GridPoint p) {
  return side_of(c.from, c.to, p) == 0 && within(c.from.x, c.to.x, p.x) && within(c.from.y, c.to.y, p.y);
}

/// Whether two chords have more in common than an end of both.
bool conflict(const GridChord& a, const GridChord& b) {
  const auto is_end = [](const GridChord& c, GridPoint p) { return p == c.from || p == c.to; };
  int common = 0;  // ends
  for (const GridPoint p : {b.from, b.to}) {
    if (is_end(a, p))
      ++common;
    else if (has(a, p))
      return true;
  }
  for (const GridPoint p : {a.from, a.to})
    if (!is_end(b, p) && has(b, p)) return true;
  if (common > 0) return common > 1;
  const auto apart = [](std::int64_t p, std::int64_t q) { return (p > 0) != (q > 0); };
  return apart(side_of(a.from, a.to, b.from), side_of(a.from, a.to, b.to)) &&
         apart(side_of(b.from, b.to, a.from), side_of(b.from, b.to, a.to));
}

}  // namespace

bool are_separate(const std::vector<GridChord>& chords) {
  std::vector<Box2> boxes;
  boxes.reserve(chords.size());
  for (const GridChord& c : chords) {
    Box2 box;
    box.add(Point2{static_cast<double>(c.from.x), static_cast<double>(c.from.y)});
    box.add(Point2{static_cast<double>(c.to.x), static_cast<double>(c.to.y)});
    boxes.push_back(box);
  }
  return BoxTree(boxes).pairs(
      [&](std::uint32_t i, std::uint32_t k) { return !conflict(chords[i], chords[k]); });
}

Voronoi voronoi(const std::vector<GridChord>& chords) {
  std::vector<segment_data<std::int32_t>> segments;
  segments.reserve(chords.size());
  for (const GridChord& c : chords)
    segments.emplace_back(point_data<std::int32_t>(c.from.x, c.from.y),
                          point_data<std::int32_t>(c.to.x, c.to.y));
  Diagram diagram;
  boost::polygon::construct_voronoi(segments.begin(), segments.end(), &diagram);
  Voronoi made;
  made.vertices.reserve(diagram.num_vertices());
  for (const auto& vertex : diagram.vertices()) {
    vertex.color(made.vertices.size());
    made.vertices.push_back({vertex.x(), vertex.y()});
  }
  for (const auto& edge : diagram.edges()) {
    // Of two halves the one that is stored first.
    if (!edge.is_primary() || !edge.is_finite() || &edge > edge.twin()) continue;
    made.edges.push_back({static_cast<std::uint32_t>(edge.vertex0()->color()),
                          static_cast<std::uint32_t>(edge.vertex1()->color()), site_of(*edge.cell()),
                          site_of(*edge.twin()->cell())});
  }
  return made;
}

}  // namespace kerf::medial_detail
