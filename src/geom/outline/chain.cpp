// Chaining: ends are welded to nodes, nodes of two ends are joined, and what is left open is joined across
// small gaps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "geom/base/box_tree.h"
#include "segment.h"

#include "kerf/geom/outline.h"

namespace kerf {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// An end of a piece: twice the piece's index, and 1 more for its last point.
using End = std::uint32_t;
constexpr std::uint32_t piece_of(End end) { return end / 2; }
constexpr End other_end(End end) { return end ^ 1u; }

/// Groups of positions: which group each belongs to, and the members of each.
struct Groups {
  std::vector<std::uint32_t> parent;
  explicit Groups(std::size_t count) : parent(count) {
    for (std::size_t i = 0; i < count; ++i) parent[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  /// The smaller index stays the root.
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a != b) parent[std::max(a, b)] = std::min(a, b);
  }
};

/// Joins the groups of points that are not farther apart than `distance`. Many points within a square of that
/// size are one group without a comparison.
void join_near(const std::vector<Point2>& points, double distance, Groups& groups) {
  constexpr std::size_t kCompared = 4;
  struct Cell {
    std::int64_t x, y;
    std::uint32_t point;
    bool operator<(const Cell& o) const { return std::tie(x, y, point) < std::tie(o.x, o.y, o.point); }
  };
  std::vector<Cell> cells(points.size());
  const auto cell_of = [&](double value) {
    constexpr double kFarthest = 4e18;
    return static_cast<std::int64_t>(std::clamp(std::floor(value / distance), -kFarthest, kFarthest));
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    cells[i] = {cell_of(points[i].x), cell_of(points[i].y), static_cast<std::uint32_t>(i)};
  std::sort(cells.begin(), cells.end());
  for (std::size_t i = kCompared; i < cells.size(); ++i) {
    const Cell& first = cells[i - kCompared];
    if (first.x != cells[i].x || first.y != cells[i].y) continue;
    for (std::size_t k = i - kCompared; k < i; ++k) groups.join(cells[k].point, cells[i].point);
  }
  for (const Cell& own : cells)
    for (std::int64_t dx = 0; dx <= 1; ++dx) {
      const std::int64_t y = dx == 0 ? own.y : own.y - 1;
      auto at = std::lower_bound(cells.begin(), cells.end(), Cell{own.x + dx, y, 0});
      std::size_t compared = 0;
      std::int64_t row = y - 1;
      for (; at != cells.end() && at->x == own.x + dx && at->y <= own.y + 1; ++at) {
        compared = at->y == row ? compared + 1 : 0;
        row = at->y;
        if (compared > kCompared) {  // on to the next row
          at = std::lower_bound(at, cells.end(), Cell{own.x + dx, row + 1, 0}) - 1;
          continue;
        }
        if (kerf::distance(points[own.point], points[at->point]) <= distance)
          groups.join(own.point, at->point);
      }
    }
}

/// How far a point is from a segment.
double distance_to_segment(Point2 from, const Segment& segment, Point2 p) {
  const double to_ends = std::min(distance(p, from), distance(p, segment.to));
  if (const auto circle = arc_circle(from, segment)) {
    const Point2 arm = p - circle->centre, start = from - circle->centre;
    const double sense = circle->turn == Turn::ccw ? 1.0 : -1.0;
    double angle = sense * std::atan2(cross(start, arm), dot(start, arm));
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;
    return angle <= circle->sweep.rad() ? std::abs(length(arm) - circle->radius) : to_ends;
  }
  const Point2 way = segment.to - from;
  const double along = dot(p - from, way), square = dot(way, way);
  if (!(along > 0.0 && along < square)) return to_ends;
  return std::abs(cross(way, p - from)) / std::sqrt(square);
}

double length_of(Point2 from, const Segment& segment) {
  const auto circle = arc_circle(from, segment);
  return circle ? circle->radius * circle->sweep.rad() : distance(from, segment.to);
}

Box2 box_of(Point2 from, const Segment& segment) {
  return bounds(outline_detail::make_carrier(from, segment, 0.0));
}

class Chainer {
 public:
  Chainer(const std::vector<Outline>& pieces, const ChainOptions& options)
      : pieces_(pieces),
        weld_(options.tolerance.weld.mm()),
        join_(std::max(options.join.mm(), weld_)),
        comparisons_(options.max_comparisons) {}
  Chained run();

 private:
  enum class State : std::uint8_t { open, closed, chained, ignored };
  /// Where a piece lies along its chain.
  struct Course {
    std::uint32_t chain = kNone;
    bool reversed = false;
    double start = 0.0, length = 0.0;
  };
  struct PieceSegment {
    std::uint32_t piece, segment;
    double from, to;  // along the piece
  };
  Point2 at(End end) const {
    const Outline& piece = pieces_[piece_of(end)];
    return end % 2 == 0 ? piece.start : piece.segments.back().to;
  }
  bool is_open(End end) const { return state_[piece_of(end)] == State::open && link_[end] == kNone; }
  double size_of(const Outline& piece) const;
  void sort_pieces();
  std::vector<std::vector<End>> groups_of(const std::vector<End>& ends, double distance) const;
  void drop_repeated(const std::vector<std::vector<End>>& nodes);
  void join_nodes();
  void join_gaps();
  void add_junction(Point2 at, const std::vector<End>& ends);
  void collect(std::uint32_t piece);
  void append(ChainedOutline& chain, std::uint32_t piece, bool reversed);
  void close(ChainedOutline& chain) const;
  void report_open_ends();
  void drop_repeated_outlines();
  bool touches(End end, const BoxTree& tree);
  bool is_near_along(End end, const PieceSegment& segment) const;
  double position(std::uint32_t piece, double along) const {
    const Course& course = course_[piece];
    return course.start + (course.reversed ? course.length - along : along);
  }

  const std::vector<Outline>& pieces_;
  const double weld_, join_;
  std::vector<State> state_;    // by piece
  std::vector<End> link_;       // by end: the end that it is joined to
  std::vector<bool> junction_;  // by end
  std::vector<Course> course_;  // by piece
  std::vector<double> total_;   // length of each chain
  std::vector<PieceSegment> segments_;
  std::size_t comparisons_;  // left
  Chained made_;
};

double Chainer::size_of(const Outline& piece) const {
  const Box2 box = bounds(piece);
  return std::max(box.high.x - box.low.x, box.high.y - box.low.y);
}

void Chainer::sort_pieces() {
  state_.assign(pieces_.size(), State::open);
  link_.assign(2 * pieces_.size(), kNone);
  junction_.assign(2 * pieces_.size(), false);
  course_.assign(pieces_.size(), {});
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Outline& piece = pieces_[i];
    const double size = piece.segments.empty() ? 0.0 : size_of(piece);
    if (!(size > weld_)) {
      state_[i] = State::ignored;
      ++made_.empty_pieces;
    } else if (piece.closed() ||
               (distance(piece.start, piece.segments.back().to) <= join_ && size > 4.0 * join_)) {
      state_[i] = State::closed;
    }
  }
}

/// Ends in groups that are not farther apart than `distance`, in order of their first ends.
std::vector<std::vector<End>> Chainer::groups_of(const std::vector<End>& ends, double distance) const {
  std::vector<Point2> points;
  points.reserve(ends.size());
  for (const End end : ends) points.push_back(at(end));
  Groups groups(ends.size());
  join_near(points, distance, groups);
  std::vector<std::uint32_t> index(ends.size(), kNone);
  std::vector<std::vector<End>> made;
  for (std::uint32_t i = 0; i < ends.size(); ++i) {
    std::uint32_t& slot = index[groups.root(i)];
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(made.size());
      made.emplace_back();
    }
    made[slot].push_back(ends[i]);
  }
  return made;
}

/// Ignores single segments that have both ends and the midpoint of an earlier one.
void Chainer::drop_repeated(const std::vector<std::vector<End>>& nodes) {
  struct Key {
    std::uint32_t low, high, piece;
  };
  std::vector<std::uint32_t> node(2 * pieces_.size(), 0);
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    for (const End end : nodes[i]) node[end] = i;
  std::vector<Key> keys;
  for (std::uint32_t i = 0; i < pieces_.size(); ++i)
    if (state_[i] == State::open && pieces_[i].segments.size() == 1)
      keys.push_back({std::min(node[2 * i], node[2 * i + 1]), std::max(node[2 * i], node[2 * i + 1]), i});
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.low, a.high, a.piece) < std::tie(b.low, b.high, b.piece);
  });
  const auto lies_on = [&](std::uint32_t piece, std::uint32_t earlier) {
    const Segment &a = pieces_[piece].segments[0], &b = pieces_[earlier].segments[0];
    const Point2 a_mid = a.via ? *a.via : 0.5 * (pieces_[piece].start + a.to);
    return distance_to_segment(pieces_[earlier].start, b, a_mid) <= weld_;
  };
  constexpr std::size_t kCompared = 8;  // pieces between the same two nodes
  for (std::size_t first = 0; first < keys.size();) {
    std::size_t next = first + 1;
    for (; next < keys.size() && keys[next].low == keys[first].low && keys[next].high == keys[first].high;
         ++next)
      for (std::size_t k = first; k < std::min(next, first + kCompared); ++k) {
        if (state_[keys[k].piece] == State::ignored || !lies_on(keys[next].piece, keys[k].piece)) continue;
        state_[keys[next].piece] = State::ignored;
        made_.repeated.push_back({keys[next].piece, keys[k].piece});
        break;
      }
    first = next;
  }
}

void Chainer::add_junction(Point2 at, const std::vector<End>& ends) {
  Junction junction;
  junction.at = at;
  junction.count = ends.size();
  for (const End end : ends) {
    junction_[end] = true;
    if (junction.pieces.size() < Junction::kNamedPieces) junction.pieces.push_back(piece_of(end));
  }
  made_.junctions.push_back(std::move(junction));
}

void Chainer::join_nodes() {
  std::vector<End> ends;
  for (End end = 0; end < link_.size(); ++end)
    if (state_[piece_of(end)] == State::open) ends.push_back(end);
  auto nodes = groups_of(ends, weld_);
  drop_repeated(nodes);
  for (std::vector<End>& node : nodes) {
    node.erase(std::remove_if(node.begin(), node.end(),
                              [&](End end) { return state_[piece_of(end)] == State::ignored; }),
               node.end());
    if (node.size() == 2) {
      link_[node[0]] = node[1];
      link_[node[1]] = node[0];
    } else if (node.size() > 2) {
      add_junction(at(node[0]), node);
    }
  }
}

void Chainer::join_gaps() {
  std::vector<End> ends;
  for (End end = 0; end < link_.size(); ++end)
    if (is_open(end) && !junction_[end]) ends.push_back(end);
  for (const std::vector<End>& near : groups_of(ends, join_)) {
    if (near.size() > 2) {
      add_junction(at(near[0]), near);
    } else if (near.size() == 2 && piece_of(near[0]) != piece_of(near[1])) {
      link_[near[0]] = near[1];
      link_[near[1]] = near[0];
    }
  }
}

/// Adds a piece to a chain that ends within `join` of its start. A gap is closed in its midpoint, or by a
/// line where a neighbouring segment is so short that moving its end would change its shape.
void Chainer::append(ChainedOutline& chain, std::uint32_t piece, bool backwards) {
  const Outline& own = pieces_[piece];
  const auto index = static_cast<std::uint32_t>(made_.outlines.size());
  if (total_.size() <= index) total_.push_back(0.0);
  course_[piece] = {index, backwards, total_[index], length(own).mm()};
  total_[index] += course_[piece].length;
  chain.parts.push_back({piece, backwards});
  Outline turned = backwards ? reversed(own) : own;
  Outline& outline = chain.outline;
  if (outline.segments.empty()) {
    outline = std::move(turned);
    return;
  }
  const Point2 end = outline.segments.back().to;
  const double gap = distance(end, turned.start);
  if (gap > weld_) {
    const Point2 before = outline.point(outline.segments.size() - 1);
    const double shortest =
        std::min(distance(before, end), distance(turned.start, turned.segments.front().to));
    if (shortest < 4.0 * gap)
      outline.segments.push_back({turned.start, {}});
    else
      outline.segments.back().to = 0.5 * (end + turned.start);
  }
  outline.segments.insert(outline.segments.end(), turned.segments.begin(), turned.segments.end());
}

/// Closes a chain whose ends are within `join`, as append() does.
void Chainer::close(ChainedOutline& chain) const {
  Outline& outline = chain.outline;
  const Point2 end = outline.segments.back().to;
  const double gap = distance(end, outline.start);
  const Point2 before = outline.point(outline.segments.size() - 1);
  const double shortest =
      std::min(distance(before, end), distance(outline.start, outline.segments.front().to));
  if (gap > weld_ && shortest < 4.0 * gap) outline.segments.push_back({outline.start, {}});
  if (gap > weld_ && shortest >= 4.0 * gap) outline.start = 0.5 * (end + outline.start);
  outline.segments.back().to = outline.start;
}

/// Makes the outline that a piece belongs to.
void Chainer::collect(std::uint32_t piece) {
  ChainedOutline chain;
  if (state_[piece] == State::closed) {
    append(chain, piece, false);
    if (!chain.outline.closed()) close(chain);
    made_.outlines.push_back(std::move(chain));
    return;
  }
  End start = 2 * piece;
  bool ring = false;
  while (link_[start] != kNone && !ring) {
    start = other_end(link_[start]);
    ring = piece_of(start) == piece;
  }
  if (ring) start = 2 * piece;
  for (End at = start;;) {
    state_[piece_of(at)] = State::chained;
    append(chain, piece_of(at), at % 2 == 1);
    const End next = link_[other_end(at)];
    if (next == kNone || next == start) break;
    at = next;
  }
  if (ring) close(chain);
  made_.outlines.push_back(std::move(chain));
}

/// Whether a segment belongs to the same chain as an end and comes soon after it.
bool Chainer::is_near_along(End end, const PieceSegment& s) const {
  const Course& own = course_[piece_of(end)];
  if (own.chain == kNone || own.chain != course_[s.piece].chain) return false;
  const double at = position(piece_of(end), end % 2 == 0 ? 0.0 : own.length);
  const double nearest =
      std::min(std::abs(position(s.piece, s.from) - at), std::abs(position(s.piece, s.to) - at));
  return nearest <= 4.0 * join_;
}

/// Whether an open end lies on another piece; it then is reported as a junction.
bool Chainer::touches(End end, const BoxTree& tree) {
  if (comparisons_ == 0) return false;
  const Point2 p = at(end);
  std::uint32_t touched = kNone;
  tree.query(Box2{p, p}.grown(join_), [&](std::uint32_t item) {
    const PieceSegment& s = segments_[item];
    if (touched != kNone || comparisons_ == 0 || is_near_along(end, s)) return;
    --comparisons_;
    const Outline& other = pieces_[s.piece];
    if (distance_to_segment(other.point(s.segment), other.segments[s.segment], p) <= join_) touched = s.piece;
  });
  if (touched == kNone) return false;
  junction_[end] = true;
  made_.junctions.push_back({p, {piece_of(end), touched}, 2});
  return true;
}

void Chainer::report_open_ends() {
  std::vector<End> ends;
  for (End end = 0; end < link_.size(); ++end)
    if (state_[piece_of(end)] == State::chained && link_[end] == kNone && !junction_[end])
      ends.push_back(end);
  if (ends.empty()) return;
  std::vector<Box2> boxes;
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
    if (state_[i] == State::ignored) continue;
    double along = 0.0;
    for (std::uint32_t k = 0; k < pieces_[i].segments.size(); ++k) {
      boxes.push_back(box_of(pieces_[i].point(k), pieces_[i].segments[k]));
      const double next = along + length_of(pieces_[i].point(k), pieces_[i].segments[k]);
      segments_.push_back({i, k, along, next});
      along = next;
    }
  }
  const BoxTree tree(boxes);
  ends.erase(std::remove_if(ends.begin(), ends.end(), [&](End end) { return touches(end, tree); }),
             ends.end());
  boxes.clear();
  for (const End end : ends) boxes.push_back({at(end), at(end)});
  const BoxTree points(boxes);
  for (std::uint32_t i = 0; i < ends.size(); ++i) {
    OpenEnd open;
    open.at = at(ends[i]);
    open.piece = piece_of(ends[i]);
    std::uint32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    points.nearest({open.at, open.at}, least, [&](std::uint32_t other) {
      const double d =
          other == i ? std::numeric_limits<double>::infinity() : distance(open.at, at(ends[other]));
      if (d < least) least = d, best = other;
      return d;
    });
    if (best != kNone) {
      open.nearest = at(ends[best]);
      open.nearest_piece = piece_of(ends[best]);
      open.distance = mm(least);
    }
    made_.open_ends.push_back(open);
  }
}

/// Of closed outlines with the same bounds, length and area only the first one stays.
void Chainer::drop_repeated_outlines() {
  struct Key {
    double length, area;
    Box2 box;
    std::uint32_t index;
  };
  std::vector<Key> keys;
  for (std::uint32_t i = 0; i < made_.outlines.size(); ++i) {
    const Outline& outline = made_.outlines[i].outline;
    if (outline.closed()) keys.push_back({length(outline).mm(), std::abs(area(outline)), bounds(outline), i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.length, a.index) < std::tie(b.length, b.index);
  });
  const auto same = [&](const Key& a, const Key& b) {
    const auto near = [&](double p, double q) { return std::abs(p - q) <= weld_; };
    return near(a.box.low.x, b.box.low.x) && near(a.box.low.y, b.box.low.y) &&
           near(a.box.high.x, b.box.high.x) && near(a.box.high.y, b.box.high.y) &&
           std::abs(a.area - b.area) <= weld_ * a.length;
  };
  constexpr std::size_t kCompared = 8;
  std::vector<bool> dropped(made_.outlines.size());
  for (std::size_t i = 1; i < keys.size(); ++i)
    for (std::size_t k = i; k-- > i - std::min(i, kCompared);) {
      if (keys[i].length - keys[k].length > weld_) break;
      if (dropped[keys[k].index] || !same(keys[i], keys[k])) continue;
      const auto [earlier, later] = std::minmax(keys[i].index, keys[k].index);
      dropped[later] = true;
      made_.repeated.push_back(
          {made_.outlines[later].parts[0].piece, made_.outlines[earlier].parts[0].piece});
      break;
    }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i)
    if (!dropped[i] && kept++ != i) made_.outlines[kept - 1] = std::move(made_.outlines[i]);
  made_.outlines.resize(kept);
}

Chained Chainer::run() {
  sort_pieces();
  join_nodes();
  join_gaps();
  for (std::uint32_t i = 0; i < pieces_.size(); ++i)
    if (state_[i] == State::open || state_[i] == State::closed) collect(i);
  report_open_ends();
  drop_repeated_outlines();
  return std::move(made_);
}

}  // namespace

Chained chain(const std::vector<Outline>& pieces, const ChainOptions& options) {
  return Chainer(pieces, options).run();
}

}  // namespace kerf
