// Pockets by rings and by zigzag lines, and facing.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/hatch.h"
#include "op/base/option_check.h"
#include "op/base/reach.h"
#include "op/mill/adaptive.h"
#include "op/mill/bones.h"
#include "op/mill/finish.h"
#include "op/mill/pocket_rings.h"
#include "op/mill/spiral.h"

#include "kerf/base/limits.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kLineInset =
    0.1;  // of the tool's radius, from the ends of a zigzag's lines to the ring along the walls
constexpr double kMinEngagement = 15.0, kMaxEngagement = 90.0;  // degrees
constexpr double kMaxLink = 1.5;  // of the tool's diameter: a longer way between rings is made above material

/// The track of a loop in the direction that cuts as requested: loops of a region have their inside on the
/// left, so the wall is on the right.
Outline directed(const Outline& loop, const CutOptions& options) {
  return options.direction == CutDirection::climb ? loop : reversed(loop);
}
Track track_of(const Outline& loop, const CutOptions& options) {
  return Track(directed(loop, options), options.tolerance.weld.mm());
}

class PocketRun {
 public:
  PocketRun(const CutOptions& options, const Tool& tool, Walls walls)
      : options_(options), diameter_(tool.diameter.mm()), cutter_(options, tool, std::move(walls)) {}

  /// With the radius of the tool: rings around one another as spirals, where these leave nothing.
  void rings(const Rings& rings, std::optional<double> spiral_radius) {
    std::vector<std::uint32_t> open = rings.roots;
    while (!open.empty() && !cutter_.full()) {
      const std::size_t next = nearest(rings, open);
      const std::vector<RingGroup> order = grouped(rings, inside_out(rings, open[next]), spiral_radius);
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(next));
      cutter_.lift();
      double cleared = options_.top;
      for (const double z : pass_levels(options_.top, options_.depth, options_.stepdown)) {
        for (const RingGroup& group : order) {
          if (group.spiral)
            spiral(*group.spiral, cleared, z);
          else
            cell(group.loops, cleared, z);
        }
        cleared = z;
      }
    }
  }

  /// Lines in alternating directions, then a ring along the walls, at each level.
  void zigzag(const std::vector<HatchLine>& lines, const Rings& walls, double spacing) {
    cutter_.lift();
    double cleared = options_.top;
    for (const double z : pass_levels(options_.top, options_.depth, options_.stepdown)) {
      std::vector<HatchLine> open = lines;
      std::size_t at = 0;
      while (!open.empty() && !cutter_.full()) {
        hatch_line(open[at], cleared, z, spacing);
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(at));
        at = next_line(open, at, spacing);
      }
      for (const RingCell& walls_of : walls.cells) cell(tracks_of(walls_of), cleared, z);
      cleared = z;
    }
  }

  /// Each level as planned.
  void adaptive(const std::vector<AdaptiveRun>& runs) {
    cutter_.lift();
    double cleared = options_.top;
    const Turn turn = options_.direction == CutDirection::climb ? Turn::ccw : Turn::cw;
    for (const double z : pass_levels(options_.top, options_.depth, options_.stepdown)) {
      for (const AdaptiveRun& run : runs) {
        if (cutter_.full()) return;
        if (run.entry)
          enter_by_helix(*run.entry, turn, cleared, z);
        else
          along(run, cleared, z);
      }
      cleared = z;
    }
  }

  /// Links between neighbouring lines may leave the region.
  void free_links() { free_links_ = true; }
  Cutter& cutter() { return cutter_; }

 private:
  std::vector<Track> tracks_of(const RingCell& cell) const {
    std::vector<Track> tracks;
    for (const Outline& loop : cell.loops)
      if (Track track = track_of(loop, options_); !track.empty()) tracks.push_back(std::move(track));
    return tracks;
  }

  /// The cells of a root, each after those inside of it; the nearest of several first.
  static std::vector<std::uint32_t> inside_out(const Rings& rings, std::uint32_t root) {
    std::vector<std::uint32_t> order;
    struct Visit {
      std::uint32_t cell;
      std::size_t next = 0;
    };
    std::vector<Visit> stack{{root}};
    while (!stack.empty()) {
      Visit& top = stack.back();
      const RingCell& cell = rings.cells[top.cell];
      if (top.next < cell.inner.size()) {
        stack.push_back({cell.inner[top.next++]});
        continue;
      }
      order.push_back(top.cell);
      stack.pop_back();
    }
    return order;
  }

  /// The loops of a cell, or those of several as a spiral.
  struct RingGroup {
    std::vector<Track> loops;
    std::optional<Spiral> spiral;
  };
  std::vector<RingGroup> grouped(const Rings& rings, const std::vector<std::uint32_t>& order,
                                 std::optional<double> spiral_radius) const {
    std::vector<RingGroup> groups;
    for (std::size_t i = 0; i < order.size();) {
      std::size_t end = i + 1;
      const auto continues = [&](std::size_t at) {
        const RingCell& cell = rings.cells[order[at]];
        return cell.loops.size() == 1 && cell.inner.size() == 1 && cell.inner.front() == order[at - 1];
      };
      if (spiral_radius && rings.cells[order[i]].loops.size() == 1)
        while (end < order.size() && continues(end)) ++end;
      std::optional<Spiral> made =
          end > i + 1 ? spiral_of(rings, order, i, end, *spiral_radius) : std::nullopt;
      if (made)
        groups.push_back({{}, std::move(made)}), i = end;
      else
        groups.push_back({tracks_of(rings.cells[order[i++]]), {}});
    }
    return groups;
  }
  std::optional<Spiral> spiral_of(const Rings& rings, const std::vector<std::uint32_t>& order,
                                  std::size_t first, std::size_t end, double radius) const {
    std::vector<Outline> outlines;
    for (std::size_t i = first; i < end; ++i)
      outlines.push_back(directed(rings.cells[order[i]].loops.front(), options_));
    return spiral_through(outlines, radius, cutter_.walls(), options_);
  }

  void spiral(const Spiral& spiral, double cleared, double z) {
    const double whole = spiral.first.length(), from = start(spiral.first, 0.0, cleared, z);
    if (cutter_.full()) return;
    // All around, and on to where the turns start.
    cutter_.follow(spiral.first, from, std::ceil((from + whole) / whole - kRounding) * whole, z);
    for (const Point2 p : spiral.points) {
      if (cutter_.full()) return;
      cutter_.line(p);
    }
    const double last = spiral.last.nearest(cutter_.position()->xy());
    cutter_.follow(spiral.last, last, last + spiral.last.length(), z);
  }
  static constexpr double kRounding = 1e-9;  // of a turn

  std::size_t nearest(const Rings& rings, const std::vector<std::uint32_t>& open) const {
    if (!cutter_.position()) return 0;
    std::size_t best = 0;
    double shortest = INFINITY;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const double d = distance(cutter_.position()->xy(), rings.cells[open[i]].loops.front().start);
      if (d < shortest) shortest = d, best = i;
    }
    return best;
  }

  /// All loops of a cell, the nearest first.
  void cell(const std::vector<Track>& loops, double cleared, double z) {
    std::vector<const Track*> open;
    for (const Track& loop : loops) open.push_back(&loop);
    while (!open.empty() && !cutter_.full()) {
      std::size_t best = 0;
      double s = 0.0, shortest = INFINITY;
      for (std::size_t i = 0; i < open.size() && cutter_.position(); ++i) {
        const double here = open[i]->nearest(cutter_.position()->xy());
        const double d = distance(open[i]->at(here), cutter_.position()->xy());
        if (d < shortest) shortest = d, best = i, s = here;
      }
      const Track& track = *open[best];
      if (const double from = start(track, s, cleared, z); !cutter_.full())
        cutter_.follow(track, from, from + track.length(), z);
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(best));
    }
  }

  void enter_by_helix(const Circle& circle, Turn turn, double cleared, double z) {
    const Point2 start = circle.centre + Point2{circle.radius.mm(), 0.0};
    cutter_.travel(start, cleared);
    cutter_.rapid_down(cleared + options_.clearance.mm());
    cutter_.helix(circle.centre, turn, z);
    cutter_.arc(start, circle.centre, turn, z, 1);
  }

  /// A path whose start is cleared.
  void along(const AdaptiveRun& run, double cleared, double z) {
    const Track track(run.path, options_.tolerance.weld.mm());
    if (track.empty()) return;
    if (run.linked) {
      cutter_.line(track.at(0.0));
    } else {
      cutter_.travel(track.at(0.0), cleared);
      cutter_.rapid_down(cleared + options_.clearance.mm());
      cutter_.plunge(z);
    }
    cutter_.follow(track, 0.0, track.length(), z);
  }

  /// To the start of a track on a level, straight where it is near; the length along it there.
  double start(const Track& track, double s, double cleared, double z) {
    const Point2 to = track.at(s);
    const auto here = cutter_.position();
    if (here && here->z == z && distance(here->xy(), to) <= kMaxLink * diameter_ &&
        cutter_.walls().permits_line(here->xy(), to)) {
      cutter_.line(to);
      return s;
    }
    cutter_.travel(to, cleared);
    return cutter_.enter(track, s, cleared, z);
  }

  void hatch_line(const HatchLine& line, double cleared, double z, double spacing) {
    Outline outline{line.from, {{line.to, {}}}};
    const auto here = cutter_.position();
    if (here && distance(here->xy(), line.to) < distance(here->xy(), line.from)) outline = reversed(outline);
    const Track track(outline, options_.tolerance.weld.mm());
    if (track.empty()) return;
    const Point2 to = track.at(0.0);
    if (here && here->z == z && distance(here->xy(), to) <= 2.0 * spacing + diameter_ &&
        (free_links_ || cutter_.walls().permits_line(here->xy(), to))) {
      cutter_.line(to);
    } else {
      cutter_.travel(to, cleared);
      cutter_.enter(track, 0.0, cleared, z);
    }
    cutter_.follow(track, 0.0, track.length(), z);
  }

  /// The line of the next rows with the nearest end, or else the first that is left. `at` is the index after
  /// the one that was cut; lines are in order of rows.
  std::size_t next_line(const std::vector<HatchLine>& open, std::size_t at, double spacing) const {
    const Point2 here = cutter_.position()->xy();
    const double enough = 2.0 * spacing + diameter_;
    const std::size_t first = at > kWindow ? at - kWindow : 0, last = std::min(open.size(), at + kWindow);
    double shortest = INFINITY;
    std::size_t best = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double d = std::min(distance(here, open[i].from), distance(here, open[i].to));
      if (d < shortest) shortest = d, best = i;
    }
    return shortest <= enough ? best : 0;
  }
  static constexpr std::size_t kWindow = 64;

  const CutOptions& options_;
  double diameter_;
  bool free_links_ = false;
  Cutter cutter_;
};

/// False, with an error, where lines at this spacing are more than the limit of steps.
bool few_lines(const Region& region, Length spacing, const CutOptions& options, Diagnostics& diagnostics) {
  const Box2 box = bounds(region);
  const double size = std::hypot(box.high.x - box.low.x, box.high.y - box.low.y);
  if (size / spacing.mm() <= static_cast<double>(options.max_steps)) return true;
  diagnostics.error(
      codes::op_limit, options.where,
      fmt::format("{}a stepover of {:g} mm needs too many lines", prefix(options), spacing.mm()));
  return false;
}

}  // namespace

namespace {

/// A warning for each slot that is too narrow for the limit, or an error where nothing else is left to cut.
std::vector<NarrowPart> narrow_slots(const AdaptivePlan& plan, const Region& region, const Tool& tool,
                                     const Reach& reachable, const PocketOptions& options,
                                     Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  std::vector<NarrowPart> parts = narrow_parts(plan.narrow, region, cut.tolerance.weld.mm());
  for (NarrowPart& part : parts)
    part.diameter = (1.0 / kNarrowestSlot) * (part.diameter - 2.0 * cut.allowance);
  if (!parts.empty()) {
    const NarrowPart& part = narrowest(parts);
    std::string message = fmt::format(
        "{}tool {} of {:.4g} mm does not keep an engagement of {:g} degrees in {} at {:.6g}, "
        "{:.6g}, which {} left; the largest that does has {:.4g} mm",
        prefix(cut), tool.number, 2.0 * (reachable.radius - cut.allowance.mm()), options.engagement.deg(),
        counted(parts.size(), "slot"), part.at.x, part.at.y, parts.size() == 1 ? "is" : "are",
        part.diameter.mm());
    const Severity severity = plan.runs.empty() ? Severity::error : Severity::warning;
    Diagnostic& d = severity == Severity::error
                        ? diagnostics.error(codes::op_tool_wide, cut.where, std::move(message))
                        : diagnostics.warning(codes::op_tool_wide, cut.where, std::move(message));
    d.hint = "a smaller tool, or pattern = \"offset\"";
  }
  return parts;
}

std::optional<Operation> cleared_adaptively(PocketRun& run, const Region& region, const Tool& tool,
                                            const Reach& reachable, const CutOptions& cut,
                                            const PocketOptions& options, Diagnostics& diagnostics) {
  const double radius = reachable.radius - cut.allowance.mm();
  const AdaptiveOptions adaptive{radius, options.engagement.rad(), 2.0 * options.stepover * radius};
  auto plan = plan_adaptive(reachable.axis, adaptive, cut, diagnostics);
  if (!plan) return std::nullopt;
  auto narrow = narrow_slots(*plan, region, tool, reachable, options, diagnostics);
  if (plan->runs.empty()) {
    if (narrow.empty())
      fail(cut, codes::op_tool_wide, fmt::format("tool {} does not fit into the region", tool.number),
           diagnostics);
    return std::nullopt;
  }
  run.adaptive(plan->runs);
  auto made = finished(run.cutter(), cut, diagnostics);
  if (made) made->unreached = std::move(plan->left), made->narrow = std::move(narrow);
  return made;
}

/// A pocket without its finishing pass; what it leaves of what the tool could reach.
std::optional<Operation> cleared(const Region& region, const Tool& tool, const Reach& reachable,
                                 const CutOptions& cut, const PocketOptions& options,
                                 Diagnostics& diagnostics) {
  const double tool_radius = reachable.radius - cut.allowance.mm();
  const Length spacing = mm(2.0 * options.stepover * tool_radius);
  PocketRun run(cut, tool, Walls(region, reachable.radius, 0.1 * cut.tolerance.chord.mm()));
  if (options.pattern == PocketPattern::adaptive)
    return cleared_adaptively(run, region, tool, reachable, cut, options, diagnostics);
  if (options.pattern == PocketPattern::zigzag) {
    if (!few_lines(reachable.axis, spacing, cut, diagnostics)) return std::nullopt;
    // The lines end short of the walls, so that links between them keep clear. The ring along the walls
    // covers what lies up to the radius from it: half a spacing beside a line, and the inset.
    const double inset = std::min(kLineInset * tool_radius, tool_radius - 0.5 * spacing.mm());
    const auto lines = offset(reachable.axis, mm(-inset), region_options(cut), diagnostics);
    if (!lines) return std::nullopt;
    run.zigzag(hatch(lines->region, options.angle, spacing, cut.max_steps), outer_rings(reachable.axis),
               spacing.mm());
  } else {
    const auto rings = pocket_rings(reachable.axis, spacing, tool_radius, cut, diagnostics);
    if (!rings) return std::nullopt;
    run.rings(*rings, options.pattern == PocketPattern::spiral ? std::optional(tool_radius) : std::nullopt);
  }
  return finished(run.cutter(), cut, diagnostics);
}

bool valid_pocket(const PocketOptions& options, const Tool& tool, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  bool good = valid(cut, tool, diagnostics);
  good = valid_stepover(options.stepover, cut, diagnostics) && good;
  OptionCheck check(cut, diagnostics);
  check.expect(options.finish >= Length{} && options.finish.mm() <= limits::kMaxToolSize,
               "finishing allowance", options.finish.mm(), "0 mm or more");
  const double engagement = options.engagement.deg();
  if (options.pattern == PocketPattern::adaptive)
    check.expect(engagement > kMinEngagement - 1e-9 && engagement < kMaxEngagement + 1e-9, "engagement",
                 engagement, fmt::format("from {:g} to {:g} degrees", kMinEngagement, kMaxEngagement));
  if (options.bones.kind != BoneKind::none && options.pattern == PocketPattern::adaptive)
    check.expect(options.finish > Length{}, "finishing allowance of an adaptive pocket with bones",
                 options.finish.mm(), "above 0 mm, since its pass cuts the bones");
  good = valid(options.bones, cut, diagnostics) && good;
  return check.valid() && good;
}

/// The union of what was never reachable and what an adaptive pocket leaves of the rest.
bool add_left(Region& unreached, const Region& left, const CutOptions& cut, Diagnostics& diagnostics) {
  if (left.empty()) return true;
  auto both = combine(unreached, left, Boolean::unite, region_options(cut), diagnostics);
  if (both) unreached = std::move(both->region);
  return both.has_value();
}

}  // namespace

std::optional<Operation> pocket(const Region& region, const Tool& tool, const PocketOptions& options,
                                Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!valid_pocket(options, tool, diagnostics) || !usable(region, cut, diagnostics)) return std::nullopt;
  std::optional<Reach> last = reach(region, tool, ReachSide::inside, cut, diagnostics);
  if (!last) return std::nullopt;
  Operation made;
  if (options.finish > Length{}) {
    CutOptions rough = cut;
    rough.allowance = cut.allowance + options.finish;
    // Parts that are too narrow with the allowance are left to the finishing pass, which then has passes.
    Diagnostics unused;
    const auto before = reach(region, tool, ReachSide::inside, rough, unused);
    if (before) {
      auto roughed = cleared(region, tool, *before, rough, options, diagnostics);
      if (!roughed) return std::nullopt;
      made = std::move(*roughed);
    }
    const auto walls =
        finish_walls(region, tool, *last, before ? &*before : nullptr, cut, options.finish, diagnostics);
    if (!walls) return std::nullopt;
    append(made.path, *walls);
  } else {
    auto all = cleared(region, tool, *last, cut, options, diagnostics);
    if (!all) return std::nullopt;
    made = std::move(*all);
  }
  if (!add_left(last->unreached, made.unreached, cut, diagnostics)) return std::nullopt;
  made.unreached = std::move(last->unreached);
  made.narrow.insert(made.narrow.begin(), last->narrow.begin(), last->narrow.end());
  const BoneWork bones{region, tool, *last, ReachSide::inside, options.bones, cut, options.finish};
  if (!add_bones(made, bones, diagnostics)) return std::nullopt;
  return made;
}

std::optional<Operation> rest_pocket(const Region& region, const Tool& earlier, const Tool& tool,
                                     const PocketOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!valid_pocket(options, tool, diagnostics) || !usable(region, cut, diagnostics)) return std::nullopt;
  Diagnostics of_earlier;  // parts too narrow for it are what is cut here
  auto before = reach(region, earlier, ReachSide::inside, cut, of_earlier);
  auto last = reach(region, tool, ReachSide::inside, cut, diagnostics);
  if (!last || stop_requested(cut.progress)) return std::nullopt;
  // Where the axis may be and the tool reaches what is left.
  const RegionOptions regions = region_options(cut);
  const Length radius = mm(last->radius);
  const auto near =
      before ? offset(before->unreached, radius, regions, diagnostics) : std::optional(Offset{region, 0, {}});
  const auto axis =
      near ? combine(last->axis, near->region, Boolean::intersect, regions, diagnostics) : std::nullopt;
  const auto part = axis ? offset(axis->region, radius, regions, diagnostics) : std::nullopt;
  if (!part) return std::nullopt;
  if (area(part->region) <= cut.tolerance.chord.mm() * length(part->region).mm()) {
    fail(cut, codes::op_empty,
         fmt::format("tool {} leaves nothing that tool {} reaches", earlier.number, tool.number),
         diagnostics);
    return std::nullopt;
  }
  PocketOptions without = options;  // the part has other corners than the region
  without.bones = {};
  auto made = pocket(part->region, tool, without, diagnostics);
  if (!made) return std::nullopt;
  made->unreached = std::move(last->unreached), made->narrow = std::move(last->narrow);
  const BoneWork bones{region, tool, *last, ReachSide::inside, options.bones, cut, options.finish};
  if (!add_bones(*made, bones, diagnostics)) return std::nullopt;
  return made;
}

std::optional<Operation> facing(const Region& region, const Tool& tool, const FacingOptions& options,
                                Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  const bool permitted = valid(cut, tool, diagnostics);
  if (!valid_stepover(options.stepover, cut, diagnostics) || !permitted) return std::nullopt;
  if (!(options.overhang >= 0.5 && options.overhang <= 10.0)) {
    diagnostics.error(
        codes::op_option, cut.where,
        fmt::format("{}overhang is {:g}; it must be from 0.5 to 10", prefix(cut), options.overhang));
    return std::nullopt;
  }
  if (!usable(region, cut, diagnostics)) return std::nullopt;
  const double diameter = 2.0 * cutting_radius(tool, cut.depth).mm();
  const auto area = offset(region, mm(options.overhang * diameter), region_options(cut), diagnostics);
  if (!area) return std::nullopt;
  const Length spacing = mm(options.stepover * diameter);
  if (!few_lines(area->region, spacing, cut, diagnostics)) return std::nullopt;
  PocketRun run(cut, tool, Walls(Walls::Kind::unknown));
  run.free_links();
  run.zigzag(hatch(area->region, options.angle, spacing, cut.max_steps), {}, spacing.mm());
  return finished(run.cutter(), cut, diagnostics);
}

}  // namespace kerf
