// Paths and their embedded paths as toolpaths; the probing run.
#include "front/pathdxf/compile/compile.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

#include "base/codes/pathdxf.h"
#include "base/number.h"
#include "front/pathdxf/compile/miller.h"
#include "front/pathdxf/text/nearly.h"

namespace kerf::pathdxf {
namespace {

constexpr unsigned kX = 1, kY = 2, kZ = 4;
constexpr double kStartRaise = 2e-6;          // of the start height, so that the first travel sets Z again
constexpr std::size_t kMaxProbes = 1000;      // each is considered at each step
constexpr int kFirstProbe = 51;               // number of the first probe's variable
constexpr Duration kProbeDwell = seconds(4);  // so that the operator can note the value
constexpr int kTool = 1;

constexpr Bilingual kTooManySteps{"the path {} makes more than {} steps",
                                  "Der Pfad {} ergibt mehr als {} Schritte"};
constexpr Bilingual kTooManyProbes{"the path {} has more than {} probes",
                                   "Der Pfad {} hat mehr als {} Z-Probes"};
constexpr Bilingual kProbeHeight{
    "S={} must be above the height {} of the probe (T, with H): rapids to the probes would hit it",
    "S={} muss über der Höhe {} der Z-Probe (T, mit H) liegen: Leerfahrten zu den Z-Probes träfen sie"};
constexpr Bilingual kMilling{"Milling length:", "Fräslänge:"};
constexpr Bilingual kDrilling{"Drill length:", "Bohrungen:"};
constexpr Bilingual kSweeps{"Sweeps:", "Leerfahrten:"};
constexpr Bilingual kSum{"Sum:", "Summe:"};
constexpr Bilingual kCommands{"Command count:", "Befehlszahl:"};

Frame frame_of(const Frame& outer, const Embedding& e) {
  return embedded(outer, e.path->start, e.path->end, e.start, e.end, e.raise);
}

bool cuts(const Operation& operation) {
  return !std::holds_alternative<Sweep>(operation.what) && !std::holds_alternative<Embedding>(operation.what);
}

class PathCompiler {
 public:
  PathCompiler(const Path& path, const PathdxfOptions& options, Report& report, Progress* progress)
      : main_(path), options_(options), report_(report), progress_(progress) {}

  Compiled compile() {
    out_.is_empty = main_.operations.empty();
    home_.shift = {-main_.start.x, -main_.start.y};
    collect_probes(main_, home_);
    order_probes();
    if (!out_.is_empty) write_milling();
    if (out_.top == 0.0) out_.top = main_.top;
    if (!out_.probes.empty()) write_probing();
    return std::move(out_);
  }

 private:
  void collect_probes(const Path& path, const Frame& frame);
  void order_probes();
  void write_milling();
  void write_probing();
  void start(Toolpath& path, Emitter& emitter, double height);
  void write_path(const Path& path, const Frame& frame, Emitter& emitter);
  void write_embedding(const Operation& operation, const Frame& frame, Emitter& emitter);
  /// The origin of a step of the milling path.
  OriginId origin(const Origin& where, OriginId caller) {
    OriginTable& table = out_.milling.origins();
    const auto [known, is_new] = origins_.try_emplace(&where, OriginId::none);
    const OriginId id = is_new ? table.add(where) : table.add_again(known->second);
    if (is_new) known->second = id;
    if (caller != OriginId::none) table.set_caller(id, caller);
    return id;
  }

  const Path& main_;
  const PathdxfOptions& options_;
  Report& report_;
  Progress* progress_;
  Frame home_;
  std::unordered_map<const Origin*, OriginId> origins_;  // of locations used before
  Compiled out_;
};

void PathCompiler::collect_probes(const Path& path, const Frame& frame) {
  for (const Probe& p : path.probes) {
    if (out_.probes.size() >= kMaxProbes) {
      report_.error(codes::pathdxf_limit, main_.where, kTooManyProbes, main_.name, kMaxProbes);
      return;
    }
    PlacedProbe placed;
    placed.at = frame(p.at);
    placed.drawn = p.at;
    placed.thickness = p.thickness + p.raise + frame.raise;
    placed.feed = p.feed;
    placed.label = p.label;
    placed.where = p.where;
    if (!above(main_.sweep, placed.thickness))
      report_.error(codes::pathdxf_rapid_height, p.where, kProbeHeight, number_text(main_.sweep, 6),
                    number_text(placed.thickness, 6));
    out_.probes.push_back(std::move(placed));
  }
  for (const Operation& operation : path.operations)
    if (const auto* e = std::get_if<Embedding>(&operation.what); e != nullptr && e->path->has_probes)
      collect_probes(*e->path, frame_of(frame, *e));
}

/// Each probe is followed by the nearest of the others, the first one is the nearest to the start.
void PathCompiler::order_probes() {
  Point2 at{0.0, 0.0};
  for (std::size_t i = 0; i < out_.probes.size(); ++i) {
    const auto rest = out_.probes.begin() + static_cast<std::ptrdiff_t>(i);
    const auto nearest = std::min_element(
        rest, out_.probes.end(),
        [at](const PlacedProbe& a, const PlacedProbe& b) { return distance(a.at, at) < distance(b.at, at); });
    std::rotate(rest, nearest, nearest + 1);
    at = out_.probes[i].at;
    out_.probes[i].name = fmt::format("#{}", kFirstProbe + static_cast<int>(i));
  }
}

/// The head of a program: the tool goes up, then to the start marker.
void PathCompiler::start(Toolpath& path, Emitter& emitter, double height) {
  const OriginId here = path.origins().add(main_.where);
  emitter.set_origin(here);
  path.add(step::ToolChange{kTool}, here);
  emitter.trace(0, fmt::format("SweepSafelyTo {}", point_text3({0.0, 0.0, height})));
  path.set_unknown_axes(emitter.add_rapid({0.0, 0.0, height}, kZ), kX | kY);
  emitter.add_rapid({0.0, 0.0, height}, kX | kY);
  emitter.start_at({0.0, 0.0, height});
}

void PathCompiler::write_milling() {
  Toolpath& path = out_.milling;
  Emitter emitter(path, options_, out_.probes, main_.feed);
  const double height = main_.sweep * (1.0 + kStartRaise);
  start(path, emitter, height);
  emitter.comment(2, "Model " + main_.name_in_file);
  write_path(main_, home_, emitter);
  emitter.set_origin(path.origins().add(main_.where));
  emitter.last_rapid(height);
  out_.statistics = emitter.statistics();
  for (const std::string& line : statistics_lines(out_.statistics, report_)) emitter.trace(2, line);
  path.add(step::End{true}, path.origins().add(main_.where));
  if (emitter.full())
    report_.error(codes::pathdxf_limit, main_.where, kTooManySteps, main_.name, options_.max_steps);
}

void PathCompiler::write_path(const Path& path, const Frame& frame, Emitter& emitter) {
  if (std::any_of(path.operations.begin(), path.operations.end(), cuts))
    out_.top = std::max(out_.top, path.top + frame.raise);
  Miller miller(path, frame, emitter, report_);
  for (const Operation& operation : path.operations) {
    if (emitter.full() || stop_requested(progress_)) return;
    if (const auto* chain = std::get_if<Chain>(&operation.what)) {
      std::vector<OriginId> origins;
      for (const MillSegment& s : chain->segments) origins.push_back(origin(s.where, frame.caller));
      miller.chain(*chain, operation.where, origins);
      continue;
    }
    if (std::holds_alternative<Embedding>(operation.what)) {
      write_embedding(operation, frame, emitter);
      continue;
    }
    emitter.set_origin(origin(operation.where, frame.caller));
    if (const auto* sweep = std::get_if<Sweep>(&operation.what)) miller.sweep(*sweep);
    if (const auto* drill = std::get_if<Drill>(&operation.what)) miller.drill(*drill, operation.where);
    if (const auto* helix = std::get_if<Helix>(&operation.what)) miller.helix(*helix, operation.where);
  }
}

void PathCompiler::write_embedding(const Operation& operation, const Frame& frame, Emitter& emitter) {
  const auto& e = std::get<Embedding>(operation.what);
  const OriginId here = origin(operation.where, frame.caller);
  Frame inner = frame_of(frame, e);
  inner.caller = here;
  const auto mapped = [&](Point2 p) {
    const Point2 q = inner(p);
    return fmt::format("[{} {}]=>[{} {}]", number_text3(p.x), number_text3(p.y), number_text3(q.x),
                       number_text3(q.y));
  };
  const std::string name = emitter.traces() ? fmt::format("{} t=[ {} / {} ]", e.path->name_in_file,
                                                          mapped(e.path->start), mapped(e.path->end))
                                            : e.path->name_in_file;
  emitter.set_origin(here);
  emitter.comment(2, "START Subpath " + name);
  write_path(*e.path, inner, emitter);
  emitter.set_origin(here);
  emitter.comment(2, "END Subpath " + name);
}

void PathCompiler::write_probing() {
  Toolpath& path = out_.probing.emplace();
  static const std::vector<PlacedProbe> kNoCorrection;
  Emitter emitter(path, options_, kNoCorrection, main_.feed);
  start(path, emitter, main_.sweep);
  for (const PlacedProbe& p : out_.probes) {
    emitter.set_origin(path.origins().add(p.where));
    emitter.add_rapid({p.at.x, p.at.y, main_.sweep}, kX | kY);
    emitter.add_rapid({p.at.x, p.at.y, p.thickness + main_.tool}, kZ);
    const OriginId here = path.origins().add(p.where);
    const std::size_t i =
        path.add(step::Probe{{p.at.x, p.at.y, 0.0}, mm_per_min(p.feed), options_.probe}, here);
    path.set_named_axes(i, kZ);
    path.set_unknown_axes(i, kZ);
    path.add(step::Dwell{kProbeDwell}, here);
    emitter.add_rapid({p.at.x, p.at.y, main_.sweep}, kZ);
  }
  emitter.set_origin(path.origins().add(main_.where));
  emitter.add_rapid({0.0, 0.0, main_.sweep}, kX | kY);
  emitter.add_rapid({0.0, 0.0, main_.sweep}, kZ);
  path.add(step::End{true}, path.origins().add(main_.where));
}

}  // namespace

std::vector<std::string> statistics_lines(const Statistics& s, const Report& report) {
  const auto line = [&](const Bilingual& label, double length, double time) {
    return fmt::format("{:<12} {:5.0f} mm   ca.{:3.0f} min", report.text(label), length, std::ceil(time));
  };
  return {line(kMilling, s.milling, s.milling_time), line(kDrilling, s.drilling, s.drilling_time),
          line(kSweeps, s.sweeps, s.sweep_time),
          line(kSum, s.milling + s.drilling + s.sweeps, s.milling_time + s.drilling_time + s.sweep_time),
          fmt::format("{:<12} {}", report.text(kCommands), s.commands)};
}

Compiled compile(const Path& path, const PathdxfOptions& options, Report& report, Progress* progress) {
  return PathCompiler(path, options, report, progress).compile();
}

}  // namespace kerf::pathdxf
