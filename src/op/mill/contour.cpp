// Contours: along the boundary of the region that the axis may be in or may not be in, and along given paths.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/inner_first.h"
#include "op/base/lead.h"
#include "op/base/reach.h"
#include "op/base/tab_path.h"
#include "op/mill/bones.h"
#include "op/mill/finish.h"

#include "kerf/base/limits.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kFinishLead = 0.25;  // radius of the lead of a finishing pass, of the tool's diameter
constexpr double kTabReach = 0.05;    // of the diameter: a loop this near to a tab's centre is held by it

/// How a run cuts a loop.
struct LoopPasses {
  Lead in{}, out{};
  double overlap = 0.0;
  double cleared = 0.0;        // Z of the material on the loop
  double aside = 0.0;          // where the lead-in starts
  std::vector<double> levels;  // of the passes
};

class ContourRun {
 public:
  ContourRun(const CutOptions& options, const Tool& tool, Walls walls)
      : options_(options), cutter_(options, tool, std::move(walls)) {}

  std::optional<Point2> here() const {
    const auto at = cutter_.position();
    return at ? std::optional(at->xy()) : std::nullopt;
  }

  void open_path(const Track& track, const LoopPasses& passes) {
    cutter_.lift();
    double cleared = passes.cleared;
    double s = 0.0;
    for (const double z : passes.levels) {
      if (cutter_.full()) return;
      cutter_.travel(track.at(s), cleared);
      cutter_.enter(track, s, cleared, z);
      const double other = s > 0.0 ? 0.0 : track.length();
      cutter_.follow(track, s, other, z);
      s = other, cleared = z;
    }
  }

  /// A closed path with all passes, each a continuation of the last. `free` is the side of it without a wall:
  /// +1 left, -1 right, 0 none.
  void loop(const Track& track, double free, const LoopPasses& passes) {
    const auto from = here();
    double s = from ? track.nearest(*from) : 0.0;
    cutter_.lift();
    const bool leads = free != 0.0 && permits(passes.in, track, s, free);
    const bool leaves = leads && permits(passes.out, track, s + passes.overlap, free);
    double cleared = leads ? passes.aside : passes.cleared;
    for (const double z : passes.levels) {
      if (cutter_.full()) return;
      if (leads) {
        lead_in(passes.in, track, s, free, cleared, z);
      } else {
        cutter_.travel(track.at(s), cleared);
        s = cutter_.enter(track, s, cleared, z);
      }
      const double end = s + track.length() + passes.overlap;
      cutter_.follow(track, s, end, z);
      if (leaves)
        lead_out(passes.out, track, end, free, z);
      else if (!leads)
        s = end;
      cleared = z;
    }
    // A ramp has moved the end.
    if (!leads && free != 0.0 && permits(passes.out, track, s, free))
      lead_out(passes.out, track, s, free, cleared);
  }

  bool full() const { return cutter_.full(); }
  Cutter& cutter() { return cutter_; }

 private:
  bool permits(const Lead& lead, const Track& track, double s, double free) const {
    return op_detail::permits(cutter_.walls(), lead, track, s, free);
  }

  /// To the start of a lead-in, where only the pass above has removed material.
  void go_to(Point2 start, double cleared) {
    const auto at = cutter_.position();
    if (at && distance(at->xy(), start) <= options_.tolerance.weld.mm()) return;
    cutter_.lift();
    cutter_.travel(start, std::max(cleared, options_.top));
    cutter_.rapid_down(cleared + options_.clearance.mm());
  }

  void lead_in(const Lead& lead, const Track& track, double s, double free, double cleared, double z) {
    const Point2 wall = track.at(s), along = track.direction(s);
    if (lead.kind == LeadKind::line) {
      const Track line({beyond_wall(lead, track, s, free), {{wall, {}}}}, 0.0);
      go_to(line.at(0.0), cleared);
      cutter_.rapid_down(cleared + options_.clearance.mm());
      if (options_.entry.kind == EntryKind::plunge && cutter_.plunges())
        cutter_.plunge(z);
      else if (z < cutter_.position()->z)
        cutter_.ramp(line, 0.0, z);
      return cutter_.line(wall);
    }
    const Point2 centre = beyond_wall(lead, track, s, free), start = centre - lead.size.mm() * along;
    const Turn turn = free > 0.0 ? Turn::ccw : Turn::cw;
    const auto at = cutter_.position();
    const Point2 opposite = centre + lead.size.mm() * along;
    // From the end of the pass above back to its start around the same circle.
    if (at && at->z == cleared && distance(at->xy(), opposite) <= options_.tolerance.weld.mm())
      cutter_.arc(start, centre, turn, at->z);
    else
      go_to(start, cleared);
    cutter_.rapid_down(cleared + options_.clearance.mm());
    if (options_.entry.kind == EntryKind::plunge && cutter_.plunges())
      cutter_.plunge(z);
    else
      cutter_.helix(centre, turn, z);
    cutter_.arc(wall, centre, turn, z);
  }

  void lead_out(const Lead& lead, const Track& track, double s, double free, double z) {
    const Point2 beyond = beyond_wall(lead, track, s, free);
    if (lead.kind == LeadKind::line) return cutter_.line(beyond);
    cutter_.arc(beyond + lead.size.mm() * track.direction(s), beyond, free > 0.0 ? Turn::ccw : Turn::cw, z);
  }

  const CutOptions& options_;
  Cutter cutter_;
};

/// The contours of a region: roughing loops, finishing loops, and the tabs of both.
class RegionContour {
 public:
  RegionContour(const Region& region, const Tool& tool, const ContourOptions& options,
                Diagnostics& diagnostics)
      : region_(region), tool_(tool), options_(options), diagnostics_(diagnostics) {}

  std::optional<Operation> run() {
    const CutOptions& cut = options_.cut;
    const bool finishes = options_.finish > Length{};
    auto last = reach(region_, tool_, reach_side(), cut, diagnostics_);
    if (!last) return std::nullopt;
    std::optional<Reach> rough;
    if (finishes) {
      CutOptions more = cut;
      more.allowance = cut.allowance + options_.finish;
      // What only the roughing passes cannot reach is cut by the finishing pass, which then has passes too.
      Diagnostics unused;
      rough = reach(region_, tool_, reach_side(), more, unused);
    }
    if (stop_requested(cut.progress)) return std::nullopt;
    const std::vector<Loop> loops = loops_of(last->axis);
    const std::vector<Loop> rough_loops = rough ? loops_of(rough->axis) : std::vector<Loop>{};
    const bool deep = !rough || rough->narrow.size() > last->narrow.size() || rough->axis.empty();
    ContourRun run(cut, tool_, Walls(region_, last->radius, 0.1 * cut.tolerance.chord.mm()));
    cut_all(run, loops, rough_loops, rough ? &rough->axis : nullptr, deep);
    auto made = finished(run.cutter(), cut, diagnostics_);
    if (!made) return std::nullopt;
    made->unreached = std::move(last->unreached), made->narrow = std::move(last->narrow);
    const BoneWork bones{region_, tool_, *last, reach_side(), options_.bones, cut, options_.finish};
    if (!add_bones(*made, bones, diagnostics_)) return std::nullopt;
    if (options_.tabs.height > Length{} && !hold(made->path)) return std::nullopt;
    return made;
  }

 private:
  ReachSide reach_side() const {
    return options_.side == ContourSide::inside ? ReachSide::inside : ReachSide::outside;
  }
  bool climbs() const { return options_.cut.direction == CutDirection::climb; }

  /// Loops have the region on their left: inside of it they run with the wall on the right, as climb does,
  /// and around it the other way.
  std::vector<Loop> loops_of(const Region& axis) const {
    std::vector<Loop> loops;
    const bool as_is = (options_.side == ContourSide::inside) == climbs();
    for (const Outline& loop : axis.loops)
      loops.push_back({Track(as_is ? loop : reversed(loop), options_.cut.tolerance.weld.mm()), bounds(loop)});
    return loops;
  }

  LoopPasses passes(bool all_levels) const {
    const CutOptions& cut = options_.cut;
    LoopPasses made{options_.lead_in, options_.lead_out, options_.overlap.mm(), cut.top, cut.top, {}};
    made.levels = pass_levels(cut.top, cut.depth, all_levels ? cut.stepdown : Length{});
    return made;
  }

  /// The roughing loops next to a finishing loop.
  std::vector<std::uint32_t> roughed_by(const Track& loop, const RegionSearch* rough) const {
    std::vector<std::uint32_t> near;
    if (rough == nullptr) return near;
    const double enough = 2.0 * options_.finish.mm() + options_.cut.tolerance.chord.mm();
    for (const LineArc& piece : loop.pieces(0.0, loop.length())) {
      const auto point = rough->nearest(piece.from);
      if (point && point->distance.mm() <= enough) near.push_back(point->loop);
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }

  void cut_all(ContourRun& run, const std::vector<Loop>& loops, const std::vector<Loop>& rough_loops,
               const Region* rough_axis, bool deep) {
    std::optional<RegionSearch> search;
    if (rough_axis != nullptr && !rough_axis->empty()) search.emplace(*rough_axis);
    std::vector<bool> done(rough_loops.size(), false);
    const double free = climbs() ? 1.0 : -1.0;
    InnerFirst order(loops);
    while (!order.done() && !run.full()) {
      const Track& track = loops[order.take(run.here())].track;
      if (track.empty()) continue;
      for (const std::uint32_t i : roughed_by(track, search ? &*search : nullptr)) {
        if (!done[i] && !rough_loops[i].track.empty()) run.loop(rough_loops[i].track, free, passes(true));
        done[i] = true;
      }
      run.loop(track, free, passes(deep));
      tracks_.push_back(track);
    }
  }

  /// Lifts the path over tabs on the loops.
  bool hold(Toolpath& path) {
    TabOptions tabs = options_.tabs;
    const CutOptions& cut = options_.cut;
    if (!(tabs.plunge > Feed{})) tabs.plunge = cut.plunge;
    const Length diameter = 2.0 * cutting_radius(tool_, cut.depth);
    if (!op_detail::valid(tabs, diameter, diagnostics_)) return false;
    std::vector<Tab> all;
    ShortPaths short_paths;
    for (const Track& track : tracks_)
      for (const Tab& tab :
           tabs_along(track, cut.top - cut.depth.mm(), tabs, diameter, cut.where, short_paths))
        all.push_back(tab);
    short_paths.report(diagnostics_);
    auto held = over_tabs(path, std::move(all), kTabReach * diameter.mm() + 1.5 * options_.finish.mm(), tabs,
                          diameter, diagnostics_);
    if (held) path = std::move(*held);
    return held.has_value();
  }

  const Region& region_;
  const Tool& tool_;
  const ContourOptions& options_;
  Diagnostics& diagnostics_;
  std::vector<Track> tracks_;  // that are cut to the bottom last
};

}  // namespace

std::optional<Toolpath> op_detail::finish_walls(const Region& region, const Tool& tool, const Reach& last,
                                                const Reach* rough, const CutOptions& cut, Length finish,
                                                Diagnostics& diagnostics) {
  const bool deep = rough == nullptr || rough->narrow.size() > last.narrow.size();
  LoopPasses passes;
  // The circle of the lead is wide enough to start where the roughing passes have removed all.
  passes.in = {LeadKind::arc, std::max(2.0 * finish, kFinishLead * tool.diameter)};
  passes.out = passes.in;
  passes.cleared = cut.top, passes.aside = deep ? cut.top : cut.top - cut.depth.mm();
  passes.levels = pass_levels(cut.top, cut.depth, deep ? cut.stepdown : Length{});
  const bool climb = cut.direction == CutDirection::climb;
  std::vector<Loop> loops;
  for (const Outline& loop : last.axis.loops)
    if (Track track(climb ? loop : reversed(loop), cut.tolerance.weld.mm()); !track.empty())
      loops.push_back({std::move(track), bounds(loop)});
  ContourRun run(cut, tool, Walls(region, last.radius, 0.1 * cut.tolerance.chord.mm()));
  InnerFirst order(loops);
  while (!order.done() && !run.full())
    run.loop(loops[order.take(run.here())].track, climb ? 1.0 : -1.0, passes);
  auto made = finished(run.cutter(), cut, diagnostics);
  if (!made) return std::nullopt;
  return std::move(made->path);
}

std::optional<Operation> contour(const Region& region, const Tool& tool, const ContourOptions& options,
                                 Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!valid(cut, tool, diagnostics) || !valid(options.bones, cut, diagnostics)) return std::nullopt;
  if (!usable(region, cut, diagnostics)) return std::nullopt;
  for (const auto& [length, what] : {std::pair(options.lead_in.size, "size of the lead-in"),
                                     {options.lead_out.size, "size of the lead-out"},
                                     {options.overlap, "overlap"},
                                     {options.finish, "finishing allowance"}}) {
    if (length >= Length{} && length.mm() <= limits::kMaxToolSize) continue;
    diagnostics.error(codes::op_option, cut.where,
                      fmt::format("{}{} is {:g}; it must be 0 mm or more", prefix(cut), what, length.mm()));
    return std::nullopt;
  }
  return RegionContour(region, tool, options, diagnostics).run();
}

std::optional<Operation> contour_on(const std::vector<Outline>& outlines, const Tool& tool,
                                    const CutOptions& options, Diagnostics& diagnostics) {
  if (!valid(options, tool, diagnostics)) return std::nullopt;
  if (!within_limits(outlines, options, diagnostics)) return std::nullopt;
  const std::vector<Loop> open = loops_of(outlines, options.tolerance.weld);
  if (open.empty()) {
    diagnostics.error(codes::op_empty, options.where,
                      prefix(options) + "no outline has a length; nothing to cut");
    return std::nullopt;
  }
  ContourRun run(options, tool, Walls(Walls::Kind::unknown));
  const LoopPasses passes{
      {}, {}, 0.0, options.top, options.top, pass_levels(options.top, options.depth, options.stepdown)};
  InnerFirst order(open);
  while (!order.done() && !run.full()) {
    const Track& track = open[order.take(run.here())].track;
    if (track.closed())
      run.loop(track, 0.0, passes);
    else
      run.open_path(track, passes);
  }
  return finished(run.cutter(), options, diagnostics);
}

}  // namespace kerf
