// The options of a job.
#include "app/options/job_options.h"

#include <fmt/format.h>

#include "app/options/common.h"
#include "base/codes/stock.h"
#include "base/names.h"
#include "job/named.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf::app {

const char* const kToolHelp =
    R"(
Tools (--tool), with priority over the program's comments, tool files and the built-in table:
  --tool "square d=3.175 flute=12.7"   for every tool number without a --tool N=... and for programs
                                       without a tool change
  --tool 2="V d=12.7 angle=90"         for tool 2
  --tool 2=301                         tool 2 is the built-in tool 301 (see: kerf tools list)
                                       shapes and keys (neck_length, teeth ...): see kerf tools shapes
)";

const char* const kStockHelp =
    R"(Stock (--stock), lengths in mm or with "in"; default: program comments, else a block around the cuts:
  --stock "100x60x12"                  work zero at the lower left corner of the top
  --stock "100x60x12 at centre bottom" or lower-left, top-right ..., top or bottom
  --stock "0,0,-12 to 100,60,0"        lower and upper corner
)";
const char* const kBodyHelp =
    R"(Stock from a file, in the program's work coordinates, instead of --stock:
  --stock-mesh casting.stl             a closed mesh: .stl .3mf .glb .obj
  --stock-left side1.kstock            the left-over stock of an earlier job (-o side1.kstock)
  --flip x                             turned by 180 degrees about an axis along X through its centre
  --flip "x y=30 z=-6"                 the same about an axis through Y30 Z-6; likewise "y x=50"
  --shift 0,0,3                        moved by X,Y,Z mm, after --flip
Fixtures (--fixture), which no part of a tool may touch:
  --fixture "0,0,-12 to 20,15,6"       a box, from its lower to its upper corner
  --fixture vice.stl                   a closed mesh
)";
const char* const kRotaryHelp =
    R"(A fourth axis (--rotary): a round bar that A turns about an axis along X:
  --rotary "d=40 length=100"           from X0, axis at Y0 Z0
  --rotary "d=40 length=100 x=-5 z=12" from X-5, axis at Y0 Z12
)";

namespace {

std::optional<Fixture> read_fixture(const std::string& text, Diagnostics& usage, Diagnostics& diagnostics,
                                    Progress* progress) {
  if (is_stock_file(text)) {
    auto solid = load_stock(text, diagnostics, progress);
    return solid ? std::optional(Fixture{text, std::move(*solid)}) : std::nullopt;
  }
  Diagnostics ignored;
  if (const auto box = read_stock_option(text, {}, ignored)) return Fixture{text, *box};
  usage
      .error(codes::fixture_option, CallLocation{"", 0, "--fixture"},
             fmt::format("\"{}\" is not a fixture", text.substr(0, 60)))
      .hint = "expected a box, such as \"0,0,-12 to 20,15,6\", or a mesh file, such as clamp.stl";
  return std::nullopt;
}

/// Stock from files, --flip and --shift, fixtures and the bar.
void read_body_options(const BodyOptions& options, JobSettings& settings, Diagnostics& usage,
                       Diagnostics& diagnostics, Progress* progress) {
  for (const std::string& path : {options.mesh, options.left})
    if (!path.empty()) settings.stock_file = load_stock(path, diagnostics, progress);
  if (options.flip) settings.move = read_flip_option(*options.flip, CallLocation{"", 0, "--flip"}, usage);
  if (options.shift) {
    const auto shift = read_shift_option(*options.shift, CallLocation{"", 0, "--shift"}, usage);
    if (!settings.move) settings.move.emplace();
    settings.move->shift = shift.value_or(Point3{});
  }
  const bool is_given = options.spoilboard_option && options.spoilboard_option->is_given();
  (is_given ? settings.spoilboard : settings.usual_spoilboard) = mm(options.spoilboard);
  for (const std::string& text : options.fixtures)
    if (auto fixture = read_fixture(text, usage, diagnostics, progress))
      settings.fixtures.push_back(std::move(*fixture));
  if (options.rotary)
    settings.bar = read_rotary_option(*options.rotary, CallLocation{"", 0, "--rotary"}, usage);
  if (options.rotary && !options.fixtures.empty())
    usage
        .error(codes::fixture_option, CallLocation{"", 0, "--fixture"},
               "contacts with fixtures cannot be found on a fourth axis (--rotary)")
        .hint = "remove --fixture and check the clearance to chuck and clamps yourself";
}

}  // namespace

void add_tool_options(CommandParser& parser, ToolOptions& options) {
  add_repeated(parser, "-t,--tool", options.specs, "SPEC",
               "Shape of tool N, or of all tools: [N=]SPEC (see below)");
  add_repeated(parser, "--tools", options.files, "PATH",
               "A tool file (TOML), or a tool library of another program");
}

namespace {

void add_setting_options(CommandParser& parser, JobOptions& options) {
  add_tool_options(parser, options.tools);
  parser.add_text("--stock", options.stock, "The stock: SIZE [at POSITION] or LOW to HIGH (see below)")
      .value_name("SPEC");
  add_reading_options(parser, options.reading);
}

}  // namespace

void add_job_options(CommandParser& parser, JobOptions& options) {
  add_program(parser, options.file);
  add_setting_options(parser, options);
}

void add_job_options(CommandParser& parser, JobOptions& options, std::vector<std::string>& files) {
  add_programs(parser, files);
  add_setting_options(parser, options);
}

void add_unit_options(CommandParser& parser, JobOptions& options) {
  parser.add_flag("--inch", options.inch, "Lengths of texts in inches (default: the program's units)");
  parser.add_flag("--mm", options.mm, "Lengths of texts in mm").excludes(parser.option("--inch"));
}

ProgramUnits units_of_text(const JobOptions& options, const Program& program) {
  if (options.inch) return ProgramUnits::inch;
  return options.mm ? ProgramUnits::mm : program.units;
}

std::vector<std::string> input_files(const JobOptions& options) {
  std::vector<std::string> files{options.file, options.bodies.mesh, options.bodies.left};
  files.insert(files.end(), options.bodies.fixtures.begin(), options.bodies.fixtures.end());
  return files;
}

void add_machine_option(CommandParser& parser, JobOptions& options) {
  parser
      .add_text("--machine", options.machine,
                "Machine profile (TOML), GRBL's $$ output, or a built-in machine: " +
                    joined(built_in_machine_names(), ", "))
      .value_name("PATH");
}

void add_body_options(CommandParser& parser, BodyOptions& options) {
  Option mesh = parser.add_text("--stock-mesh", options.mesh, "The stock as a closed mesh (see below)");
  Option left =
      parser.add_text("--stock-left", options.left, "The left-over stock of an earlier job (.kstock)");
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
               "A body that the tool must not touch: LOW to HIGH, or a mesh");
}

void add_setup_options(CommandParser& parser, BodyOptions& options) {
  add_body_options(parser, options);
  options.spoilboard_option =
      add_length(parser, "--spoilboard", options.spoilboard, 0.0, limits::kThickestSpoilboard,
                 "Thickness of the board below the stock: cuts into it are not hazards (default: 0)");
  Option rotary = parser
                      .add_text("--rotary", options.rotary,
                                "A round bar that A turns: d=.. length=.. [x=..] [y=..] [z=..]")
                      .value_name("SPEC");
  for (const char* other : {"--stock", "--stock-mesh", "--stock-left", "--flip", "--shift", "--spoilboard"})
    rotary.excludes(parser.option(other));
}

ToolChoices read_tool_options(const ToolOptions& options, Diagnostics& usage, Diagnostics& diagnostics) {
  ToolChoices choices;
  for (const std::string& text : options.specs)
    add_tool(text, CallLocation{"", 0, fmt::format("--tool \"{}\"", text.substr(0, 80))}, choices, usage);
  for (const std::string& file : options.files) add_tool_file(file, choices, diagnostics);
  return choices;
}

ProgramOptions program_options(const ReadingOptions& options, const ToolChoices& tools) {
  ProgramOptions out = read_reading_options(options);
  out.tool_diameter = diameters_of(tools);
  return out;
}

JobInputs read_job_options(const JobOptions& options, Diagnostics& usage, Diagnostics& diagnostics,
                           Progress* progress) {
  JobInputs inputs;
  inputs.job.tools = read_tool_options(options.tools, usage, diagnostics);
  inputs.program = program_options(options.reading, inputs.job.tools);
  if (options.stock)
    inputs.job.stock = read_stock_option(*options.stock, CallLocation{"", 0, "--stock"}, usage);
  read_body_options(options.bodies, inputs.job, usage, diagnostics, progress);
  if (!options.machine.empty()) inputs.program.machine = machine_called(options.machine, diagnostics);
  if (inputs.program.machine) inputs.job.rapid_rates = inputs.program.machine->rates_by_axis();
  return inputs;
}

}  // namespace kerf::app
