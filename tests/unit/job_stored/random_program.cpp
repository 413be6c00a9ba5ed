// Random programs.
#include "random_program.h"

#include <variant>

#include "kerf/base/limits.h"
#include "kerf/stock/stock.h"

namespace kerf {
namespace {

const ToolShape kShapes[] = {
    shape::Square{mm(6), mm(20)},
    shape::Ball{mm(3.175), mm(12.7)},
    shape::BullNose{mm(6), mm(20), mm(1)},
    shape::Bowl{mm(12.7), mm(20), mm(3)},
    shape::Vee{mm(12.7), mm(0), degrees(60), mm(0.2), mm(0)},
    shape::TaperedBall{mm(6), mm(0), degrees(10), mm(1)},
    shape::Keyhole{mm(9.5), mm(3), mm(4.7), mm(12)},
    shape::Dovetail{mm(12.7), mm(10), degrees(14)},
    shape::Roundover{mm(3), mm(3.175), mm(0)},
    shape::ThreadMill{mm(4), mm(6), mm(0.8), mm(12)},
    shape::Lollipop{mm(6), mm(3), mm(0)},
    shape::TSlot{mm(12), mm(3), mm(6), mm(0)},
    shape::Drill{mm(3.2), mm(30), degrees(118)},
    shape::CentreDrill{mm(1), mm(1.3), degrees(118), mm(3.15), mm(10), degrees(60)},
    shape::FlatGroove{mm(4), mm(12), mm(1)},
    shape::Chamfer{mm(10), mm(8), degrees(90), mm(2)},
    shape::CornerRounding{mm(2), mm(10), mm(3), mm(4), mm(4)},
    shape::Drawn{Profile{{{0, 0, 0}, {2, 0, 0.2}, {3, 2, 0}, {3, 9, 0}}}},
};
static_assert(std::size(kShapes) == std::variant_size_v<ToolShape>);

}  // namespace

Point3 RandomProgram::point() { return {number(-500, 500), number(-500, 500), number(-50, 50)}; }

std::string RandomProgram::word() {
  std::string text;
  for (int left = whole(0, 12); left > 0; --left) text += static_cast<char>(whole(0, 255));
  return text;
}

OriginId RandomProgram::origin(OriginTable& table) {
  if (table.size() > 3 && chance(0.3))
    return static_cast<OriginId>(whole(0, static_cast<int>(table.size()) - 1));
  const auto line = static_cast<std::uint32_t>(whole(0, 100'000));
  OriginId made = OriginId::none;
  switch (whole(0, 3)) {
    case 0: made = table.text(table.file(word()), line, static_cast<std::uint32_t>(whole(0, 80))); break;
    case 1:
      made = table.add(DrawingLocation{word(), word(), word(), number(-9, 9), number(-9, 9), word()});
      break;
    case 2: made = table.add(CallLocation{word(), line, word()}); break;
    default: return OriginId::none;
  }
  if (chance(0.2)) table.set_caller(made, origin(table));
  return made;
}

void RandomProgram::decorate(Toolpath& path, std::size_t i) {
  if (path[i].kind() == StepKind::probe && chance(0.5))
    return path.set_probed_axes(i, axes(), axes(), axes());
  if (chance(0.2)) path.set_unknown_axes(i, 7);
  if (path[i].unknown_axes() == 7 && path[i].kind() != StepKind::probe && chance(0.7))
    path.set_reference(i, one_of(Reference::measured), axes());
  if (chance(0.3)) path.set_named_axes(i, static_cast<unsigned>(whole(0, 63)));
  if (chance(0.1)) path.set_rests_before(i);
  if (!chance(0.2)) return;
  MotionExtra extra;
  if (chance(0.7)) extra.abc = {number(-720, 720), number(-720, 720), number(-720, 720)};
  if (chance(0.3)) extra.z_correction = word();
  extra.unknown_abc = axes();
  extra.reference_abc = axes();
  extra.lock = one_of(SpindleLock::tap);
  extra.per_turn = number(0, 3);
  path.set_extra(i, extra);
}

void RandomProgram::add_motion(Toolpath& path) {
  const OriginId at = origin(path.origins());
  const Feed feed = mm_per_min(chance(0.1) ? 0.0 : number(1, 5000));
  switch (whole(0, 4)) {
    case 0: path.add(step::Rapid{point()}, at); break;
    case 1: path.add(step::Cut{point(), feed}, at); break;
    case 2:
      path.add(step::Arc{.to = point(),
                         .centre = {number(-500, 500), number(-500, 500)},
                         .plane = one_of(Plane::yz),
                         .turn = one_of(Turn::ccw),
                         .extra_turns = chance(0.2) ? whole(1, limits::kMaxTurns) : 0,
                         .feed = feed},
               at);
      break;
    case 3: path.add(step::Probe{point(), feed, one_of(ProbeKind::release)}, at); break;
    default:
      path.add(step::Extrude{point(), mm3(number(-5, 40)), mm(number(0, 2)), mm(number(0, 1)), feed,
                             one_of(BeadKind::custom)},
               at);
  }
  decorate(path, path.size() - 1);
}

void RandomProgram::add_machine_step(Toolpath& path, OriginId at) {
  switch (whole(0, 14)) {
    case 0: path.add(step::Dwell{seconds(number(0, 100))}, at); break;
    case 1:
      path.add(step::ToolChange{whole(0, limits::kMaxToolNumber), one_of(ToolChangeKind::number_only)}, at);
      break;
    case 2: path.add(step::Spindle{rpm(number(0, 24'000)), one_of(SpindleTurn::ccw)}, at); break;
    case 3: path.add(step::Coolant{chance(0.5), chance(0.5)}, at); break;
    case 4: path.add(step::PathMode{one_of(PathModeKind::blend), mm(number(0, 1))}, at); break;
    case 5:
      path.add(step::Temperature{one_of(Heater::chamber), number(0, 300), chance(0.5), whole(-1, 5)}, at);
      break;
    case 6: path.add(step::Extruder{whole(0, 9)}, at); break;
    case 7: path.add(step::Fan{whole(0, 3), number(0, 1)}, at); break;
    case 8:
      path.add(step::MotionLimits{one_of(LimitKind::corner_speed),
                                  {number(0, 9), number(0, 9), number(0, 9), number(0, 9)},
                                  static_cast<unsigned>(whole(0, 15))},
               at);
      break;
    case 9: path.add(step::LaserPower{one_of(LaserMode::dynamic), number(0, 1000)}, at); break;
    case 10: path.add(step::Pause{one_of(PauseKind::pallet_change)}, at); break;
    case 11: path.add(step::End{chance(0.5)}, at); break;
    case 12: path.add(step::ClosePath{}, at); break;
    case 13: path.add(step::StoreHome{chance(0.5) ? Reference::home : Reference::second_home}, at); break;
    default: add_zero(path, at);
  }
}

void RandomProgram::add_zero(Toolpath& path, OriginId at) {
  if (chance(0.5)) {
    path.add(step::ToolLength{one_of(ToolLengthKind::given), whole(-1, 99), point(), axes()}, at);
    return;
  }
  const unsigned given = axes();
  path.add(step::WorkZero{.kind = one_of(ZeroKind::shift_on),
                          .system = whole(1, 9),
                          .axes = given,
                          .zero = point(),
                          .at = point(),
                          .known = given & axes(),
                          .unknown = axes()},
           at);
}

void RandomProgram::add_text(Toolpath& path, OriginId at) {
  switch (whole(0, 3)) {
    case 0: path.add(step::Layer{word(), whole(0, 256)}, at); break;
    case 1: path.add(step::Note{word(), one_of(NoteKind::message)}, at); break;
    case 2: path.add(step::Verbatim{word()}, at); break;
    default: path.add(step::Unresolved{word(), one_of(UnresolvedKind::code)}, at);
  }
}

Tool RandomProgram::tool(int number) {
  ToolBody body;
  if (chance(0.5))
    body.shank_diameter = mm(this->number(13, 20)), body.shank_length = mm(this->number(5, 30));
  if (chance(0.5))
    body.holder_diameter = mm(this->number(20, 40)), body.holder_length = mm(this->number(5, 30));
  body.transition = one_of(Transition::cone);
  Diagnostics diagnostics;
  auto made = make_tool(number, kShapes[static_cast<std::size_t>(whole(0, std::size(kShapes) - 1))], body, {},
                        diagnostics);
  if (!made) made = make_tool(number, shape::Square{mm(6), mm(20)}, {}, {}, diagnostics);
  for (int left = whole(0, 2); left > 0; --left) made->names.push_back(word());
  made->description = word();
  made->teeth = whole(1, 6);
  made->teeth_assumed = chance(0.5);
  return *made;
}

Stock RandomProgram::stock() {
  if (chance(0.4))
    return make_block({number(1, 99), number(1, 99), number(1, 30)}, ZeroCorner::centre, ZeroHeight::top);
  Diagnostics ignored;
  std::shared_ptr<const StockBody> body;
  if (chance(0.5)) {
    const double a = number(1, 9);
    const std::vector<double> points{0, 0, 0, a, 0, 0, 0, a, 0, 0, 0, number(1, 9)};
    body = make_mesh_body(points, std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, word(),
                          ignored);
  } else {
    LeftColumns left;
    left.bounds.add(Point3{0, 0, -5});
    left.bounds.add(Point3{3, 2, 0});
    left.positions = {.x = 0.5, .y = 0.5, .z = -5, .pitch = 1, .nx = 3, .ny = 2};
    left.columns = {.nx = 3, .ny = 2, .first = {0}, .runs = {}};
    for (int column = 0; column < 6; ++column) {
      const auto height = static_cast<float>(number(1, 4));
      if (chance(0.8)) left.columns.runs.push_back({0.0f, height});
      if (chance(0.3)) left.columns.runs.push_back({height + 0.5f, 5.0f});
      left.columns.first.push_back(static_cast<std::uint32_t>(left.columns.runs.size()));
    }
    body = make_columns_body(std::move(left));
  }
  Stock made = stock_of(body);
  StockMove move{.flip = one_of(StockMove::Flip::about_y), .across = {}, .z = {}, .shift = point()};
  return chance(0.5) ? moved(made, move) : made;
}

Program RandomProgram::make() {
  Program out;
  out.source = word();
  out.front_end = word();
  for (int left = whole(0, 60); left > 0; --left) {
    if (chance(0.5)) {
      add_motion(out.path);
      continue;
    }
    const OriginId at = origin(out.path.origins());
    chance(0.7) ? add_machine_step(out.path, at) : add_text(out.path, at);
  }
  out.units = one_of(ProgramUnits::inch);
  for (int left = whole(0, 3); left > 0; --left) {
    const int number = whole(0, 999);
    out.tools.insert_or_assign(number, tool(number));
    out.tools_beside.set(number + 1, tool(number + 1));
  }
  out.tools_are = one_of(ToolsOfProgram::whole);
  if (chance(0.7)) out.stock = stock();
  if (chance(0.2))
    out.bar = RoundBar{number(1, 50), number(-9, 0), number(1, 99), number(-9, 9), number(-9, 9)};
  for (int left = whole(0, 2); left > 0; --left) out.fixtures.push_back({word(), stock()});
  out.spoilboard = mm(chance(0.5) ? 0.0 : number(1, 20));
  if (chance(0.5)) out.filament_diameter = number(1, 3);
  if (chance(0.5)) out.filament_density = number(0.5, 2);
  out.units_given = chance(0.5);
  out.end = one_of(ProgramEnd::missing);
  out.manual_spindle = chance(0.5);
  for (int left = whole(0, 3); left > 0; --left)
    out.probes.push_back({whole(-9, 9999), {number(-9, 9), number(-9, 9)}, {}});
  if (!out.probes.empty()) out.probes.front().expected = number(-1, 1);
  if (chance(0.5)) out.assumed_diameter = number(0.1, 6);
  out.states_tool_lengths = chance(0.5);
  for (int left = whole(0, 3); left > 0; --left) out.files.push_back(word());
  return out;
}

}  // namespace kerf
