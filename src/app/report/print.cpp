// A print, simulated: volumes by layer, and hazards.
#include <algorithm>
#include <fmt/format.h>
#include <iterator>

#include "app/report/findings.h"
#include "app/report/simulation.h"
#include "app/report/status.h"
#include "base/number.h"
#include "job/record/figures.h"

namespace kerf::app {
namespace {

/// Hazards that damage something first, then those that only affect the surface.
std::vector<Finding> worst_first(std::vector<PrintHazard> hazards, const Toolpath& path) {
  std::stable_sort(hazards.begin(), hazards.end(),
                   [](const PrintHazard& a, const PrintHazard& b) { return a.kind < b.kind; });
  return findings_of(hazards, path);
}

/// The findings of a run that are no hazards of its print: codes that were left out.
std::vector<Finding> left_out(const JobRun& run) {
  std::vector<Finding> list;
  std::copy_if(run.findings.begin(), run.findings.end(), std::back_inserter(list),
               [](const Finding& f) { return f.kind == "left_out"; });
  return list;
}

Record record_of_result(const Program& program, const PrintSimulation& s,
                        const std::vector<PartFile>& outputs, const Diagnostics& diagnostics) {
  Record out;
  out["source"] = program.source;
  out["kind"] = "print";
  out.update(record_of_totals(s.total));
  out["roads"] = s.beads;
  Record& layers = out["layers"] = Record::array();
  for (const PrintLayer& layer : s.layers) layers.push_back(record_of(layer));
  out["resolution_mm"] = record_of(s.columns.pitch);
  out["steps"] = program.path.size();
  out["seconds"] = record_of(s.seconds);
  out["hazards"] = record_of(s.hazards, program.path);
  out["outputs"] = record_of(outputs);
  out["diagnostics"] = record_of(diagnostics);
  return out;
}

void show_summary(Console& console, const Program& program, const PrintSimulation& s,
                  const std::vector<PartFile>& outputs, const std::vector<Finding>& findings) {
  const auto text = [](Volume v) { return number_text(v.mm3(), 1); };
  const PrintVolumes& t = s.total;
  const double overlap_percent = 100.0 * (t.overlap / t.extruded);
  console.summary(fmt::format("{}: {} steps, a print", program.source, program.path.size()));
  console.summary(fmt::format("beads    {} in {} layers, {} mm long", s.beads, s.layers.size(),
                              number_text(t.bead_length.mm(), 1)));
  console.summary(fmt::format("extruded {} mm3, {} of it ({}%) overlapping other beads", text(t.extruded),
                              text(t.overlap), number_text(overlap_percent, 1)));
  console.summary(fmt::format("laid     {} mm3 of material", text(t.laid)));
  console.summary(
      fmt::format("hollow   {} mm3 below material, {} of it enclosed", text(t.hollow), text(t.enclosed)));
  console.summary(
      fmt::format("bridges  {} mm of beads without support below", number_text(t.unsupported.mm(), 1)));
  if (t.blobs.mm3() > 0.0)
    console.summary(fmt::format("blobs    {} mm3 extruded without a motion", text(t.blobs)));
  console.summary(fmt::format("columns  {} mm apart, simulated in {} s", number_text(s.columns.pitch, 4),
                              number_text(s.seconds, 3)));
  show_written(console, outputs);
  console.summary(fmt::format("hazards  {}", count_text(findings)));
}

}  // namespace

void report_print(Console& console, const SimulationReport& report) {
  const Program& program = report.job.program;
  const PrintSimulation& s = report.run.print();
  const auto colour = [](const std::array<std::uint8_t, 3>& c) {
    return fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]);
  };
  if (console.json()) {
    Record out = record_of_result(program, s, report.files, report.diagnostics);
    for (const Finding& finding : left_out(report.run)) out["hazards"].push_back(record_of(finding));
    Record colours = Record::array();
    for (const auto& [name, rgb] : report.legend)
      colours.push_back(Record{{"name", name}, {"colour", colour(rgb)}});
    if (!report.legend.empty()) out["colours"] = colours;
    console.print_json(text_of(out, Layout::indented));
    return;
  }
  std::vector<Finding> findings = worst_first(s.hazards, program.path);
  for (Finding& finding : left_out(report.run)) findings.push_back(std::move(finding));
  show_summary(console, program, s, report.files, findings);
  for (const auto& [name, rgb] : report.legend)
    console.summary(fmt::format("colour   {} {}", colour(rgb), name));
  show(console, findings);
}

}  // namespace kerf::app
