// The order of cuts. Blocks and what must precede what; the nearest block first, then blocks moved to where
// they make the rapids shorter.
//
// Whether cuts come near to each other is found on a grid of squares of half the tool's diameter: cuts in
// squares up to two apart count as near. That errs on the side of the given order.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxBlocks = 3000;      // of one run: constraints take the time of their square
constexpr std::size_t kMaxCells = 4'000'000;  // of one run
constexpr double kMinCell = 0.05;             // mm
constexpr double kChord = 0.1;                // mm, of arcs on the grid and of closed contours
constexpr int kMaxSweeps = 30;                // of improvements
constexpr std::size_t kMaxReverse = 60;       // blocks of a part that is reversed

struct Block {
  std::size_t first = 0, end = 0;  // steps
  std::vector<std::size_t> notes;  // before it
  Point2 start, finish;
  std::vector<Point2> cuts;  // points of cuts, in order
  std::vector<Point2> ring;  // the lowest closed contour, or empty
  Box2 box;
};

/// The points of the cut that step `s` makes from `from`, without its start.
void add_points(const Step& s, Point3 from, std::vector<Point2>& points) {
  if (s.kind() == StepKind::arc) {
    const ArcWalk walk = walk_of(s, from);
    const int count = std::max(walk.chords(mm(kChord), limits::kMaxChords), 1);
    for (int k = 1; k < count; ++k) points.push_back(walk.at(static_cast<double>(k) / count).xy());
  }
  points.push_back(s.to().xy());
}

bool encloses(const std::vector<Point2>& ring, Point2 p) {
  bool in = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    if ((ring[i].y > p.y) != (ring[j].y > p.y) &&
        p.x < ring[i].x + (p.y - ring[i].y) / (ring[j].y - ring[i].y) * (ring[j].x - ring[i].x))
      in = !in;
  return in;
}

/// Which blocks must come before which.
class Precedence {
 public:
  Precedence(const std::vector<Block>& blocks, double diameter)
      : blocks_(blocks), before(blocks.size()), after(blocks.size()) {
    keep_near_ones(diameter);
    inner_first();
  }

  bool keep_all = false;  // too large a run

 private:
  const std::vector<Block>& blocks_;

  void add(std::uint32_t first, std::uint32_t second) {
    if (after[first].insert(second).second) before[second].insert(first);
  }

  void keep_near_ones(double diameter) {
    const double cell = std::max(0.5 * diameter, kMinCell);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> grid;
    const auto key = [](std::int64_t x, std::int64_t y) {
      return (static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xffffffffull);
    };
    std::size_t cells = 0;
    for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
      std::set<std::pair<std::int64_t, std::int64_t>> own;
      const std::vector<Point2>& points = blocks_[b].cuts;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Point2 from = points[i == 0 ? 0 : i - 1], to = points[i];
        const double steps = std::ceil(distance(from, to) / cell) + 1.0;
        if (steps + static_cast<double>(cells) > static_cast<double>(kMaxCells)) {
          keep_all = true;
          return;
        }
        for (double k = 0.0; k <= steps; k += 1.0) {
          const Point2 p = from + (k / steps) * (to - from);
          own.emplace(static_cast<std::int64_t>(std::floor(p.x / cell)),
                      static_cast<std::int64_t>(std::floor(p.y / cell)));
        }
      }
      cells += own.size();
      for (const auto& [x, y] : own)
        for (std::int64_t dx = -2; dx <= 2; ++dx)
          for (std::int64_t dy = -2; dy <= 2; ++dy)
            if (const auto at = grid.find(key(x + dx, y + dy)); at != grid.end())
              for (const std::uint32_t other : at->second)
                if (other != b) add(other, b);
      for (const auto& [x, y] : own) grid[key(x, y)].push_back(b);
    }
  }

  bool leads_to(std::uint32_t from, std::uint32_t to) const {
    std::vector<std::uint32_t> open{from};
    std::vector<bool> seen(blocks_.size(), false);
    while (!open.empty()) {
      const std::uint32_t b = open.back();
      open.pop_back();
      if (b == to) return true;
      if (seen[b]) continue;
      seen[b] = true;
      open.insert(open.end(), after[b].begin(), after[b].end());
    }
    return false;
  }

  /// What lies inside a closed contour comes before it, unless the given order of near ones says otherwise.
  void inner_first() {
    for (std::uint32_t outer = 0; outer < blocks_.size() && !keep_all; ++outer) {
      if (blocks_[outer].ring.empty()) continue;
      for (std::uint32_t inner = 0; inner < blocks_.size(); ++inner) {
        const Block &a = blocks_[outer], &b = blocks_[inner];
        if (inner == outer || b.cuts.empty() || !a.box.contains(b.box) || b.box.contains(a.box)) continue;
        if (after[outer].contains(inner) || after[inner].contains(outer)) continue;
        if (encloses(a.ring, b.cuts.front()) && !leads_to(outer, inner)) add(inner, outer);
      }
    }
  }

 public:
  std::vector<std::set<std::uint32_t>> before, after;
};

/// An order of blocks with short ways between them.
class Tour {
 public:
  Tour(const std::vector<Block>& blocks, const Precedence& rules, Point2 start)
      : blocks_(blocks), rules_(rules), start_(start) {}

  std::vector<std::uint32_t> run() {
    nearest_first();
    bool better = true;
    for (int sweep = 0; sweep < kMaxSweeps && better; ++sweep) {
      better = move_blocks();
      better = reverse_parts() || better;
    }
    return order_;
  }
  double length(const std::vector<std::uint32_t>& order) const {
    double sum = 0.0;
    Point2 here = start_;
    for (const std::uint32_t b : order) sum += distance(here, blocks_[b].start), here = blocks_[b].finish;
    return sum;
  }

 private:
  void nearest_first() {
    std::vector<std::size_t> waits(blocks_.size());
    std::vector<std::uint32_t> ready;
    for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
      waits[b] = rules_.before[b].size();
      if (waits[b] == 0) ready.push_back(b);
    }
    Point2 here = start_;
    while (!ready.empty()) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < ready.size(); ++i) {
        const double d = distance(here, blocks_[ready[i]].start),
                     least = distance(here, blocks_[ready[best]].start);
        if (d < least || (d == least && ready[i] < ready[best])) best = i;
      }
      const std::uint32_t b = ready[best];
      ready.erase(ready.begin() + static_cast<std::ptrdiff_t>(best));
      order_.push_back(b);
      here = blocks_[b].finish;
      for (const std::uint32_t next : rules_.after[b])
        if (--waits[next] == 0) ready.push_back(next);
    }
    position_.resize(blocks_.size());
    number(0, order_.size());
  }
  void number(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) position_[order_[i]] = i;
  }

  Point2 end_before(std::size_t i) const { return i == 0 ? start_ : blocks_[order_[i - 1]].finish; }
  /// From the end of the block before position `i` to the start of `b`; 0 after the last.
  double way(Point2 from, std::size_t i) const {
    return i < order_.size() ? distance(from, blocks_[order_[i]].start) : 0.0;
  }

  /// Each block to where it makes the rapids shortest.
  bool move_blocks() {
    bool better = false;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const std::uint32_t b = order_[i];
      std::size_t low = 0, high = order_.size();  // of the gaps that it may move to
      for (const std::uint32_t p : rules_.before[b]) low = std::max(low, position_[p] + 1);
      for (const std::uint32_t n : rules_.after[b]) high = std::min(high, position_[n]);
      const Block& block = blocks_[b];
      const double gain =
          distance(end_before(i), block.start) + way(block.finish, i + 1) - way(end_before(i), i + 1);
      double best = kMinGain;
      std::size_t to = i;
      for (std::size_t gap = low; gap <= high; ++gap) {
        if (gap == i || gap == i + 1) continue;
        const Point2 from = end_before(gap);
        const double cost = distance(from, block.start) + way(block.finish, gap) - way(from, gap);
        if (gain - cost > best) best = gain - cost, to = gap;
      }
      if (to == i) continue;
      const auto begin = order_.begin();
      if (to > i)
        std::rotate(begin + static_cast<std::ptrdiff_t>(i), begin + static_cast<std::ptrdiff_t>(i) + 1,
                    begin + static_cast<std::ptrdiff_t>(to));
      else
        std::rotate(begin + static_cast<std::ptrdiff_t>(to), begin + static_cast<std::ptrdiff_t>(i),
                    begin + static_cast<std::ptrdiff_t>(i) + 1);
      number(std::min(i, to), std::max(i + 1, to));
      better = true;
    }
    return better;
  }

  /// Parts without rules between their blocks in the opposite order.
  bool reverse_parts() {
    bool better = false;
    for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
      double forwards = 0.0, backwards = 0.0;  // inside the part
      for (std::size_t j = i + 1; j < std::min(order_.size(), i + kMaxReverse); ++j) {
        const Block &last = blocks_[order_[j]], &previous = blocks_[order_[j - 1]],
                    &first = blocks_[order_[i]];
        bool free = true;
        for (const std::uint32_t p : rules_.before[order_[j]])
          free = free && (position_[p] < i || position_[p] > j);
        if (!free) break;
        forwards += distance(previous.finish, last.start), backwards += distance(last.finish, previous.start);
        const double now = distance(end_before(i), first.start) + forwards + way(last.finish, j + 1);
        const double then = distance(end_before(i), last.start) + backwards + way(first.finish, j + 1);
        if (now - then <= kMinGain) continue;
        std::reverse(order_.begin() + static_cast<std::ptrdiff_t>(i),
                     order_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        number(i, j + 1);
        better = true;
        break;
      }
    }
    return better;
  }

  static constexpr double kMinGain = 1e-6;  // mm
  const std::vector<Block>& blocks_;
  const Precedence& rules_;
  Point2 start_;
  std::vector<std::uint32_t> order_;
  std::vector<std::size_t> position_;
};

class Orderer {
 public:
  Orderer(const Toolpath& path, const std::map<int, Length>& diameters)
      : path_(path), diameters_(diameters) {}

  Ordered run() {
    std::size_t first = 0;
    while (first < path_.size()) {
      std::size_t end = first + 1;
      while (end < path_.size() && path_[end].kind() != StepKind::tool_change) ++end;
      section(first, end);
      first = end;
    }
    return std::move(made_);
  }

 private:
  /// The highest rapid of a section is the height between blocks.
  void section(std::size_t first, std::size_t end) {
    high_ = -INFINITY;
    if (path_[first].kind() == StepKind::tool_change) {
      const auto known = diameters_.find(path_[first].tool_change().tool);
      diameter_ = known == diameters_.end() ? 0.0 : known->second.mm();
    }
    for (std::size_t i = first; i < end; ++i)
      if (path_[i].kind() == StepKind::rapid && (path_[i].unknown_axes() & 4u) == 0)
        high_ = std::max(high_, path_[i].to().z);
    std::size_t i = first;
    while (i < end) {
      if (here_ && here_->z == high_ && orderable(i)) {
        i = run_of_blocks(i, end);
        continue;
      }
      copy(i++);
    }
  }

  void copy(std::size_t i) {
    const Step& s = path_[i];
    made_.path.add_copy(path_, i);
    if (s.is_motion()) here_ = s.unknown_axes() == 0 ? std::optional(s.to()) : std::nullopt;
  }
  bool orderable(std::size_t i) const {
    const Step& s = path_[i];
    if (s.kind() == StepKind::note) return true;
    return (s.kind() == StepKind::rapid || s.is_cutting()) && s.unknown_axes() == 0 &&
           path_.extra(i) == nullptr && s.reference() == Reference::work;
  }

  /// Blocks from step `first` on, at the height between blocks; the step after them.
  std::size_t run_of_blocks(std::size_t first, std::size_t end) {
    std::vector<Block> blocks;
    const Point2 start = here_->xy();
    Point3 here = *here_;
    std::size_t i = first, done = first;
    std::vector<std::size_t> notes;
    while (i < end && orderable(i)) {
      const Step& s = path_[i];
      const bool level = s.kind() == StepKind::note || (s.kind() == StepKind::rapid && s.to().z >= high_);
      if (level) {
        if (s.kind() == StepKind::rapid)
          here = s.to();
        else
          notes.push_back(i);
        ++i;
        continue;
      }
      Block block = read_block(i, end, here);
      if (block.end == 0) break;
      block.notes = std::move(notes);
      notes.clear();
      here = path_[block.end - 1].to();
      i = done = block.end;
      blocks.push_back(std::move(block));
    }
    if (blocks.empty()) {
      // Only rapids: at least one step is copied, so that the run continues.
      for (i = std::max(i, first + 1), done = first; done < i; ++done) copy(done);
      return i;
    }
    emit(blocks, start);
    return done;
  }

  /// The block whose first motion is step `first`; its end is 0 where it does not return to the height.
  Block read_block(std::size_t first, std::size_t end, Point3 here) const {
    Block block;
    block.first = first, block.start = here.xy();
    double low = INFINITY;
    for (std::size_t i = first; i < end && orderable(i); ++i) {
      const Step& s = path_[i];
      if (!s.is_motion()) continue;
      if (s.is_cutting()) {
        if (block.cuts.empty()) block.cuts.push_back(here.xy());
        add_points(s, here, block.cuts);
        low = std::min(low, s.to().z);
      }
      here = s.to();
      if (s.kind() == StepKind::rapid && here.z >= high_) {
        block.end = i + 1, block.finish = here.xy();
        break;
      }
    }
    for (const Point2 p : block.cuts) block.box.add(p);
    if (block.end != 0) block.ring = ring_of(block, low);
    return block;
  }

  /// The closed contour on the lowest level of a block.
  std::vector<Point2> ring_of(const Block& block, double low) const {
    std::vector<Point2> ring;
    Point3 here{};
    const double weld = Tolerance{}.weld.mm();
    for (std::size_t i = block.first; i < block.end; ++i) {
      const Step& s = path_[i];
      if (!s.is_motion()) continue;
      if (s.is_cutting() && here.z == low && s.to().z == low) {
        if (ring.empty()) ring.push_back(here.xy());
        add_points(s, here, ring);
        if (ring.size() > 2 && distance(ring.front(), ring.back()) <= 2.0 * weld) return ring;
      }
      here = s.to();
    }
    return {};
  }

  void emit(const std::vector<Block>& blocks, Point2 start) {
    std::vector<std::uint32_t> given(blocks.size());
    for (std::uint32_t b = 0; b < blocks.size(); ++b) given[b] = b;
    std::vector<std::uint32_t> order = given;
    made_.blocks += blocks.size();
    const Precedence rules =
        blocks.size() <= kMaxBlocks ? Precedence(blocks, diameter_) : Precedence({}, 0.0);
    if (blocks.size() <= kMaxBlocks && !rules.keep_all) {
      Tour tour(blocks, rules, start);
      std::vector<std::uint32_t> found = tour.run();
      made_.rapid_before += tour.length(given), made_.rapid_after += tour.length(found);
      order = std::move(found);
    }
    for (const std::uint32_t b : order) {
      const Block& block = blocks[b];
      for (const std::size_t i : block.notes) copy(i);
      if (here_->xy() != block.start || here_->z != high_) {
        here_ = Point3{block.start.x, block.start.y, high_};
        made_.path.add(step::Rapid{*here_}, made_.path.copy_origin(path_, block.first));
      }
      for (std::size_t i = block.first; i < block.end; ++i) copy(i);
    }
  }

  const Toolpath& path_;
  const std::map<int, Length>& diameters_;
  Ordered made_;
  double high_ = 0.0, diameter_ = 0.0;
  std::optional<Point3> here_;
};

}  // namespace

Ordered order_cuts(const Toolpath& path, const std::map<int, Length>& diameters) {
  return Orderer(path, diameters).run();
}

}  // namespace kerf
