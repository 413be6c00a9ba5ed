// The packing of toolpaths: what is stored is read back.
#include "kerf/path/toolpath.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace kerf {
namespace {

TEST(Toolpath, KeepsEveryKindOfStep) {
  Toolpath path;
  const OriginId here = path.origins().add(TextLocation{"a.nc", 3, 1});
  path.add(step::Rapid{{1, 2, 3}}, here);
  path.add(step::Cut{{4, 5, 6}, mm_per_min(400)}, here);
  path.add(step::Arc{{7, 8, 9}, {1.5, 2.5}, Plane::xz, Turn::cw, 3, mm_per_min(300)}, here);
  path.add(step::Dwell{seconds(2)}, here);
  path.add(step::ToolChange{102}, here);
  path.add(step::Spindle{rpm(16000), SpindleTurn::ccw}, here);
  path.add(step::Coolant{true, false}, here);
  path.add(step::PathMode{PathModeKind::blend, mm(0.02)}, here);
  path.add(step::Probe{{0, 0, -5}, mm_per_min(50), ProbeKind::contact}, here);
  path.add(step::Extrude{{10, 0, 0.2}, mm3(1.2), mm(0.6), mm(0.2), mm_per_min(1800)}, here);
  path.add(step::Temperature{Heater::bed, 60, true}, here);
  path.add(step::Fan{1, 0.5}, here);
  path.add(step::LaserPower{LaserMode::dynamic, 255}, here);
  path.add(step::Layer{"cut 3 mm", 5}, here);
  path.add(step::Note{"hello"}, here);
  path.add(step::Verbatim{"M101 P1"}, here);
  path.add(step::Pause{PauseKind::pallet_change}, here);
  path.add(step::End{true}, here);
  path.add(step::ClosePath{}, here);
  path.add(step::StoreHome{Reference::second_home}, here);
  path.set_unknown_axes(path.add(step::Rapid{{0, 0, 0}}, here), 6);
  path.set_reference(20, Reference::end_switches, 4);

  EXPECT_EQ(path[0].to(), (Point3{1, 2, 3}));
  EXPECT_EQ(path[1].cut().feed, mm_per_min(400));
  const step::Arc arc = path[2].arc();
  EXPECT_EQ(arc.to, (Point3{7, 8, 9}));
  EXPECT_EQ(arc.centre, (Point2{1.5, 2.5}));
  EXPECT_EQ(arc.plane, Plane::xz);
  EXPECT_EQ(arc.turn, Turn::cw);
  EXPECT_EQ(arc.extra_turns, 3);
  EXPECT_EQ(path[3].dwell().time, seconds(2));
  EXPECT_EQ(path[4].tool_change().tool, 102);
  EXPECT_EQ(path[5].spindle().turn, SpindleTurn::ccw);
  EXPECT_TRUE(path[6].coolant().mist);
  EXPECT_FALSE(path[6].coolant().flood);
  EXPECT_EQ(path[7].path_mode().tolerance, mm(0.02));
  EXPECT_EQ(path[8].probe().kind, ProbeKind::contact);
  EXPECT_EQ(path.extrude(9).height, mm(0.2));
  EXPECT_EQ(path.extrude(9).volume, mm3(1.2));
  EXPECT_TRUE(path[10].temperature().wait);
  EXPECT_EQ(path[11].fan().fraction, 0.5);
  EXPECT_EQ(path[12].laser_power().mode, LaserMode::dynamic);
  EXPECT_EQ(path.layer(13).name, "cut 3 mm");
  EXPECT_EQ(path.layer(13).colour, 5);
  EXPECT_EQ(path.text(14), "hello");
  EXPECT_EQ(path.text(15), "M101 P1");
  EXPECT_EQ(path[16].pause().kind, PauseKind::pallet_change);
  EXPECT_TRUE(path[17].end().rewind);
  EXPECT_EQ(name_of(path[18].kind()), "closepath");
  EXPECT_EQ(path[19].store_home().home, Reference::second_home);
  EXPECT_EQ(to_string(path.origin_of(15)), "a.nc:3:1");

  Toolpath copy;
  for (std::size_t i = 0; i < path.size(); ++i) copy.add_copy(path, i);
  ASSERT_EQ(copy.size(), path.size());
  EXPECT_EQ(copy.text(15), "M101 P1");
  EXPECT_EQ(copy[16].pause().kind, PauseKind::pallet_change);
  EXPECT_EQ(copy[19].store_home().home, Reference::second_home);
  EXPECT_EQ(copy[20].unknown_axes(), 6u);
  EXPECT_EQ(copy[20].reference_axes(), 4u);
  EXPECT_EQ(copy[20].reference(), Reference::end_switches);
  EXPECT_EQ(copy.extrude(9).width, mm(0.6));
  EXPECT_EQ(to_string(copy.origin_of(2)), "a.nc:3:1");
}

TEST(Toolpath, VisitsMotionsWithTheirState) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.set_unknown_axes(0, 3);
  path.add(step::ToolChange{2}, OriginId::none);
  path.add(step::Cut{{0, 0, -1}, mm_per_min(10)}, OriginId::none);
  std::vector<MotionContext> seen;
  for_each_motion(path, [&](const Step&, const MotionContext& c) { seen.push_back(c); });
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].unknown_from, 7u);
  EXPECT_FALSE(seen[0].tool.has_value());
  EXPECT_EQ(seen[1].unknown_from, 3u);
  EXPECT_EQ(seen[1].from, (Point3{0, 0, 5}));
  EXPECT_EQ(seen[1].tool, 2);
}

bool is_same(const MotionContext& a, const MotionContext& b) {
  return a.index == b.index && a.from == b.from && a.unknown_from == b.unknown_from && a.tool == b.tool &&
         a.spindle.speed == b.spindle.speed && a.spindle.turn == b.spindle.turn &&
         a.spindle_stated == b.spindle_stated;
}

TEST(Toolpath, AReaderThatStartsAnywhereReadsTheSame) {
  Toolpath path;
  const auto motion = [&](double x) { path.add(step::Cut{{x, 0, 0}, mm_per_min(10)}, OriginId::none); };
  path.add(step::Note{"start"}, OriginId::none);
  motion(1);
  path.add(step::ToolChange{7}, OriginId::none);
  motion(2);
  path.add(step::Spindle{rpm(1000), SpindleTurn::cw}, OriginId::none);
  path.add(step::Dwell{}, OriginId::none);
  path.set_unknown_axes(3, 4);
  motion(3);
  path.add(step::Spindle{rpm(0), SpindleTurn::off}, OriginId::none);
  path.add(step::ToolChange{9}, OriginId::none);
  motion(4);
  path.add(step::Note{"end"}, OriginId::none);
  std::vector<MotionContext> all;
  for_each_motion(path, [&](const Step&, const MotionContext& c) { all.push_back(c); });
  ASSERT_EQ(all.size(), 4u);
  Toolpath copy;
  for (std::size_t i = 0; i < path.size(); ++i) copy.add_copy(path, i);
  for (const Toolpath* of : {&path, &copy}) {
    for (std::size_t first = 0; first <= path.size(); ++first) {
      std::vector<MotionContext> rest;
      for (MotionReader reader(*of, first); reader.next();) rest.push_back(reader.context());
      ASSERT_LE(rest.size(), all.size());
      EXPECT_TRUE(
          std::equal(rest.begin(), rest.end(), all.end() - static_cast<std::ptrdiff_t>(rest.size()), is_same))
          << "from step " << first;
      EXPECT_EQ(rest.size(), static_cast<std::size_t>(std::count_if(
                                 all.begin(), all.end(), [&](const auto& c) { return c.index >= first; })));
    }
  }
}

TEST(Toolpath, ReportsKindsAndMotionsBefore) {
  Toolpath path;
  EXPECT_FALSE(path.has(StepKind::cut));
  EXPECT_EQ(path.motion_before(0), std::nullopt);
  path.add(step::Note{"x"}, OriginId::none);
  path.add(step::Cut{{0, 0, 0}, mm_per_min(10)}, OriginId::none);
  path.add(step::Note{"y"}, OriginId::none);
  EXPECT_TRUE(path.has(StepKind::cut));
  EXPECT_TRUE(path.has(StepKind::note));
  EXPECT_FALSE(path.has(StepKind::laser_power));
  EXPECT_EQ(path.motion_before(1), std::nullopt);
  EXPECT_EQ(path.motion_before(2), 1u);
  EXPECT_EQ(path.motion_before(3), 1u);
}

}  // namespace
}  // namespace kerf
