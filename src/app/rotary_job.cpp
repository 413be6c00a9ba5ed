// The fourth axis for kerf simulate: the same figures as for a block.
#include "app/rotary_job.h"

#include <fmt/format.h>

#include "app/report/terminal_progress.h"

#include "kerf/number.h"

namespace kerf::app {
namespace {

Json json_of_bar(const RoundBar& bar) {
  return {{"bar",
           {{"diameter_mm", json_of(bar.diameter)},
            {"x_mm", {json_of(bar.x_low), json_of(bar.x_high)}},
            {"axis_mm", {json_of(bar.axis_y), json_of(bar.axis_z)}}}},
          {"source", to_string(StockSource::option)}};
}

Json json_of_result(const Job& job, const RotarySimulation& s, const std::vector<Finding>& findings,
                    const std::vector<OutputFile>& outputs, const Diagnostics& diagnostics) {
  Json out;
  out["source"] = job.program.source;
  out["stock_mm3"] = json_of(s.stock.mm3());
  out["removed_mm3"] = json_of(s.removed.mm3());
  out["left_mm3"] = json_of(s.stock.mm3() - s.removed.mm3());
  out["resolution_mm"] = json_of(s.workpiece.dx);
  out["steps"] = job.program.path.size();
  out["seconds"] = json_of(s.seconds);
  out["stock"] = json_of_bar(*job.bar);
  out["hazards"] = json_of(findings);
  out["outputs"] = json_of(outputs);
  out["diagnostics"] = json_of(diagnostics);
  return out;
}

void show_summary(Console& console, const Job& job, const RotarySimulation& s,
                  const std::vector<Finding>& findings, const std::vector<OutputFile>& outputs) {
  console.summary(fmt::format("{}: {} steps", job.program.source, job.program.path.size()));
  console.summary(fmt::format("bar      {} mm across, {} mm long, {} mm3", number_text(job.bar->diameter, 3),
                              number_text(job.bar->x_high - job.bar->x_low, 3),
                              number_text(s.stock.mm3(), 1)));
  console.summary(fmt::format("removed  {} mm3, left {} mm3", number_text(s.removed.mm3(), 1),
                              number_text(s.stock.mm3() - s.removed.mm3(), 1)));
  console.summary(fmt::format("rays     {} mm apart, simulated in {} s", number_text(s.workpiece.dx, 4),
                              number_text(s.seconds, 3)));
  show_written(console, outputs);
  console.summary(fmt::format("hazards  {}", count_text(findings)));
}

}  // namespace

Status simulate_bar(Console& console, const Job& job, const SimulationOptions& how,
                    const std::vector<OutputFile>& outputs, const View& view, Diagnostics& diagnostics) {
  refuse_left(outputs, "what is left of a bar", diagnostics);
  if (diagnostics.has_errors()) return fail(console, diagnostics, Status::input_errors);
  TerminalProgress progress(console);
  const auto s = simulate_rotary(job.program.path, job.tools, *job.bar, how, diagnostics, &progress);
  OutputSet files;
  bool written = s && !s->stopped && !diagnostics.has_errors();
  if (written && !outputs.empty()) {
    const Mesh mesh = extract_mesh(s->workpiece, &progress);
    written =
        !progress.stop_requested() && write_surface(outputs, job.program, mesh, mesh_volume(s->workpiece),
                                                    steps_of(s->hazards), view, files, diagnostics, progress);
  }
  if (const auto end = finish_outputs(console, progress, written, files, diagnostics)) return *end;
  std::vector<Finding> findings = findings_of(s->hazards, job.program.path);
  tell_assumed_flutes(findings, job.program.path, job.tools, diagnostics);
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(json_of_result(job, *s, findings, outputs, diagnostics), Layout::indented));
    return Status::done;
  }
  show_summary(console, job, *s, findings, outputs);
  show(console, findings);
  return Status::done;
}

}  // namespace kerf::app
