// Findings and figures as records.
#include "job/record/figures.h"

#include <algorithm>

#include "job/record/info.h"

namespace kerf {
namespace {

Record side_of(const Comparison& c, DifferenceKind kind) {
  const bool gouge = kind == DifferenceKind::gouge;
  const auto deepest = std::find_if(c.regions.begin(), c.regions.end(),
                                    [kind](const DifferenceRegion& r) { return r.kind == kind; });
  const bool any = deepest != c.regions.end();
  return {{"volume_mm3", record_of((gouge ? c.gouge : c.rest).mm3())},
          {"beyond_tolerance_mm3", record_of((gouge ? c.gouge_beyond : c.rest_beyond).mm3())},
          {"largest_mm", record_of(any ? deepest->depth.mm() : 0.0)},
          {"at", any ? record_of(deepest->at) : Record(nullptr)}};
}

Record number_or_null(std::optional<int> tool) { return tool ? Record(*tool) : Record(nullptr); }

}  // namespace

Record record_of(const Finding& f) {
  Record out{{"kind", f.kind},
             {"at", record_of(f.at)},
             {"depth_mm", record_of(f.depth_mm)},
             {"removed_mm3", record_of(f.removed_mm3)},
             {"step", f.step},
             {"steps", f.steps},
             {"message", f.message},
             {"hint", f.hint},
             {"origin", record_of(f.origin)}};
  for (const Origin& caller : f.callers) out["callers"].push_back(record_of(caller));
  return out;
}

Record record_of(const std::vector<Finding>& findings) {
  Record list = Record::array();
  for (const Finding& f : findings) list.push_back(record_of(f));
  return list;
}

Record record_of(const std::vector<PrintHazard>& hazards, const Toolpath& path) {
  Record list = record_of(findings_of(hazards, path));
  for (std::size_t i = 0; i < hazards.size(); ++i) {
    list[i]["length_mm"] = record_of(hazards[i].length.mm());
    list[i]["volume_mm3"] = record_of(hazards[i].volume.mm3());
  }
  return list;
}

Record record_of(const MotionFigures& f) {
  return {{"lines", f.lines},
          {"arcs", f.arcs},
          {"rapids", f.rapids},
          {"cut_mm", record_of(f.cut_mm)},
          {"rapid_mm", record_of(f.rapid_mm)},
          {"cut_bounds_mm", record_of(f.cut_ends)},
          {"cut_extent_mm", record_of(f.cut_bounds)}};
}

Record record_of(const TimeFigures& time) {
  return {{"total", record_of(time.total().seconds())},
          {"motion", record_of(time.motion.seconds())},
          {"cutting", record_of(time.cutting().seconds())},
          {"rapid", record_of(time.rapid.seconds())},
          {"dwell", record_of(time.dwell.seconds())},
          {"halts", record_of(time.halts.seconds())},
          {"stops", time.stops}};
}

Record record_of(const JobTimes& times) {
  const TimeEstimate& estimate = times.estimate;
  Record out = record_of(estimate.all);
  out["method"] = times.planned() ? kPlannedMethod : kPlainMethod;
  out["machine"] = times.planned() ? Record(times.machine) : Record(nullptr);
  Record& tools = out["tools"] = Record::array();
  for (const ToolTime& t : estimate.tools) {
    Record entry{{"number", number_or_null(t.tool)}};
    entry.update(record_of(t.time));
    tools.push_back(std::move(entry));
  }
  if (!times.planned()) return out;
  out["not_timed"] = estimate.not_timed;
  Record& operations = out["operations"] = Record::array();
  for (const OperationTime& o : estimate.operations) {
    Record entry{{"name", o.name}, {"tool", number_or_null(o.tool)}, {"step", o.first_step}};
    entry.update(record_of(o.time));
    operations.push_back(std::move(entry));
  }
  return out;
}

Record record_of_volumes(Volume stock, Volume removed) {
  return {{"stock_mm3", record_of(stock.mm3())},
          {"removed_mm3", record_of(removed.mm3())},
          {"left_mm3", record_of((stock - removed).mm3())}};
}

Record record_of_tool(int number, const Tool& tool) {
  return {{"number", number},
          {"shape", name_of(tool.shape)},
          {"diameter_mm", record_of(tool.diameter.mm())},
          {"flute_mm", record_of(tool.flute.mm())},
          {"teeth", tool.teeth},
          {"teeth_assumed", tool.teeth_assumed},
          {"plunges", tool.plunges},
          {"names", tool.names},
          {"description", tool.description}};
}

Record record_of_stock(const Job& job) {
  if (job.bar) {
    const RoundBar& bar = *job.bar;
    return {{"bar", Record{{"diameter_mm", record_of(bar.diameter)},
                           {"x_mm", record_of(Point2{bar.x_low, bar.x_high})},
                           {"axis_mm", record_of(Point2{bar.axis_y, bar.axis_z})}}},
            {"source", to_string(StockSource::option)}};
  }
  if (!job.stock) return nullptr;
  return {{"block_mm", record_of(job.stock->block)},
          {"size_mm", record_of(job.stock->block.size())},
          {"source", to_string(job.stock_source)}};
}

Record record_of(const PrintVolumes& v) {
  return {{"extruded_mm3", record_of(v.extruded.mm3())}, {"laid_mm3", record_of(v.laid.mm3())},
          {"overlap_mm3", record_of(v.overlap.mm3())},   {"ends_mm3", record_of(v.ends.mm3())},
          {"hollow_mm3", record_of(v.hollow.mm3())},     {"enclosed_mm3", record_of(v.enclosed.mm3())},
          {"road_mm", record_of(v.bead_length.mm())},    {"unsupported_mm", record_of(v.unsupported.mm())}};
}

Record record_of(const PrintLayer& layer) {
  Record out{
      {"z_mm", record_of(layer.z.mm())}, {"height_mm", record_of(layer.height.mm())}, {"roads", layer.beads}};
  out.update(record_of(layer.volumes));
  return out;
}

Record record_of_totals(const PrintVolumes& volumes) {
  Record out = record_of(volumes);
  out["blobs_mm3"] = record_of(volumes.blobs.mm3());
  return out;
}

Range heights_of(const PrintFigures& figures) {
  Range heights;
  for (const PrintFigures::Layer& layer : figures.layers) heights.add(layer.height.mm());
  return heights;
}

Record record_of(const PrintFigures& figures, const Filament& filament) {
  const Range heights = heights_of(figures);
  Record layers = Record::array();
  for (const PrintFigures::Layer& layer : figures.layers)
    layers.push_back(record_of(Point2{layer.z.mm(), layer.height.mm()}));
  return {{"filament_mm", record_of(filament.length)},
          {"filament_mm3", record_of(filament.volume)},
          {"filament_diameter_mm", record_of(filament.diameter)},
          {"mass_g", record_of(filament.grams())},
          {"density_g_cm3", record_of(filament.density)},
          {"density_assumed", filament.density_assumed},
          {"layers", figures.layers.size()},
          {"layers_mm", std::move(layers)},  // Z and height of each
          {"layer_height_mm", record_of(heights)},
          {"beads", figures.beads},
          {"bead_mm", record_of(figures.bead_length.mm())},
          {"bounds_mm", record_of(figures.box)}};
}

Record record_of(const TimeOfPrint& time) {
  return {{"total", record_of((time.motion + time.dwell).seconds())},
          {"motion", record_of(time.motion.seconds())},
          {"dwell", record_of(time.dwell.seconds())},
          {"method", time.method},
          {"machine", time.machine.empty() ? Record(nullptr) : Record(time.machine)}};
}

Record record_of_flow(const PlannedPrint& plan) {
  const auto flow = [](VolumeFlow f) {
    return f > VolumeFlow{} ? record_of(in_mm3_per_s(f)) : Record(nullptr);
  };
  return {{"highest", flow(plan.highest)},
          {"step", plan.highest > VolumeFlow{} ? Record(plan.step) : Record(nullptr)},
          {"limit", flow(plan.limit)}};
}

Record record_of(const Comparison& c) {
  Record out{{"target_mm3", record_of(c.target.mm3())},    {"part_mm3", record_of(c.part.mm3())},
             {"gouge", side_of(c, DifferenceKind::gouge)}, {"rest", side_of(c, DifferenceKind::rest)},
             {"within_tolerance", c.region_count == 0},    {"region_count", c.region_count}};
  Record& regions = out["regions"] = Record::array();
  for (const DifferenceRegion& r : c.regions)
    regions.push_back({{"kind", to_string(r.kind)},
                       {"depth_mm", record_of(r.depth.mm())},
                       {"at", record_of(r.at)},
                       {"volume_mm3", record_of(r.volume.mm3())},
                       {"bounds_mm", record_of(r.bounds)}});
  return out;
}

Record record_of(const BurnMap& map) {
  return {{"energy_j", record_of(map.joules)},       {"beam_s", record_of(map.on.seconds())},
          {"burnt_mm2", record_of(map.burnt_mm2)},   {"highest_j_mm2", record_of(map.highest)},
          {"highest_at", record_of(map.highest_at)}, {"cell_mm", record_of(map.cell)}};
}

Record record_of(const LevelReport& report) {
  return {{"lowest_mm", record_of(report.lowest)},
          {"highest_mm", record_of(report.highest)},
          {"lowest_at", record_of(report.lowest_at)},
          {"highest_at", record_of(report.highest_at)},
          {"divided", report.divided},
          {"unchanged", report.unchanged},
          {"outside_mm", record_of(report.outside)}};
}

Record record_of(const std::vector<PartFile>& files) {
  Record list = Record::array();
  for (const PartFile& file : files) list.push_back(file.path);
  return list;
}

}  // namespace kerf
