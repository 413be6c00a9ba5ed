// Passes change nothing but what they are for: over random programs with state of every kind that milling
// has, the state in force at each cut, and the cut itself, are those of the source, or differ as the pass
// says. Each step has a line of its own, by which a cut of the result is known.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <vector>

#include "path/state.h"

#include "kerf/op/rework.h"
#include "kerf/path/passes.h"

namespace kerf {
namespace {

constexpr unsigned kRuns = 60;
constexpr double kNear = 1e-9;  // mm

/// Programs of parts, each cut from a safe height, with changes of state between and within them.
class StateProgram {
 public:
  explicit StateProgram(unsigned seed) : random_(seed) {}

  Toolpath make() {
    file_ = path_.origins().file("part.nc");
    if (chance(2)) {  // zeros at a known distance
      add(step::WorkZero{.kind = ZeroKind::offset, .system = 1, .axes = 7});
      add(step::WorkZero{.kind = ZeroKind::offset, .system = 2, .axes = 7, .zero = {5, 6, 0}});
      related_ = true;
    }
    add(step::PathMode{PathModeKind::exact_path, {}});
    add(step::ToolLength{.kind = ToolLengthKind::table, .number = 1});
    for (int tool = 1; tool <= whole(1, 3); ++tool) section(tool);
    add(step::Spindle{});
    add(step::Coolant{});
    add(step::End{});
    return std::move(path_);
  }

 private:
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(int of) { return whole(1, of) == 1; }
  OriginId next() { return path_.origins().text(file_, ++line_, 1); }
  template <class Made>
  void add(const Made& step) {
    path_.add(step, next());
  }
  void cut(Point3 to) {
    add(step::Cut{to, mm_per_min(whole(1, 9) * 100)});
    at_ = to;
  }
  void rapid(Point3 to) {
    add(step::Rapid{to});
    at_ = to;
  }

  void section(int tool) {
    add(step::ToolChange{tool});
    if (chance(2)) add(step::ToolLength{.kind = ToolLengthKind::table, .number = tool});
    if (chance(2)) spindle();
    for (int i = 0; i < whole(1, 4); ++i) part();
    if (chance(2)) add(step::Spindle{});
    if (chance(3)) rapid({0, 0, 9});
  }
  void spindle() {
    add(step::Spindle{rpm(whole(5, 20) * 1000), chance(4) ? SpindleTurn::ccw : SpindleTurn::cw});
  }
  void coolant() { add(step::Coolant{chance(2), chance(2)}); }
  void any_state() {
    switch (whole(0, 4)) {
      case 0: return spindle();
      case 1: return coolant();
      case 2: return add(step::PathMode{PathModeKind::blend, mm(0.01 * whole(1, 9))});
      case 3: return add(step::Note{"between"});
      default: return;
    }
  }
  void select() {
    const int system = whole(1, 2);
    const bool other = std::exchange(system_, system) != system;
    const Point3 zero = related_ && system == 2 ? Point3{5, 6, 0} : Point3{};
    add(step::WorkZero{.system = system, .zero = zero, .unknown = other && !related_ ? 7u : 0u});
  }

  void part() {
    if (chance(4)) select();
    any_state();
    const Point2 start{real(-40, 40), real(-40, 40)};
    rapid({start.x, start.y, 9});
    if (chance(3)) spindle();
    rapid({start.x, start.y, chance(4) ? real(-6, -1) : 2});  // also below the surface
    if (chance(2)) cut({start.x, start.y, real(-7, -6)});
    for (int i = 0; i < whole(1, 5); ++i) {
      if (chance(2)) any_state();
      move();
    }
    if (chance(3)) any_state();
    rapid({at_.x, at_.y, 9});
    if (chance(3)) add(step::Spindle{});
  }
  void move() {
    const Point3 to{real(-40, 40), real(-40, 40), real(-7, -1)};
    if (chance(2)) return cut(to);
    step::Arc arc;
    arc.feed = mm_per_min(500), arc.turn = chance(2) ? Turn::cw : Turn::ccw;
    const double radius = real(1, 9);
    switch (whole(0, 2)) {
      case 0:  // half a circle, or a helix
        arc.centre = {at_.x + radius, at_.y};
        arc.to = {at_.x + 2 * radius, at_.y, chance(2) ? at_.z : to.z};
        break;
      case 1:
        arc.plane = Plane::xz, arc.centre = {at_.x + radius, at_.z}, arc.turn = Turn::cw;
        arc.to = {at_.x + 2 * radius, at_.y, at_.z};
        break;
      default:
        arc.plane = Plane::yz, arc.centre = {at_.y + radius, at_.z}, arc.turn = Turn::ccw;
        arc.to = {at_.x, at_.y + 2 * radius, at_.z};
        break;
    }
    add(arc);
    at_ = arc.to;
  }

  std::mt19937 random_;
  Toolpath path_;
  std::uint32_t file_ = 0, line_ = 0;
  Point3 at_{0, 0, 9};
  int system_ = 1;
  bool related_ = false;
};

struct CutRecord {
  std::size_t step = 0;
  std::uint32_t line = 0;
  Point3 from, halfway, to;
  unsigned unknown = 0;  // of `from`
  double feed = 0.0;
  PathState state;
};

std::vector<CutRecord> cuts_of(const Toolpath& path) {
  std::vector<CutRecord> made;
  StateReader reader(path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!path[i].is_cutting()) continue;
    reader.to(i);
    const PathPosition from = reader.state().position;
    const Point3 to = path[i].to();
    const Point3 halfway =
        path[i].kind() == StepKind::arc ? walk_of(path[i], from.at).at(0.5) : 0.5 * (from.at + to);
    made.push_back({i, path.origins().line(path[i].origin()), from.at, halfway, to, from.unknown,
                    path[i].feed().mm_per_min(), reader.state()});
  }
  return made;
}

constexpr StateParts kMill = bit_of(StatePart::work_zero) | bit_of(StatePart::tool) |
                             bit_of(StatePart::tool_length) | bit_of(StatePart::path_mode) |
                             bit_of(StatePart::spindle) | bit_of(StatePart::coolant);

std::string differing(const CutRecord& a, const CutRecord& b, StateParts parts = kMill) {
  return to_text(difference(a.state, b.state) & parts);
}
void expect_near(Point3 a, Point3 b, std::uint32_t line) {
  EXPECT_LT(distance(a, b), 1e-6) << "line " << line;
}

class PassStates : public testing::TestWithParam<unsigned> {
 protected:
  Toolpath path_ = StateProgram(GetParam()).make();
  std::vector<CutRecord> source_ = cuts_of(path_);

  const CutRecord* source_of(std::uint32_t line) const {
    for (const CutRecord& c : source_)
      if (c.line == line) return &c;
    return nullptr;
  }
  /// All cuts of the result have the state of the source's cut of their line.
  void expect_states(const Toolpath& made) const {
    for (const CutRecord& c : cuts_of(made)) {
      const CutRecord* was = source_of(c.line);
      ASSERT_NE(was, nullptr) << c.line;
      EXPECT_EQ(differing(*was, c), "") << "line " << c.line;
      EXPECT_EQ(c.unknown, 0u) << "line " << c.line;
    }
  }
  /// The same cuts in the same order, each at the position `map` of the source's.
  template <class Map>
  void expect_mapped(const Toolpath& made, Map map) const {
    const std::vector<CutRecord> cuts = cuts_of(made);
    ASSERT_EQ(cuts.size(), source_.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      expect_near(cuts[i].from, map(source_[i].from), source_[i].line);
      expect_near(cuts[i].halfway, map(source_[i].halfway), source_[i].line);
      expect_near(cuts[i].to, map(source_[i].to), source_[i].line);
    }
    expect_states(made);
  }
};

TEST_P(PassStates, copies_are_cut_as_the_source) {
  Diagnostics diagnostics;
  const auto made = repeated(path_, {.columns = 2, .rows = 2, .pitch = {100, 90}}, diagnostics);
  ASSERT_TRUE(made) << diagnostics.list().back().message;
  expect_states(*made);
  std::map<std::uint32_t, std::vector<CutRecord>> copies;
  for (const CutRecord& c : cuts_of(*made)) copies[c.line].push_back(c);
  for (const CutRecord& was : source_) {
    const std::vector<CutRecord>& all = copies[was.line];
    ASSERT_EQ(all.size(), 4u);
    const Point3 by[] = {{0, 0, 0}, {100, 0, 0}, {100, 90, 0}, {0, 90, 0}};
    for (std::size_t k = 0; k < 4; ++k) {
      expect_near(all[k].from, was.from + by[k], was.line);
      expect_near(all[k].halfway, was.halfway + by[k], was.line);
      expect_near(all[k].to, was.to + by[k], was.line);
      EXPECT_EQ(all[k].feed, was.feed);
    }
  }
}

TEST_P(PassStates, transformed_cuts_are_the_mapped_ones) {
  Diagnostics diagnostics;
  const auto half = transformed(path_, {.rotate = degrees(180), .move = {1, 2, 3}}, diagnostics);
  ASSERT_TRUE(half);
  expect_mapped(*half, [](Point3 p) { return Point3{1 - p.x, 2 - p.y, p.z + 3}; });
  const auto quarter = transformed(path_, {.mirror = Mirror::y, .rotate = degrees(-90)}, diagnostics);
  ASSERT_TRUE(quarter);
  expect_mapped(*quarter, [](Point3 p) { return Point3{-p.y, -p.x, p.z}; });
  const auto turned = transformed(path_, {.scale = 2.0, .rotate = degrees(33)}, diagnostics);
  ASSERT_TRUE(turned);
  expect_states(*turned);
}

TEST_P(PassStates, passes_have_the_state_of_their_cut) {
  Diagnostics diagnostics;
  const double stepdown = 1.7;
  const auto made = step_down(path_, {.top = 0, .stepdown = mm(stepdown)}, diagnostics);
  ASSERT_TRUE(made) << diagnostics.list().back().message;
  expect_states(*made);
  // The last pass is the source; passes before it stay above their level, which falls by no more than a pass.
  std::map<std::uint32_t, std::vector<double>> lows;
  for (const CutRecord& c : cuts_of(*made))
    if (c.from.xy() != c.to.xy()) lows[c.line].push_back(std::min(c.from.z, c.to.z));
  for (const CutRecord& was : source_) {
    bool last = false;
    for (const CutRecord& c : cuts_of(*made))
      last = last || (c.line == was.line && distance(c.from, was.from) + distance(c.to, was.to) < kNear);
    EXPECT_TRUE(last) << was.line;
    double floor = 0.0;
    for (const double low : lows[was.line]) {
      EXPECT_LE(floor - low, stepdown + kNear) << was.line;
      floor = std::min(floor, low);
    }
  }
}

TEST_P(PassStates, resumed_programs_are_the_rest_of_the_source) {
  for (std::uint32_t line = 2; line < path_.size(); line += 5) {
    Diagnostics diagnostics;
    const auto rest = resume_from(path_, {.line = line, .safe_z = 20}, diagnostics);
    if (!rest) continue;  // from an unknown position, or no motion follows
    std::vector<CutRecord> cuts = cuts_of(rest->path), left;
    for (const CutRecord& c : source_)
      if (c.line >= line) left.push_back(c);
    ASSERT_LE(left.size(), cuts.size());
    ASSERT_LE(cuts.size(), left.size() + 1);  // the way down
    cuts.erase(cuts.begin(), cuts.end() - static_cast<std::ptrdiff_t>(left.size()));
    for (std::size_t i = 0; i < left.size(); ++i) {
      EXPECT_EQ(cuts[i].line, left[i].line);
      expect_near(cuts[i].from, left[i].from, line);
      expect_near(cuts[i].to, left[i].to, line);
      EXPECT_EQ(differing(left[i], cuts[i]), "") << "resumed at " << line << ", line " << cuts[i].line;
    }
  }
}

TEST_P(PassStates, ordered_and_shortened_programs_keep_the_state_of_each_cut) {
  const Ordered ordered = order_cuts(path_, {});
  expect_states(ordered.path);
  EXPECT_EQ(cuts_of(ordered.path).size(), source_.size());
  expect_mapped(shorten_rapids(path_).path, [](Point3 p) { return p; });
  expect_states(arcs_to_chords(path_, mm(0.01)).path);
  expect_states(chords_to_arcs(arcs_to_chords(path_, mm(0.001)).path, {}).path);
  expect_states(join_straight(path_, mm(0.01)).path);
}

TEST_P(PassStates, leads_keep_the_state_of_each_cut) {
  Diagnostics diagnostics;
  const auto made = add_leads(path_, {.lead_in = {LeadKind::arc, mm(1)}, .finish = mm(0.2)}, diagnostics);
  ASSERT_TRUE(made);
  expect_states(made->path);
}

TEST_P(PassStates, joined_programs_start_with_all_off) {
  Toolpath other;
  other.add(step::Rapid{{0, 0, 9}}, OriginId::none);
  other.add(step::Cut{{0, 0, -1}, mm_per_min(100)}, OriginId::none);
  Diagnostics diagnostics;
  Toolpath path;
  for (std::size_t i = 0; i < path_.size(); ++i)
    if (path_[i].kind() != StepKind::work_zero) path.add_copy(path_, i);
  ASSERT_TRUE(append_program(path, other, diagnostics));
  const PathState last = cuts_of(path).back().state;
  EXPECT_EQ(difference(last, {}) & (bit_of(StatePart::spindle) | bit_of(StatePart::coolant)), 0u);
  // What stays in force is reported.
  ASSERT_FALSE(diagnostics.list().empty());
  EXPECT_NE(diagnostics.list().back().message.find("the tool length"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Random, PassStates, testing::Range(1u, kRuns + 1));

}  // namespace
}  // namespace kerf
