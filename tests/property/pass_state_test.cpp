// Passes change nothing but what they are for: over random programs of mills and lasers with state of every
// kind, the state in force at each cut, and the cut itself, are those of the source, or differ as the pass
// says. Each step has a line of its own, by which a cut of the result is known. What a post writes is read
// back with the same cuts and states. A third of the programs is on whole numbers, so that points touch and
// motions have no length. KERF_RUNS is the number of programs; 20,000 is the long run.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/codes/op.h"
#include "path/state.h"

#include "kerf/op/rework.h"
#include "kerf/path/passes.h"
#include "kerf/program/gcode.h"
#include "kerf/program/post.h"

namespace kerf {
namespace {

unsigned runs() {
  const char* given = std::getenv("KERF_RUNS");
  return given == nullptr ? 60 : static_cast<unsigned>(std::atoi(given));
}
constexpr double kNear = 1e-9;  // mm

/// Programs of parts, each cut from a safe height, with changes of state between and within them.
class StateProgram {
 public:
  explicit StateProgram(unsigned seed)
      : random_(seed), laser_(chance(5)), whole_numbers_(chance(3)), rotary_(!laser_ && chance(5)) {}

  /// Whether it has beams instead of tools and spindles.
  bool laser() const { return laser_; }
  /// Whether it has what some passes refuse: rotary axes, unknown positions, probes.
  bool refusable() const { return rotary_ || unknown_; }

  Toolpath make() {
    file_ = path_.origins().file("part.nc");
    if (laser_) return make_for_laser();
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
  Toolpath make_for_laser() {
    for (int i = 0; i < whole(2, 6); ++i) part();
    add(step::LaserPower{});
    add(step::End{});
    return std::move(path_);
  }
  double real(double low, double high) {
    const double value = std::uniform_real_distribution<double>(low, high)(random_);
    return whole_numbers_ ? std::round(value) : value;
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(int of) { return whole(1, of) == 1; }
  OriginId next() { return path_.origins().text(file_, ++line_, 1); }
  template <class Made>
  void add(const Made& step) {
    path_.add(step, next());
  }
  void cut(Point3 to) {
    add(step::Cut{to, mm_per_min(whole(1, 9) * 100)});
    if (rotary_ && chance(3)) turn();
    at_ = to;
  }
  void rapid(Point3 to) {
    add(step::Rapid{to});
    if (rotary_ && (!turned_ || chance(3))) turn();
    at_ = to;
  }
  /// The last motion turns A.
  void turn() {
    angle_ = turned_ && chance(3) ? angle_ : whole(-4, 4) * 22.5;
    turned_ = true;
    path_.set_extra(path_.size() - 1, {.abc = std::array<double, 3>{angle_, 0, 0}, .unknown_abc = 6});
  }
  /// To the top of the machine: Z is unknown in work coordinates.
  void retract() {
    add(step::Rapid{{at_.x, at_.y, 0}});
    path_.set_unknown_axes(path_.size() - 1, 4);
    path_.set_reference(path_.size() - 1, Reference::machine, 4);
    unknown_ = true;
  }
  void probe() {
    rapid({at_.x, at_.y, 9});
    add(step::Probe{{at_.x, at_.y, -5}, mm_per_min(50)});
    path_.set_unknown_axes(path_.size() - 1, 4);
    path_.set_probed_axes(path_.size() - 1, 4, 4, 0);
    unknown_ = true;
    rapid({at_.x, at_.y, 9});
  }

  void section(int tool) {
    if (tool > 1 && chance(8)) retract();
    add(step::ToolChange{tool});
    if (chance(8)) add(step::ToolLength{});
    if (chance(8)) add(step::ToolLength{.kind = ToolLengthKind::given, .offset = {0, 0, 12.5}, .axes = 4});
    if (chance(2)) add(step::ToolLength{.kind = ToolLengthKind::table, .number = tool});
    if (chance(2)) spindle();
    for (int i = 0; i < whole(1, 4); ++i) part();
    if (chance(2)) add(step::Spindle{});
    if (chance(3)) rapid({0, 0, 9});
    if (chance(12)) probe();
    if (chance(6)) add(step::Pause{chance(2) ? PauseKind::always : PauseKind::optional});
  }
  void spindle() {
    const SpindleTurn turn = chance(4) ? SpindleTurn::ccw : SpindleTurn::cw;
    const bool by_hand = !std::exchange(speed_stated_, true) && chance(8);  // words cannot return to it
    if (by_hand) return add(step::Spindle{rpm(0), turn});
    const Feed surface = chance(6) ? mm_per_min(whole(50, 300) * 1000) : Feed{};
    add(step::Spindle{rpm(whole(5, 20) * 1000), turn, surface});
  }
  void beam() {
    const LaserMode mode = chance(2) ? LaserMode::constant : LaserMode::dynamic;
    add(step::LaserPower{mode, static_cast<double>(whole(1, 1000))});
  }
  void coolant() { add(step::Coolant{chance(2), chance(2)}); }
  void any_state() {
    if (laser_) return chance(3) ? coolant() : beam();
    switch (whole(0, 5)) {
      case 0: return spindle();
      case 1: return coolant();
      case 2: return add(step::PathMode{PathModeKind::blend, mm(0.01 * whole(1, 9))});
      case 3: return add(step::Note{"between"});
      case 4: return add(step::Dwell{seconds(whole(1, 3))});
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
    if (!laser_ && chance(4)) select();
    any_state();
    if (laser_) return engraving();
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
  void engraving() {
    rapid({real(-40, 40), real(-40, 40), 0});
    beam();
    for (int i = 0; i < whole(1, 5); ++i) {
      if (chance(2)) any_state();
      move();
    }
    if (chance(2)) add(step::LaserPower{});
  }
  void move() {
    if (chance(9)) return cut(at_);  // a motion without length
    const double z = laser_ ? 0.0 : real(-7, -1);
    const Point3 to{real(-40, 40), real(-40, 40), z};
    if (chance(2)) return cut(to);
    step::Arc arc;
    arc.feed = mm_per_min(500), arc.turn = chance(2) ? Turn::cw : Turn::ccw;
    const double radius = real(1, 9);
    if (chance(3) || laser_) {  // whole turns, or a helix
      arc.centre = {at_.x + radius, at_.y};
      arc.to = {at_.x, at_.y, chance(2) ? at_.z : to.z};
      arc.extra_turns = chance(3) ? whole(1, 3) : 0;
      add(arc);
      at_ = arc.to;
      return;
    }
    switch (whole(0, 2)) {
      case 0:  // half a circle, or a helix
        arc.centre = {at_.x + radius, at_.y};
        arc.to = {at_.x + 2 * radius, at_.y, chance(2) ? at_.z : to.z};
        break;
      case 1:
        arc.plane = Plane::xz, arc.centre = {at_.x + radius, at_.z}, arc.turn = Turn::cw;
        arc.to = {at_.x + 2 * radius, chance(3) ? to.y : at_.y, at_.z};
        break;
      default:
        arc.plane = Plane::yz, arc.centre = {at_.y + radius, at_.z}, arc.turn = Turn::ccw;
        arc.to = {chance(3) ? to.x : at_.x, at_.y + 2 * radius, at_.z};
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
  double angle_ = 0.0;
  bool related_ = false, turned_ = false, unknown_ = false, speed_stated_ = false;
  bool laser_, whole_numbers_, rotary_;
};

struct CutRecord {
  std::size_t step = 0;
  std::uint32_t line = 0;
  Point3 from, halfway, to;
  double length = 0.0;
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
    const double length =
        path[i].kind() == StepKind::arc ? walk_of(path[i], from.at).length() : distance(from.at, to);
    made.push_back({i, path.origins().line(path[i].origin()), from.at, halfway, to, length, from.unknown,
                    path[i].feed().mm_per_min(), reader.state()});
  }
  return made;
}

constexpr StateParts kMill = bit_of(StatePart::work_zero) | bit_of(StatePart::tool) |
                             bit_of(StatePart::tool_length) | bit_of(StatePart::path_mode) |
                             bit_of(StatePart::spindle) | bit_of(StatePart::coolant) |
                             bit_of(StatePart::laser) | bit_of(StatePart::rotary);

/// What a post writes of it; zeros are compared by the positions of the cuts.
constexpr StateParts kRead = kMill & ~bit_of(StatePart::work_zero);
constexpr double kWritten = 3e-3;  // mm, of three decimals, twice where a centre is relative

std::string differing(const CutRecord& a, const CutRecord& b, StateParts parts = kMill) {
  return to_text(difference(a.state, b.state) & parts);
}
void expect_near(Point3 a, Point3 b, std::uint32_t line) {
  EXPECT_LT(distance(a, b), 1e-6) << "line " << line;
}

class PassStates : public testing::TestWithParam<unsigned> {
 protected:
  StateProgram program_{GetParam()};
  Toolpath path_ = program_.make();
  std::vector<CutRecord> source_ = cuts_of(path_);

  const CutRecord* source_of(std::uint32_t line) const {
    for (const CutRecord& c : source_)
      if (c.line == line) return &c;
    return nullptr;
  }
  /// Whether a pass has made something; it may refuse programs with what it cannot know.
  template <class Made>
  bool made_or_refused(const Made& made, const Diagnostics& diagnostics) const {
    if (made) return true;
    EXPECT_FALSE(diagnostics.list().empty());
    if (diagnostics.list().empty()) return false;
    EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
    EXPECT_TRUE(program_.refusable() || program_.laser()) << diagnostics.list().back().message;
    return false;
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
  if (!made_or_refused(made, diagnostics)) return;
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
  if (!made_or_refused(half, diagnostics)) return;
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
  if (!made_or_refused(made, diagnostics)) return;
  expect_states(*made);
  // The last pass is the source; passes before it stay above their level, which falls by no more than a pass.
  std::map<std::uint32_t, std::vector<double>> lows;
  for (const CutRecord& c : cuts_of(*made))
    if (c.from.xy() != c.halfway.xy()) lows[c.line].push_back(std::min(c.from.z, c.to.z));
  for (const CutRecord& was : source_) {
    bool last = false;
    // The last pass of a loop starts at the level before, a helix there in chords down to its end.
    const bool first = was.from.xy() == was.to.xy();
    for (const CutRecord& c : cuts_of(*made)) {
      const double apart = distance(c.to, was.to) + (first ? 0.0 : distance(c.from, was.from));
      last = last || (c.line == was.line && apart < kNear);
    }
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
  if (!made_or_refused(append_program(path, other, diagnostics), diagnostics)) return;
  const PathState last = cuts_of(path).back().state;
  EXPECT_EQ(difference(last, {}) & (bit_of(StatePart::spindle) | bit_of(StatePart::coolant)), 0u);
  if (program_.laser()) return;
  // What stays in force is reported.
  ASSERT_FALSE(diagnostics.list().empty());
  EXPECT_NE(diagnostics.list().back().message.find("the tool length"), std::string::npos);
}

/// How the cuts that were read differ from the written one. An arc may be read as several.
std::string differing_when_read(const CutRecord& written, const std::vector<CutRecord>& read,
                                std::size_t& next) {
  double length = 0.0;
  std::string differences;
  for (bool first = true; next < read.size(); first = false) {
    const CutRecord& one = read[next++];
    if (first && distance(written.from, one.from) > kWritten) return "the start";
    differences = differing(written, one, kRead);
    if (written.unknown != one.unknown) differences += " unknown axes";
    if (std::abs(written.feed - one.feed) > 0.01) differences += " the feed";
    if (!differences.empty()) return differences;
    length += one.length;
    if (distance(written.to, one.to) <= kWritten && length > 0.99 * written.length - kWritten)
      return length < 1.01 * written.length + kWritten ? "" : "the length";
  }
  return "the end";
}

/// Each post writes the program so that it is read back as the same, or says what it leaves out.
TEST_P(PassStates, posts_are_read_back_with_the_state_of_each_cut) {
  for (const char* name : {"linuxcnc", "mach3", "grblhal", "grbl", "carbide", "laser"}) {
    if (program_.laser() != (std::string_view(name) == "laser")) continue;
    PostProfile profile = *find_post(name);
    profile.spindle_dwell = Duration{};
    PostOptions options;
    options.tool_change = ToolChangePolicy::command;
    options.tool_lengths = ToolLengths::by_path;
    Diagnostics diagnostics, reading;
    const auto files = post(path_, profile, options, diagnostics);
    const bool whole = std::none_of(diagnostics.list().begin(), diagnostics.list().end(),
                                    [](const auto& d) { return d.severity != Severity::note; });
    if (!whole && std::string_view(name) != "linuxcnc") continue;  // its controller lacks something
    ASSERT_TRUE(whole) << to_string(diagnostics.list().back());
    ASSERT_EQ(files.size(), 1u);
    GcodeReadOptions given;
    given.dialect = dialect_named(name);
    const GcodeProgram read = read_gcode(files[0].text, given, reading);
    const std::vector<CutRecord> cuts = cuts_of(read.path);
    std::size_t next = 0;
    for (const CutRecord& was : source_)
      ASSERT_EQ(differing_when_read(was, cuts, next), "")
          << name << ", line " << was.line << " of the source, cut " << next << " of\n"
          << files[0].text;
    EXPECT_EQ(next, cuts.size()) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Random, PassStates, testing::Range(1u, runs() + 1));

}  // namespace
}  // namespace kerf
