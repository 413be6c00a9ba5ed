// Stock from files and fixtures, for the command.
#include "app/bodies.h"

#include <fmt/format.h>

#include "kerf/files.h"
#include "kerf/number.h"
#include "kerf/stock_files.h"

namespace kerf::app {

const char* const kBodyHelp =
    R"(Stock from a file, in the program's work coordinates, instead of --stock:
  --stock-mesh casting.stl             a closed mesh: .stl .3mf .glb .obj
  --stock-left side1.kstock            what an earlier job has left (-o side1.kstock)
  --flip x                             half a turn about an axis along X through the block's middle
  --flip "x y=30 z=-6"                 ... through Y30 Z-6; likewise "y x=50"
  --shift 0,0,3                        then moved by so many mm
Fixtures (--fixture), which no part of a tool may touch:
  --fixture "0,0,-12 to 20,15,6"       a box, from its lowest to its highest corner
  --fixture vice.stl                   a closed mesh
)";
const char* const kRotaryHelp =
    R"(A fourth axis (--rotary), the bar from X0 on, turned by A about an axis along X:
  --rotary "d=40 length=100"           axis at Y0 Z0; "x=-5 y=0 z=12" where it begins and stands elsewhere
)";

namespace {

std::optional<Fixture> read_fixture(const std::string& text, Diagnostics& usage, Diagnostics& diagnostics) {
  if (is_stock_file(text)) {
    auto solid = load_stock(text, diagnostics);
    return solid ? std::optional(Fixture{text, std::move(*solid)}) : std::nullopt;
  }
  Diagnostics said;
  if (const auto box = read_stock_option(text, {}, said)) return Fixture{text, *box};
  usage
      .error(Code::fixture_option, CallSpot{"", 0, "--fixture"},
             fmt::format("\"{}\" is no fixture", text.substr(0, 60)))
      .hint = "expected a box from corner to corner, \"0,0,-12 to 20,15,6\", or a mesh, clamp.stl";
  return std::nullopt;
}

/// What meets the fixture; empty for a tool as a whole, at rapid speed.
std::string part_name(const FixtureContact& contact) {
  if (contact.part == ToolPart::cutting) return "cutting edge";
  return contact.part ? std::string(to_string(*contact.part)) : std::string();
}

std::string message_of(const FixtureContact& contact, const Fixture& fixture) {
  const std::string part = part_name(contact);
  const std::string where = fmt::format("{} mm deep into the fixture \"{}\"",
                                        number_text(contact.depth.mm(), 3), fixture.name.substr(0, 60));
  if (part.empty()) return "a rapid move goes " + where;
  return fmt::format("the tool's {} goes {}", part, where);
}

}  // namespace

std::optional<Stock> load_stock(const std::string& path, Diagnostics& diagnostics) {
  const auto file = InputFile::open(path, diagnostics);
  return file ? read_stock_file(file->bytes(), path, diagnostics) : std::nullopt;
}

void add_body_options(CommandParser& parser, BodyOptions& options) {
  Option mesh = parser.add_text("--stock-mesh", options.mesh, "The stock as a closed mesh (see below)");
  Option left = parser.add_text("--stock-left", options.left, "The stock that an earlier job left (.kstock)");
  mesh.value_name("PATH");
  left.value_name("PATH").excludes(mesh);
  if (const auto block = parser.find_option("--stock")) {
    mesh.excludes(*block);
    left.excludes(*block);
  }
  parser.add_text("--flip", options.flip, "Turn the stock over: x or y [y=..|x=..] [z=..] (see below)")
      .value_name("SPEC");
  parser.add_text("--shift", options.shift, "Move the stock by X,Y,Z mm, after a flip").value_name("X,Y,Z");
  add_repeated(parser, "--fixture", options.fixtures, "SPEC",
               "What the tool may not touch: LOW to HIGH, or a mesh");
}

void add_rotary_option(CommandParser& parser, BodyOptions& options) {
  Option rotary = parser
                      .add_text("--rotary", options.rotary,
                                "A round bar that A turns: d=.. length=.. [x=..] [y=..] [z=..]")
                      .value_name("SPEC");
  for (const char* other : {"--stock", "--stock-mesh", "--stock-left", "--flip", "--shift"})
    rotary.excludes(parser.option(other));
}

BodySettings read_body_options(const BodyOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  BodySettings settings;
  for (const std::string& path : {options.mesh, options.left})
    if (!path.empty()) settings.stock = load_stock(path, diagnostics);
  if (options.flip) settings.move = read_flip_option(*options.flip, CallSpot{"", 0, "--flip"}, usage);
  if (options.shift) {
    const auto shift = read_shift_option(*options.shift, CallSpot{"", 0, "--shift"}, usage);
    if (!settings.move) settings.move.emplace();
    settings.move->shift = shift.value_or(Point3{});
  }
  for (const std::string& text : options.fixtures)
    if (auto fixture = read_fixture(text, usage, diagnostics))
      settings.fixtures.push_back(std::move(*fixture));
  if (options.rotary) settings.bar = read_rotary_option(*options.rotary, CallSpot{"", 0, "--rotary"}, usage);
  if (options.rotary && !options.fixtures.empty())
    usage
        .error(Code::fixture_option, CallSpot{"", 0, "--fixture"},
               "contacts with fixtures are not looked for on a fourth axis (--rotary)")
        .hint = "leave --fixture out, and look after the chuck and the clamps yourself";
  return settings;
}

std::vector<Finding> findings_at_fixtures(const Toolpath& path, const ToolTable& tools,
                                          const std::vector<Fixture>& fixtures, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress& progress) {
  std::vector<Finding> out;
  if (fixtures.empty()) return out;
  progress.phase("looking at fixtures");
  const auto contacts = find_fixture_contacts(path, tools, fixtures, how, diagnostics, &progress);
  if (!contacts) return out;
  for (const FixtureContact& c : *contacts)
    out.push_back({.kind = "fixture_contact",
                   .step = c.step,
                   .steps = 1,
                   .at = c.at,
                   .depth_mm = c.depth.mm(),
                   .removed_mm3 = c.met.mm3(),
                   .origin = path.origin_of(c.step),
                   .message = message_of(c, fixtures[c.fixture]),
                   .callers = path.origins().callers(path[c.step].origin()),
                   .hint = {},
                   .about = fmt::format("{} {}", c.fixture, part_name(c))});
  return out;
}

}  // namespace kerf::app
