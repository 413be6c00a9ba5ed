// A random toolpath, written by every post and read back, is the same toolpath, and the linter accepts what
// was written. The seed of a failure is in its message; KERF_SEED repeats it,
// and KERF_SHOW names a file that gets the G-code.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <random>
#include <string>

#include "base/number.h"
#include "path/bead.h"

#include "kerf/program/gcode.h"
#include "kerf/program/post.h"
#include "kerf/sim/print.h"

namespace kerf {
namespace {

constexpr unsigned kRuns = 40;           // random paths per post
constexpr double kSmallestRadius = 0.2;  // mm; in text, smaller arcs are hard to distinguish from chords
constexpr double kTinyRadius = 0.0005;   // mm
constexpr double kVolumeSlack = 2e-3;    // mm3; E words have 5 decimals, of mm or inches

/// The machine of the random program: a laser has a beam instead of a spindle, a printer also beads, heaters
/// and fans.
enum class Work { mill, laser, print };

class RandomPath {
 public:
  /// `profile`: the coolants that it has are switched.
  RandomPath(unsigned seed, Work work, double smallest_radius, const PostProfile& profile)
      : random_(seed),
        work_(work),
        smallest_(std::log10(smallest_radius)),
        has_mist_(profile.has_m(70)),
        has_flood_(profile.has_m(80)) {}

  Toolpath make() {
    change_tool(1);
    drive();
    go(step::Rapid{point()});
    for (int i = 0; i < 120; ++i) add_step();
    return std::move(path_);
  }

 private:
  /// A printer has no tools but extruders; a T word of a print selects one of them.
  void change_tool(int number) {
    if (work_ != Work::print) path_.add(step::ToolChange{number}, OriginId::none);
  }

  /// The spindle at a random speed, or the beam at a random power.
  void drive() {
    const int speed = whole(1000, 24000);
    if (work_ != Work::laser) {
      path_.add(step::Spindle{rpm(speed), SpindleTurn::cw}, OriginId::none);
      return;
    }
    const LaserMode modes[] = {LaserMode::constant, LaserMode::dynamic, LaserMode::off};
    const LaserMode mode = modes[whole(0, 2)];
    path_.add(step::LaserPower{mode, mode == LaserMode::off ? 0.0 : 0.04 * speed}, OriginId::none);
  }

  void add_printing() {
    switch (whole(0, 4)) {
      case 4: path_.add(step::Extruder{whole(0, 3)}, OriginId::none); return;
      case 0: path_.add(step::Fan{whole(0, 2), whole(0, 255) / 255.0}, OriginId::none); return;
      case 1: add_temperature(); return;
      case 2:  // filament retracted or extruded while the nozzle is at rest
        go(step::Extrude{at_, Volume::raw(real(-10, 10)), {}, {}, feed()});
        return;
      default: go(step::Extrude{point(), Volume::raw(real(0.001, 5)), {}, {}, feed()});
    }
  }

  void add_temperature() {
    step::Temperature t{static_cast<Heater>(whole(0, 1)), 0.5 * whole(20, 500), whole(0, 1) == 0};
    if (t.heater == Heater::nozzle) t.extruder = whole(-1, 3);
    path_.add(t, OriginId::none);
  }

  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Point3 point() {
    const double size = whole(0, 3) == 0 ? 0.01 : 100.0;  // also moves near the last decimal
    return {at_.x + real(-size, size), at_.y + real(-size, size), at_.z + real(-0.1 * size, 0.1 * size)};
  }
  Feed feed() { return mm_per_min(whole(1, 3) == 1 ? whole(10, 4000) : 900); }
  template <class S>
  void go(const S& s) {
    path_.add(s, OriginId::none);
    at_ = s.to;
  }

  void add_arc() {
    const auto plane = static_cast<Plane>(whole(0, 2));
    const PlaneAxes axes = axes_of(plane);
    const double radius = std::pow(10.0, real(smallest_, 3.0));
    const double angle = real(-4, 4);
    const double sweep = whole(0, 4) == 0 ? 2.0 * std::acos(-1.0) : real(0.0, 6.28);
    const Turn turn = whole(0, 1) == 0 ? Turn::cw : Turn::ccw;
    const double u = at_[axes.u] - radius * std::cos(angle), v = at_[axes.v] - radius * std::sin(angle);
    const double end = angle + (turn == Turn::ccw ? sweep : -sweep);
    Point3 to = at_;
    to[axes.u] = u + radius * std::cos(end);
    to[axes.v] = v + radius * std::sin(end);
    if (sweep > 6.282) to = at_;
    if (whole(0, 2) == 0) to[axes.w] += real(-1, 1);
    const Point2 centre = plane == Plane::xz ? Point2{v, u} : Point2{u, v};
    go(step::Arc{to, centre, plane, turn, whole(0, 9) == 0 ? 2 : 0, feed()});
  }

  void add_step() {
    if (work_ == Work::print && whole(0, 1) == 0) return add_printing();
    switch (whole(0, 12)) {
      case 12:
        path_.add(step::Coolant{has_mist_ && whole(0, 1) == 0, has_flood_ && whole(0, 1) == 0},
                  OriginId::none);
        return;
      case 0: return go(step::Rapid{point()});
      case 1: path_.add(step::Dwell{seconds(0.25 * whole(1, 8))}, OriginId::none); return;
      case 2: return drive();
      case 3: change_tool(whole(1, 3)); return;
      case 4:
      case 5:
      case 6:
      case 7: return add_arc();
      default: return go(step::Cut{point(), feed()});
    }
  }

  std::mt19937 random_;
  Work work_;
  double smallest_;  // power of ten of the smallest radius
  bool has_mist_, has_flood_;
  Toolpath path_;
  Point3 at_;
};

/// A motion and the state in force during it.
struct Motion {
  const Step* step;
  Point3 from;
  step::Spindle spindle;
  step::LaserPower beam;
  double laid;  // mm3 of filament extruded so far
  step::Coolant coolant;
};

std::vector<Motion> motions_of(const Toolpath& path) {
  std::vector<Motion> list;
  Point3 from;
  step::Spindle spindle;
  step::LaserPower beam;
  double laid = 0.0;
  step::Coolant coolant;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    if (s.kind() == StepKind::spindle) spindle = s.spindle();
    if (s.kind() == StepKind::laser_power) beam = s.laser_power();
    if (s.kind() == StepKind::coolant) coolant = s.coolant();
    if (s.kind() == StepKind::extrude) laid += path.extrude(i).volume.mm3();
    if (!s.is_motion()) continue;
    list.push_back({&s, from, spindle, beam, laid, coolant});
    from = s.to();
  }
  return list;
}

/// Maximum distance of points of `m` (sampled) from the arc or line `original`.
double deviation(const Motion& m, const Motion& original) {
  const auto at = [](const Motion& motion, double t) {
    if (motion.step->kind() == StepKind::arc) return walk_of(*motion.step, motion.from).at(t);
    return motion.from + t * (motion.step->to() - motion.from);
  };
  double worst = 0.0;
  for (const double t : {0.25, 0.5, 0.75, 1.0}) {
    const Point3 p = at(m, t);
    double nearest = 1e300;
    if (original.step->kind() == StepKind::arc) {
      const ArcWalk walk = walk_of(*original.step, original.from);
      const PlaneAxes axes = axes_of(walk.plane);
      nearest = std::abs(std::hypot(p[axes.u] - walk.u, p[axes.v] - walk.v) - walk.start_radius);
    } else {
      const Point3 way = original.step->to() - original.from;
      const double s = dot(way, way) > 0.0 ? dot(p - original.from, way) / dot(way, way) : 0.0;
      nearest = distance(p, original.from + std::clamp(s, 0.0, 1.0) * way);
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

double length_of(const Motion& m) {
  if (m.step->kind() == StepKind::arc) return walk_of(*m.step, m.from).length();
  return distance(m.from, m.step->to());
}

std::string text_of(const Motion& m) {
  std::string text(name_of(m.step->kind()));
  for (const Point3 p : {m.from, m.step->to()})
    text += " " + exact_text(p.x) + "," + exact_text(p.y) + "," + exact_text(p.z);
  if (m.step->kind() != StepKind::arc) return text;
  const ArcWalk walk = walk_of(*m.step, m.from);
  return text + " r " + exact_text(walk.start_radius) + " sweep " + exact_text(walk.sweep) + " plane " +
         std::to_string(static_cast<int>(walk.plane)) + " centre " + exact_text(walk.u) + "," +
         exact_text(walk.v);
}

/// True if two positions are written with the same numbers.
bool same_counts(Point3 a, Point3 b, double unit) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(a[axis] - b[axis]) > 0.5 * unit + 1e-9) return false;
  return true;
}

/// Kind, feed, spindle or beam, and the filament extruded until then.
void expect_same_state(const Motion& read, const Motion& written, std::size_t w) {
  SCOPED_TRACE("motion " + std::to_string(w) + " (" + text_of(written) + ") read as " + text_of(read));
  const StepKind kind = written.step->kind();
  for (const StepKind k : {StepKind::rapid, StepKind::extrude}) ASSERT_EQ(read.step->kind() == k, kind == k);
  ASSERT_NEAR(read.step->feed().mm_per_min(), written.step->feed().mm_per_min(), 0.02);
  ASSERT_EQ(read.spindle.turn, written.spindle.turn);
  ASSERT_NEAR(read.spindle.speed.rpm(), written.spindle.speed.rpm(), 0.01);
  ASSERT_EQ(read.beam.mode, written.beam.mode);
  if (kind != StepKind::rapid) {  // not written with a rapid
    ASSERT_NEAR(read.beam.power, written.beam.power, 0.01);
  }
  ASSERT_NEAR(read.laid, written.laid, kVolumeSlack);
  ASSERT_EQ(read.coolant.mist, written.coolant.mist);
  ASSERT_EQ(read.coolant.flood, written.coolant.flood);
}

/// Heaters and fans in their order, as text.
std::vector<std::string> printing_of(const Toolpath& path) {
  std::vector<std::string> list;
  for (const Step& s : path.steps()) {
    if (s.kind() == StepKind::temperature) {
      const step::Temperature t = s.temperature();
      list.push_back("heater " + std::to_string(static_cast<int>(t.heater)) + " " +
                     number_text(t.celsius, 1) + (t.wait ? " waits" : "") + " of " +
                     std::to_string(t.extruder));
    }
    if (s.kind() == StepKind::extruder) list.push_back("extruder " + std::to_string(s.extruder().number));
    if (s.kind() == StepKind::fan)
      list.push_back("fan " + std::to_string(s.fan().fan) + " " + number_text(255 * s.fan().fraction, 0));
  }
  return list;
}

/// Compares the motions read with those written: each written motion is read as one or more, which follow its
/// curve and have its length, feed and spindle.
void expect_same(const Toolpath& written, const Toolpath& read, double unit, double chord) {
  const std::vector<Motion> want = motions_of(written), got = motions_of(read);
  std::size_t g = 0;
  for (std::size_t w = 0; w < want.size(); ++w) {
    double made = 0.0;
    bool taken = false;  // motions of length 0 count as well
    const double total = length_of(want[w]);
    // Consume motions until position and length reach the end.
    while (g < got.size()) {
      const bool there = same_counts(g == 0 ? Point3{} : got[g - 1].step->to(), want[w].step->to(), unit);
      const double slack = 0.01 * total + 40.0 * unit;
      if (taken && there && made + slack >= total) break;
      const Motion& m = got[g++];
      taken = true;
      made += length_of(m);
      ASSERT_LE(deviation(m, want[w]), 4.0 * unit + 1.1 * chord)
          << "motion " << w << " (" << text_of(want[w]) << ") read as " << text_of(m);
      expect_same_state(m, want[w], w);
      if (testing::Test::HasFatalFailure()) return;
      ASSERT_LE(made, total + slack) << "motion " << w;
    }
    const Point3 end = g == 0 ? Point3{} : got[g - 1].step->to();
    ASSERT_TRUE(same_counts(end, want[w].step->to(), unit)) << "motion " << w;
  }
  ASSERT_EQ(g, got.size()) << "more was read than written";
}

double dwell_of(const Toolpath& path) {
  double sum = 0.0;
  for (const Step& s : path.steps())
    if (s.kind() == StepKind::dwell) sum += s.dwell().time.seconds();
  return sum;
}

std::vector<unsigned> seeds() {
  if (const char* seed = std::getenv("KERF_SEED")) return {static_cast<unsigned>(std::atoi(seed))};
  std::vector<unsigned> list;
  for (unsigned seed = 1; seed <= kRuns; ++seed) list.push_back(seed);
  return list;
}

/// A post and the dialect that its programs are recognised as.
struct Loop {
  const char* post;
  GcodeDialect dialect;
  Work work = Work::mill;
};
void PrintTo(const Loop& one, std::ostream* out) { *out << one.post; }

class ClosedLoop : public testing::TestWithParam<Loop> {};

/// Writes `path` as one file that the linter accepts, and reads it again.
GcodeProgram looped(const Toolpath& path, const PostProfile& profile, PostOptions options) {
  options.program_name = "loop";
  // One file, so that it reads as one program.
  if (profile.tool_change == ToolChangePolicy::files) options.tool_change = ToolChangePolicy::ignore;
  Diagnostics diagnostics;
  const auto files = post(path, profile, options, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << to_string(d);
  if (files.size() != 1u) ADD_FAILURE() << "not one file";
  const std::string text = files.empty() ? std::string() : files[0].text;
  Diagnostics found, reading;
  EXPECT_TRUE(lint_gcode(text, profile, "written", found));
  for (const Diagnostic& d : found.list()) ADD_FAILURE() << to_string(d);
  if (const char* shown = std::getenv("KERF_SHOW")) std::ofstream(shown) << text;
  return read_gcode(text, {}, reading);
}

void expect_loop(const Loop& loop, LengthUnit unit, unsigned seed) {
  PostProfile profile = *find_post(loop.post);
  profile.spindle_dwell = Duration{};
  const Toolpath path = RandomPath(seed, loop.work, kSmallestRadius, profile).make();
  PostOptions options;
  options.unit = unit;
  const GcodeProgram program = looped(path, profile, options);
  EXPECT_EQ(program.dialect, loop.dialect);
  const double count = unit == LengthUnit::mm ? std::pow(10.0, -profile.decimals.mm)
                                              : 25.4 * std::pow(10.0, -profile.decimals.inch);
  expect_same(path, program.path, count, profile.chord.mm());
  EXPECT_NEAR(dwell_of(program.path), dwell_of(path), 1e-6);
  EXPECT_EQ(printing_of(program.path), printing_of(path));
}

TEST_P(ClosedLoop, returns_the_same_toolpath) {
  const bool inches = find_post(GetParam().post)->has_g(200);
  for (const unsigned seed : seeds()) {
    for (const LengthUnit unit : {LengthUnit::mm, LengthUnit::inch}) {
      if (unit == LengthUnit::inch && !inches) continue;
      SCOPED_TRACE("seed " + std::to_string(seed) + (unit == LengthUnit::mm ? " mm" : " inch"));
      expect_loop(GetParam(), unit, seed);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST_P(ClosedLoop, tiny_arcs_stay_tiny) {
  for (const unsigned seed : seeds()) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Toolpath path = RandomPath(seed, GetParam().work, kTinyRadius, *find_post(GetParam().post)).make();
    const GcodeProgram program = looped(path, *find_post(GetParam().post), {});
    double written = 0.0, read = 0.0;
    for (const Motion& m : motions_of(path)) written += length_of(m);
    for (const Motion& m : motions_of(program.path)) read += length_of(m);
    EXPECT_NEAR(read, written, 1e-4 * written);
    ASSERT_EQ(HasFailure(), false);
  }
}

/// A print in layers with beads of random kinds and sizes, retractions, and limits that every firmware has.
Toolpath random_print(unsigned seed) {
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Toolpath path;
  double z = 0.0;
  for (int layer = 0; layer < 8; ++layer) {
    const double height = std::round(real(8, 40)) / 100.0;
    z += height;
    Point3 at{real(0, 100), real(0, 100), z};
    path.add(step::Rapid{at}, OriginId::none);
    for (int i = 0; i < 25; ++i) {
      const double width = height + std::round(real(0, 60)) / 100.0;
      const Point3 to{at.x + real(-20, 20), at.y + real(1, 20), z};
      const Volume volume = bead_volume(mm(distance(at, to)), mm(width), mm(height));
      const auto kind = static_cast<BeadKind>(1 + static_cast<int>(real(0, kBeadKinds - 1.01)));
      path.add(step::Extrude{to, volume, mm(width), mm(height), mm_per_min(1800), kind}, OriginId::none);
      at = to;
      if (i % 5 != 4) continue;
      path.add(step::Extrude{at, mm3(-2), {}, {}, mm_per_min(2400)}, OriginId::none);
      at = {real(0, 100), real(0, 100), z};
      path.add(step::Rapid{at}, OriginId::none);
      path.add(step::Extrude{at, mm3(2), {}, {}, mm_per_min(2400)}, OriginId::none);
    }
  }
  return path;
}

std::vector<step::Extrude> beads_of(const Toolpath& path) {
  std::vector<step::Extrude> beads;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::extrude) beads.push_back(path.extrude(i));
  return beads;
}

TEST(PrintedLoop, every_firmware_returns_the_same_beads) {
  constexpr double kSlack = 1e-3;  // of the volume
  for (const char* name : {"marlin", "klipper", "reprapfirmware", "plain"}) {
    for (const double filament : {1.75, 2.85}) {
      for (unsigned seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE(std::string(name) + " seed " + std::to_string(seed));
        PostProfile profile = *find_post(name);
        profile.filament = mm(filament);
        const Toolpath path = random_print(seed);
        const GcodeProgram read = looped(path, profile, {});
        EXPECT_EQ(read.filament_diameter, filament);
        const auto want = beads_of(path), got = beads_of(read.path);
        ASSERT_EQ(got.size(), want.size());
        ASSERT_EQ(want.size(), 8u * (25u + 10u));
        for (std::size_t i = 0; i < want.size(); ++i) {
          ASSERT_LE(distance(got[i].to, want[i].to), 1e-3);
          const double rounding = 1e-5 * std::acos(-1.0) / 4.0 * filament * filament;  // of E
          ASSERT_NEAR(got[i].volume.mm3(), want[i].volume.mm3(),
                      std::max(kSlack * std::abs(want[i].volume.mm3()), rounding));
          if (want[i].volume < Volume() || want[i].width == Length()) continue;
          ASSERT_EQ(got[i].kind, want[i].kind);
          ASSERT_NEAR(got[i].width.mm(), want[i].width.mm(), 1e-5);
          ASSERT_NEAR(got[i].height.mm(), want[i].height.mm(), 1e-5);
        }
        PrintOptions options;
        options.resolution = mm(0.2);
        Diagnostics diagnostics;
        const auto before = simulate_print(path, options, diagnostics),
                   after = simulate_print(read.path, options, diagnostics);
        ASSERT_TRUE(before && after);
        EXPECT_NEAR(after->total.extruded.mm3(), before->total.extruded.mm3(),
                    kSlack * before->total.extruded.mm3());
        EXPECT_NEAR(after->total.laid.mm3(), before->total.laid.mm3(), kSlack * before->total.laid.mm3());
        ASSERT_EQ(after->layers.size(), before->layers.size());
      }
    }
  }
}

/// The limits of a program as text, in their order.
std::vector<std::string> limits_of(const Toolpath& path) {
  std::vector<std::string> list;
  for (const Step& s : path.steps()) {
    if (s.kind() != StepKind::motion_limits) continue;
    const step::MotionLimits limits = s.motion_limits();
    list.emplace_back(to_string(limits.kind));
    for (std::size_t i = 0; i < 4; ++i)
      if ((limits.given >> i & 1u) != 0)
        list.back() += " " + std::to_string(i) + ":" + number_text(limits.values[i], 3);
  }
  return list;
}

TEST(PrintedLoop, every_firmware_returns_the_limits_that_it_has) {
  using K = LimitKind;
  const std::vector<step::MotionLimits> axes{{K::axis_acceleration, {500, 600, 70, 800}, 15},
                                             {K::axis_speed, {200, 180, 12, 0}, 7},
                                             {K::acceleration, {1000, 0, 1500, 0}, 5},
                                             {K::jerk, {8, 9, 0, 2.5}, 11}},
      klipper{{K::axis_speed, {200, 200, 0, 0}, 3},
              {K::acceleration, {900, 0, 900, 0}, 5},
              {K::corner_speed, {5, 0, 0, 0}, 1}};
  for (const auto& [name, limits] :
       {std::pair{"marlin", axes}, std::pair{"reprapfirmware", axes}, std::pair{"klipper", klipper}}) {
    SCOPED_TRACE(name);
    Toolpath path;
    for (const step::MotionLimits& one : limits) path.add(one, OriginId::none);
    path.add(step::Temperature{Heater::nozzle, 200, true}, OriginId::none);
    path.add(step::Rapid{{0, 0, 0.2}}, OriginId::none);
    path.add(step::Extrude{{10, 0, 0.2}, mm3(1), {}, {}, mm_per_min(600)}, OriginId::none);
    const GcodeProgram read = looped(path, *find_post(name), {});
    EXPECT_EQ(limits_of(read.path), limits_of(path));
    EXPECT_EQ(limits_of(path).size(), limits.size());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Posts, ClosedLoop,
    testing::Values(Loop{"grbl", GcodeDialect::grbl}, Loop{"grblhal", GcodeDialect::grbl},
                    Loop{"linuxcnc", GcodeDialect::rs274}, Loop{"mach3", GcodeDialect::mach3},
                    Loop{"carbide", GcodeDialect::grbl}, Loop{"marlin", GcodeDialect::marlin, Work::print},
                    Loop{"klipper", GcodeDialect::klipper, Work::print},
                    Loop{"reprapfirmware", GcodeDialect::reprap, Work::print},
                    Loop{"laser", GcodeDialect::laser, Work::laser}),
    [](const auto& one) { return one.param.post; });

}  // namespace
}  // namespace kerf
