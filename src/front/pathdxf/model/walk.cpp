// The order of the elements of a path.
#include "front/pathdxf/model/walk.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <unordered_map>

#include "front/pathdxf/text/nearly.h"

namespace kerf::pathdxf {
namespace {

/// Ends of links in square cells, in the order of preference.
class Ends {
 public:
  explicit Ends(const std::vector<Link>& links) : links_(links) {
    for (std::size_t i = 0; i < links.size(); ++i) {
      cells_[cell(links[i].start)].insert(key(i));
      cells_[cell(links[i].end)].insert(key(i));
    }
  }
  void remove(std::size_t link) {
    for (const Point2 p : {links_[link].start, links_[link].end})
      if (const auto found = cells_.find(cell(p)); found != cells_.end()) found->second.erase(key(link));
  }
  /// The preferred link with an end at `at`.
  std::optional<std::size_t> best(Point2 at) const {
    std::optional<Key> found;
    for (const double dx : {-kJoin, kJoin})
      for (const double dy : {-kJoin, kJoin}) {
        const auto in_cell = cells_.find(cell({at.x + dx, at.y + dy}));
        if (in_cell == cells_.end()) continue;
        for (const Key& k : in_cell->second) {
          if (found && *found <= k) break;
          const Link& link = links_[std::get<3>(k)];
          if (!near(link.start, at) && !near(link.end, at)) continue;
          found = k;
          break;
        }
      }
    return found ? std::optional(std::get<3>(*found)) : std::nullopt;
  }

 private:
  using Key = std::tuple<double, int, double, std::size_t>;
  static constexpr double kCell = 1e-3;  // mm, larger than twice kJoin: a point's neighbours are in 4 cells

  Key key(std::size_t i) const {
    const Link& link = links_[i];
    return {link.order, link.rank, distance(link.start, link.end), i};
  }
  static std::uint64_t cell(Point2 p) {
    const auto x = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p.x / kCell)));
    const auto y = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p.y / kCell)));
    return x * 0x9E3779B97F4A7C15u ^ y;
  }

  const std::vector<Link>& links_;
  std::unordered_map<std::uint64_t, std::set<Key>> cells_;
};

}  // namespace

Walk walk(const std::vector<Link>& links, Point2 from) {
  Ends ends(links);
  Walk out{{}, from, {}};
  std::vector<bool> used(links.size(), false);
  while (const auto next = ends.best(out.end)) {
    const Link& link = links[*next];
    const bool reversed = !near(link.start, out.end);
    out.steps.push_back({*next, reversed});
    out.end = reversed ? link.start : link.end;
    used[*next] = true;
    ends.remove(*next);
  }
  for (std::size_t i = 0; i < links.size(); ++i)
    if (!used[i]) out.unreached.push_back(i);
  return out;
}

std::optional<OpenEnd> nearest_end(const std::vector<Link>& links, const std::vector<std::size_t>& candidates,
                                   Point2 to) {
  std::optional<OpenEnd> best;
  for (const std::size_t i : candidates)
    for (const Point2 p : {links[i].start, links[i].end}) {
      const double d = distance(p, to);
      if (!best || d < best->distance) best = OpenEnd{p, d};
    }
  return best;
}

}  // namespace kerf::pathdxf
