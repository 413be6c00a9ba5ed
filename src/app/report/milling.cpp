// The result of a milling job: volumes by tool, and hazards.
#include <fmt/format.h>
#include <map>
#include <optional>

#include "app/report/findings.h"
#include "app/report/simulation.h"
#include "app/report/status.h"
#include "base/clock_text.h"
#include "base/number.h"
#include "job/record/figures.h"

namespace kerf::app {
namespace {

/// Removed mm3 by the tool in force; key nothing: before the first tool change.
std::map<std::optional<int>, double> removed_by_tool(const Job& job, const Simulation& simulation) {
  std::map<std::optional<int>, double> removed;
  std::optional<int> tool;
  for (std::size_t i = 0; i < job.program.path.size(); ++i) {
    if (job.program.path[i].kind() == StepKind::tool_change) tool = job.program.path[i].tool_change().tool;
    removed[tool] += static_cast<double>(simulation.removed_by_step[i]);
  }
  return removed;
}

double seconds_of(const MotionFigures& f) { return (f.cutting + f.rapid + f.dwell).seconds(); }

Record tools_record(const SimulationReport& result) {
  const auto removed = removed_by_tool(result.job, result.run.milling());
  Record list = Record::array();
  for (const ToolFigures& t : result.job.report.tools) {
    const auto it = removed.find(t.tool);
    Record entry;
    entry["number"] = t.tool ? Record(*t.tool) : Record(nullptr);
    const Tool* tool = t.tool ? result.job.tools.find(*t.tool) : nullptr;
    entry["name"] = tool != nullptr ? Record(short_name(*tool)) : Record(nullptr);
    if (t.tool) entry["source"] = to_string(result.job.tool_sources.at(*t.tool));
    entry["removed_mm3"] = record_of(it == removed.end() ? 0.0 : it->second);
    entry["time_s"] = record_of(seconds_of(t.figures));
    list.push_back(std::move(entry));
  }
  return list;
}

Record record_of_result(const SimulationReport& result) {
  const Simulation& s = result.run.milling();
  Record out;
  out["source"] = result.job.program.source;
  out.update(record_of_volumes(s.stock, s.removed));
  out["resolution_mm"] = record_of(s.workpiece.pitch().mm());
  if (result.mesh_tolerance) out["mesh_tolerance_mm"] = record_of(result.mesh_tolerance->mm());
  out["steps"] = result.job.program.path.size();
  out["seconds"] = record_of(s.seconds);
  out["stock"] = record_of_stock(result.job);
  out["hazards"] = record_of(result.run.findings);
  out["tools"] = tools_record(result);
  out["outputs"] = record_of(result.files);
  out["diagnostics"] = record_of(result.diagnostics);
  return out;
}

void show_summary(Console& console, const SimulationReport& result) {
  const Simulation& s = result.run.milling();
  const LengthText& lengths = console.lengths();
  console.summary(fmt::format("{}: {} steps", result.job.program.source, result.job.program.path.size()));
  console.summary(fmt::format("stock    {} ({}), {}", lengths.size(result.job.stock->block.size()),
                              to_string(result.job.stock_source), lengths.volume(s.stock.mm3(), 1)));
  const double percent = s.stock.mm3() > 0.0 ? 100.0 * s.removed.mm3() / s.stock.mm3() : 0.0;
  console.summary(fmt::format("removed  {} ({}%), left {}", lengths.volume(s.removed.mm3(), 1),
                              number_text(percent, 1), lengths.volume(s.stock.mm3() - s.removed.mm3(), 1)));
  const auto removed = removed_by_tool(result.job, s);
  for (const ToolFigures& t : result.job.report.tools) {
    if (!t.tool || t.figures.cut_bounds.empty()) continue;
    const Tool* tool = result.job.tools.find(*t.tool);
    const auto it = removed.find(t.tool);
    console.summary(fmt::format(
        "tool {:<4}{}: {} in about {}", *t.tool, tool != nullptr ? lengths.tool(*tool) : "unknown",
        lengths.volume(it == removed.end() ? 0.0 : it->second, 1), clock_text(seconds_of(t.figures))));
  }
  console.summary(fmt::format("columns  {} apart, simulated in {} s",
                              lengths.with_unit(s.workpiece.pitch().mm(), 4), number_text(s.seconds, 3)));
  show_written(console, result.files);
  console.summary(fmt::format("hazards  {}", count_text(result.run.findings)));
}

}  // namespace

void report_milling(Console& console, const SimulationReport& report) {
  if (console.json()) {
    console.print_json(text_of(record_of_result(report), Layout::indented));
    return;
  }
  show_summary(console, report);
  show(console, report.run.findings);
}

void report_drawing(Console& console, const Job& job, const std::vector<PartFile>& files,
                    const Diagnostics& diagnostics) {
  console.show(diagnostics);
  if (console.json()) {
    Record out;
    out["source"] = job.program.source;
    out["removed_mm3"] = record_of(0.0);
    out["steps"] = job.program.path.size();
    out["stock"] = nullptr;
    out["hazards"] = Record::array();
    out["outputs"] = record_of(files);
    out["diagnostics"] = record_of(diagnostics);
    console.print_json(text_of(out, Layout::indented));
    return;
  }
  console.summary(fmt::format("{}: {} steps", job.program.source, job.program.path.size()));
  show_written(console, files);
}

}  // namespace kerf::app
