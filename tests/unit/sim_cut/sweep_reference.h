// Every kind of motion, and an independent reference of what a tool removes along it: the tool's position is
// sampled densely along the true curve, and each end of the removed intervals of a column is refined, all in
// double precision.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cut_jobs.h"

namespace kerf::test {

inline constexpr double kMicron = 0.001;
inline constexpr double kTop = 12.0;  // of the block, whose floor is at 0

/// The intervals of a stationary tool at a distance from the axis, above the tip, from the half profile
/// alone.
class Silhouette2 {
 public:
  explicit Silhouette2(const Profile& profile) {
    for (std::size_t i = 0; i + 1 < profile.knots.size(); ++i) add(profile.knots[i], profile.knots[i + 1]);
  }
  int segments() const { return static_cast<int>(segments_.size()); }
  double max_radius() const {
    double r = 0;
    for (const Segment& s : segments_)
      for (int k = 0; k <= 200; ++k) r = std::max(r, s.radius(s.z0 + (s.z1 - s.z0) * k / 200));
    return r;
  }
  struct Run {
    double low, high;
    int segment = 0;
  };
  /// The run of material of one segment at a distance.
  std::optional<Run> run(double rho, int segment) const {
    auto run = segments_[static_cast<std::size_t>(segment)].run(rho);
    if (run) run->segment = segment;
    return run;
  }

 private:
  struct Segment {
    double r0, z0, r1, z1, bulge, cr, cz, q;
    double radius(double z) const {
      if (bulge == 0) return r0 + (r1 - r0) * (z - z0) / (z1 - z0);
      const double w = std::sqrt(std::max(0.0, q * q - (z - cz) * (z - cz)));
      return bulge > 0 ? cr + w : cr - w;
    }
    /// The radii of all segments here rise to one peak, or only rise or fall: there is one run.
    std::optional<Run> run(double rho) const {
      double peak = r0 > r1 ? z0 : z1;
      if (bulge > 0 && cz > z0 && cz < z1) peak = cz;
      if (radius(peak) < rho) return std::nullopt;
      double low = z0, high = z1;
      if (radius(z0) < rho) low = crossing(rho, z0, peak);
      if (radius(z1) < rho) high = crossing(rho, z1, peak);
      return Run{low, high, 0};
    }
    /// The height between `outside` and `inside` at which the radius is rho.
    double crossing(double rho, double outside, double inside) const {
      if (bulge == 0) return r1 == r0 ? inside : z0 + (rho - r0) * (z1 - z0) / (r1 - r0);
      const double w = std::sqrt(std::max(0.0, q * q - (rho - cr) * (rho - cr)));
      const double low = std::min(outside, inside), high = std::max(outside, inside);
      const double below = std::clamp(cz - w, low, high), above = std::clamp(cz + w, low, high);
      return std::abs(radius(below) - rho) < std::abs(radius(above) - rho) ? below : above;
    }
  };
  void add(const Knot& a, const Knot& b) {
    if (b.z <= a.z) return;
    Segment s{a.r, a.z, b.r, b.z, a.bulge, 0, 0, 0};
    if (a.bulge != 0) {
      const double k = 0.25 * (1 / a.bulge - a.bulge);
      s.cr = 0.5 * (a.r + b.r) - k * (b.z - a.z);
      s.cz = 0.5 * (a.z + b.z) + k * (b.r - a.r);
      s.q = std::hypot(a.r - s.cr, a.z - s.cz);
    }
    segments_.push_back(s);
  }
  std::vector<Segment> segments_;
};

struct Motion {
  std::string name;
  Point3 from;
  std::optional<step::Arc> arc;  // else straight to `to`
  Point3 to;
};

inline std::vector<Motion> motions() {
  const Point3 a{8.03, 9.07, 6.0};
  std::vector<Motion> list{
      {"level", a, {}, {21.3, 13.9, 6.0}},
      {"along_x", a, {}, {20.0, 9.07, 6.0}},
      {"plunge", {12.0, 11.0, 14.0}, {}, {12.0, 11.0, 5.5}},
      {"up", {12.0, 11.0, 5.5}, {}, {12.0, 11.0, 9.0}},
      {"slope_down", {8, 9, 8.0}, {}, {20.5, 14.0, 4.5}},
      {"slope_up", {8, 9, 4.5}, {}, {20.5, 14.0, 8.0}},
      {"steep_down", {12, 11, 11.0}, {}, {13.1, 12.0, 4.5}},
      {"steep_up", {13.1, 12, 4.5}, {}, {12, 11, 11.0}},
      {"dot", a, {}, a},
  };
  const auto arc = [&](std::string name, Point3 from, Point3 to, Point2 centre, Turn turn,
                       Plane plane = Plane::xy, int turns = 0) {
    list.push_back({std::move(name), from,
                    step::Arc{.to = to,
                              .centre = centre,
                              .plane = plane,
                              .turn = turn,
                              .extra_turns = turns,
                              .feed = mm_per_min(300)},
                    to});
  };
  arc("arc_ccw_short", {18, 12, 6}, {14, 16, 6}, {14, 12}, Turn::ccw);
  arc("arc_cw_long", {18, 12, 6}, {14, 16, 6}, {14, 12}, Turn::cw);
  arc("arc_cw_short", {14, 16, 6}, {18, 12, 6}, {14, 12}, Turn::cw);
  arc("circle", {19, 12, 6}, {19, 12, 6}, {14, 12}, Turn::ccw);
  arc("small_circle", {15, 12, 6}, {15, 12, 6}, {14, 12}, Turn::cw);
  arc("helix", {18, 12, 8}, {18, 12, 5}, {14, 12}, Turn::cw, Plane::xy, 1);
  arc("helix_up", {18, 12, 5}, {10, 12, 7}, {14, 12}, Turn::ccw);
  arc("spiral", {18, 12, 6}, {14, 15, 6}, {14, 12}, Turn::ccw);
  arc("xz", {10, 12, 7}, {16, 12, 7}, {13, 7}, Turn::cw, Plane::xz);
  arc("yz", {14, 8, 7}, {14, 14, 7}, {11, 7}, Turn::ccw, Plane::yz);
  return list;
}

/// What the tool removes above one point: merged runs.
class Reference {
 public:
  Reference(const Profile& profile, const Motion& motion) : tool_(profile), motion_(motion) {
    if (motion.arc)
      walk_ = walk_arc(motion.from, motion.arc->to, motion.arc->centre, motion.arc->plane, motion.arc->turn,
                       motion.arc->extra_turns);
    const double length = walk_ ? walk_->length() : distance(motion.from, motion.to);
    samples_ = std::max(2, static_cast<int>(length / 0.05));
    for (int k = 0; k <= samples_; ++k) points_.push_back(at(k / static_cast<double>(samples_)));
    rim_ = tool_.max_radius();
  }
  Point3 at(double t) const { return walk_ ? walk_->at(t) : motion_.from + t * (motion_.to - motion_.from); }

  /// True if a point is removed, by the samples alone: exact at walls, within a sample step on slopes.
  bool removes(Point3 p) const {
    for (const Point3& tip : points_) {
      const double rho = std::sqrt((p.x - tip.x) * (p.x - tip.x) + (p.y - tip.y) * (p.y - tip.y));
      for (int k = 0; rho <= rim_ && k < tool_.segments(); ++k) {
        const std::optional<Run> r = tool_.run(rho, k);
        if (r && r->low + tip.z <= p.z && p.z <= r->high + tip.z) return true;
      }
    }
    return false;
  }

  using Run = Silhouette2::Run;
  std::vector<Run> removed(double x, double y) const {
    std::vector<Sample> all;
    for (int segment = 0; segment < tool_.segments(); ++segment) add_segment(x, y, segment, all);
    std::sort(all.begin(), all.end(), [](const Sample& a, const Sample& b) { return a.low < b.low; });
    std::vector<Run> out;
    for (std::size_t i = 0; i < all.size();) {
      Sample whole = all[i];
      for (; i < all.size() && all[i].low <= whole.high + kAdjoining; ++i) {
        if (all[i].high > whole.high) whole.high = all[i].high, whole.t_high = all[i].t_high;
      }
      out.push_back(
          {refined(x, y, whole.low, whole.t_low, false), refined(x, y, whole.high, whole.t_high, true), 0});
    }
    return out;
  }

 private:
  static constexpr double kAdjoining = 1e-4;  // mm: parts of a tool that touch leave nothing between them
  struct Sample {
    double low, high, t_low, t_high;
  };
  std::optional<Run> run_at(double x, double y, int segment, double t) const {
    const Point3 p = at(t);
    const double rho2 = (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y);
    if (rho2 > rim_ * rim_ + 1e-11) return std::nullopt;
    const double rho = std::sqrt(rho2);
    const std::optional<Run> r = tool_.run(rho, segment);
    return r ? std::optional(Run{r->low + p.z, r->high + p.z, segment}) : std::nullopt;
  }
  /// The runs that one segment of the profile removes: one while it reaches the column without a break.
  void add_segment(double x, double y, int segment, std::vector<Sample>& all) const {
    std::optional<Sample> current;
    const auto join = [&](double t) {
      const std::optional<Run> run = run_at(x, y, segment, t);
      if (!run) return;
      if (!current) current = Sample{run->low, run->high, t, t};
      if (run->low < current->low) current->low = run->low, current->t_low = t;
      if (run->high > current->high) current->high = run->high, current->t_high = t;
    };
    bool was_in = false;
    for (int k = 0; k <= samples_; ++k) {
      const double t = k / static_cast<double>(samples_);
      const bool is_in = run_at(x, y, segment, t).has_value();
      if (k > 0 && is_in != was_in)
        join(edge(x, y, segment, is_in ? t : t - 1.0 / samples_, is_in ? t - 1.0 / samples_ : t));
      if (is_in) join(t);
      if (!is_in && current) all.push_back(*std::exchange(current, std::nullopt));
      was_in = is_in;
    }
    if (current) all.push_back(*current);
  }
  /// The last parameter between `in` and `out` at which the segment reaches the column.
  double edge(double x, double y, int segment, double in, double out) const {
    for (int n = 0; n < 50; ++n) {
      const double midpoint = 0.5 * (in + out);
      (run_at(x, y, segment, midpoint) ? in : out) = midpoint;
    }
    return in;
  }
  /// The lowest low (highest high) near the best sample, by golden section on each side of it.
  double refined(double x, double y, double best, double t_best, bool upper) const {
    double result = best;
    const auto value = [&](double t) {
      const Point3 p = at(std::clamp(t, 0.0, 1.0));
      const double rho = std::hypot(x - p.x, y - p.y);
      double v = upper ? -1e9 : 1e9;
      for (int k = 0; k < tool_.segments(); ++k) {
        const std::optional<Run> r = tool_.run(rho, k);
        if (!r) continue;
        const double end = (upper ? r->high : r->low) + p.z;
        if (std::abs(end - best) < 0.2) v = upper ? std::max(v, end) : std::min(v, end);
      }
      return upper ? -v : v;
    };
    double a = t_best - 1.0 / samples_, b = t_best + 1.0 / samples_;
    for (int n = 0; n < 60; ++n) {
      const double l = a + 0.382 * (b - a), r = b - 0.382 * (b - a);
      (value(l) < value(r) ? b : a) = value(l) < value(r) ? r : l;
    }
    const double found = value(0.5 * (a + b));
    if (std::abs(found) < 1e8) result = upper ? std::max(result, -found) : std::min(result, found);
    return result;
  }

  Silhouette2 tool_;
  const Motion& motion_;
  std::optional<ArcWalk> walk_;
  int samples_ = 0;
  double rim_ = 0;
  std::vector<Point3> points_;
};

inline std::vector<Silhouette2::Run> left_of(const std::vector<Silhouette2::Run>& removed) {
  std::vector<Silhouette2::Run> left;
  double from = 0.0;
  for (const auto& r : removed) {
    if (std::min(r.low, kTop) > from) left.push_back({from, std::min(r.low, kTop), 0});
    from = std::max(from, r.high);
  }
  if (from < kTop) left.push_back({from, kTop, 0});
  std::erase_if(left, [](const auto& r) { return r.high - r.low < 2e-5; });
  return left;
}

/// The job of one motion: straight down to its start, then the motion.
inline Toolpath path_of(const Motion& motion) {
  Path path;
  path.tool(1).rapid({motion.from.x, motion.from.y, 40}).cut(motion.from);
  if (motion.arc) {
    path.arc(*motion.arc);
  } else {
    path.cut(motion.to);
  }
  return path.path();
}

/// The remaining column after the approach and the motion.
class Remainder {
 public:
  Remainder(const NamedProfile& tool, const Motion& motion)
      : approach_{"approach",
                  {motion.from.x, motion.from.y,
                   std::max(motion.from.z, kTop) + 0.1},  // the tip is above the block
                  {},
                  motion.from},
        down_(tool.profile, approach_),
        along_(tool.profile, motion) {}
  std::vector<Silhouette2::Run> operator()(double x, double y) const {
    std::vector<Silhouette2::Run> runs = down_.removed(x, y);
    const auto more = along_.removed(x, y);
    runs.insert(runs.end(), more.begin(), more.end());
    std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.low < b.low; });
    return left_of(runs);
  }
  bool is_removed(Point3 p) const { return down_.removes(p) || along_.removes(p); }

 private:
  Motion approach_;
  Reference down_, along_;
};

/// The tool as number 1. Its neck is very thin: some motions go deeper than the profile is high, and nothing
/// above it may cut there.
inline ToolTable table_of(const NamedProfile& tool) {
  ToolTable tools;
  Tool drawn = make_drawn(1, tool.profile);
  const double top = tool.profile.top();
  drawn.silhouette.neck = profile({{1e-4, top, 0}, {1e-4, top + 1, 0}});
  tools.set(1, drawn);
  return tools;
}
inline Stock block_of_motions() { return block({0, 0, 0}, {28, 24, kTop}); }

/// The job of one motion with one tool.
inline std::optional<Simulation> cut(const NamedProfile& tool, const Motion& motion, double pitch) {
  Diagnostics diagnostics;
  return run(path_of(motion), table_of(tool), block_of_motions(), pitch, diagnostics);
}

/// Errors over a pattern of points, mm.
struct Errors {
  double largest = 0.0, percentile_99 = 0.0;
};

inline Errors summary_of(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  return {errors.back(), errors[errors.size() * 99 / 100]};
}

}  // namespace kerf::test
