// Programs as files: what is read equals what was written; newer and damaged files are refused.
#include "kerf/job/program_file.h"

#include <gtest/gtest.h>
#include <random>
#include <tuple>

#include "base/codes/files.h"
#include "random_program.h"

#include "kerf/stock/stock.h"

namespace kerf {
namespace {

void expect_same(const MotionExtra* a, const MotionExtra* b) {
  ASSERT_EQ(a == nullptr, b == nullptr);
  if (a == nullptr) return;
  EXPECT_EQ(a->abc, b->abc);
  EXPECT_EQ(a->z_correction, b->z_correction);
  EXPECT_EQ(a->unknown_abc, b->unknown_abc);
  EXPECT_EQ(a->reference_abc, b->reference_abc);
  EXPECT_EQ(a->lock, b->lock);
  EXPECT_EQ(a->per_turn, b->per_turn);
}

void expect_same_motion(const Toolpath& a, const Toolpath& b, std::size_t i) {
  EXPECT_EQ(a[i].to(), b[i].to());
  EXPECT_EQ(a[i].feed(), b[i].feed());
  EXPECT_EQ(a[i].unknown_axes(), b[i].unknown_axes());
  EXPECT_EQ(a[i].reference(), b[i].reference());
  EXPECT_EQ(a[i].reference_axes(), b[i].reference_axes());
  EXPECT_EQ(a[i].named_axes(), b[i].named_axes());
  EXPECT_EQ(a[i].rests_before(), b[i].rests_before());
  expect_same(a.extra(i), b.extra(i));
  if (a[i].kind() == StepKind::arc) {
    const step::Arc p = a[i].arc(), q = b[i].arc();
    EXPECT_TRUE(p.centre == q.centre && p.plane == q.plane && p.turn == q.turn);
    EXPECT_EQ(p.extra_turns, q.extra_turns);
  }
  if (a[i].kind() == StepKind::probe) {
    EXPECT_EQ(a[i].probe().kind, b[i].probe().kind);
  }
  if (a[i].kind() == StepKind::extrude) {
    const step::Extrude p = a.extrude(i), q = b.extrude(i);
    EXPECT_TRUE(p.volume == q.volume && p.width == q.width && p.height == q.height && p.kind == q.kind);
  }
}

/// The members of a step that is no motion and has no text. No default: a new kind is compared here, too.
bool has_same_setting(const Step& p, const Step& q) {
  const auto same = [&](auto members) { return members(p) == members(q); };
  using std::tuple;
  switch (p.kind()) {
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::probe:
    case StepKind::extrude:
    case StepKind::close_path:
    case StepKind::layer:
    case StepKind::verbatim: return true;
    case StepKind::dwell: return same([](const Step& s) { return s.dwell().time; });
    case StepKind::tool_change:
      return same([](const Step& s) { return tuple(s.tool_change().tool, s.tool_change().kind); });
    case StepKind::spindle:
      return same([](const Step& s) { return tuple(s.spindle().speed, s.spindle().turn); });
    case StepKind::coolant:
      return same([](const Step& s) { return tuple(s.coolant().mist, s.coolant().flood); });
    case StepKind::path_mode:
      return same([](const Step& s) { return tuple(s.path_mode().kind, s.path_mode().tolerance); });
    case StepKind::temperature:
      return same([](const Step& s) {
        const step::Temperature t = s.temperature();
        return tuple(t.heater, t.celsius, t.wait, t.extruder);
      });
    case StepKind::fan: return same([](const Step& s) { return tuple(s.fan().fan, s.fan().fraction); });
    case StepKind::laser_power:
      return same([](const Step& s) { return tuple(s.laser_power().mode, s.laser_power().power); });
    case StepKind::note: return same([](const Step& s) { return s.note_kind(); });
    case StepKind::pause: return same([](const Step& s) { return s.pause().kind; });
    case StepKind::end: return same([](const Step& s) { return s.end().rewind; });
    case StepKind::store_home: return same([](const Step& s) { return s.store_home().home; });
    case StepKind::work_zero: {
      const step::WorkZero v = p.work_zero(), w = q.work_zero();
      return tuple(v.kind, v.system, v.axes, v.known, v.unknown) ==
                 tuple(w.kind, w.system, w.axes, w.known, w.unknown) &&
             v.zero == w.zero && v.at == w.at;
    }
    case StepKind::tool_length: {
      const step::ToolLength v = p.tool_length(), w = q.tool_length();
      return tuple(v.kind, v.number, v.axes) == tuple(w.kind, w.number, w.axes) && v.offset == w.offset;
    }
    case StepKind::unresolved: return same([](const Step& s) { return s.unresolved(); });
    case StepKind::motion_limits:
      return same([](const Step& s) {
        return tuple(s.motion_limits().kind, s.motion_limits().values, s.motion_limits().given);
      });
    case StepKind::extruder: return same([](const Step& s) { return s.extruder().number; });
  }
  return false;
}

/// Of the steps with a text.
void expect_same_text(const Toolpath& a, const Toolpath& b, std::size_t i) {
  const StepKind kind = a[i].kind();
  if (kind == StepKind::layer) {
    EXPECT_EQ(a.layer(i).name, b.layer(i).name);
    EXPECT_EQ(a.layer(i).colour, b.layer(i).colour);
  } else if (kind == StepKind::note || kind == StepKind::verbatim || kind == StepKind::unresolved) {
    EXPECT_EQ(a.text(i), b.text(i));
  }
}

void expect_same(const Toolpath& a, const Toolpath& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].kind(), b[i].kind());
    EXPECT_EQ(a.origin_of(i), b.origin_of(i));
    EXPECT_EQ(a.origins().callers(a[i].origin()), b.origins().callers(b[i].origin()));
    if (a[i].is_motion()) expect_same_motion(a, b, i);
    EXPECT_TRUE(has_same_setting(a[i], b[i])) << name_of(a[i].kind());
    expect_same_text(a, b, i);
    EXPECT_EQ(a.motion_before(i), b.motion_before(i));
    EXPECT_TRUE(b.has(a[i].kind()));
  }
  EXPECT_EQ(a.origins().files(), b.origins().files());
}

void expect_same(const Tool& a, const Tool& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.description, b.description);
  ASSERT_EQ(a.shape.index(), b.shape.index());
  for (const ShapeParameter& p : parameters_of(a.shape)) EXPECT_EQ(p.get(a.shape), p.get(b.shape)) << p.name;
  if (const auto* drawn = std::get_if<shape::Drawn>(&a.shape)) {
    EXPECT_EQ(drawn->cutting, std::get<shape::Drawn>(b.shape).cutting);
  }
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder})
    EXPECT_EQ(a.silhouette.part(part), b.silhouette.part(part));
  EXPECT_TRUE(a.diameter == b.diameter && a.flute == b.flute && a.flute_assumed == b.flute_assumed);
  EXPECT_TRUE(a.teeth == b.teeth && a.teeth_assumed == b.teeth_assumed && a.plunges == b.plunges);
}

void expect_same(const std::map<int, Tool>& a, const std::map<int, Tool>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [number, tool] : a) {
    ASSERT_EQ(b.count(number), 1u);
    expect_same(tool, b.at(number));
  }
}

void expect_same(const Stock& a, const Stock& b) {
  EXPECT_EQ(a.block, b.block);
  ASSERT_EQ(a.body == nullptr, b.body == nullptr);
  if (!a.body) return;
  EXPECT_EQ(a.body->bounds(), b.body->bounds());
  EXPECT_EQ(a.body->volume(), b.body->volume());
  EXPECT_EQ(a.body->pitch(), b.body->pitch());
  const ColumnPositions lines{a.block.low.x + 0.1, a.block.low.y + 0.1, a.block.low.z, 0.7, 3, 2, {}, {}};
  Diagnostics diagnostics;
  const auto p = a.body->columns(lines, diagnostics), q = b.body->columns(lines, diagnostics);
  ASSERT_TRUE(p && q);
  EXPECT_TRUE(p->first == q->first && p->runs == q->runs);
}

void expect_same_fields(const Program& a, const Program& b) {
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.front_end, b.front_end);
  EXPECT_EQ(a.units, b.units);
  EXPECT_EQ(a.tools_are, b.tools_are);
  EXPECT_EQ(a.spoilboard, b.spoilboard);
  EXPECT_EQ(a.filament_diameter, b.filament_diameter);
  EXPECT_EQ(a.filament_density, b.filament_density);
  EXPECT_EQ(a.units_given, b.units_given);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.manual_spindle, b.manual_spindle);
  EXPECT_EQ(a.assumed_diameter, b.assumed_diameter);
  EXPECT_EQ(a.states_tool_lengths, b.states_tool_lengths);
  EXPECT_EQ(a.files, b.files);
  ASSERT_EQ(a.bar.has_value(), b.bar.has_value());
  if (a.bar) {
    EXPECT_TRUE(a.bar->diameter == b.bar->diameter && a.bar->x_low == b.bar->x_low &&
                a.bar->x_high == b.bar->x_high);
    EXPECT_TRUE(a.bar->axis_y == b.bar->axis_y && a.bar->axis_z == b.bar->axis_z);
  }
  ASSERT_EQ(a.probes.size(), b.probes.size());
  for (std::size_t i = 0; i < a.probes.size(); ++i) {
    EXPECT_EQ(a.probes[i].variable, b.probes[i].variable);
    EXPECT_EQ(a.probes[i].at, b.probes[i].at);
    EXPECT_EQ(a.probes[i].expected, b.probes[i].expected);
  }
}

void expect_same(const Program& a, const Program& b) {
  expect_same(a.path, b.path);
  expect_same(a.tools, b.tools);
  expect_same(a.tools_beside.tools(), b.tools_beside.tools());
  expect_same_fields(a, b);
  ASSERT_EQ(a.stock.has_value(), b.stock.has_value());
  if (a.stock) expect_same(*a.stock, *b.stock);
  ASSERT_EQ(a.fixtures.size(), b.fixtures.size());
  for (std::size_t i = 0; i < a.fixtures.size(); ++i) {
    EXPECT_EQ(a.fixtures[i].name, b.fixtures[i].name);
    expect_same(a.fixtures[i].solid, b.fixtures[i].solid);
  }
}

constexpr std::uint32_t kPrograms = 500;

TEST(ProgramFile, RandomProgramsAreReadAsTheyWereWritten) {
  for (std::uint32_t seed = 1; seed <= kPrograms && !::testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const Program program = RandomProgram(seed).make();
    const std::string bytes = write_program(program);
    Diagnostics diagnostics;
    const auto again = read_program(bytes, "part.kerf", diagnostics);
    ASSERT_TRUE(again) << (diagnostics.list().empty() ? "" : to_string(diagnostics.list().front()));
    expect_same(program, *again);
    EXPECT_EQ(write_program(*again), bytes);
    EXPECT_TRUE(is_program_file(bytes));
  }
}

TEST(ProgramFile, SingleValuesAreReadAsTheyWereWritten) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Program program = RandomProgram(seed).make();
    Diagnostics diagnostics;
    const auto path = read_toolpath(write_toolpath(program.path), "p", diagnostics);
    ASSERT_TRUE(path);
    expect_same(program.path, *path);
    for (const auto& [number, tool] : program.tools) {
      const auto again = read_tool(write_tool(tool), "t", diagnostics);
      ASSERT_TRUE(again);
      expect_same(tool, *again);
    }
    if (!program.stock) continue;
    const auto stock = read_stock(write_stock(*program.stock), "s", diagnostics);
    ASSERT_TRUE(stock);
    expect_same(*program.stock, *stock);
  }
}

TEST(ProgramFile, AStepTakesFewBytes) {
  Toolpath path;
  const std::uint32_t file = path.origins().file("part.nc");
  constexpr std::uint32_t kSteps = 100'000;
  std::mt19937 random(1);
  std::uniform_real_distribution<> position(-500, 500);
  for (std::uint32_t i = 0; i < kSteps; ++i)
    path.add(step::Cut{{position(random), position(random), position(random)}, mm_per_min(position(random))},
             path.origins().text(file, i, i % 7));
  EXPECT_LT(write_toolpath(path).size() / kSteps, 90u);
}

/// The only error of reading these bytes.
Diagnostic error_of(const std::string& bytes) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_program(bytes, "part.kerf", diagnostics));
  EXPECT_EQ(diagnostics.list().size(), 1u);
  return diagnostics.list().empty() ? Diagnostic{} : diagnostics.list().front();
}

TEST(ProgramFile, ANewerVersionIsRefusedWithBothVersions) {
  std::string bytes = write_program({});
  bytes[8] = 7;  // the version follows the mark of 8 bytes
  const Diagnostic error = error_of(bytes);
  EXPECT_EQ(error.code, codes::program_file_newer);
  EXPECT_NE(error.message.find("version 7"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("up to version 2"), std::string::npos) << error.message;
}

TEST(ProgramFile, AnyDamagedByteIsFound) {
  const std::string bytes = write_program(RandomProgram(3).make());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string other = bytes;
    other[i] = static_cast<char>(other[i] ^ 0x41);
    Diagnostics diagnostics;
    if (i >= 12 && i < 12 + 1 + static_cast<std::size_t>(bytes[12])) continue;  // the writer's name is free
    EXPECT_FALSE(read_program(other, "part.kerf", diagnostics)) << i;
    EXPECT_EQ(diagnostics.errors(), 1u) << i;
  }
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Diagnostic error = error_of(bytes.substr(0, length));
    EXPECT_EQ(error.code, codes::program_file_damaged);
  }
  EXPECT_EQ(error_of(bytes + "x").code, codes::program_file_damaged);
}

TEST(ProgramFile, OtherContentIsNamed) {
  const Diagnostic error = error_of(write_stock(make_block({1, 2, 3}, ZeroCorner::centre, ZeroHeight::top)));
  EXPECT_NE(error.message.find("it holds stock, not a program"), std::string::npos) << error.message;
}

}  // namespace
}  // namespace kerf
