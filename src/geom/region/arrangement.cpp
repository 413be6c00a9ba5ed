// Splits edges at their contacts and joins points within the tolerance, repeatedly until no point is
// displaced.
#include "arrangement.h"

#include <algorithm>
#include <cmath>

#include "crossing.h"
#include "point_grid.h"

#include "kerf/base/limits.h"

namespace kerf::region_detail {
namespace {

constexpr int kMaxRounds = 14;
/// Maximum displacement without another round. In the first round, edges without a contact may be nearer to
/// each other than the tolerance, in the others not.
constexpr double kFirstSlack = 1.0 / 256.0, kSlack = 0.125;  // of the tolerance

/// Most inputs take few rounds; where displaced parts continue to touch others, the tolerance decreases.
double weld_of_round(double weld, int round) { return round < 5 ? weld : weld / (round < 9 ? 4.0 : 16.0); }

}  // namespace

Arrangement::Outcome Arrangement::build(const EdgeSet& set, double weld, Care care, std::size_t max_pairs,
                                        Progress* progress) {
  set_ = &set;
  points_ = set.points;
  contracted_.clear();
  for (rounds_ = 0; rounds_ < kMaxRounds; ++rounds_) {
    weld_ = weld_of_round(weld, rounds_);
    const double slack = (rounds_ == 0 ? kFirstSlack : kSlack) * weld_;
    displaced_ = 0.0;
    tree_ = tree_of(edges(), 0.5 * weld_);
    if (const Outcome found = find_contacts(max_pairs, progress); found != Outcome::done) return found;
    split_edges(slack);
    gather_ends();
    merge_duplicates();
    has_displaced_parts_ = displaced_ > slack;
    const bool settled = !has_displaced_parts_ || displaced_parts_are_clear(slack);
    if (settled && (care == Care::ordinary || rounds_ > 0)) {
      sort_ends();
      return spread_windings() && locate_components() ? Outcome::done : Outcome::contradiction;
    }
    contract();
  }
  --rounds_;
  return Outcome::contradiction;
}

double Arrangement::slack() const { return kSlack * weld_; }

// ---------------------------------------------------------------------------------------------- contacts

Arrangement::Outcome Arrangement::find_contacts(std::size_t max_pairs, Progress* progress) {
  constexpr std::size_t kBetweenReports = 1u << 16;
  hits_.clear();
  std::size_t examined = 0;
  bool stopped = false;
  const Edge* all = edges().data();
  const auto first_crossing = static_cast<std::uint32_t>(points_.size());
  touched_.assign(edges().size(), false);
  tree_.pairs([&](std::uint32_t i, std::uint32_t j) {
    find_contacts_of(all[i], i, all[j], j);
    stopped = ++examined % kBetweenReports == 0 && stop_requested(progress);
    return !stopped && examined <= max_pairs && hits_.size() < limits::kMaxRegionIntersections;
  });
  if (stopped) return Outcome::stopped;
  if (examined <= max_pairs) find_near_crossings(first_crossing);
  if (hits_.size() >= limits::kMaxRegionIntersections) return Outcome::too_many;
  return examined > max_pairs ? Outcome::exceeded : Outcome::done;
}

/// A third edge that is tangent to two edges along one another may, by rounding, intersect one of them only.
/// An intersection is therefore a point of all edges within the tolerance of it.
void Arrangement::find_near_crossings(std::uint32_t first_crossing) {
  const std::size_t count = hits_.size();
  for (std::size_t k = 0; k + 1 < count && hits_.size() < limits::kMaxRegionIntersections; ++k) {
    const Hit one = hits_[k], other = hits_[k + 1];  // a crossing hits both of its edges at once
    if (one.point < first_crossing || other.point != one.point) continue;
    if (!touched_[one.edge] && !touched_[other.edge]) continue;
    const Point2 p = points_[one.point];
    tree_.query(Box2{p, p}.grown(weld_), [&](std::uint32_t i) {
      if (i == one.edge || i == other.edge) return;
      const double off = touches(edges()[i], p, weld_);
      if (off < 0.0) return;
      displaced_ = std::max(displaced_, off);
      hit(i, one.point);
    });
  }
}

void Arrangement::find_contacts_of(const Edge& e, std::uint32_t i, const Edge& f, std::uint32_t j) {
  const Contacts m = contacts_of(e, f, weld_);
  if (!m.any()) return;
  displaced_ = std::max(displaced_, m.off);
  if (m.first_has_from || m.first_has_to || m.second_has_from || m.second_has_to)
    touched_[i] = touched_[j] = true;
  if (m.first_has_from) hit(i, f.from_point);
  if (m.first_has_to) hit(i, f.to_point);
  if (m.second_has_from) hit(j, e.from_point);
  if (m.second_has_to) hit(j, e.to_point);
  for (int k = 0; k < m.crossings; ++k) {
    const auto number = static_cast<std::uint32_t>(points_.size());
    points_.push_back(m.at[k]);
    hit(i, number);
    hit(j, number);
  }
}

// ------------------------------------------------------------------------------------- splitting, welding

std::uint32_t Arrangement::welded(std::uint32_t point) {
  while (same_as_[point] != point) point = same_as_[point] = same_as_[same_as_[point]];
  return point;
}

/// The smaller number remains, so that points of the input keep their positions.
void Arrangement::join(std::uint32_t a, std::uint32_t b) {
  a = welded(a);
  b = welded(b);
  if (a != b) same_as_[std::max(a, b)] = std::min(a, b);
}

/// The points of each edge, in order along it.
void Arrangement::sort_hits() {
  const std::size_t count = edges().size();
  edge_hits_.assign(count + 1, 0);
  for (const Hit& h : hits_) ++edge_hits_[h.edge + 1];
  for (std::size_t i = 0; i < count; ++i) edge_hits_[i + 1] += edge_hits_[i];
  hits_of_edge_.resize(hits_.size());
  std::vector<std::uint32_t> next(edge_hits_.begin(), edge_hits_.end() - 1);
  for (const Hit& h : hits_) hits_of_edge_[next[h.edge]++] = h.point;
  for (std::size_t i = 0; i < count; ++i) {
    if (edge_hits_[i + 1] - edge_hits_[i] < 2) continue;
    const Edge& e = edges()[i];
    std::sort(hits_of_edge_.data() + edge_hits_[i], hits_of_edge_.data() + edge_hits_[i + 1],
              [&](std::uint32_t a, std::uint32_t b) { return along(e, points_[a]) < along(e, points_[b]); });
  }
}

/// Successive points of an edge within the tolerance become one. Where that displaces points by more than
/// rounding does, only those within the tolerance of a point that remains, so that chains of points do not
/// collapse.
void Arrangement::split_edges(double slack) {
  sort_hits();
  same_as_.resize(points_.size());
  for (std::uint32_t i = 0; i < same_as_.size(); ++i) same_as_[i] = i;
  const std::vector<Edge>& all = edges();
  const auto for_each_piece = [&](auto visit) {
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      std::uint32_t from = all[i].from_point;
      for (std::uint32_t k = edge_hits_[i]; k < edge_hits_[i + 1]; ++k) {
        visit(i, from, hits_of_edge_[k]);
        from = hits_of_edge_[k];
      }
      visit(i, from, all[i].to_point);
    }
  };
  for_each_piece([&](std::uint32_t, std::uint32_t from, std::uint32_t to) {
    const Point2 step = points_[to] - points_[from];
    const double square = dot(step, step);
    if (square > weld_ * weld_) return;
    if (square > displaced_ * displaced_) displaced_ = std::sqrt(square);
    join(from, to);
  });
  if (displaced_ > slack) cluster_joined();
  parts_.clear();
  parts_.reserve(all.size() + hits_.size());
  for_each_piece([&](std::uint32_t edge, std::uint32_t from, std::uint32_t to) {
    Part part;
    part.from = welded(from);
    part.to = welded(to);
    if (part.from == part.to) return;
    part.edge = edge;
    part.step = all[edge].step;
    parts_.push_back(part);
  });
}

/// Of the joined points, those remain that are not within the tolerance of one that remains.
void Arrangement::cluster_joined() {
  std::vector<bool> joined(points_.size(), false);
  std::size_t count = 0;
  for (std::uint32_t point = 0; point < points_.size(); ++point)
    if (const std::uint32_t other = welded(point); other != point) {
      count += joined[other] ? 1 : 2;
      joined[other] = joined[point] = true;
    }
  PointGrid stay(points_, weld_, count);
  for (std::uint32_t point = 0; point < points_.size(); ++point) {
    if (!joined[point]) continue;
    same_as_[point] = point;
    if (const std::uint32_t near = stay.nearest(points_[point]); near != PointGrid::kNone)
      same_as_[point] = near;
    else
      stay.add(point);
  }
}

/// Whether parts whose ends are not on their edges have no contact with others but common ends: then another
/// round would change nothing.
bool Arrangement::displaced_parts_are_clear(double slack) const {
  for (const Part& part : parts_) {
    if (!part.kept) continue;
    const Edge& e = edges()[part.edge];
    const auto off = [&](std::uint32_t end) {
      if (end == e.from_point || end == e.to_point) return false;
      const double distance = touches(e, points_[end], 4.0 * weld_);
      return distance < 0.0 || distance > slack;
    };
    if ((off(part.from) || off(part.to)) && !is_clear(part)) return false;
  }
  return true;
}

bool Arrangement::is_clear(const Part& part) const {
  Edge own = drawn(part, Axis::x);
  own.from_point = part.from;
  own.to_point = part.to;
  bool clear = true;
  tree_.query(own.box(weld_ + reach()), [&](std::uint32_t edge) {
    if (!clear) return;
    parts_of_edge(edge, [&](std::uint32_t i) {
      const Part& other = parts_[i];
      if (!clear || &other == &part) return;
      Edge e = drawn(other, Axis::x);
      e.from_point = other.from;
      e.to_point = other.to;
      clear = !e.box(weld_).overlaps(own.box(weld_)) || !contacts_of(own, e, weld_).any();
    });
  });
  return clear;
}

void Arrangement::gather_ends() {
  point_ends_.assign(points_.size() + 1, 0);
  for (const Part& part : parts_) {
    ++point_ends_[part.from + 1];
    ++point_ends_[part.to + 1];
  }
  for (std::size_t i = 0; i < points_.size(); ++i) point_ends_[i + 1] += point_ends_[i];
  std::vector<std::uint32_t> next(point_ends_.begin(), point_ends_.end() - 1);
  ends_.resize(point_ends_.back());
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    ends_[next[parts_[i].from]++] = 2 * i;
    ends_[next[parts_[i].to]++] = 2 * i + 1;
  }
}

// --------------------------------------------------------------------------------------------- duplicates

/// The height of a part over its chord, to the right; in its direction or against it.
double Arrangement::bulge(const Part& p, bool forward) const {
  const Edge& e = edges()[p.edge];
  if (!e.is_arc()) return 0.0;
  const double half = std::min(0.5 * norm(points_[p.to] - points_[p.from]), e.radius);
  const double sagitta = half * half / (e.radius + std::sqrt(e.radius * e.radius - half * half));
  return forward ? e.turn * sagitta : -e.turn * sagitta;
}

/// Parts with the same ends and within twice the tolerance of each other become one.
void Arrangement::merge_duplicates_at(std::uint32_t point, std::vector<std::uint32_t>& ends) {
  const auto other = [&](std::uint32_t end) { return point_of(end ^ 1); };
  ends.clear();
  for (std::uint32_t k = point_ends_[point]; k < point_ends_[point + 1]; ++k)
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
      if (!goes.kept) continue;
      const double apart = std::abs(bulge(stays, true) - bulge(goes, stays.from == goes.from));
      if (apart > 2.0 * weld_) continue;
      displaced_ = std::max(displaced_, apart);
      goes.kept = false;
      const int sign = goes.from == stays.from ? 1 : -1;
      for (int g = 0; g < 2; ++g) stays.step.of[g] += sign * goes.step.of[g];
    }
    if (stays.step == Winding{}) stays.kept = false;  // in both directions: it separates nothing
  }
}

void Arrangement::merge_duplicates() {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t point = 0; point < points_.size(); ++point)
    if (point_ends_[point + 1] - point_ends_[point] > 1) merge_duplicates_at(point, ends);
  // Remove the ends of parts that are not kept.
  std::uint32_t kept = 0, first = 0;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    const std::uint32_t last = point_ends_[point + 1];
    for (std::uint32_t k = first; k < last; ++k)
      if (parts_[ends_[k] >> 1].kept) ends_[kept++] = ends_[k];
    first = last;
    point_ends_[point + 1] = kept;
  }
  ends_.resize(kept);
}

/// The parts become the edges of the next round.
void Arrangement::contract() {
  std::vector<Edge> next;
  next.reserve(parts_.size());
  for (const Part& part : parts_) {
    if (!part.kept) continue;
    Edge e = edges()[part.edge];
    set_shape(e, points_[part.from], points_[part.to], e.radius, e.turn, weld_);
    e.from_point = part.from;
    e.to_point = part.to;
    e.step = part.step;
    next.push_back(e);
  }
  contracted_ = std::move(next);
}

}  // namespace kerf::region_detail
