// The live simulation against the plain one: after every edit, at every step.
#include "kerf/sim/live.h"

#include <gtest/gtest.h>
#include <random>

#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

struct Move {
  StepKind kind = StepKind::cut;
  Point3 to;     // of an arc: the end of half a circle or helix
  int tool = 0;  // changed to before the motion; 0: unchanged
  bool note = false;
};

ToolTable two_tools() {
  ToolTable tools;
  Diagnostics diagnostics;
  tools.set(1, *make_tool(1, shape::Ball{mm(3), {}}, {}, {}, diagnostics));
  tools.set(2, *make_tool(2, shape::TSlot{mm(8), mm(2), mm(4), {}}, {}, {}, diagnostics));
  return tools;
}

Stock block() {
  Stock stock;
  stock.block = {{0, 0, -10}, {50, 40, 0}};
  return stock;
}

Toolpath path_of(const std::vector<Move>& moves) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  Point3 at{0, 0, 5};
  path.add(step::Rapid{at}, OriginId::none);
  for (const Move& move : moves) {
    if (move.note) path.add(step::Note{"here"}, OriginId::none);
    if (move.tool != 0) path.add(step::ToolChange{move.tool}, OriginId::none);
    if (move.kind == StepKind::rapid) path.add(step::Rapid{move.to}, OriginId::none);
    if (move.kind == StepKind::cut)
      path.add(step::Cut{.to = move.to, .feed = mm_per_min(500)}, OriginId::none);
    if (move.kind == StepKind::arc)
      path.add(step::Arc{.to = move.to,
                         .centre = {0.5 * (at.x + move.to.x), 0.5 * (at.y + move.to.y)},
                         .feed = mm_per_min(500)},
               OriginId::none);
    at = move.to;
  }
  return path;
}

class RandomJob {
 public:
  explicit RandomJob(unsigned seed) : random_(seed) {
    for (int k = 0; k < 60; ++k) moves_.push_back(move());
  }
  const std::vector<Move>& moves() const { return moves_; }
  /// Changes, adds or removes a few motions at a random position.
  void edit() {
    const auto at = static_cast<std::ptrdiff_t>(pick(moves_.size()));
    switch (pick(4)) {
      case 0: moves_[static_cast<std::size_t>(at)] = move(); break;
      case 1: moves_.insert(moves_.begin() + at, {move(), move(), move()}); break;
      case 2: moves_.erase(moves_.begin() + at); break;
      default: moves_[static_cast<std::size_t>(at)].note = !moves_[static_cast<std::size_t>(at)].note;
    }
  }
  std::size_t pick(std::size_t below) { return random_() % below; }

 private:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Move move() {
    Move out;
    // Short motions, so that an edit leaves most tiles unchanged.
    const Point3 near = moves_.empty() ? Point3{25, 20, 0} : moves_.back().to;
    out.to = {std::clamp(near.x + number(-8, 8), -5.0, 55.0), std::clamp(near.y + number(-8, 8), -5.0, 45.0),
              pick(20) == 0 ? -10.5 : number(-4, 1)};  // also below the floor
    if (pick(8) == 0) out.kind = StepKind::rapid;
    if (pick(5) == 0) out.kind = StepKind::arc;
    if (pick(10) == 0) out.tool = 1 + static_cast<int>(pick(2));
    return out;
  }

  std::mt19937 random_;
  std::vector<Move> moves_;
};

/// Sweeps are cut in groups, and results within a group are rounded differently where a batch ends elsewhere:
/// some ulps on the steep flank of a ball.
constexpr float kRounding = 1e-4f;  // mm

void expect_same_columns(const Workpiece& a, const Workpiece& b) {
  const ColumnGrid ga = a.grid(), gb = b.grid();
  ASSERT_EQ(ga.first, gb.first);
  for (std::size_t k = 0; k < ga.intervals.size(); ++k) {
    const Interval &x = ga.intervals[k], &y = gb.intervals[k];
    ASSERT_TRUE(std::abs(x.low - y.low) <= kRounding && std::abs(x.high - y.high) <= kRounding &&
                x.low_step == y.low_step && x.high_step == y.high_step)
        << "interval " << k << ": " << x.low << ".." << x.high << " by " << x.low_step << ", " << x.high_step
        << " and " << y.low << ".." << y.high << " by " << y.low_step << ", " << y.high_step;
  }
  EXPECT_EQ(ga.cut_through, gb.cut_through);
}

Simulation plain(const Toolpath& path, const Stock& stock, const SimulationOptions& options) {
  Diagnostics diagnostics;
  auto simulation = simulate(path, two_tools(), stock, options, diagnostics);
  EXPECT_TRUE(simulation);
  return std::move(*simulation);
}

void expect_same(const LiveSimulation& live, const Simulation& simulation) {
  ASSERT_NE(live.workpiece(), nullptr);
  expect_same_columns(*live.workpiece(), simulation.workpiece);
  const std::vector<Hazard> hazards = live.hazards();
  ASSERT_EQ(hazards.size(), simulation.hazards.size());
  for (std::size_t k = 0; k < hazards.size(); ++k) {
    const Hazard &a = hazards[k], &b = simulation.hazards[k];
    EXPECT_TRUE(a.kind == b.kind && a.step == b.step && a.at == b.at);
    EXPECT_NEAR(a.depth.mm(), b.depth.mm(), kRounding);
    EXPECT_NEAR(a.removed.mm3(), b.removed.mm3(), 1e-5 * b.removed.mm3());
  }
}

LiveOptions coarse() {
  LiveOptions options;
  options.simulation.resolution = mm(0.2);
  options.simulation.threads = 2;
  options.states = 5;
  return options;
}

class LiveEdits : public ::testing::TestWithParam<unsigned> {};

TEST_P(LiveEdits, MatchThePlainSimulation) {
  RandomJob job(GetParam());
  const LiveOptions options = coarse();
  LiveSimulation live(two_tools(), block(), options);
  for (int edit = 0; edit < 12; ++edit) {
    Diagnostics diagnostics;
    const Toolpath path = path_of(job.moves());
    const auto done = live.update(path, diagnostics);
    ASSERT_TRUE(done && !done->stopped);
    const Simulation whole = plain(path, block(), options.simulation);
    expect_same(live, whole);
    const std::size_t steps = job.pick(path.size() + 1);
    Toolpath part;
    for (std::size_t i = 0; i < steps; ++i) part.add_copy(path, i);
    const auto then = live.at(steps);
    ASSERT_TRUE(then);
    expect_same_columns(*then, plain(part, block(), options.simulation).workpiece);
    if (HasFatalFailure()) return;
    job.edit();
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, LiveEdits, ::testing::Range(1u, 25u));

TEST(Live, AnEditAffectsOnlyItsTiles) {
  std::vector<Move> moves;
  for (int k = 0; k < 10; ++k) {
    moves.push_back({StepKind::rapid, {5.0 * k, 2, 5}, 0, false});
    moves.push_back({StepKind::cut, {5.0 * k, 2, -1}, 0, false});
    moves.push_back({StepKind::cut, {5.0 * k, 38, -1}, 0, false});
    moves.push_back({StepKind::rapid, {5.0 * k, 38, 5}, 0, false});
  }
  LiveOptions options;
  options.simulation.resolution = mm(0.05);  // tiles of 3.2 mm
  LiveSimulation live(two_tools(), block(), options);
  Diagnostics diagnostics;
  ASSERT_TRUE(live.update(path_of(moves), diagnostics));
  moves[2].to.z = moves[3].to.z = -2;
  moves[3].to.z = 5;
  const Toolpath path = path_of(moves);
  const auto done = live.update(path, diagnostics);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->motions_kept, path.size() - 1 - 2);  // the cut and the retract that starts at its end
  for (const ColumnBlock& changed : done->redone) EXPECT_LT(changed.i * 0.05, 5.0);
  EXPECT_FALSE(done->redone.empty());
  expect_same(live, plain(path, block(), options.simulation));
  const auto same = live.update(path, diagnostics);
  EXPECT_TRUE(same->redone.empty());
}

TEST(Live, ChunksListTheChangedColumns) {
  RandomJob job(3);
  const LiveOptions options = coarse();
  LiveSimulation live(two_tools(), block(), options);
  std::vector<bool> seen(static_cast<std::size_t>(250 * 200), false);
  std::size_t chunks = 0, steps = 0;
  Diagnostics diagnostics;
  ASSERT_TRUE(live.update(path_of(job.moves()), diagnostics, nullptr, [&](const LiveChunk& chunk) {
    ++chunks;
    EXPECT_GE(chunk.steps_done, steps);
    steps = chunk.steps_done;
    for (const ColumnBlock& b : chunk.changed)
      for (int j = b.j; j < b.j + b.ny; ++j)
        for (int i = b.i; i < b.i + b.nx; ++i) seen[static_cast<std::size_t>(j * 250 + i)] = true;
  }));
  EXPECT_GE(chunks, options.states);
  EXPECT_EQ(steps, live.path().size());
  for (int j = 0; j < 200; ++j)
    for (int i = 0; i < 250; ++i) {
      const std::vector<Interval> column = live.workpiece()->column(i, j);
      const bool uncut = column.size() == 1 && column[0].high == 10.0f && column[0].low == 0.0f;
      EXPECT_TRUE(uncut || seen[static_cast<std::size_t>(j * 250 + i)]);
    }
}

TEST(Live, CutsBelowTheFloorComeAndGoWithTheirMotions) {
  std::vector<Move> moves{{StepKind::rapid, {10, 10, 5}, 0, false},
                          {StepKind::cut, {10, 10, -1}, 0, false},
                          {StepKind::cut, {20, 10, -11.5}, 0, false},  // the floor is at Z-10
                          {StepKind::cut, {20, 30, -1}, 0, false},
                          {StepKind::cut, {40, 30, -1}, 0, false}};
  LiveSimulation live(two_tools(), block(), coarse());
  Diagnostics diagnostics;
  const auto below_floor = [&] {
    std::vector<std::pair<std::uint32_t, double>> found;  // step and depth
    for (const Hazard& h : live.hazards())
      if (h.kind == HazardKind::below_floor) found.emplace_back(h.step, std::round(100 * h.depth.mm()) / 100);
    return found;
  };
  using Found = std::vector<std::pair<std::uint32_t, double>>;
  ASSERT_TRUE(live.update(path_of(moves), diagnostics));
  EXPECT_EQ(below_floor(), (Found{{4, 1.5}, {5, 1.5}})) << "down to it, and up from it";
  moves[2].to.z = -1;
  ASSERT_TRUE(live.update(path_of(moves), diagnostics));
  EXPECT_EQ(below_floor(), Found{});
  moves[4].to.z = -12;
  ASSERT_TRUE(live.update(path_of(moves), diagnostics));
  EXPECT_EQ(below_floor(), (Found{{6, 2.0}}));
  moves.insert(moves.begin() + 1, {StepKind::cut, {5, 5, -1}, 0, false});
  ASSERT_TRUE(live.update(path_of(moves), diagnostics));
  EXPECT_EQ(below_floor(), (Found{{7, 2.0}})) << "the same motion, one step later";
  moves.pop_back();
  ASSERT_TRUE(live.update(path_of(moves), diagnostics));
  EXPECT_EQ(below_floor(), Found{});
}

TEST(Live, AnErrorChangesNothing) {
  RandomJob job(4);
  LiveSimulation live(two_tools(), block(), coarse());
  EXPECT_EQ(live.workpiece(), nullptr);
  EXPECT_FALSE(live.at(0));
  Diagnostics diagnostics;
  ASSERT_TRUE(live.update(path_of(job.moves()), diagnostics));
  const double removed = live.removed().mm3();
  std::vector<Move> wrong = job.moves();
  wrong[7].tool = 9;
  EXPECT_FALSE(live.update(path_of(wrong), diagnostics));
  EXPECT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(live.removed().mm3(), removed);
  EXPECT_GT(removed, 0.0);
}

/// Requests a stop after `polls` questions.
class StopAfter final : public Progress {
 public:
  explicit StopAfter(int polls) : polls_(polls) {}
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return --polls_ < 0; }

 private:
  int polls_;
};

TEST(Live, AStoppedUpdateIsRepeated) {
  RandomJob job(5);
  const LiveOptions options = coarse();
  LiveSimulation live(two_tools(), block(), options);
  Diagnostics diagnostics;
  const Toolpath path = path_of(job.moves());
  const Simulation whole = plain(path, block(), options.simulation);
  bool stopped = true;
  int polls = 0;
  for (; stopped; ++polls) {
    StopAfter stop(polls);
    const auto update = live.update(path, diagnostics, &stop);
    ASSERT_TRUE(update);
    stopped = update->stopped;
  }
  EXPECT_GT(polls, 3);  // stopped between tiles of a batch, not only at the start
  expect_same(live, whole);
}

}  // namespace
}  // namespace kerf
