// The result of a job on a fourth axis: volumes and hazards.
#include <fmt/format.h>

#include "app/report/findings.h"
#include "app/report/simulation.h"
#include "app/report/status.h"
#include "base/number.h"
#include "job/record/figures.h"

namespace kerf::app {
namespace {

Record record_of_result(const Job& job, const RotarySimulation& s, const std::vector<Finding>& findings,
                        const std::vector<PartFile>& outputs, const Diagnostics& diagnostics) {
  Record out;
  out["source"] = job.program.source;
  out.update(record_of_volumes(s.stock, s.removed));
  out["resolution_mm"] = record_of(s.workpiece.dx);
  out["steps"] = job.program.path.size();
  out["seconds"] = record_of(s.seconds);
  out["stock"] = record_of_stock(job);
  out["hazards"] = record_of(findings);
  out["outputs"] = record_of(outputs);
  out["diagnostics"] = record_of(diagnostics);
  return out;
}

void show_summary(Console& console, const Job& job, const RotarySimulation& s,
                  const std::vector<Finding>& findings, const std::vector<PartFile>& outputs) {
  console.summary(fmt::format("{}: {} steps", job.program.source, job.program.path.size()));
  console.summary(
      fmt::format("bar      diameter {} mm, length {} mm, {} mm3", number_text(job.bar->diameter, 3),
                  number_text(job.bar->x_high - job.bar->x_low, 3), number_text(s.stock.mm3(), 1)));
  console.summary(fmt::format("removed  {} mm3, left {} mm3", number_text(s.removed.mm3(), 1),
                              number_text(s.stock.mm3() - s.removed.mm3(), 1)));
  console.summary(fmt::format("rays     {} mm apart, simulated in {} s", number_text(s.workpiece.dx, 4),
                              number_text(s.seconds, 3)));
  show_written(console, outputs);
  console.summary(fmt::format("hazards  {}", count_text(findings)));
}

}  // namespace

void report_rotary(Console& console, const SimulationReport& report) {
  const RotarySimulation& s = report.run.rotary();
  if (console.json()) {
    console.print_json(
        text_of(record_of_result(report.job, s, report.run.findings, report.files, report.diagnostics),
                Layout::indented));
    return;
  }
  show_summary(console, report.job, s, report.run.findings, report.files);
  show(console, report.run.findings);
}

}  // namespace kerf::app
