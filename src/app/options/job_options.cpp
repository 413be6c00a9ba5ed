// The options of a job.
#include "app/options/job_options.h"

#include <fmt/format.h>

#include "app/options/common.h"

#include "kerf/files.h"
#include "kerf/machine_files.h"
#include "kerf/stock_files.h"

namespace kerf::app {

const char* const kToolHelp =
    R"(
Tools (--tool), the last word over tool files, the program's comments and the built-in table:
  --tool "square d=3.175 flute=12.7"   for every tool number that has no --tool N=... of its own,
                                       and for programs without a tool change
  --tool 2="V d=12.7 angle=90"         for tool 2
  --tool 2=301                         tool 2 is the built-in tool 301 (see: kerf tools list)
                                       all shapes and keys (neck_length, teeth ...): kerf tools shapes
)";

const char* const kStockHelp =
    R"(Stock (--stock), lengths in mm or with "in"; else the program's comments, else a block around the cuts:
  --stock "100x60x12"                  program zero at the lower left of the top
  --stock "100x60x12 at centre bottom" or lower-left, top-right ..., top or bottom
  --stock "0,0,-12 to 100,60,0"        lowest and highest corner
)";
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
  Diagnostics ignored;
  if (const auto box = read_stock_option(text, {}, ignored)) return Fixture{text, *box};
  usage
      .error(Code::fixture_option, CallSpot{"", 0, "--fixture"},
             fmt::format("\"{}\" is no fixture", text.substr(0, 60)))
      .hint = "expected a box from corner to corner, \"0,0,-12 to 20,15,6\", or a mesh, clamp.stl";
  return std::nullopt;
}

/// Stock from files, its movement, fixtures and the bar.
void read_body_options(const BodyOptions& options, JobSettings& settings, Diagnostics& usage,
                       Diagnostics& diagnostics) {
  for (const std::string& path : {options.mesh, options.left})
    if (!path.empty()) settings.stock_file = load_stock(path, diagnostics);
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
}

}  // namespace

void add_tool_options(CommandParser& parser, ToolOptions& options) {
  add_repeated(parser, "-t,--tool", options.specs, "SPEC",
               "A tool's shape, for tool N or for all: [N=]SPEC (see below)");
  add_repeated(parser, "--tools", options.files, "PATH", "A file of tools (TOML)");
}

void add_job_options(CommandParser& parser, JobOptions& options) {
  add_program(parser, options.file);
  add_tool_options(parser, options.tools);
  parser.add_text("--stock", options.stock, "The stock: SIZE [at PLACE] or LOW to HIGH (see below)")
      .value_name("SPEC");
  add_reading_options(parser, options.reading);
}

std::vector<std::string> input_files(const JobOptions& options) {
  std::vector<std::string> files{options.file, options.bodies.mesh, options.bodies.left};
  files.insert(files.end(), options.bodies.fixtures.begin(), options.bodies.fixtures.end());
  return files;
}

void add_machine_option(CommandParser& parser, JobOptions& options) {
  parser.add_text("--machine", options.machine, "The machine: a profile (TOML) or what GRBL answers to $$")
      .value_name("PATH");
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

ToolChoices read_tool_options(const ToolOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  ToolChoices choices;
  for (const std::string& text : options.specs)
    add_tool(text, CallSpot{"", 0, fmt::format("--tool \"{}\"", text.substr(0, 80))}, choices, usage);
  for (const std::string& file : options.files) add_tool_file(file, choices, diagnostics);
  return choices;
}

ProgramOptions program_options(const ReadingOptions& options, const ToolChoices& tools) {
  ProgramOptions out = read_reading_options(options);
  out.tool_diameter = diameters_of(tools);
  return out;
}

JobInputs read_job_options(const JobOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  JobInputs inputs;
  inputs.job.tools = read_tool_options(options.tools, usage, diagnostics);
  inputs.program = program_options(options.reading, inputs.job.tools);
  if (options.stock) inputs.job.stock = read_stock_option(*options.stock, CallSpot{"", 0, "--stock"}, usage);
  read_body_options(options.bodies, inputs.job, usage, diagnostics);
  if (!options.machine.empty())
    if (const auto file = InputFile::open(options.machine, diagnostics))
      inputs.program.machine = read_machine_file(file->bytes(), options.machine, diagnostics);
  return inputs;
}

}  // namespace kerf::app
