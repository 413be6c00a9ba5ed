// Single sweeps of every tool and every kind of motion against an independent reference: the tool's position
// is sampled densely along the true curve, and each end of what it removes above a column is refined, all in
// double.
#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>
#include <utility>

#include "jobs.h"

namespace kerf::test {
namespace {

constexpr double kMicron = 0.001;
constexpr double kTop = 12.0;  // of the block, whose floor is at 0

/// Where a static tool's material lies at a distance from the axis: intervals above the tip, by the half
/// profile alone.
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
  /// The runs of material at a distance, each segment's own (they may adjoin).
  void runs(double rho, std::vector<Run>& out) const {
    out.clear();
    for (std::size_t k = 0; k < segments_.size(); ++k) segments_[k].run(rho, static_cast<int>(k), out);
  }

 private:
  struct Segment {
    double r0, z0, r1, z1, bulge, cr, cz, q;
    double radius(double z) const {
      if (bulge == 0) return r0 + (r1 - r0) * (z - z0) / (z1 - z0);
      const double w = std::sqrt(std::max(0.0, q * q - (z - cz) * (z - cz)));
      return bulge > 0 ? cr + w : cr - w;
    }
    /// All segments used here have radii that rise to one peak (or only rise or fall), so that one run
    /// remains.
    void run(double rho, int number, std::vector<Run>& out) const {
      double peak = r0 > r1 ? z0 : z1;
      if (bulge > 0 && cz > z0 && cz < z1) peak = cz;
      if (radius(peak) < rho) return;
      double low = z0, high = z1;
      if (radius(z0) < rho) low = crossing(rho, z0, peak);
      if (radius(z1) < rho) high = crossing(rho, z1, peak);
      out.push_back({low, high, number});
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

std::vector<Motion> motions() {
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

/// What the tool removes above one place: merged runs.
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
    const double rho = std::hypot(x - p.x, y - p.y);
    if (rho > rim_ + 1e-12) return std::nullopt;
    std::vector<Run> runs;
    tool_.runs(rho, runs);
    for (const Run& r : runs)
      if (r.segment == segment) return Run{r.low + p.z, r.high + p.z, segment};
    return std::nullopt;
  }
  /// What one segment of the profile removes: while it reaches the column without a break, that is one run.
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
  /// The last moment between `in` and `out` at which the segment reaches the column.
  double edge(double x, double y, int segment, double in, double out) const {
    for (int n = 0; n < 50; ++n) {
      const double middle = 0.5 * (in + out);
      (run_at(x, y, segment, middle) ? in : out) = middle;
    }
    return in;
  }
  /// The lowest low (highest high) near the best sample, by golden section on each side of it.
  double refined(double x, double y, double best, double t_best, bool upper) const {
    double result = best;
    std::vector<Run> runs;
    const auto value = [&](double t) {
      const Point3 p = at(std::clamp(t, 0.0, 1.0));
      tool_.runs(std::hypot(x - p.x, y - p.y), runs);
      double v = upper ? -1e9 : 1e9;
      for (const Run& r : runs) {
        const double end = (upper ? r.high : r.low) + p.z;
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

std::vector<Silhouette2::Run> left_of(const std::vector<Silhouette2::Run>& removed) {
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

/// How far the ends of a column's intervals lie from where they may be. Where the surface is steep, a micron
/// sideways counts as much as a micron in height: an end may be anywhere between the heights that the
/// reference gives within a micron of the column. `left(x, y)` is the reference.
template <class Left>
double surface_error(double x, double y, const std::vector<Interval>& have, const Left& left) {
  std::vector<Silhouette2::Run> low, high;
  const auto allow = [&](const std::vector<Silhouette2::Run>& want) {
    if (want.size() != have.size()) return;
    if (low.empty()) low = high = want;
    for (std::size_t k = 0; k < want.size(); ++k) {
      low[k] = {std::min(low[k].low, want[k].low), std::min(low[k].high, want[k].high), 0};
      high[k] = {std::max(high[k].low, want[k].low), std::max(high[k].high, want[k].high), 0};
    }
  };
  const auto error = [&] {
    if (low.size() != have.size()) return 1e9;
    double worst = 0.0;
    for (std::size_t k = 0; k < have.size(); ++k) {
      const double bottom = static_cast<double>(have[k].low), top = static_cast<double>(have[k].high);
      worst =
          std::max({worst, low[k].low - bottom, bottom - high[k].low, low[k].high - top, top - high[k].high});
    }
    return worst;
  };
  allow(left(x, y));
  for (int k = 0; k < 8 && error() > kMicron; ++k) {
    const double angle = k * std::numbers::pi / 4;
    allow(left(x + kMicron * std::cos(angle), y + kMicron * std::sin(angle)));
  }
  return error();
}

/// The job of one motion: straight down to its begin, then the motion.
Toolpath path_of(const Motion& motion) {
  Path path;
  path.tool(1).rapid({motion.from.x, motion.from.y, 40}).cut(motion.from);
  if (motion.arc) {
    path.arc(*motion.arc);
  } else {
    path.cut(motion.to);
  }
  return path.path();
}

template <class Runs>
std::string text_of(const Runs& runs) {
  std::string text;
  for (const auto& run : runs) text += std::to_string(run.low) + " to " + std::to_string(run.high) + "\n";
  return text;
}

/// Errors over a pattern of columns, mm.
struct Errors {
  double largest = 0.0, percentile_99 = 0.0;
};

Errors summary_of(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  return {errors.back(), errors[errors.size() * 99 / 100]};
}

/// Errors of the columns that the job touches; reports those that are worse than a micron.
Errors errors_of(const NamedProfile& tool, const Motion& motion, const Workpiece& workpiece) {
  const Motion approach{"approach", {motion.from.x, motion.from.y, 40}, {}, motion.from};
  const Reference down(tool.profile, approach), along(tool.profile, motion);
  const auto left = [&](double x, double y) {
    std::vector<Silhouette2::Run> runs = down.removed(x, y);
    const auto more = along.removed(x, y);
    runs.insert(runs.end(), more.begin(), more.end());
    std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.low < b.low; });
    return left_of(runs);
  };
  const double pitch = workpiece.pitch().mm();
  double worst = 0.0;
  std::vector<double> errors;
  for (int j = 0; j < workpiece.columns_y(); ++j) {
    for (int i = (3 * j) % 11; i < workpiece.columns_x(); i += 11) {
      const double x = (i + 0.5) * pitch, y = (j + 0.5) * pitch;
      const double error = surface_error(x, y, workpiece.column(i, j), left);
      if (error > kMicron && worst <= kMicron)
        ADD_FAILURE() << tool.name << " " << motion.name << " at " << x << ", " << y << ": " << error
                      << " mm\n"
                      << text_of(workpiece.column(i, j)) << "reference\n"
                      << text_of(left(x, y));
      worst = std::max(worst, error);
      const std::vector<Interval> column = workpiece.column(i, j);
      if (column.size() != 1 || static_cast<double>(column[0].high - column[0].low) < kTop)
        errors.push_back(error);
    }
  }
  return summary_of(std::move(errors));
}

class Sweeps : public testing::TestWithParam<std::size_t> {};

TEST_P(Sweeps, MatchTheReferenceWithinAMicron) {
  const NamedProfile tool = all_profiles()[GetParam()];
  ToolTable tools;
  Tool drawn = make_drawn(1, tool.profile);
  // A neck like a thread: some motions go deeper than the profile is high, and nothing is to follow it there.
  const double top = tool.profile.top();
  drawn.silhouette.neck = profile({{1e-4, top, 0}, {1e-4, top + 1, 0}});
  tools.set(1, drawn);
  for (const Motion& motion : motions()) {
    Diagnostics diagnostics;
    const auto result = run(path_of(motion), tools, block({0, 0, 0}, {28, 24, kTop}), 0.25, diagnostics);
    ASSERT_TRUE(result);
    const Errors errors = errors_of(tool, motion, result->workpiece);
    EXPECT_LE(errors.largest, kMicron) << tool.name << " " << motion.name;
    std::printf("sweep error, um  %-14s %-14s largest %6.3f  99th percentile %6.3f\n", tool.name.c_str(),
                motion.name.c_str(), errors.largest * 1000, errors.percentile_99 * 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(AllTools, Sweeps, testing::Range<std::size_t>(0, all_profiles().size()),
                         [](const auto& tool) { return all_profiles()[tool.param].name; });

}  // namespace
}  // namespace kerf::test
