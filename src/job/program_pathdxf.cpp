// Path drawings as a way in: with the tool of the path, and a plate around its cuts.
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "base/codes/pathdxf.h"
#include "base/number.h"
#include "front/pathdxf/pathdxf.h"
#include "job/front_ends.h"

#include "kerf/path/report.h"

namespace kerf {
namespace {

const Length kPlateMargin = mm(2);  // beyond the tool's radius around the cuts
const Length kSpoilboard = mm(3);
constexpr int kTool = 1;  // number of the only tool

/// The first section of a DXF file, or the first bytes of a binary one.
bool looks_like_dxf(std::string_view text) {
  if (text.substr(0, 22) == "AutoCAD Binary DXF\r\n\x1A") return true;
  const std::size_t section = text.find("SECTION");
  const std::size_t header = text.find("HEADER"), entities = text.find("ENTITIES");
  return section != std::string_view::npos &&
         (header != std::string_view::npos || entities != std::string_view::npos);
}

/// A plate from Z0 to the thickness that the paths specify.
std::optional<Stock> plate_of(const PathdxfProgram& program) {
  Box3 cuts = report_on(program.milling, {}).all.cut_bounds;
  if (cuts.empty() || !(program.top > Length())) return std::nullopt;
  const double margin = (0.5 * program.tool_diameter + kPlateMargin).mm();
  Stock stock;
  stock.block.add(Point3{cuts.low.x - margin, cuts.low.y - margin, 0.0});
  stock.block.add(Point3{cuts.high.x + margin, cuts.high.y + margin, program.top.mm()});
  return stock;
}

/// The probes, by the numbers of their variables ("#51").
std::vector<HeightTarget> targets_of(const PathdxfProgram& program) {
  std::vector<HeightTarget> targets;
  for (const PathdxfProbe& p : program.probes)
    if (const auto number = parse_number(std::string_view(p.name).substr(1)))
      targets.push_back({static_cast<int>(*number), {p.at.x, p.at.y}, p.height.mm()});
  return targets;
}

Program read(const InputFile& file, const ProgramOptions& input, Diagnostics& diagnostics,
             Progress* progress) {
  PathdxfOptions options;
  static_cast<PathDrawingOptions&>(options) = input.drawing;
  options.variables = input.defines;
  options.free_variables = FreeVariables::example;
  options.folders = input.include_paths;
  options.opened = OpenedDrawing{file.path(), file.bytes()};
  PathdxfRun run = compile_pathdxf(file.path(), options, diagnostics, progress);
  Program program;
  for (const std::string& name : run.files)
    if (name != file.path()) program.files.push_back(name);
  if (run.programs.empty()) return program;
  PathdxfProgram& compiled = run.programs.front();
  const Origin where = TextLocation{file.path(), 0, 0};
  if (auto tool = make_tool(kTool, shape::Square{compiled.tool_diameter, {}}, {}, where, diagnostics))
    program.tools.emplace(kTool, std::move(*tool));
  program.stock = plate_of(compiled);
  // Paths cut through the plate, below Z0.
  program.spoilboard = kSpoilboard;
  program.manual_spindle = true;
  program.probes = targets_of(compiled);
  program.path = std::move(compiled.milling);
  diagnostics
      .note(codes::pathdxf_assumed, where,
            fmt::format(
                "tool 1 is a flat mill of {} mm (O); the stock is a plate from Z0 to Z{} (T) around the cuts",
                number_text(compiled.tool_diameter.mm(), 3), number_text(compiled.top.mm(), 3)))
      .hint = "specify others with --tool and --stock";
  return program;
}

}  // namespace

FrontEnd pathdxf_front_end() {
  return {"path drawing", {".dxf"}, looks_like_dxf, read, {OptionGroup::define, OptionGroup::drawing}};
}

}  // namespace kerf
