// The model as JSON: bounds, stock, tools, findings, times, marks and sources.
#include "app/shown/model.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "app/report/findings.h"
#include "app/report/info_json.h"
#include "app/shown/motions.h"
#include "app/shown/viewable.h"

#include "kerf/base/files.h"
#include "kerf/job/outputs.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxSourceBytes = std::size_t{4} << 20;  // of one source; pages do not scroll more
constexpr std::size_t kMaxMarks = 2000;                        // on the time axis
constexpr double kBulgeStep = 0.12;                            // radians between points of a profile's arc

std::string_view name_of(LiveKind kind) {
  switch (kind) {
    case LiveKind::milling: return "milling";
    case LiveKind::rotary: return "rotary";
    case LiveKind::print: return "print";
    case LiveKind::path_only: break;
  }
  return "drawing";
}

Json colour_json(std::size_t index) {
  Json list = Json::array();
  for (const std::uint8_t channel : part_palette()[index]) list.push_back(channel);
  return list;
}

/// A profile as points [r, z], arcs as chords.
Json points_json(const Profile& profile) {
  Json points = Json::array();
  const auto add = [&](double r, double z) { points.push_back(Json::array({json_of(r), json_of(z)})); };
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

Json profiles_json(const Silhouette& silhouette) {
  Json list = Json::array();
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = silhouette.part(part);
    if (profile.empty()) continue;
    const bool cuts = part == ToolPart::cutting;
    list.push_back(
        {{"part", cuts ? std::string_view("flute") : to_string(part)}, {"points", points_json(profile)}});
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

Json tools_json(const LiveJob& live, const JobTimes& times) {
  const Job& job = *live.job();
  std::map<int, std::uint8_t> colours;
  for (const auto& [tool, colour] : tool_colours(job.program.path)) colours[tool] = colour;
  std::map<std::optional<int>, double> removed;
  if (live.cut() != nullptr) removed = removed_by_tool(*live.cut());
  Json list = Json::array();
  for (const ToolFigures& figures : job.report.tools) {
    const Tool* tool = figures.tool ? job.tools.find(*figures.tool) : nullptr;
    const auto colour = figures.tool ? colours.find(*figures.tool) : colours.end();
    Json entry;
    entry["number"] = figures.tool ? Json(*figures.tool) : Json(nullptr);
    entry["name"] = tool != nullptr ? Json(short_name(*tool)) : Json(nullptr);
    entry["source"] = figures.tool ? Json(to_string(job.tool_sources.at(*figures.tool))) : Json(nullptr);
    entry["colour"] = colour_json(colour == colours.end() ? 2 : colour->second);
    entry["profiles"] = tool != nullptr ? profiles_json(tool->silhouette) : Json::array();
    entry["flute_length"] = tool != nullptr ? json_of(tool->flute.mm()) : Json(nullptr);
    entry["time_s"] = json_of(times.of_tool(figures.tool).total().seconds());
    entry["removed_mm3"] = json_of(removed[figures.tool]);
    list.push_back(std::move(entry));
  }
  return list;
}

Json stock_json(const Job& job) {
  if (job.bar)
    return {{"block", json_of(box_of(*job.bar))},
            {"source", to_string(StockSource::option)},
            {"shape", "bar"},
            {"diameter", json_of(job.bar->diameter)}};
  if (!job.stock) return nullptr;
  const std::string_view shape = !job.stock->body ? "block" : job.stock->body->pitch() ? "columns" : "mesh";
  return {{"block", json_of(job.stock->block)}, {"source", to_string(job.stock_source)}, {"shape", shape}};
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

std::optional<Json> mark_of(const Toolpath& path, std::size_t i) {
  const Step& s = path[i];
  switch (s.kind()) {
    case StepKind::tool_change:
      return Json{{"step", i}, {"kind", "tool"}, {"tool", s.tool_change().tool}, {"text", ""}};
    case StepKind::layer: return Json{{"step", i}, {"kind", "layer"}, {"text", path.layer(i).name}};
    case StepKind::note: return Json{{"step", i}, {"kind", "note"}, {"text", path.text(i)}};
    case StepKind::pause: return Json{{"step", i}, {"kind", "pause"}, {"text", ""}};
    default: return std::nullopt;
  }
}

/// Tool changes and pauses first, where there is not enough room for all.
Json marks_json(const Toolpath& path) {
  std::size_t important = 0;
  const auto is_important = [](const Step& s) {
    return s.kind() == StepKind::tool_change || s.kind() == StepKind::pause;
  };
  for (const Step& s : path.steps()) important += is_important(s) ? 1 : 0;
  std::size_t others = kMaxMarks - std::min(important, kMaxMarks), kept = 0;
  Json list = Json::array();
  for (std::size_t i = 0; i < path.size() && kept < kMaxMarks; ++i) {
    if (!is_important(path[i]) && others == 0) continue;
    std::optional<Json> mark = mark_of(path, i);
    if (!mark) continue;
    if (!is_important(path[i])) --others;
    ++kept;
    list.push_back(std::move(*mark));
  }
  return list;
}

Json volumes_json(const LiveJob& live) {
  const auto volumes = [](Volume stock, Volume removed) {
    return Json{{"stock_mm3", json_of(stock.mm3())},
                {"removed_mm3", json_of(removed.mm3())},
                {"left_mm3", json_of((stock - removed).mm3())}};
  };
  switch (live.kind()) {
    case LiveKind::milling: return volumes(live.cut()->stock(), live.cut()->removed());
    case LiveKind::rotary: return volumes(live.run()->rotary().stock, live.run()->rotary().removed);
    case LiveKind::print: {
      const PrintSimulation& print = live.run()->print();
      return {{"extruded_mm3", json_of(print.total.extruded.mm3())},
              {"laid_mm3", json_of(print.total.laid.mm3())},
              {"layers", print.layers.size()},
              {"beads", print.beads}};
    }
    case LiveKind::path_only: break;
  }
  return Json::object();
}

Json times_json(const JobTimes& times) {
  const TimeFigures& all = times.estimate.all;
  return {{"total_s", json_of(all.total().seconds())},
          {"cutting_s", json_of(all.cutting().seconds())},
          {"rapid_s", json_of(all.rapid.seconds())},
          {"dwell_s", json_of(all.dwell.seconds())},
          {"planned", times.planned()},
          {"machine", times.machine}};
}

Json pitch_json(const LiveJob& live) {
  if (live.cut() != nullptr) return json_of(live.cut()->workpiece()->pitch().mm());
  if (live.kind() == LiveKind::rotary) return json_of(live.run()->rotary().workpiece.dx);
  if (live.kind() == LiveKind::print) return json_of(live.run()->print().columns.pitch);
  return nullptr;
}

Json fixtures_json(const Job& job) {
  Json list = Json::array();
  for (const Fixture& fixture : job.fixtures)
    list.push_back({{"name", fixture.name},
                    {"block", json_of(fixture.solid.block)},
                    {"shape", fixture.solid.body ? "body" : "block"}});
  return list;
}

/// The travel in work coordinates, null where an end or the work zero is unknown.
Json machine_json(const std::optional<Machine>& machine) {
  if (!machine) return nullptr;
  Json travel = nullptr;
  const auto& axes = machine->travel;
  if (axes[0] && axes[1] && axes[2] && machine->work_zero) {
    const Point3 zero = *machine->work_zero;
    Box3 box;
    box.add(Point3{axes[0]->low, axes[1]->low, axes[2]->low} - zero);
    box.add(Point3{axes[0]->high, axes[1]->high, axes[2]->high} - zero);
    travel = json_of(box);
  }
  return {{"name", machine->name}, {"travel", std::move(travel)}};
}

Json files_json(const std::vector<SourceText>& sources) {
  Json list = Json::array();
  for (const SourceText& source : sources)
    list.push_back({{"path", source.path},
                    {"text", source.text ? Json(*source.text) : Json(nullptr)},
                    {"complete", source.is_complete}});
  return list;
}

}  // namespace

std::vector<SourceText> read_sources(const std::vector<std::string>& files) {
  std::vector<SourceText> sources;
  for (const std::string& path : files) {
    SourceText source{path, {}, false};
    Diagnostics ignored;
    if (path != "-") {
      if (const auto file = InputFile::open(path, ignored)) {
        const std::string_view text = file->bytes().substr(0, kMaxSourceBytes);
        source.is_complete = text.size() == file->bytes().size();
        if (text.find('\0') == std::string_view::npos) source.text = std::string(text);
      }
    }
    sources.push_back(std::move(source));
  }
  return sources;
}

Json model_json(const ModelInputs& inputs) {
  const LiveJob& live = inputs.live;
  const Job& job = *live.job();
  const JobTimes times = times_of(job, inputs.machine ? &*inputs.machine : nullptr);
  Json out;
  out["name"] = std::filesystem::path(job.program.source).filename().string();
  out["source"] = job.program.source;
  out["front_end"] = job.program.front_end;
  out["kind"] = name_of(live.kind());
  out["units"] = job.program.units == ProgramUnits::inch ? "inch" : "mm";
  out["bounds"] = json_of(bounds_of(live));
  out["stock"] = stock_json(job);
  out["pitch"] = pitch_json(live);
  out["fixtures"] = fixtures_json(job);
  out["machine"] = machine_json(inputs.machine);
  out["target"] = inputs.target != nullptr ? *inputs.target : Json(nullptr);
  out["steps"] = job.program.path.size();
  out["motions"] = inputs.motions;
  out["tools"] = tools_json(live, times);
  out["stock_colour"] = colour_json(0);
  out["hazard_colour"] = colour_json(1);
  out["findings"] = is_program(job) ? json_of(live.findings()) : Json::array();
  out["diagnostics"] = json_of(inputs.diagnostics);
  out["report"] = info_json(job, times, Diagnostics{});
  out["report"]["volumes"] = volumes_json(live);
  out["times"] = times_json(times);
  out["marks"] = marks_json(job.program.path);
  out["files"] = files_json(inputs.sources);
  out["tiles"] = Json{{"count", inputs.tiles}, {"level", 0}};
  return out;
}

}  // namespace kerf::app::view
