// The sheet of a path drawing.
#include "app/commands/path_sheet.h"

#include <fmt/format.h>
#include <variant>

#include "app/commands/drop_in_output.h"

#include "kerf/dxf.h"
#include "kerf/files.h"
#include "kerf/names.h"
#include "kerf/number.h"
#include "kerf/path_sheet.h"

namespace kerf::app {
namespace {

/// Lines, arcs and circles as drawn.
void add_drawn(const std::string& file, Drawing& out) {
  Diagnostics ignored;  // reported by the compiler
  const auto input = InputFile::open(file, ignored);
  const auto drawing = input ? dxf::read_dxf(input->bytes(), file, ignored) : std::nullopt;
  if (!drawing) return;
  const std::size_t layer = sheet_layer("drawn");
  for (const dxf::Entity& e : drawing->entities) {
    if (e.paper || drawing->extrusions[e.extrusion].z <= 0.0) continue;
    if (const auto* line = std::get_if<dxf::Line>(&e.shape))
      out.entities.push_back(
          {layer, drawing::Line{line->from.x, line->from.y, line->to.x, line->to.y, 0, 0}});
    if (const auto* arc = std::get_if<dxf::Arc>(&e.shape))
      out.entities.push_back(
          {layer, drawing::Arc{arc->centre.x, arc->centre.y, arc->radius, arc->start, arc->end, 0}});
    if (const auto* circle = std::get_if<dxf::Circle>(&e.shape))
      out.entities.push_back({layer, drawing::Circle{circle->centre.x, circle->centre.y, circle->radius, 0}});
  }
}

void describe(const PathdxfProgram& program, PathSheet& sheet) {
  const auto number = [](Length length) { return number_text(length.mm(), 3); };
  sheet.path = &program.milling;
  sheet.start = program.start;
  sheet.tool_diameter = program.tool_diameter;
  sheet.title = "Path " + program.path;
  sheet.lines.push_back(fmt::format("Material {}, Z0 to Z{}; tool: flat mill, {} mm; rapids at Z{}",
                                    program.material.empty() ? "-" : program.material,
                                    number(program.thickness), number(program.tool_diameter),
                                    number(program.rapid_height)));
  sheet.lines.push_back(fmt::format("Keep the grey band free of clamps; elsewhere clamps end below Z{}",
                                    number(program.rapid_height)));
  sheet.lines.push_back("Numbers: order of milling, with the depth of the last pass");
  for (const std::string& line : program.statistics) sheet.lines.push_back(line);
  for (const PathdxfProbe& p : program.probes)
    sheet.probes.push_back(
        {p.at + program.start, fmt::format("{} {} T{}", p.name, p.label, number(p.height))});
}

}  // namespace

void write_path_sheet(const std::string& file, const PathdxfRun& run, const std::string& sheet_file,
                      Diagnostics& diagnostics) {
  PathSheet sheet;
  sheet.title = file.substr(file.find_last_of("/\\") + 1);
  if (!run.programs.empty()) describe(run.programs.front(), sheet);
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.severity == Severity::note) continue;
    const auto* at = std::get_if<DrawingLocation>(&d.where);
    if (at != nullptr && at->file == file && !at->entity.empty())
      sheet.faults.push_back({{at->x, at->y}, pathdxf_line(d)});
    else
      sheet.lines.push_back(clipped(pathdxf_line(d), 110));
  }
  Drawing drawing = path_sheet(sheet);
  add_drawn(file, drawing);
  OutputSet files;
  print_line("Writing " + sheet_file);
  if (files.write(sheet_file, write_svg(drawing), diagnostics)) files.commit(diagnostics);
}

}  // namespace kerf::app
