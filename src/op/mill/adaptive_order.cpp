// A run depends on the runs of earlier passes whose boxes come near to its own: what these clear is what the
// engagement of the run is computed from. Of the runs that can be cut, the nearest is next.
#include "op/mill/adaptive_order.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace kerf::op_detail {
namespace {

/// More runs are cut pass by pass: the dependencies of n runs are up to n^2 / 2 numbers.
constexpr std::size_t kMaxOrdered = 6000;
constexpr double kMaxLink = 4.0;  // of the tool's radius: a longer way is made above material
/// Distance, over the tool's radius, up to which the cuts of a pass count for a run: a disc of the largest
/// stage with the tool on both sides, and links.
constexpr double kNear = 2.0 + 2.0 * 4.0 + kMaxLink;
constexpr double kSlack = 0.002;  // of the tool's radius: rounding of what is cleared, for links

struct Node {
  AdaptiveRun run;
  std::size_t pass = 0;
  std::size_t open = 0;                // runs before it that are not done
  std::vector<std::uint32_t> after{};  // those that depend on it
  std::vector<Box2> boxes{};           // of its segments
  Box2 box{};
};

Box2 box_of(Point2 from, const Segment& segment) {
  const auto arc = arc_circle(from, segment);
  return arc ? bounds(arc_about(arc->centre, from, segment.to, arc->turn))
             : bounds(line_between(from, segment.to));
}

class Ordering {
 public:
  Ordering(std::vector<AdaptivePass> passes, double radius, const CutOptions& options)
      : passes_(std::move(passes)), radius_(radius), options_(options) {
    for (std::size_t i = 0; i < passes_.size(); ++i)
      for (AdaptiveRun& run : passes_[i].runs) nodes_.push_back({.run = std::move(run), .pass = i});
    for (Node& node : nodes_) find_boxes(node);
  }

  std::vector<AdaptiveRun> run() {
    depend();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].open == 0) ready_.push_back(i);
    while (!ready_.empty() && !stop_requested(options_.progress)) take(nearest());
    return std::move(order_);
  }

 private:
  static void find_boxes(Node& node) {
    if (node.run.entry) {
      const Circle& c = *node.run.entry;
      node.boxes.push_back(Box2{c.centre, c.centre}.grown(c.radius.mm()));
    }
    for (std::size_t i = 0; i < node.run.path.segments.size(); ++i)
      node.boxes.push_back(box_of(node.run.path.point(i), node.run.path.segments[i]));
    for (const Box2& box : node.boxes) node.box.add(box);
  }

  /// Entries depend on nothing; the rings around them on them.
  void depend() {
    const bool all = nodes_.size() > kMaxOrdered;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (all) {
        if (i > 0) link(i - 1, i);
        continue;
      }
      if (nodes_[i].run.entry) continue;
      for (std::size_t j = 0; j < i; ++j)
        if (nodes_[j].pass < nodes_[i].pass && near(nodes_[j], nodes_[i])) link(j, i);
    }
  }
  void link(std::size_t before, std::size_t after) {
    nodes_[before].after.push_back(static_cast<std::uint32_t>(after));
    ++nodes_[after].open;
  }
  bool near(const Node& a, const Node& b) const {
    const Box2 reach = b.box.grown(kNear * radius_);
    if (!a.box.overlaps(reach)) return false;
    return std::any_of(a.boxes.begin(), a.boxes.end(), [&](const Box2& box) {
      if (!box.overlaps(reach)) return false;
      const Box2 around = box.grown(kNear * radius_);
      return std::any_of(b.boxes.begin(), b.boxes.end(),
                         [&](const Box2& other) { return other.overlaps(around); });
    });
  }

  static Point2 start_of(const AdaptiveRun& run) { return run.entry ? start_of(*run.entry) : run.path.start; }
  static Point2 start_of(const Circle& circle) { return circle.centre + Point2{circle.radius.mm(), 0.0}; }

  /// Of the runs that can be cut; an entry only where there is no other.
  std::size_t nearest() const {
    std::size_t best = 0;
    double shortest = INFINITY;
    bool entry = true;
    for (std::size_t i = 0; i < ready_.size(); ++i) {
      const AdaptiveRun& run = nodes_[ready_[i]].run;
      const double way = at_ ? distance(*at_, start_of(run)) : static_cast<double>(ready_[i]);
      if ((run.entry && !entry) || (run.entry.has_value() == entry && way >= shortest)) continue;
      best = i, shortest = way, entry = run.entry.has_value();
    }
    return best;
  }

  void take(std::size_t position) {
    Node& node = nodes_[ready_[position]];
    ready_.erase(ready_.begin() + static_cast<std::ptrdiff_t>(position));
    const Point2 start = start_of(node.run);
    node.run.linked = !node.run.entry && at_ && is_clear(node.pass, *at_, start);
    at_ = node.run.entry ? start : node.run.path.segments.back().to;
    order_.push_back(std::move(node.run));
    for (const std::uint32_t after : node.after)
      if (--nodes_[after].open == 0) ready_.push_back(after);
  }

  /// Whether the straight line is within what the axis has covered before a pass.
  bool is_clear(std::size_t pass, Point2 from, Point2 to) {
    const double whole = distance(from, to), slack = kSlack * radius_;
    if (whole <= slack) return true;
    if (whole > kMaxLink * radius_) return false;
    if (!search_ || searched_ != pass)
      search_ = std::make_unique<RegionSearch>(passes_[pass].cleared), searched_ = pass;
    for (double along = 0.0; along < whole;) {
      const auto clearance = search_->clearance(from + (along / whole) * (to - from));
      if (!clearance || clearance->mm() < -slack) return false;
      along += std::max(clearance->mm(), slack);
    }
    return true;
  }

  std::vector<AdaptivePass> passes_;
  double radius_;
  const CutOptions& options_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> ready_;
  std::vector<AdaptiveRun> order_;
  std::optional<Point2> at_;
  std::unique_ptr<RegionSearch> search_;
  std::size_t searched_ = 0;
};

}  // namespace

std::vector<AdaptiveRun> in_order(std::vector<AdaptivePass> passes, double radius,
                                  const CutOptions& options) {
  return Ordering(std::move(passes), radius, options).run();
}

}  // namespace kerf::op_detail
