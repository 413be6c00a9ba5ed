// The figures of a program that cuts as JSON.
#include "app/report/info_json.h"

namespace kerf::app {
namespace {

Json motion_json(const MotionFigures& f) {
  return {{"lines", f.lines},
          {"arcs", f.arcs},
          {"rapids", f.rapids},
          {"cut_mm", json_of(f.cut_mm)},
          {"rapid_mm", json_of(f.rapid_mm)},
          {"cut_bounds_mm", json_of(f.cut_ends)},
          {"cut_extent_mm", json_of(f.cut_bounds)}};
}

Json number_or_null(std::optional<int> tool) { return tool ? Json(*tool) : Json(nullptr); }

Json figures_json(const TimeFigures& time) {
  return {{"total", json_of(time.total().seconds())},
          {"motion", json_of(time.motion.seconds())},
          {"cutting", json_of(time.cutting().seconds())},
          {"rapid", json_of(time.rapid.seconds())},
          {"dwell", json_of(time.dwell.seconds())},
          {"halts", json_of(time.halts.seconds())},
          {"stops", time.stops}};
}

Json time_json(const JobTimes& times) {
  const TimeEstimate& estimate = times.estimate;
  Json out = figures_json(estimate.all);
  out["method"] = times.planned() ? kPlannedMethod : kPlainMethod;
  out["machine"] = times.planned() ? Json(times.machine) : Json(nullptr);
  Json& tools = out["tools"] = Json::array();
  for (const ToolTime& t : estimate.tools) {
    Json entry{{"number", number_or_null(t.tool)}};
    entry.update(figures_json(t.time));
    tools.push_back(std::move(entry));
  }
  if (!times.planned()) return out;
  out["not_timed"] = estimate.not_timed;
  Json& operations = out["operations"] = Json::array();
  for (const OperationTime& o : estimate.operations) {
    Json entry{{"name", o.name}, {"tool", number_or_null(o.tool)}, {"step", o.first_step}};
    entry.update(figures_json(o.time));
    operations.push_back(std::move(entry));
  }
  return out;
}

Json tool_json(const Job& job, const ToolFigures& t) {
  const Tool* tool = t.tool ? job.tools.find(*t.tool) : nullptr;
  Json out;
  out["number"] = t.tool ? Json(*t.tool) : Json(nullptr);
  out["name"] = tool != nullptr ? Json(short_name(*tool)) : Json(nullptr);
  out["known"] = tool != nullptr;
  out["source"] = t.tool ? to_string(job.tool_sources.at(*t.tool)) : to_string(ToolSource::unknown);
  out["deepest_mm"] = t.deepest ? json_of(*t.deepest) : Json(nullptr);
  out["flute_mm"] = tool != nullptr ? json_of(tool->flute.mm()) : Json(nullptr);
  out["flute_assumed"] = tool != nullptr && tool->flute_assumed;
  out["deeper_than_flute"] = deeper_than_flute(job, t);
  if (tool != nullptr) {
    out["shape"] = name_of(tool->shape);
    out["diameter_mm"] = json_of(tool->diameter.mm());
  }
  out["motion"] = motion_json(t.figures);
  out["feeds"] = json_of(t.figures.feed);
  out["speeds"] = json_of(t.figures.speed);
  return out;
}

}  // namespace

Json info_json(const Job& job, const JobTimes& times, const Diagnostics& diagnostics) {
  const PathReport& report = job.report;
  Json out;
  out["source"] = job.program.source;
  out["front_end"] = job.program.front_end;
  out["units"] = job.program.units == ProgramUnits::inch ? "inch" : "mm";
  out["steps"] = job.program.path.size();
  if (job.program.end != ProgramEnd::not_asked) out["ended"] = job.program.end == ProgramEnd::seen;
  out["motion"] = motion_json(report.all);
  out["time_s"] = time_json(times);
  Json& tools = out["tools"] = Json::array();
  for (const ToolFigures& t : report.tools) tools.push_back(tool_json(job, t));
  out["feeds"] = json_of(report.all.feed);
  out["speeds"] = json_of(report.all.speed);
  out["stock"] = nullptr;
  if (job.stock)
    out["stock"] = Json{{"block_mm", json_of(job.stock->block)},
                        {"size_mm", json_of(job.stock->block.size())},
                        {"source", to_string(job.stock_source)}};
  out["diagnostics"] = json_of(diagnostics);
  return out;
}

}  // namespace kerf::app
