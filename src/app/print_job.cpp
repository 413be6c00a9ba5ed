// Printing programs for kerf simulate: volumes by layer, hazards, the part as meshes and pictures.
#include "app/print_job.h"

#include <algorithm>
#include <fmt/format.h>

#include "app/report/terminal_progress.h"

#include "kerf/number.h"

namespace kerf::app {
namespace {

std::string message_of(const PrintHazard& hazard) {
  const std::string length = number_text(hazard.length.mm(), 2);
  switch (hazard.kind) {
    case PrintHazardKind::nozzle_contact:
      return fmt::format("the nozzle goes {} mm deep through printed material or the bed",
                         number_text(hazard.depth.mm(), 3));
    case PrintHazardKind::in_air: return fmt::format("{} mm of road are printed in the air", length);
    case PrintHazardKind::unsupported: return fmt::format("{} mm of road have nothing below", length);
    case PrintHazardKind::blob: break;
  }
  return fmt::format("{} mm3 of filament are pushed on the spot", number_text(hazard.volume.mm3(), 3));
}

std::vector<Finding> findings_of(const std::vector<PrintHazard>& hazards, const Toolpath& path) {
  std::vector<Finding> out;
  for (const PrintHazard& h : hazards) {
    Finding finding;
    finding.kind = to_string(h.kind);
    finding.step = h.step;
    finding.steps = h.steps;
    finding.at = h.at;
    finding.depth_mm = h.depth.mm();
    finding.origin = path.origin_of(h.step);
    finding.message = message_of(h);
    out.push_back(std::move(finding));
  }
  return out;
}

/// What breaks something comes before what only looks bad.
std::vector<Finding> worst_first(std::vector<PrintHazard> hazards, const Toolpath& path) {
  std::stable_sort(hazards.begin(), hazards.end(),
                   [](const PrintHazard& a, const PrintHazard& b) { return a.kind < b.kind; });
  return findings_of(hazards, path);
}

/// Those whose material is drawn red; bridges are as they should be.
std::vector<std::uint32_t> red_steps(const std::vector<PrintHazard>& hazards) {
  std::vector<PrintHazard> bad;
  std::copy_if(hazards.begin(), hazards.end(), std::back_inserter(bad), [](const PrintHazard& h) {
    return h.kind == PrintHazardKind::nozzle_contact || h.kind == PrintHazardKind::in_air;
  });
  return steps_of(bad);
}

void add_volumes(Json& out, const PrintVolumes& v) {
  out["extruded_mm3"] = json_of(v.extruded.mm3());
  out["laid_mm3"] = json_of(v.laid.mm3());
  out["overlap_mm3"] = json_of(v.overlap.mm3());
  out["ends_mm3"] = json_of(v.ends.mm3());
  out["hollow_mm3"] = json_of(v.hollow.mm3());
  out["enclosed_mm3"] = json_of(v.enclosed.mm3());
  out["road_mm"] = json_of(v.road_length.mm());
  out["unsupported_mm"] = json_of(v.unsupported.mm());
}

Json layers_json(const std::vector<PrintLayer>& layers) {
  Json list = Json::array();
  for (const PrintLayer& layer : layers) {
    Json entry{
        {"z_mm", json_of(layer.z.mm())}, {"height_mm", json_of(layer.height.mm())}, {"roads", layer.roads}};
    add_volumes(entry, layer.volumes);
    list.push_back(std::move(entry));
  }
  return list;
}

Json hazards_json(const std::vector<PrintHazard>& hazards, const Toolpath& path) {
  Json list = json_of(findings_of(hazards, path));
  for (std::size_t i = 0; i < hazards.size(); ++i) {
    list[i]["length_mm"] = json_of(hazards[i].length.mm());
    list[i]["volume_mm3"] = json_of(hazards[i].volume.mm3());
  }
  return list;
}

Json json_of_result(const LoadedProgram& program, const PrintSimulation& s,
                    const std::vector<OutputFile>& outputs, const Diagnostics& diagnostics) {
  Json out;
  out["source"] = program.source;
  out["kind"] = "print";
  add_volumes(out, s.total);
  out["blobs_mm3"] = json_of(s.total.blobs.mm3());
  out["roads"] = s.roads;
  out["layers"] = layers_json(s.layers);
  out["resolution_mm"] = json_of(s.columns.pitch);
  out["steps"] = program.path.size();
  out["seconds"] = json_of(s.seconds);
  out["hazards"] = hazards_json(s.hazards, program.path);
  out["outputs"] = json_of(outputs);
  out["diagnostics"] = json_of(diagnostics);
  return out;
}

void show_summary(Console& console, const LoadedProgram& program, const PrintSimulation& s,
                  const std::vector<OutputFile>& outputs, const std::vector<Finding>& findings) {
  const auto text = [](Volume v) { return number_text(v.mm3(), 1); };
  const PrintVolumes& t = s.total;
  const double share = 100.0 * (t.overlap / t.extruded);
  console.summary(fmt::format("{}: {} steps, a print", program.source, program.path.size()));
  console.summary(fmt::format("roads    {} in {} layers, {} mm long", s.roads, s.layers.size(),
                              number_text(t.road_length.mm(), 1)));
  console.summary(fmt::format("extruded {} mm3, {} of it ({}%) where material is already", text(t.extruded),
                              text(t.overlap), number_text(share, 1)));
  console.summary(fmt::format("laid     {} mm3 of material", text(t.laid)));
  console.summary(
      fmt::format("hollow   {} mm3 below material, {} of it enclosed", text(t.hollow), text(t.enclosed)));
  console.summary(
      fmt::format("bridges  {} mm of road have nothing below", number_text(t.unsupported.mm(), 1)));
  if (t.blobs.mm3() > 0.0) console.summary(fmt::format("blobs    {} mm3 pushed on the spot", text(t.blobs)));
  console.summary(fmt::format("columns  {} mm apart, simulated in {} s", number_text(s.columns.pitch, 4),
                              number_text(s.seconds, 3)));
  show_written(console, outputs);
  console.summary(fmt::format("hazards  {}", count_text(findings)));
}

bool write_part(const std::vector<OutputFile>& outputs, const LoadedProgram& program,
                const PrintSimulation& s, Grooves grooves, const View& view, OutputSet& files,
                Diagnostics& diagnostics, Progress& progress) {
  Length layer;
  for (const PrintLayer& l : s.layers) layer = std::max(layer, l.height);
  const std::vector<std::uint32_t> red = red_steps(s.hazards);
  const auto groups = colour_groups(program.path, red);
  const MeshOptions options{.tolerance = kMeshTolerance, .step_groups = groups};
  progress.phase("making the surface");
  const ColumnGrid closed = grooves == Grooves::kept ? ColumnGrid{} : without_grooves(s.columns, layer);
  const ColumnGrid& columns = grooves == Grooves::kept ? s.columns : closed;
  const Mesh mesh = extract_print_mesh(columns, options, &progress);
  return !progress.stop_requested() && write_surface(outputs, program, mesh, mesh_volume(columns, options),
                                                     red, view, files, diagnostics, progress);
}

}  // namespace

Status simulate_printing(Console& console, const LoadedProgram& program, const PrintOptions& how,
                         Grooves grooves, const std::vector<OutputFile>& outputs, const View& view,
                         Diagnostics& diagnostics) {
  refuse_left(outputs, "a print", diagnostics);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  TerminalProgress progress(console);
  const auto s = simulate_print(program.path, how, diagnostics, &progress);
  OutputSet files;
  bool written = s && !s->stopped && !diagnostics.has_errors();
  if (written && !outputs.empty())
    written = write_part(outputs, program, *s, grooves, view, files, diagnostics, progress);
  if (const auto end = finish_outputs(console, progress, written, files, diagnostics)) return *end;
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(json_of_result(program, *s, outputs, diagnostics), Layout::indented));
    return Status::done;
  }
  const std::vector<Finding> findings = worst_first(s->hazards, program.path);
  show_summary(console, program, *s, outputs, findings);
  show(console, findings);
  return Status::done;
}

}  // namespace kerf::app
