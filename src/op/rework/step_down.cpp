// Depth per pass: chains of cuts repeated at raised levels.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "op/base/chains.h"
#include "op/base/pass_state.h"
#include "op/base/upwards.h"
#include "path/arc_parts.h"

#include "kerf/base/limits.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kMaxLegs = 500.0;    // of a ramp back and forth: a part too short for them is plunged into
constexpr double kMinRampPart = 1.0;  // mm
constexpr double kSameLevel = 1e-6;   // mm
constexpr double kHelixTouch = 1e-4;  // mm: a helix touches the path that it leads to

class StepDown {
 public:
  StepDown(const Toolpath& path, const StepDownOptions& options, Diagnostics& diagnostics)
      : path_(path),
        options_(options),
        diagnostics_(diagnostics),
        loops_(options.entry == EntryKind::helix ? loop_chains(path) : std::vector<LoopChain>{}),
        walls_(walls_of(loops_)),
        state_(path, out_, diagnostics) {}

  std::optional<Toolpath> run() {
    std::size_t i = 0;
    while (i < path_.size()) {
      const std::size_t first = end_of_lead(i);  // of a chain
      if (first < path_.size()) {
        const std::size_t end = end_of_chain(path_, first);
        if (!chain(i, first, end)) return std::nullopt;
        i = end;
        continue;
      }
      copy(i++);
    }
    return std::move(out_);
  }

 private:
  void copy(std::size_t i) {
    const Step& s = path_[i];
    const bool across = s.kind() == StepKind::rapid && known_ && s.unknown_axes() == 0;
    if (across && s.to().xy() != here_.xy()) travel_ = std::max(here_.z, s.to().z);
    if (s.is_motion()) here_ = s.to();
    out_.add_copy(path_, i);
    known_ = state_.now().position.is_known();
  }
  bool refuse(std::size_t i, std::string_view why) {
    diagnostics_.error(codes::pass_refused, path_.origin_of(i), fmt::format("no depth per pass: {}", why));
    return false;
  }

  /// Whether step `i` is a rapid between known positions that ends below the surface.
  bool is_deep_rapid(std::size_t i) const {
    const Step& s = path_[i];
    return s.kind() == StepKind::rapid && s.unknown_axes() == 0 && path_.extra(i) == nullptr &&
           s.to().z < options_.top;
  }
  /// The first cut of the chain that step `first` starts, or to which rapids from there on lead that carry a
  /// part of its depth. The number of steps where it does neither.
  std::size_t end_of_lead(std::size_t first) {
    if (path_[first].is_cutting()) return first;
    const bool divided = options_.stepdown > Length{} && known_;
    if (!divided || first < no_lead_before_ || !is_deep_rapid(first)) return path_.size();
    std::size_t i = first;
    while (i < path_.size() && (is_deep_rapid(i) || is_transparent(path_[i].kind()))) ++i;
    if (i < path_.size() && path_[i].is_cutting()) return i;
    no_lead_before_ = i;
    return path_.size();
  }

  /// The lowest point of motion `i`, which starts at `from`.
  double lowest(std::size_t i, Point3 from) const {
    double low = std::min(from.z, path_[i].to().z);
    if (path_[i].kind() == StepKind::arc) low = std::min(low, walk_of(path_[i], from).bounds().low.z);
    return low;
  }

  /// Whether the tool of the chain that starts at step `first` cuts below what it leaves; warns of the first.
  bool undercuts(std::size_t first, double depth) {
    if (options_.undercutting.empty() || depth <= options_.stepdown.mm()) return false;
    const std::optional<step::ToolChange>& change = state_.before(first).tool;
    if (!change || options_.undercutting.count(change->tool) == 0) return false;
    if (warned_.insert(change->tool).second)
      diagnostics_.warning(
          codes::pass_refused, path_.origin_of(first),
          fmt::format("tool {} is wider below than above; what it cuts is not divided into passes",
                      change->tool));
    return true;
  }

  bool is_whole(std::size_t first) const {
    return std::binary_search(options_.whole.begin(), options_.whole.end(), first);
  }

  /// Cuts from step `first` on, with the rapids from step `lead` on that carry a part of their depth.
  struct Chain {
    std::size_t lead = 0, first = 0, end = 0;
    Point3 start;           // of the first cut
    double low = INFINITY;  // of all cuts
    double above = 0.0;     // the tool comes from this height
  };
  Chain chain_of(std::size_t lead, std::size_t first, std::size_t end) const {
    Chain made{lead, first, end, here_, INFINITY, here_.z};
    for (std::size_t i = lead; i < first; ++i)
      if (path_[i].is_motion()) made.start = path_[i].to();
    Point3 from = made.start;
    for (std::size_t i = first; i < end; ++i)
      if (path_[i].is_cutting()) made.low = std::min(made.low, lowest(i, from)), from = path_[i].to();
    return made;
  }

  /// The start of a chain that goes straight down, and the level part after it.
  struct Descent {
    std::size_t first = 0, end = 0;  // the steps that go down
    double bottom = 0.0;
    Feed plunge{}, feed{};
    Track level{{}, 0.0};
    std::optional<Point2> helix;  // its centre
  };

  bool chain(std::size_t lead, std::size_t first, std::size_t end) {
    const Chain c = chain_of(lead, first, end);
    const double depth = options_.top - c.low;
    const double passes = options_.stepdown > Length{} && !is_whole(first) && !undercuts(first, depth)
                              ? std::ceil(depth / options_.stepdown.mm() - 1e-9)
                              : 1.0;
    double cleared = options_.top;
    const std::optional<Descent> descent = descent_of(first, end, c.start);
    if (passes > 1.0 && !raised_passes(c, depth, passes, descent, cleared)) return false;
    if (!(passes > 1.0))
      for (std::size_t i = lead; i < first; ++i) copy(i);
    if (descent) ramp(*descent, c.start, cleared, descent->bottom);
    for (std::size_t i = first; i < end; ++i)
      if (!descent || i < descent->first || i >= descent->end) copy(i);
    return true;
  }

  /// All passes but the last, which starts where they leave the tool.
  bool raised_passes(const Chain& c, double depth, double passes, const std::optional<Descent>& descent,
                     double& cleared) {
    if (!can_be_raised(c, depth, passes)) return false;
    const PathState& wanted = state_.before(c.first);
    bool again = false;  // the tool has been at the start of the chain
    for (double pass = 1.0; pass < passes; pass += 1.0) {
      const double level = options_.top - depth * (pass / passes);
      if (c.lead == c.first && level >= c.start.z) continue;
      go_down(c, level, again ? &wanted : nullptr);
      if (descent) ramp(*descent, c.start, cleared, level);
      cleared = level;
      if (out_.size() + (c.end - c.lead) > options_.max_steps)
        return refuse(c.first, fmt::format("more than {} steps", options_.max_steps));
      raised(c.first, c.end, c.start, level);
      go_back(c);
      again = true;
    }
    go_down(c, c.start.z, again ? &wanted : nullptr);
    return true;
  }

  bool can_be_raised(const Chain& c, double depth, double passes) {
    if (!known_) return refuse(c.first, "the cut starts at an unknown position");
    if (passes > limits::kMaxPasses)
      return refuse(c.first, fmt::format("more than {:g} passes", limits::kMaxPasses));
    // The step before it is one at which the tool cannot be raised, such as a pause.
    if (c.lead == c.first && c.start.z < options_.top - depth / passes - kSameLevel)
      return refuse(c.first, "the cut continues below the surface, where no rapid leads to it");
    for (std::size_t i = c.first; i < c.end; ++i)
      if (path_[i].is_cutting() && (path_[i].unknown_axes() != 0 || path_.extra(i) != nullptr))
        return refuse(i, "the cut has an unknown position, a rotary axis or a probed height");
    return true;
  }

  std::optional<Descent> descent_of(std::size_t first, std::size_t end, Point3 start) const {
    if (options_.entry == EntryKind::plunge || !known_ || is_whole(first)) return std::nullopt;
    Descent made;
    made.first = made.end = first;
    Point3 here = start;
    std::size_t i = first;
    for (; i < end && is_plain_cut(path_, i) && path_[i].kind() == StepKind::cut &&
           path_[i].to().xy() == here.xy() && path_[i].to().z <= here.z;
         ++i)
      here = path_[i].to(), made.plunge = path_[i].feed(), made.end = i + 1;
    made.bottom = here.z;
    if (made.end == first || i == end) return std::nullopt;
    made.feed = path_[i].feed();
    const double enough = (start.z - here.z) / std::tan(options_.entry_angle.rad());
    Outline outline{here.xy(), {}};
    double along = 0.0;
    for (; i < end && is_plain_cut(path_, i) && path_[i].to().z == here.z && along < enough; ++i) {
      if (path_[i].kind() == StepKind::arc) {
        if (path_[i].arc().plane != Plane::xy || path_[i].arc().extra_turns > 0) break;
        along += walk_of(path_[i], here).length();
      } else {
        along += distance(here.xy(), path_[i].to().xy());
      }
      add_segment(outline, path_[i], here);
      here = path_[i].to();
    }
    // A closed part is cut like an open one, so that the ramp ends where the chain starts.
    made.level = Track(outline, Tolerance{}.weld.mm());
    if (options_.entry == EntryKind::helix) made.helix = helix_of(first, end, start, made.level);
    if (made.helix) return made;
    if (made.level.length() < kMinRampPart || enough / made.level.length() > kMaxLegs) return std::nullopt;
    return made;
  }

  double free_side() const { return options_.part == PartSide::right ? 1.0 : -1.0; }
  /// The centre of a helix that touches the level part of a chain at its start, on the side without the part,
  /// if it crosses no closed path, nor the chain itself where that is none. A lead-in is part of its circle.
  std::optional<Point2> helix_of(std::size_t first, std::size_t end, Point3 from, const Track& level) const {
    if (level.empty()) return std::nullopt;
    double radius = options_.helix_radius.mm();
    const LineArc start = level.pieces(0.0, level.length()).front();
    if (start.is_arc() && start.turn == free_side()) radius = std::min(radius, start.radius);
    const Point2 centre = level.at(0.0) + (free_side() * radius) * left_of(level.direction(0.0));
    if (!walls_.permits_circle(centre, radius)) return std::nullopt;
    const bool is_loop =
        std::any_of(loops_.begin(), loops_.end(), [&](const LoopChain& loop) { return loop.first == first; });
    return is_loop || keeps_clear(first, end, from, centre, radius) ? std::optional(centre) : std::nullopt;
  }
  /// Whether no cut of a chain goes into a circle.
  bool keeps_clear(std::size_t first, std::size_t end, Point3 here, Point2 centre, double radius) const {
    Outline seen{here.xy(), {}};
    for (std::size_t i = first; i < end; ++i) {
      if (!path_[i].is_cutting()) continue;
      const bool arc = path_[i].kind() == StepKind::arc;
      if (!is_plain_cut(path_, i) || (arc && path_[i].arc().plane != Plane::xy)) return false;
      if (arc || path_[i].to().xy() != here.xy()) add_segment(seen, path_[i], here);
      here = path_[i].to();
    }
    const Track chain(seen, Tolerance{}.weld.mm());
    return distance(chain.at(chain.nearest(centre)), centre) >= radius - kHelixTouch;
  }
  /// Around the centre of a helix down to the level `z`.
  void helix(const Descent& d, double z, Feed feed, OriginId origin) {
    const double round = 2.0 * std::numbers::pi * distance(*d.helix, here_.xy());
    const double turns = std::ceil((here_.z - z) / (round * std::tan(options_.entry_angle.rad())) - 1e-9);
    step::Arc arc;
    arc.to = here_ = {here_.x, here_.y, z};
    arc.centre = *d.helix, arc.feed = feed;
    arc.turn = free_side() > 0.0 ? Turn::ccw : Turn::cw;
    arc.extra_turns = static_cast<int>(std::clamp(turns, 1.0, double{limits::kMaxTurns})) - 1;
    out_.add(arc, origin);
  }

  /// From above the start of a chain, where material was removed down to `cleared`, along its level part to
  /// the level `z`, and back to the start.
  void ramp(const Descent& d, Point3 start, double cleared, double z) {
    const OriginId origin = out_.copy_origin(path_, d.first);
    if (here_.z > cleared && here_.xy() == start.xy())
      cut({start.x, start.y, std::max(std::min(here_.z, cleared), z)}, d.plunge, origin);
    const double drop = here_.z - z;
    if (!(drop > 0.0) || here_.xy() != start.xy()) return;
    const double tangent = std::tan(options_.entry_angle.rad()), run = drop / tangent;
    const Feed down = d.plunge > Feed{} ? d.plunge / std::sin(std::atan(tangent)) : d.feed;
    const Feed feed = std::min(d.feed, down);
    if (d.helix) return helix(d, z, feed, origin);
    const double there = std::ceil(run / (2.0 * d.level.length())), leg = run / (2.0 * there);
    for (double k = 0.0; k < 2.0 * there; k += 1.0) {
      const bool back = std::fmod(k, 2.0) > 0.5, last = k + 1.5 > 2.0 * there;
      const double level = last ? z : here_.z - 0.5 * drop / there;
      here_ = add_along(out_, d.level, back ? leg : 0.0, back ? 0.0 : leg, here_, level, feed, origin,
                        Tolerance{}.weld.mm(), options_.max_steps);
    }
  }

  /// Whether step `i` of a chain is part of every pass: what sets the state, and the time that a spindle
  /// needs.
  bool is_repeated(std::size_t i) const {
    if (path_[i].kind() == StepKind::dwell) return i > 0 && path_[i - 1].kind() == StepKind::spindle;
    return part_set_by(path_[i]) != 0;
  }
  void raised(std::size_t first, std::size_t end, Point3 start, double level) {
    Point3 from = start;  // in the path as it was
    for (std::size_t i = first; i < end; ++i) {
      const Step& s = path_[i];
      if (!s.is_cutting()) {
        if (is_repeated(i)) out_.add_copy(path_, i);
        continue;
      }
      const OriginId origin = out_.copy_origin(path_, i);
      if (s.kind() == StepKind::arc)
        raised_arc(i, from, level, origin);
      else
        raised_line(from, s.to(), level, s.feed(), origin);
      from = s.to();
    }
  }

  void cut(Point3 to, Feed feed, OriginId origin) {
    if (to == here_) return;
    out_.add(step::Cut{to, feed}, origin);
    here_ = to;
  }

  void raised_line(Point3 from, Point3 to, double level, Feed feed, OriginId origin) {
    if ((from.z < level) != (to.z < level) && from.z != to.z) {
      Point3 crossing = from + ((level - from.z) / (to.z - from.z)) * (to - from);
      crossing.z = level;
      cut(crossing, feed, origin);
    }
    cut({to.x, to.y, std::max(to.z, level)}, feed, origin);
  }

  void raised_arc(std::size_t i, Point3 from, double level, OriginId origin) {
    const Step& s = path_[i];
    step::Arc arc = s.arc();
    const double low = lowest(i, from);
    const bool flat = arc.plane == Plane::xy && from.z <= level && arc.to.z <= level;
    // The tool is above the start where a pass continues from the level of the last one.
    if (flat || (low >= level && here_ == from)) {
      if (flat) arc.to.z = level, arc.extra_turns = 0;
      if (here_.z != (flat ? level : from.z))
        cut({here_.x, here_.y, flat ? level : from.z}, s.feed(), origin);
      out_.add(arc, origin);
      here_ = arc.to;
      return;
    }
    Point3 last = from;
    for (const Point3 to : chords_of(s, from, options_.chord, limits::kMaxChords)) {
      raised_line(last, to, level, s.feed(), origin);
      last = to;
    }
  }

  void rapid(Point3 to, OriginId origin) {
    if (to == here_) return;
    out_.add(step::Rapid{to}, origin);
    here_ = to;
  }

  /// To above the start of the chain, unless the pass ended there.
  void go_back(const Chain& c) {
    if (here_.xy() == c.start.xy()) return;
    const OriginId origin = out_.copy_origin(path_, c.first);
    const double safe = std::max({c.above, travel_, here_.z});
    rapid({here_.x, here_.y, safe}, origin);
    rapid({c.start.x, c.start.y, safe}, origin);
  }

  /// To the start of a pass; of a further one in the state in which the chain starts.
  void go_down(const Chain& c, double level, const PathState* wanted) {
    if (wanted != nullptr) {
      state_.restore_or_warn(*wanted, kAllState, c.first, "the passes of this cut");
      if (c.lead != c.first || here_.z > c.start.z)
        rapid({c.start.x, c.start.y, std::max(c.start.z, level)}, out_.copy_origin(path_, c.first));
      return;
    }
    for (std::size_t i = c.lead; i < c.first; ++i) {
      const Point3 to = path_[i].to();
      if (path_[i].is_motion())
        rapid({to.x, to.y, std::max(to.z, level)}, out_.copy_origin(path_, i));
      else
        out_.add_copy(path_, i);
    }
  }

  const Toolpath& path_;
  const StepDownOptions& options_;
  Diagnostics& diagnostics_;
  std::vector<LoopChain> loops_;
  Walls walls_;
  std::set<int> warned_;  // undercutting tools
  Toolpath out_;
  PassState state_;
  std::size_t no_lead_before_ = 0;  // a step; rapids before it lead to no cut
  Point3 here_;
  bool known_ = false;
  double travel_ = -INFINITY;  // height of the last rapid across
};

}  // namespace

std::optional<Toolpath> step_down(const Toolpath& path, const StepDownOptions& options,
                                  Diagnostics& diagnostics) {
  const double stepdown = options.stepdown.mm();
  const double radius = options.helix_radius.mm();
  if (options.entry == EntryKind::helix && !(radius > 0.0 && radius <= limits::kMaxToolSize)) {
    diagnostics.error(codes::pass_option, {},
                      fmt::format("the radius of a helix is {:g} mm; it must be above 0", radius));
    return std::nullopt;
  }
  const double angle = options.entry_angle.deg();
  if (!((stepdown > 0.0 || (stepdown == 0.0 && options.entry != EntryKind::plunge)) &&
        std::isfinite(stepdown) && std::isfinite(options.top) && options.chord > Length{} && angle >= 0.1 &&
        angle <= 89.0)) {
    diagnostics.error(codes::pass_option, {},
                      fmt::format("a stepdown of {:g} mm from Z{:g} is not usable", stepdown, options.top));
    return std::nullopt;
  }
  if (!counts_upwards(path, "passes", diagnostics)) return std::nullopt;
  return StepDown(path, options, diagnostics).run();
}

}  // namespace kerf
