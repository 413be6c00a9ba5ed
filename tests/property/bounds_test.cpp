// Bounds of toolpaths contain every point of every cut; a rapid into the material is found wherever it is,
// also with an assumed stock. Points of arcs are computed here by their angles. The seed of a failure is in
// its message.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "path/assumed_stock.h"

#include "kerf/path/report.h"
#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

constexpr unsigned kRuns = 300;
constexpr double kSlack = 1e-9;  // mm

/// A random path and the points of its cuts, step by step.
struct Sampled {
  Toolpath path;
  struct Point {
    std::size_t step;
    Point3 at;
  };
  std::vector<Point> points;
};

class RandomCuts {
 public:
  explicit RandomCuts(unsigned seed) : random_(seed) {}

  Sampled make() {
    rapid(anywhere());
    for (int i = 0; i < 40; ++i) {
      switch (whole(0, 5)) {
        case 0: rapid(anywhere()); break;
        case 1: other_step(); break;
        case 2: cut(anywhere()); break;
        default: arc();
      }
    }
    return std::move(made_);
  }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  Point3 anywhere() { return {real(-50, 50), real(-50, 50), real(-20, 5)}; }

  void rapid(Point3 to) {
    made_.path.add(step::Rapid{to}, OriginId::none);
    at_ = to;
  }
  void other_step() {
    if (whole(0, 1) == 0)
      made_.path.add(step::ToolChange{whole(1, 3)}, OriginId::none);
    else
      made_.path.add(step::Note{"between"}, OriginId::none);
  }
  void cut(Point3 to) {
    const std::size_t step = made_.path.add(step::Cut{to, mm_per_min(100)}, OriginId::none);
    for (int k = 0; k <= 10; ++k) made_.points.push_back({step, at_ + (k / 10.0) * (to - at_)});
    at_ = to;
  }
  void arc() {
    const Plane plane = std::array{Plane::xy, Plane::xz, Plane::yz}[static_cast<std::size_t>(whole(0, 2))];
    // The first, second and third axis of a right-handed frame, as G17, G18 and G19 have them.
    const std::array<int, 3> axes = plane == Plane::xy   ? std::array{0, 1, 2}
                                    : plane == Plane::xz ? std::array{2, 0, 1}
                                                         : std::array{1, 2, 0};
    const double radius = real(0.5, 20), start = real(-3, 3), rise = whole(0, 1) == 0 ? 0 : real(-4, 4);
    const bool ccw = whole(0, 1) == 0;
    const int extra = whole(0, 4) == 0 ? whole(1, 3) : 0;
    const double fraction = real(0.02, 0.99);
    const double sweep = (ccw ? 1 : -1) * 2 * std::numbers::pi * (fraction + extra);
    double centre[3] = {at_.x, at_.y, at_.z};
    centre[axes[0]] -= radius * std::cos(start);
    centre[axes[1]] -= radius * std::sin(start);
    const auto point = [&](double t) {
      Point3 p = at_;
      p[axes[0]] = centre[axes[0]] + radius * std::cos(start + t * sweep);
      p[axes[1]] = centre[axes[1]] + radius * std::sin(start + t * sweep);
      p[axes[2]] = at_[axes[2]] + t * rise;
      return p;
    };
    const Point2 in_name_order = plane == Plane::xy   ? Point2{centre[0], centre[1]}
                                 : plane == Plane::xz ? Point2{centre[0], centre[2]}
                                                      : Point2{centre[1], centre[2]};
    const Turn turn = ccw ? Turn::ccw : Turn::cw;
    const std::size_t step = made_.path.add(
        step::Arc{point(1.0), in_name_order, plane, turn, extra, mm_per_min(100)}, OriginId::none);
    for (int k = 0; k <= 200; ++k) made_.points.push_back({step, point(k / 200.0)});
    at_ = point(1.0);
  }

  std::mt19937 random_;
  Sampled made_;
  Point3 at_;
};

/// The distance by which a box has to grow to contain a point.
double outside(const Box3& box, Point3 p) {
  double worst = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    worst = std::max({worst, box.low[axis] - p[axis], p[axis] - box.high[axis]});
  return worst;
}

TEST(Bounds, ContainEveryPointOfEveryCut) {
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Sampled made = RandomCuts(seed).make();
    const PathReport whole = report_on(made.path, {});
    Box3 points;
    for (const Sampled::Point& p : made.points) {
      ASSERT_LE(outside(whole.all.cut_bounds, p.at), kSlack) << "step " << p.step;
      points.add(p.at);
    }
    if (made.points.empty()) continue;
    // And they are tight: an arc of 20 mm with 200 points over 4 turns leaves at most 20 (1 - cos(pi / 50)).
    ASSERT_LE(outside(points, whole.all.cut_bounds.low), 0.05);
    ASSERT_LE(outside(points, whole.all.cut_bounds.high), 0.05);
    double deepest = 0.0;
    for (const ToolFigures& tool : whole.tools) deepest = std::min(deepest, tool.deepest.value_or(0.0));
    ASSERT_LE(deepest, std::min(0.0, points.low.z) + kSlack);
    // Of a part of the steps.
    const ReportOptions part{.first = made.path.size() / 3, .end = 2 * made.path.size() / 3};
    const Box3 bounds = report_on(made.path, part).all.cut_bounds;
    for (const Sampled::Point& p : made.points) {
      if (p.step < part.first || p.step >= part.end) continue;
      ASSERT_LE(outside(bounds, p.at), kSlack) << "step " << p.step;
    }
  }
}

Tool square_mill(double diameter) {
  Diagnostics diagnostics;
  auto tool = make_tool(1, shape::Square{mm(diameter), mm(40)}, {}, {}, diagnostics);
  return std::move(*tool);
}

/// Slots of a few millimetres depth, and one rapid that goes down below Z0 somewhere, also beside all cuts.
class RapidPlunge {
 public:
  explicit RapidPlunge(unsigned seed) : random_(seed) {
    path_.add(step::ToolChange{1}, OriginId::none);
    path_.add(step::Spindle{rpm(10000), SpindleTurn::cw}, OriginId::none);
    const int slots = whole(1, 5), wrong = whole(0, slots);
    for (int i = 0; i <= slots; ++i) {
      const Point3 at{real(-40, 40), real(-40, 40), -real(0.5, 6)};
      rapid({at.x, at.y, 5});
      if (i == wrong) {
        plunge_ = path_.size();
        rapid(at);
      } else {
        path_.add(step::Cut{at, mm_per_min(100)}, OriginId::none);
      }
      if (i != wrong || whole(0, 1) == 0)
        path_.add(step::Cut{{real(-40, 40), real(-40, 40), at.z}, mm_per_min(100)}, OriginId::none);
      const Point3 end = path_[path_.size() - 1].to();
      rapid({end.x, end.y, 5});
    }
  }
  const Toolpath& path() const { return path_; }
  std::size_t plunge() const { return plunge_; }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  void rapid(Point3 to) { path_.add(step::Rapid{to}, OriginId::none); }

  std::mt19937 random_;
  Toolpath path_;
  std::size_t plunge_ = 0;
};

TEST(Bounds, ARapidIntoAnAssumedStockIsFoundWhereverItIs) {
  ToolTable tools;
  tools.set(1, square_mill(3));
  SimulationOptions options;
  options.resolution = mm(0.4);
  int crossed = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RapidPlunge job(seed);
    const auto assumed = assume_stock(job.path(), mm(3.5), mm(1));
    ASSERT_TRUE(assumed);
    ASSERT_EQ(assumed->stock.block.high.z, 0.0) << "all cuts are below Z0";
    Diagnostics diagnostics;
    const auto result = simulate(job.path(), tools, assumed->stock, options, diagnostics);
    ASSERT_TRUE(result);
    bool found = false;
    for (const Hazard& h : result->hazards)
      found = found || (h.kind == HazardKind::rapid_in_stock && h.step == job.plunge());
    // Where an earlier slot has removed the material, there is nothing to find.
    const bool nothing_left = result->removed_by_step[job.plunge()] <= 0.0f;
    crossed += nothing_left ? 1 : 0;
    ASSERT_TRUE(found || nothing_left);
  }
  EXPECT_LT(crossed, 8);
}

}  // namespace
}  // namespace kerf
