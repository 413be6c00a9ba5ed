// Cutting edges where they meet, and winding numbers of what is between them.
#include "arrangement.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "crossing.h"
#include "exact.h"

namespace kerf::region_detail {
namespace {

constexpr std::size_t kMostHits = 20'000'000;  // about a gigabyte of work; beyond, the input is refused

}  // namespace

int ray_crosses(const Edge& e, Point2 at) {
  const bool upward = e.to.y > e.from.y;
  // The end counts with the edge above it, so that a chain through a point of this height crosses once.
  if ((e.from.y > at.y) == (e.to.y > at.y)) return 0;
  const int step = upward ? -1 : 1;
  if (at.x < std::min(e.from.x, e.to.x)) return 0;
  if (at.x > std::max(e.from.x, e.to.x)) return step;
  if (!e.is_arc()) {
    const double side = upward ? orientation(e.from, e.to, at) : orientation(e.to, e.from, at);
    return side < 0.0 ? step : 0;
  }
  const Point2 q = at - e.from;
  const bool inside = dot(q, q) < 2.0 * dot(q, e.centre);
  const bool centre_right = e.centre.x > 0.5 * (e.to.x - e.from.x);
  return inside == centre_right ? step : 0;
}

Arrangement::Outcome Arrangement::build(const EdgeSet& set, double weld, Care care) {
  set_ = &set;
  weld_ = weld;
  points_ = set.points;
  hits_.clear();
  const BoxTree tree = tree_of(set.edges, 0.5 * weld);
  if (!find_meetings(tree)) return Outcome::too_many;
  if (care == Care::thorough && !find_near_crossings(tree)) return Outcome::too_many;
  cut_edges();
  gather_ends();
  merge_twins();
  sort_ends();
  return spread_windings(tree) ? Outcome::done : Outcome::contradiction;
}

bool Arrangement::find_meetings(const BoxTree& tree) {
  return tree.pairs([&](std::uint32_t i, std::uint32_t j) {
    meet_edges(i, j);
    return hits_.size() < kMostHits;
  });
}

void Arrangement::meet_edges(std::uint32_t i, std::uint32_t j) {
  const Edge &e = set_->edges[i], &f = set_->edges[j];
  const Meeting m = meet(e, f, weld_);
  if (!m.any()) return;
  if (m.first_has_from) note(i, f.from_point);
  if (m.first_has_to) note(i, f.to_point);
  if (m.second_has_from) note(j, e.from_point);
  if (m.second_has_to) note(j, e.to_point);
  for (int k = 0; k < m.crossings; ++k) {
    const auto number = static_cast<std::uint32_t>(points_.size());
    points_.push_back(m.at[k]);
    note(i, number);
    note(j, number);
  }
}

/// Crossings lie on all edges that pass them within the tolerance: where curves touch, a third one that runs
/// along one of them meets the other elsewhere.
bool Arrangement::find_near_crossings(const BoxTree& tree) {
  for (auto number = static_cast<std::uint32_t>(set_->points.size()); number < points_.size(); ++number) {
    const Point2 p = points_[number];
    tree.query({p.x - weld_, p.y - weld_, p.x + weld_, p.y + weld_}, [&](std::uint32_t i) {
      if (touches(set_->edges[i], p, weld_)) note(i, number);
    });
    if (hits_.size() >= kMostHits) return false;
  }
  return true;
}

// --------------------------------------------------------------------------------------------- cutting,
// welding

std::uint32_t Arrangement::welded(std::uint32_t point) {
  while (same_as_[point] != point) point = same_as_[point] = same_as_[same_as_[point]];
  return point;
}

/// The smaller number stays, so that points of the input keep their places.
void Arrangement::join(std::uint32_t a, std::uint32_t b) {
  a = welded(a);
  b = welded(b);
  if (a != b) same_as_[std::max(a, b)] = std::min(a, b);
}

void Arrangement::cut_edge(std::uint32_t edge, std::vector<std::uint32_t>& on_it, std::vector<Part>& raw) {
  const Edge& e = set_->edges[edge];
  if (on_it.size() > 1)
    std::sort(on_it.begin(), on_it.end(),
              [&](std::uint32_t a, std::uint32_t b) { return along(e, points_[a]) < along(e, points_[b]); });
  on_it.push_back(e.to_point);
  std::uint32_t from = e.from_point;
  for (const std::uint32_t to : on_it) {
    const Point2 step = points_[to] - points_[from];
    if (dot(step, step) <= weld_ * weld_) join(from, to);
    Part part;
    part.from = from;
    part.to = to;
    part.edge = edge;
    part.step.of[e.group] = 1;
    raw.push_back(part);
    from = to;
  }
}

void Arrangement::cut_edges() {
  const std::size_t edges = set_->edges.size();
  same_as_.resize(points_.size());
  for (std::uint32_t i = 0; i < same_as_.size(); ++i) same_as_[i] = i;
  std::vector<std::uint32_t> begin(edges + 1, 0), sorted(hits_.size()), on_it;
  for (const Hit& hit : hits_) ++begin[hit.edge + 1];
  for (std::size_t i = 0; i < edges; ++i) begin[i + 1] += begin[i];
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const Hit& hit : hits_) sorted[next[hit.edge]++] = hit.point;
  parts_.clear();
  parts_.reserve(edges + hits_.size());
  for (std::uint32_t i = 0; i < edges; ++i) {
    on_it.assign(sorted.data() + begin[i], sorted.data() + begin[i + 1]);
    cut_edge(i, on_it, parts_);
  }
  std::size_t kept = 0;
  for (const Part& raw : parts_) {
    Part part = raw;
    part.from = welded(raw.from);
    part.to = welded(raw.to);
    if (part.from != part.to) parts_[kept++] = part;
  }
  parts_.resize(kept);
}

void Arrangement::gather_ends() {
  ends_begin_.assign(points_.size() + 1, 0);
  for (const Part& part : parts_) {
    if (!part.kept) continue;
    ++ends_begin_[part.from + 1];
    ++ends_begin_[part.to + 1];
  }
  for (std::size_t i = 0; i < points_.size(); ++i) ends_begin_[i + 1] += ends_begin_[i];
  std::vector<std::uint32_t> next(ends_begin_.begin(), ends_begin_.end() - 1);
  ends_.resize(ends_begin_.back());
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].kept) continue;
    ends_[next[parts_[i].from]++] = 2 * i;
    ends_[next[parts_[i].to]++] = 2 * i + 1;
  }
}

// -------------------------------------------------------------------------------------------------------
// twins

/// Whether two parts with the same ends run within the tolerance of each other.
bool Arrangement::twins(std::uint32_t a, std::uint32_t b) const {
  const auto bulge = [&](const Part& p, bool forward) {  // how far it strays to the right of its chord
    const Edge& e = set_->edges[p.edge];
    if (!e.is_arc()) return 0.0;
    const double half = std::min(0.5 * distance(points_[p.from], points_[p.to]), e.radius);
    const double sagitta = half * half / (e.radius + std::sqrt(e.radius * e.radius - half * half));
    return forward ? e.turn * sagitta : -e.turn * sagitta;
  };
  const Part &p = parts_[a], &q = parts_[b];
  return std::abs(bulge(p, true) - bulge(q, p.from == q.from)) <= 2.0 * weld_;
}

void Arrangement::merge_twins_at(std::uint32_t point, std::vector<std::uint32_t>& ends) {
  const auto other = [&](std::uint32_t end) { return place_of(end ^ 1); };
  ends.clear();
  for (std::uint32_t k = ends_begin_[point]; k < ends_begin_[point + 1]; ++k)
    if (other(ends_[k]) > point) ends.push_back(ends_[k]);
  if (ends.size() < 2) return;
  std::sort(ends.begin(), ends.end(), [&](std::uint32_t a, std::uint32_t b) {
    return other(a) != other(b) ? other(a) < other(b) : a < b;
  });
  for (std::size_t i = 0; i < ends.size(); ++i) {
    Part& stays = parts_[ends[i] >> 1];
    if (!stays.kept) continue;
    for (std::size_t k = i + 1; k < ends.size() && other(ends[k]) == other(ends[i]); ++k) {
      Part& goes = parts_[ends[k] >> 1];
      if (!goes.kept || !twins(ends[i] >> 1, ends[k] >> 1)) continue;
      goes.kept = false;
      const int sign = goes.from == stays.from ? 1 : -1;
      for (int g = 0; g < 2; ++g) stays.step.of[g] += sign * goes.step.of[g];
    }
    if (stays.step == Winding{}) stays.kept = false;  // there and back: nothing is divided
  }
}

void Arrangement::merge_twins() {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t point = 0; point < points_.size(); ++point) merge_twins_at(point, ends);
  // Ends of parts that are gone leave their lists.
  std::uint32_t kept = 0, begin = 0;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    const std::uint32_t end = ends_begin_[point + 1];
    for (std::uint32_t k = begin; k < end; ++k)
      if (parts_[ends_[k] >> 1].kept) ends_[kept++] = ends_[k];
    begin = end;
    ends_begin_[point + 1] = kept;
  }
  ends_.resize(kept);
}

// ------------------------------------------------------------------------------------------- order around
// points

Arrangement::Leaving Arrangement::leaving(std::uint32_t end) const {
  const Part& part = parts_[end >> 1];
  const Edge& e = set_->edges[part.edge];
  const bool forward = (end & 1) == 0;
  const Point2 v = forward ? points_[part.to] - points_[part.from] : points_[part.from] - points_[part.to];
  const double chord = norm(v);
  const double curvature = e.is_arc() ? (forward ? e.turn : -e.turn) / e.radius : 0.0;
  return {(1.0 / chord) * v, chord, curvature};
}

/// Counter-clockwise from -x. The directions at the point itself decide, and where they are nearly one, where
/// the curves are half way along the shorter: at its end they may meet again.
void Arrangement::sort_ends_at(std::uint32_t* begin, std::uint32_t* end) const {
  struct Ray {
    double angle;  // grows with the angle from -pi to pi: -2 to 2
    Leaving out;
    std::uint32_t end;
  };
  constexpr double kNearlyOne = 1e-3;
  const auto count = static_cast<std::size_t>(end - begin);
  std::vector<Ray> many;
  Ray few[8];
  if (count > 8) many.resize(count);
  Ray* rays = count > 8 ? many.data() : few;
  for (std::size_t i = 0; i < count; ++i) {
    const Leaving out = leaving(begin[i]);
    const Point2 d = direction_at(out.unit, out.chord, out.curvature, 0.0);
    const double share = d.x / (std::abs(d.x) + std::abs(d.y));
    rays[i] = {d.y < 0.0 || (d.y == 0.0 && d.x < 0.0) ? -1.0 + share : 1.0 - share, out, begin[i]};
  }
  std::sort(rays, rays + count, [](const Ray& a, const Ray& b) { return a.angle < b.angle; });
  const auto wrong = [](const Ray& a, const Ray& b) {
    const double ahead = 0.5 * std::min(a.out.chord, b.out.chord);
    const auto at = [&](const Leaving& l) { return direction_at(l.unit, l.chord, l.curvature, ahead); };
    return cross(at(a.out), at(b.out)) < 0.0;
  };
  for (std::size_t pass = 0; pass < std::min<std::size_t>(count, 64); ++pass) {
    bool moved = false;
    for (std::size_t i = 0; i < count; ++i) {
      Ray &a = rays[i], &b = rays[i + 1 < count ? i + 1 : 0];
      const double gap = i + 1 < count ? b.angle - a.angle : b.angle - a.angle + 4.0;
      if (gap > kNearlyOne || !wrong(a, b)) continue;
      std::swap(a.out, b.out);  // the angles stay: they are the same but for rounding
      std::swap(a.end, b.end);
      moved = true;
    }
    if (!moved) break;
  }
  for (std::size_t i = 0; i < count; ++i) begin[i] = rays[i].end;
}

void Arrangement::sort_ends() {
  for (std::size_t point = 0; point < points_.size(); ++point)
    if (ends_begin_[point + 1] - ends_begin_[point] > 2)
      sort_ends_at(&ends_[ends_begin_[point]], ends_.data() + ends_begin_[point + 1]);
}

// ---------------------------------------------------------------------------------------------- winding
// numbers

/// Winding numbers of one connected piece of the arrangement, first as differences to where the walk begins,
/// then as they are: its leftmost point looks out on what only other pieces wind around.
bool Arrangement::spread_from(std::uint32_t root, const WindingSearch& search) {
  walk_.assign(1, {ends_[ends_begin_[root]], {}});
  seen_[root] = true;
  std::vector<std::uint32_t> reached;
  std::uint32_t leftmost = root;
  for (std::size_t next = 0; next < walk_.size(); ++next) {
    const Step step = walk_[next];
    const std::uint32_t point = place_of(step.end);
    if (points_[point].x < points_[leftmost].x) leftmost = point;
    if (!spread_around(step, reached)) return false;
  }
  const Winding true_left = search.around(points_[leftmost], [&](std::uint32_t i) {
    return touches(set_->edges[i], points_[leftmost], 2.0 * weld_);
  });
  std::vector<std::uint32_t> ends(ends_.data() + ends_begin_[leftmost],
                                  ends_.data() + ends_begin_[leftmost + 1]);
  sort_ends_at(ends.data(), ends.data() + ends.size());
  const Winding found = left_of_end(ends.back());
  for (const std::uint32_t part : reached)
    for (int g = 0; g < 2; ++g) parts_[part].left.of[g] += true_left.of[g] - found.of[g];
  return true;
}

/// Goes once around a point, counter-clockwise from the end whose left winding number is known. False where a
/// part has another number already.
bool Arrangement::spread_around(const Step& known, std::vector<std::uint32_t>& reached) {
  const std::uint32_t point = place_of(known.end);
  const std::uint32_t begin = ends_begin_[point], count = ends_begin_[point + 1] - begin;
  std::uint32_t at = 0;
  while (ends_[begin + at] != known.end) ++at;
  Winding left = known.left;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t end = ends_[begin + (at + k) % count];
    Part& part = parts_[end >> 1];
    const bool forward = (end & 1) == 0;
    const Winding right = left;
    Winding own;
    for (int g = 0; g < 2; ++g) {
      const std::int32_t step = forward ? part.step.of[g] : -part.step.of[g];
      // The first one's left is what is known; each other's right is the left of the one before.
      if (k > 0) left.of[g] = right.of[g] + step;
      own.of[g] = forward ? left.of[g] : left.of[g] + part.step.of[g];
    }
    if (part.known) {
      if (!(part.left == own)) return false;
      continue;
    }
    part.known = true;
    part.left = own;
    reached.push_back(end >> 1);
    const std::uint32_t other = place_of(end ^ 1);
    if (seen_[other]) continue;
    seen_[other] = true;
    walk_.push_back({end ^ 1, left_of_end(end ^ 1)});
  }
  return true;
}

bool Arrangement::spread_windings(const BoxTree& tree) {
  const WindingSearch search(set_->edges, tree);
  seen_.assign(points_.size(), false);
  for (std::uint32_t point = 0; point < points_.size(); ++point)
    if (!seen_[point] && ends_begin_[point] != ends_begin_[point + 1] && !spread_from(point, search))
      return false;
  return true;
}

// ------------------------------------------------------------------------------------------------------
// outlines

std::vector<Arrangement::Loop> Arrangement::follow(const std::vector<std::int8_t>& sides) const {
  std::vector<std::uint32_t> index(2 * parts_.size());  // of an end among those of its point
  for (std::size_t point = 0; point < points_.size(); ++point)
    for (std::uint32_t k = ends_begin_[point]; k < ends_begin_[point + 1]; ++k)
      index[ends_[k]] = k - ends_begin_[point];
  // Clockwise from where a boundary arrives lies the inside, and where that ends the boundary leaves: loops
  // that touch in a point stay apart. Winding numbers that agree leave as many ways out of a point as in.
  const auto after = [&](Way way) {
    const std::uint32_t arrival = 2 * way.part + (way.forward ? 1 : 0), point = place_of(arrival);
    const std::uint32_t begin = ends_begin_[point], count = ends_begin_[point + 1] - begin;
    std::uint32_t at = index[arrival], end = arrival;
    do {
      at = at == 0 ? count - 1 : at - 1;
      end = ends_[begin + at];
    } while (sides[end >> 1] == 0);
    assert(sides[end >> 1] == ((end & 1) == 0 ? 1 : -1));
    return Way{end >> 1, (end & 1) == 0};
  };
  std::vector<Loop> loops;
  std::vector<bool> used(parts_.size(), false);
  for (std::uint32_t first = 0; first < parts_.size(); ++first) {
    if (sides[first] == 0 || used[first]) continue;
    Loop loop;
    for (Way way{first, sides[first] > 0}; !used[way.part]; way = after(way)) {
      used[way.part] = true;
      loop.push_back(way);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace kerf::region_detail
