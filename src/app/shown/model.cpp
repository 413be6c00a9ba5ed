// The model as JSON: bounds, stock, tools, findings, times, marks and sources.
#include "app/shown/model.h"

#include <algorithm>
#include <map>

#include "app/report/findings.h"
#include "app/shown/motions.h"
#include "app/shown/viewable.h"
#include "base/file_names.h"
#include "job/named.h"
#include "job/record/figures.h"
#include "job/record/info.h"

#include "kerf/base/files.h"
#include "kerf/job/outputs.h"
#include "kerf/job/posting.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxMarks = 2000;  // on the time axis
constexpr double kBulgeStep = 0.12;      // radians between points of a profile's arc

std::string_view name_of(LiveKind kind) {
  switch (kind) {
    case LiveKind::milling: return "milling";
    case LiveKind::rotary: return "rotary";
    case LiveKind::print: return "print";
    case LiveKind::path_only: break;
  }
  return "drawing";
}

Record colour_record(std::size_t index) {
  Record list = Record::array();
  for (const std::uint8_t channel : part_palette()[index]) list.push_back(channel);
  return list;
}

/// A profile as points [r, z], arcs as chords.
Record points_record(const Profile& profile) {
  Record points = Record::array();
  const auto add = [&](double r, double z) { points.push_back(Record::array({record_of(r), record_of(z)})); };
  for (std::size_t k = 0; k < profile.knots.size(); ++k) {
    const Knot& a = profile.knots[k];
    add(a.r, a.z);
    if (a.bulge == 0.0 || k + 1 == profile.knots.size()) continue;
    const Knot& b = profile.knots[k + 1];
    // Around the centre: the perpendicular of the chord at its midpoint, scaled by the bulge.
    const double scale = (1.0 / a.bulge - a.bulge) / 4.0, angle = 4.0 * std::atan(a.bulge);
    const Point2 centre{0.5 * (a.r + b.r) - scale * (b.z - a.z), 0.5 * (a.z + b.z) + scale * (b.r - a.r)};
    const int chords = std::max(2, static_cast<int>(std::ceil(std::abs(angle) / kBulgeStep)));
    for (int i = 1; i < chords; ++i) {
      const double turn = angle * i / chords, c = std::cos(turn), s = std::sin(turn);
      const double r = a.r - centre.x, z = a.z - centre.y;
      add(std::max(centre.x + c * r - s * z, 0.0), centre.y + s * r + c * z);
    }
  }
  return points;
}

Record profiles_record(const Silhouette& silhouette) {
  Record list = Record::array();
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = silhouette.part(part);
    if (profile.empty()) continue;
    const bool cuts = part == ToolPart::cutting;
    list.push_back(
        {{"part", cuts ? std::string_view("flute") : to_string(part)}, {"points", points_record(profile)}});
  }
  return list;
}

/// Removed mm3 by the tool in force; key nothing: before the first tool change.
std::map<std::optional<int>, double> removed_by_tool(const LiveSimulation& live) {
  std::map<std::optional<int>, double> removed;
  const std::vector<float> by_step = live.removed_by_step();
  std::optional<int> tool;
  for (std::size_t i = 0; i < by_step.size(); ++i) {
    if (live.path()[i].kind() == StepKind::tool_change) tool = live.path()[i].tool_change().tool;
    removed[tool] += static_cast<double>(by_step[i]);
  }
  return removed;
}

Record tools_record(const LiveJob& live, const JobTimes& times) {
  const Job& job = *live.job();
  std::map<int, std::uint8_t> colours;
  for (const auto& [tool, colour] : tool_colours(job.program.path)) colours[tool] = colour;
  std::map<std::optional<int>, double> removed;
  if (live.cut() != nullptr) removed = removed_by_tool(*live.cut());
  Record list = Record::array();
  for (const ToolFigures& figures : job.report.tools) {
    const Tool* tool = figures.tool ? job.tools.find(*figures.tool) : nullptr;
    const auto colour = figures.tool ? colours.find(*figures.tool) : colours.end();
    Record entry;
    entry["number"] = figures.tool ? Record(*figures.tool) : Record(nullptr);
    entry["name"] = tool != nullptr ? Record(short_name(*tool)) : Record(nullptr);
    entry["source"] = figures.tool ? Record(to_string(job.tool_sources.at(*figures.tool))) : Record(nullptr);
    entry["colour"] = colour_record(colour == colours.end() ? 2 : colour->second);
    entry["profiles"] = tool != nullptr ? profiles_record(tool->silhouette) : Record::array();
    entry["flute_length"] = tool != nullptr ? record_of(tool->flute.mm()) : Record(nullptr);
    entry["time_s"] = record_of(times.of_tool(figures.tool).total().seconds());
    entry["removed_mm3"] = record_of(removed[figures.tool]);
    list.push_back(std::move(entry));
  }
  return list;
}

Record stock_record(const Job& job) {
  if (job.bar)
    return {{"block", record_of(box_of(*job.bar))},
            {"source", to_string(StockSource::option)},
            {"shape", "bar"},
            {"diameter", record_of(job.bar->diameter)}};
  if (!job.stock) return nullptr;
  const std::string_view shape = !job.stock->body ? "block" : job.stock->body->pitch() ? "columns" : "mesh";
  return {{"block", record_of(job.stock->block)}, {"source", to_string(job.stock_source)}, {"shape", shape}};
}

/// What a page shows at first: the stock or the print, else the motions.
Box3 bounds_of(const LiveJob& live) {
  const Job& job = *live.job();
  if (job.bar) return box_of(*job.bar);
  if (job.stock) return job.stock->block;
  if (live.kind() == LiveKind::print) return live.run()->print().columns.bounds;
  Box3 box = job.report.all.cut_bounds;
  if (!box.empty()) return box;
  const unsigned drawn = drawn_axes(job.program.path);
  for_each_motion(job.program.path, [&](const Step& s, const MotionContext&) {
    if ((s.unknown_axes() & drawn) == 0) box.add(s.to());
  });
  return box;
}

std::optional<Record> mark_of(const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  switch (s.kind()) {
    case StepKind::tool_change:
      return Record{{"step", i}, {"kind", "tool"}, {"tool", s.tool_change().tool}, {"text", ""}};
    case StepKind::layer: return Record{{"step", i}, {"kind", "layer"}, {"text", path.layer(i).name}};
    case StepKind::note: return Record{{"step", i}, {"kind", "note"}, {"text", path.text(i)}};
    case StepKind::pause: return Record{{"step", i}, {"kind", "pause"}, {"text", ""}};
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::dwell:
    case StepKind::spindle:
    case StepKind::coolant:
    case StepKind::path_mode:
    case StepKind::probe:
    case StepKind::extrude:
    case StepKind::temperature:
    case StepKind::fan:
    case StepKind::laser_power:
    case StepKind::verbatim:
    case StepKind::end:
    case StepKind::close_path:
    case StepKind::store_home:
    case StepKind::work_zero:
    case StepKind::tool_length:
    case StepKind::unresolved:
    case StepKind::motion_limits:
    case StepKind::extruder: break;
  }
  return std::nullopt;
}

/// Tool changes and pauses first, where there is not enough room for all.
Record marks_record(const Toolpath& path) {
  std::size_t important = 0;
  const auto is_important = [](const Step& s) {
    return s.kind() == StepKind::tool_change || s.kind() == StepKind::pause;
  };
  for (const Step& s : path.steps()) important += is_important(s) ? 1 : 0;
  std::size_t others = kMaxMarks - std::min(important, kMaxMarks), kept = 0;
  Record list = Record::array();
  for (std::size_t i = 0; i < path.size() && kept < kMaxMarks; ++i) {
    if (!is_important(path[i]) && others == 0) continue;
    std::optional<Record> mark = mark_of(path, i);
    if (!mark) continue;
    if (!is_important(path[i])) --others;
    ++kept;
    list.push_back(std::move(*mark));
  }
  return list;
}

Record volumes_record(const LiveJob& live) {
  switch (live.kind()) {
    case LiveKind::milling: return record_of_volumes(live.cut()->stock(), live.cut()->removed());
    case LiveKind::rotary: return record_of_volumes(live.run()->rotary().stock, live.run()->rotary().removed);
    case LiveKind::print: {
      const PrintSimulation& print = live.run()->print();
      return {{"extruded_mm3", record_of(print.total.extruded.mm3())},
              {"laid_mm3", record_of(print.total.laid.mm3())},
              {"layers", print.layers.size()},
              {"beads", print.beads}};
    }
    case LiveKind::path_only: break;
  }
  return Record::object();
}

Record times_record(const JobTimes& times) {
  const TimeFigures& all = times.estimate.all;
  return {{"total_s", record_of(all.total().seconds())},
          {"cutting_s", record_of(all.cutting().seconds())},
          {"rapid_s", record_of(all.rapid.seconds())},
          {"dwell_s", record_of(all.dwell.seconds())},
          {"planned", times.planned()},
          {"machine", times.machine}};
}

Record pitch_record(const LiveJob& live) {
  if (live.cut() != nullptr) return record_of(live.cut()->workpiece()->pitch().mm());
  if (live.kind() == LiveKind::rotary) return record_of(live.run()->rotary().workpiece.dx);
  if (live.kind() == LiveKind::print) return record_of(live.run()->print().columns.pitch);
  return nullptr;
}

Record fixtures_record(const Job& job) {
  Record list = Record::array();
  for (const Fixture& fixture : job.fixtures)
    list.push_back({{"name", fixture.name},
                    {"block", record_of(fixture.solid.block)},
                    {"shape", fixture.solid.body ? "body" : "block"}});
  return list;
}

/// The travel in work coordinates, null where an end or the work zero is unknown.
Record machine_record(const std::optional<Machine>& machine) {
  if (!machine) return nullptr;
  Record travel = nullptr;
  const auto& axes = machine->travel;
  if (axes[0] && axes[1] && axes[2] && machine->work_zero) {
    const Point3 zero = *machine->work_zero;
    Box3 box;
    box.add(Point3{axes[0]->low, axes[1]->low, axes[2]->low} - zero);
    box.add(Point3{axes[0]->high, axes[1]->high, axes[2]->high} - zero);
    travel = record_of(box);
  }
  return {{"name", machine->name}, {"travel", std::move(travel)}};
}

/// What beads are part of, in the order of the numbers in /path.
Record bead_kinds_record() {
  Record list = Record::array();
  for (std::size_t k = 0; k < kBeadKinds; ++k) list.push_back(to_string(static_cast<BeadKind>(k)));
  return list;
}

}  // namespace

/// The targets for which the program can be downloaded.
Record posts_record(const Program& program) {
  Record list = Record::array();
  for (const std::string& name : offered_posts(program.source)) list.push_back(name);
  return list;
}

Record model_record(const ModelInputs& inputs) {
  const LiveJob& live = inputs.live;
  const Job& job = *live.job();
  const JobTimes times = times_of(job, inputs.machine ? &*inputs.machine : nullptr);
  Record out;
  out["name"] = file_name_of(job.program.source);
  out["source"] = job.program.source;
  out["front_end"] = job.program.front_end;
  out["kind"] = name_of(live.kind());
  out["units"] = job.program.units == ProgramUnits::inch ? "inch" : "mm";
  out["bounds"] = record_of(bounds_of(live));
  out["stock"] = stock_record(job);
  out["pitch"] = pitch_record(live);
  out["fixtures"] = fixtures_record(job);
  out["machine"] = machine_record(inputs.machine);
  out["target"] = inputs.target != nullptr ? *inputs.target : Record(nullptr);
  out["steps"] = job.program.path.size();
  out["motions"] = inputs.motions;
  out["tools"] = tools_record(live, times);
  out["stock_colour"] = colour_record(0);
  out["hazard_colour"] = colour_record(1);
  out["findings"] = is_program(job) ? record_of(live.findings()) : Record::array();
  out["diagnostics"] = record_of(inputs.diagnostics);
  out["report"] = info_record(job, times, Diagnostics{});
  out["report"]["volumes"] = volumes_record(live);
  out["times"] = times_record(times);
  out["marks"] = marks_record(job.program.path);
  out["posts"] = posts_record(job.program);
  if (live.kind() == LiveKind::print) out["bead_kinds"] = bead_kinds_record();
  out["tiles"] = Record{{"count", inputs.tiles}, {"level", 0}};
  return out;
}

}  // namespace kerf::app::view
