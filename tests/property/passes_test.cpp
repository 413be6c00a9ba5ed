// Passes stay within their tolerance of the path (measured here between the points of both paths), keep feeds
// and other steps, and move at rapid only where the path did. The seed of a failure is in its message.
#include "kerf/path/passes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace kerf {
namespace {

constexpr unsigned kRuns = 40;
constexpr double kTolerance = 0.01;  // mm, of the passes
constexpr double kSampling = 5e-4;   // mm, chord tolerance of sampled arcs

/// Paths as CAM programs write them: circles and helices as chords, divided lines, with some noise.
class ChordPath {
 public:
  explicit ChordPath(unsigned seed) : random_(seed) {}

  Toolpath make() {
    path_.add(step::Rapid{at_}, OriginId::none);
    for (int i = 0; i < 25; ++i) add_feature();
    return std::move(path_);
  }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  void cut(Point3 to) {
    path_.add(step::Cut{to, feed_}, OriginId::none);
    at_ = to;
  }
  Point3 noisy(Point3 p) {
    const double size = whole(0, 3) == 0 ? 0.0 : noise_;
    return {p.x + real(-size, size), p.y + real(-size, size), p.z};
  }

  void add_arc() {
    const double radius = std::pow(10.0, real(-0.5, 1.4)), angle = real(-3, 3),
                 rise = whole(0, 2) == 0 ? -1 : 0;
    const double sweep = real(0.2, 6.2) * (whole(0, 1) == 0 ? 1 : -1);
    const Point3 from = at_,
                 centre{at_.x - radius * std::cos(angle), at_.y - radius * std::sin(angle), at_.z};
    const int count = whole(3, 80);
    for (int i = 1; i <= count; ++i) {
      const double a = angle + sweep * i / count;
      cut(noisy(
          {centre.x + radius * std::cos(a), centre.y + radius * std::sin(a), from.z + rise * i / count}));
    }
  }
  void add_line() {
    const Point3 from = at_, to{real(-40, 40), real(-40, 40), real(-3, 0)};
    const int count = whole(1, 30);
    for (int i = 1; i <= count; ++i) cut(noisy(from + (static_cast<double>(i) / count) * (to - from)));
  }
  void add_rapids() {
    const Point3 up{at_.x, at_.y, 5}, there{real(-40, 40), real(-40, 40), 5};
    path_.add(step::Rapid{up}, OriginId::none);
    if (whole(0, 1) == 0) path_.add(step::Rapid{there}, OriginId::none), at_ = there;
    if (whole(0, 1) == 0) path_.add(step::Rapid{{at_.x, at_.y, 9}}, OriginId::none);
    at_.z = whole(0, 1) == 0 ? 5 : 1;
    path_.add(step::Rapid{at_}, OriginId::none);
    if (whole(0, 2) == 0) path_.add(step::Rapid{at_}, OriginId::none);
  }
  void add_feature() {
    noise_ = real(0, 1.5) * kTolerance;
    switch (whole(0, 6)) {
      case 0: return add_line();
      case 1: return add_rapids();
      case 2: feed_ = mm_per_min(whole(1, 9) * 100); return;
      case 3: path_.add(step::Note{"between"}, OriginId::none); return;
      default: return add_arc();
    }
  }

  std::mt19937 random_;
  Toolpath path_;
  Point3 at_{0, 0, 5};
  Feed feed_ = mm_per_min(600);
  double noise_ = 0.0;
};

struct Chord {
  Point3 a, b;
  double feed;  // 0: a rapid
};

/// The path as straight chords.
std::vector<Chord> chords_of(const Toolpath& path) {
  std::vector<Chord> list;
  Point3 from;
  for (const Step& s : path.steps()) {
    if (!s.is_motion()) continue;
    const double feed = s.kind() == StepKind::rapid ? 0.0 : s.feed().mm_per_min();
    const int count = s.kind() == StepKind::arc ? walk_of(s, from).chords(mm(kSampling)) : 1;
    Point3 a = from;
    for (int k = 1; k <= count; ++k) {
      const Point3 b = k == count ? s.to() : walk_of(s, from).at(static_cast<double>(k) / count);
      list.push_back({a, b, feed});
      a = b;
    }
    from = s.to();
  }
  return list;
}

double distance_to(const Chord& chord, Point3 p) {
  const Point3 way = chord.b - chord.a;
  const double square = dot(way, way);
  const double t = square > 0.0 ? std::clamp(dot(p - chord.a, way) / square, 0.0, 1.0) : 0.0;
  return distance(p, chord.a + t * way);
}

/// Maximum distance of the points of `of` from the chords of `from` with the same feed.
double max_distance(const std::vector<Chord>& of, const std::vector<Chord>& from) {
  double worst = 0.0;
  for (const Chord& chord : of) {
    for (const double t : {0.0, 0.5, 1.0}) {
      const Point3 p = chord.a + t * (chord.b - chord.a);
      double nearest = 1e300;
      for (const Chord& other : from)
        if (other.feed == chord.feed) nearest = std::min(nearest, distance_to(other, p));
      worst = std::max(worst, nearest);
    }
  }
  return worst;
}

std::vector<Chord> rapids_of(std::vector<Chord> chords) {
  chords.erase(std::remove_if(chords.begin(), chords.end(), [](const Chord& p) { return p.feed != 0.0; }),
               chords.end());
  return chords;
}

std::size_t others(const Toolpath& path) {
  return static_cast<std::size_t>(
      std::count_if(path.steps().begin(), path.steps().end(), [](const Step& s) { return !s.is_motion(); }));
}

void expect_near(const Toolpath& before, const PassResult& result, double tolerance) {
  EXPECT_EQ(result.before.steps, before.size());
  EXPECT_EQ(result.after.steps, result.path.size());
  EXPECT_EQ(others(result.path), others(before));
  const std::vector<Chord> was = chords_of(before), is = chords_of(result.path);
  EXPECT_LE(max_distance(is, was), tolerance);
  EXPECT_LE(max_distance(was, is), tolerance);
  EXPECT_LE(max_distance(rapids_of(is), rapids_of(was)), 1e-9) << "a rapid where the path had none";
}

class Passes : public testing::TestWithParam<unsigned> {
 protected:
  Toolpath path_ = ChordPath(GetParam()).make();
};

TEST_P(Passes, fitted_arcs_keep_to_the_path) {
  const PassResult result = chords_to_arcs(path_, {.tolerance = mm(kTolerance)});
  expect_near(path_, result, kTolerance + 2.0 * kSampling);
  EXPECT_LT(result.after.steps, result.before.steps);
  EXPECT_NEAR(result.after.cut_mm, result.before.cut_mm, 0.02 * result.before.cut_mm);
}

TEST_P(Passes, joined_cuts_keep_to_the_path) {
  const PassResult result = join_straight(path_, mm(kTolerance));
  expect_near(path_, result, kTolerance + 1e-9);
  EXPECT_LT(result.after.steps, result.before.steps);
}

TEST_P(Passes, chords_keep_to_their_arcs) {
  const Toolpath arcs = chords_to_arcs(path_, {.tolerance = mm(kTolerance)}).path;
  const PassResult result = arcs_to_chords(arcs, mm(kTolerance));
  expect_near(arcs, result, kTolerance + 2.0 * kSampling);
}

TEST_P(Passes, rapids_go_only_where_rapids_went) {
  const PassResult result = shorten_rapids(path_);
  const std::vector<Chord> was = chords_of(path_), is = chords_of(result.path);
  EXPECT_LE(max_distance(rapids_of(is), rapids_of(was)), 1e-9);
  EXPECT_LE(result.after.rapid_mm, result.before.rapid_mm);
  EXPECT_EQ(result.after.cut_mm, result.before.cut_mm);
}

INSTANTIATE_TEST_SUITE_P(Random, Passes, testing::Range(1u, kRuns + 1));

}  // namespace
}  // namespace kerf
