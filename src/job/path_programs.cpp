// The texts of a path drawing's program, and its sheet for the workshop.
#include "job/path_programs.h"

#include <algorithm>
#include <fmt/format.h>
#include <variant>

#include "back/drawing/path_sheet.h"
#include "back/pathdxf/pathdxf_gcode.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/base/files.h"
#include "kerf/drawing/dxf.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxSheetLine = 110;  // characters

using namespace path_endings;

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

std::vector<PathFile> path_files(const PathdxfProgram& program, const std::string& drawing,
                                 Diagnostics& diagnostics) {
  PathdxfGcodeOptions options;
  options.program_line = "PathDxf2GCode - Kerf " KERF_VERSION;
  options.file_name = name_in_folder(drawing);
  std::vector<PathFile> files;
  const auto add = [&](const char* ending, std::string text) {
    files.push_back({program.suffix + ending, std::move(text)});
  };
  std::string milling = program.is_empty ? "" : pathdxf_gcode(program.milling, options, diagnostics);
  if (program.probing) {
    add(kProbing, pathdxf_gcode(*program.probing, options, diagnostics));
    add(kProbeList, pathdxf_probe_list(program));
    add(kClean, std::move(milling));
  } else {
    add(kMilling, std::move(milling));
  }
  return files;
}

std::vector<std::string> stale_path_files(const std::string& base, const PathdxfProgram& program,
                                          const std::vector<PathFile>& written) {
  std::vector<std::string> stale;
  for (const char* const ending : {kMilling, kProbing, kProbeList, kClean}) {
    const std::string name = program.suffix + ending;
    const bool is_written = std::any_of(written.begin(), written.end(),
                                        [&](const PathFile& file) { return file.ending == name; });
    if (!is_written && exists(base + name)) stale.push_back(base + name);
  }
  return stale;
}

std::string path_sheet_svg(const std::string& file, const PathdxfRun& run, const Diagnostics& diagnostics) {
  PathSheet sheet;
  sheet.title = name_in_folder(file);
  if (!run.programs.empty()) describe(run.programs.front(), sheet);
  for (const Diagnostic& d : diagnostics.list()) {
    if (d.severity == Severity::note) continue;
    const auto* at = std::get_if<DrawingLocation>(&d.where);
    if (at != nullptr && at->file == file && !at->entity.empty())
      sheet.faults.push_back({{at->x, at->y}, pathdxf_line(d)});
    else
      sheet.lines.push_back(clipped(pathdxf_line(d), kMaxSheetLine));
  }
  Drawing drawing = path_sheet(sheet);
  add_drawn(file, drawing);
  return write_svg(drawing);
}

}  // namespace kerf
