// The figures of a program that cuts as JSON.
#include "job/record/info.h"

#include "job/beam.h"
#include "job/record/figures.h"

namespace kerf {
namespace {

Record tool_record(const Job& job, const ToolFigures& t) {
  const Tool* tool = t.tool ? job.tools.find(*t.tool) : nullptr;
  const bool beam = t.tool && is_beam(job, *t.tool);
  Record out;
  out["number"] = t.tool ? Record(*t.tool) : Record(nullptr);
  out["name"] = tool != nullptr ? Record(beam ? "beam" : short_name(*tool)) : Record(nullptr);
  out["known"] = tool != nullptr;
  out["source"] = t.tool ? to_string(job.tool_sources.at(*t.tool)) : to_string(ToolSource::unknown);
  out["deepest_mm"] = t.deepest ? record_of(*t.deepest) : Record(nullptr);
  out["flute_mm"] = tool != nullptr && !beam ? record_of(tool->flute.mm()) : Record(nullptr);
  out["flute_assumed"] = tool != nullptr && !beam && tool->flute_assumed;
  out["deeper_than_flute"] = deeper_than_flute(job, t);
  if (tool != nullptr) {
    out["shape"] = beam ? "beam" : name_of(tool->shape);
    out["diameter_mm"] = record_of(tool->diameter.mm());
  }
  out["motion"] = record_of(t.figures);
  out["feeds"] = record_of(t.figures.feed);
  out["speeds"] = record_of(t.figures.speed);
  return out;
}

}  // namespace

Record info_record(const Job& job, const JobTimes& times, const Diagnostics& diagnostics) {
  const PathReport& report = job.report;
  Record out;
  out["source"] = job.program.source;
  out["front_end"] = job.program.front_end;
  out["units"] = job.program.units == ProgramUnits::inch ? "inch" : "mm";
  out["steps"] = job.program.path.size();
  if (job.program.end != ProgramEnd::not_asked) out["ended"] = job.program.end == ProgramEnd::seen;
  out["motion"] = record_of(report.all);
  out["time_s"] = record_of(times);
  Record& tools = out["tools"] = Record::array();
  for (const ToolFigures& t : report.tools) tools.push_back(tool_record(job, t));
  out["feeds"] = record_of(report.all.feed);
  out["speeds"] = record_of(report.all.speed);
  out["stock"] = record_of_stock(job);
  out["diagnostics"] = record_of(diagnostics);
  return out;
}

}  // namespace kerf
