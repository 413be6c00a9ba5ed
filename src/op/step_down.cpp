// Depth per pass: chains of cuts repeated at raised levels.
#include "kerf/op/step_down.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "op/cutter.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kMaxPasses = 10'000.0;
constexpr double kMaxLegs = 500.0;    // of a ramp back and forth: a part too short for them is plunged into
constexpr double kMinRampPart = 1.0;  // mm

/// Whether a chain of cuts continues across a step of this kind: it neither moves the tool nor stops it.
bool is_transparent(StepKind kind) {
  switch (kind) {
    case StepKind::note:
    case StepKind::layer:
    case StepKind::verbatim:
    case StepKind::close_path:
    case StepKind::path_mode:
    case StepKind::dwell:
    case StepKind::coolant: return true;
    default: return false;
  }
}

class StepDown {
 public:
  StepDown(const Toolpath& path, const StepDownOptions& options, Diagnostics& diagnostics)
      : path_(path), options_(options), diagnostics_(diagnostics) {}

  std::optional<Toolpath> run() {
    std::size_t i = 0;
    while (i < path_.size()) {
      const Step& s = path_[i];
      if (s.is_cutting()) {
        const std::size_t end = end_of_chain(i);
        if (!chain(i, end)) return std::nullopt;
        i = end;
        continue;
      }
      copy(i++);
    }
    return std::move(out_);
  }

 private:
  /// One past the last cut of the chain that starts with step `first`.
  std::size_t end_of_chain(std::size_t first) const {
    std::size_t end = first + 1;
    for (std::size_t i = end; i < path_.size(); ++i) {
      if (path_[i].is_cutting())
        end = i + 1;
      else if (!is_transparent(path_[i].kind()))
        break;
    }
    return end;
  }

  void copy(std::size_t i) {
    const Step& s = path_[i];
    if (s.is_motion()) {
      if (s.kind() == StepKind::rapid && known_ && s.unknown_axes() == 0 && s.to().xy() != here_.xy())
        travel_ = std::max(here_.z, s.to().z);
      here_ = s.to(), known_ = s.unknown_axes() == 0;
    }
    out_.add_copy(path_, i);
  }

  bool refuse(std::size_t i, std::string_view why) {
    diagnostics_.error(Code::pass_refused, path_.origin_of(i), fmt::format("no depth per pass: {}", why));
    return false;
  }

  /// The lowest point of motion `i`, which starts at `from`.
  double lowest(std::size_t i, Point3 from) const {
    double low = std::min(from.z, path_[i].to().z);
    if (path_[i].kind() == StepKind::arc) low = std::min(low, walk_of(path_[i], from).bounds().low.z);
    return low;
  }

  bool chain(std::size_t first, std::size_t end) {
    const Point3 start = here_;
    double low = INFINITY;
    Point3 from = start;
    for (std::size_t i = first; i < end; ++i)
      if (path_[i].is_cutting()) low = std::min(low, lowest(i, from)), from = path_[i].to();
    const double depth = options_.top - low;
    const double passes =
        options_.stepdown > Length{} ? std::ceil(depth / options_.stepdown.mm() - 1e-9) : 1.0;
    const std::optional<Descent> descent = descent_of(first, end);
    double cleared = options_.top;
    if (passes > 1.0) {
      if (!known_) return refuse(first, "the cut starts at an unknown position");
      if (passes > kMaxPasses) return refuse(first, fmt::format("more than {:g} passes", kMaxPasses));
      for (std::size_t i = first; i < end; ++i)
        if (path_[i].is_cutting() && (path_[i].unknown_axes() != 0 || path_.extra(i) != nullptr))
          return refuse(i, "the cut has an unknown position, a rotary axis or a probed height");
      for (double pass = 1.0; pass < passes; pass += 1.0) {
        const double level = options_.top - depth * (pass / passes);
        if (level >= start.z) continue;
        if (descent) ramp(*descent, start, cleared, level);
        cleared = level;
        if (out_.size() + (end - first) > options_.max_steps)
          return refuse(first, fmt::format("more than {} steps", options_.max_steps));
        raised(first, end, start, level);
        go_back(start, out_.copy_origin(path_, first));
      }
    }
    if (descent) ramp(*descent, start, cleared, descent->bottom);
    for (std::size_t i = first; i < end; ++i)
      if (!descent || i < descent->first || i >= descent->end) copy(i);
    return true;
  }

  /// The start of a chain that goes straight down, and the level part after it.
  struct Descent {
    std::size_t first = 0, end = 0;  // the steps that go down
    double bottom = 0.0;
    Feed plunge{}, feed{};
    Track level{{}, 0.0};
  };
  std::optional<Descent> descent_of(std::size_t first, std::size_t end) const {
    if (options_.entry == EntryKind::plunge || !known_) return std::nullopt;
    Descent made;
    made.first = made.end = first;
    Point3 here = here_;
    const auto is_plain = [&](std::size_t i) {
      return path_[i].is_cutting() && path_[i].unknown_axes() == 0 && path_.extra(i) == nullptr;
    };
    std::size_t i = first;
    for (; i < end && is_plain(i) && path_[i].kind() == StepKind::cut && path_[i].to().xy() == here.xy() &&
           path_[i].to().z <= here.z;
         ++i)
      here = path_[i].to(), made.plunge = path_[i].feed(), made.end = i + 1;
    made.bottom = here.z;
    if (made.end == first || i == end) return std::nullopt;
    made.feed = path_[i].feed();
    const double enough = (here_.z - here.z) / std::tan(options_.entry_angle.rad());
    Outline outline{here.xy(), {}, {}};
    double along = 0.0;
    for (; i < end && is_plain(i) && path_[i].to().z == here.z && along < enough; ++i) {
      if (path_[i].kind() == StepKind::arc) {
        if (path_[i].arc().plane != Plane::xy || path_[i].arc().extra_turns > 0) break;
        const ArcWalk walk = walk_of(path_[i], here);
        outline.segments.push_back({walk.at(0.5).xy(), walk.at(0.25).xy(), {}});
        outline.segments.push_back({path_[i].to().xy(), walk.at(0.75).xy(), {}});
        along += walk.length();
      } else {
        along += distance(here.xy(), path_[i].to().xy());
        outline.segments.push_back({path_[i].to().xy(), {}, {}});
      }
      here = path_[i].to();
    }
    // A closed part is cut like an open one, so that the ramp ends where the chain starts.
    made.level = Track(outline, Tolerance{}.weld.mm());
    if (made.level.length() < kMinRampPart || enough / made.level.length() > kMaxLegs) return std::nullopt;
    return made;
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
    const double there = std::ceil(run / (2.0 * d.level.length())), leg = run / (2.0 * there);
    const Feed down = d.plunge > Feed{} ? d.plunge / std::sin(std::atan(tangent)) : d.feed;
    const Feed feed = std::min(d.feed, down);
    for (double k = 0.0; k < 2.0 * there; k += 1.0) {
      const bool back = std::fmod(k, 2.0) > 0.5, last = k + 1.5 > 2.0 * there;
      const double level = last ? z : here_.z - 0.5 * drop / there;
      here_ = add_along(out_, d.level, back ? leg : 0.0, back ? 0.0 : leg, here_, level, feed, origin,
                        Tolerance{}.weld.mm(), options_.max_steps);
    }
  }

  void raised(std::size_t first, std::size_t end, Point3 start, double level) {
    Point3 from = start;  // in the path as it was
    for (std::size_t i = first; i < end; ++i) {
      const Step& s = path_[i];
      if (!s.is_cutting()) continue;
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
    const ArcWalk walk = walk_of(s, from);
    const int count = std::max(walk.chords(options_.chord, limits::kMaxChords), 1);
    Point3 last = from;
    for (int k = 1; k <= count; ++k) {
      const Point3 to = k == count ? s.to() : walk.at(static_cast<double>(k) / count);
      raised_line(last, to, level, s.feed(), origin);
      last = to;
    }
  }

  /// To above the start of the chain, unless the pass ended there.
  void go_back(Point3 start, OriginId origin) {
    if (here_.xy() == start.xy()) return;
    const double safe = std::max({start.z, travel_, here_.z});
    const auto rapid = [&](Point3 to) {
      if (to == here_) return;
      out_.add(step::Rapid{to}, origin);
      here_ = to;
    };
    rapid({here_.x, here_.y, safe});
    rapid({start.x, start.y, safe});
    rapid(start);
  }

  const Toolpath& path_;
  const StepDownOptions& options_;
  Diagnostics& diagnostics_;
  Toolpath out_;
  Point3 here_;
  bool known_ = false;
  double travel_ = -INFINITY;  // height of the last rapid across
};

}  // namespace

std::optional<Toolpath> step_down(const Toolpath& path, const StepDownOptions& options,
                                  Diagnostics& diagnostics) {
  const double stepdown = options.stepdown.mm();
  if (options.entry == EntryKind::helix) {
    diagnostics
        .error(Code::pass_option, {},
               "a helix beside the path of a finished program could cut what is to remain")
        .hint = "use ramps";
    return std::nullopt;
  }
  const double angle = options.entry_angle.deg();
  if (!((stepdown > 0.0 || (stepdown == 0.0 && options.entry == EntryKind::ramp)) &&
        std::isfinite(stepdown) && std::isfinite(options.top) && options.chord > Length{} && angle >= 0.1 &&
        angle <= 89.0)) {
    diagnostics.error(Code::pass_option, {},
                      fmt::format("a stepdown of {:g} mm from Z{:g} is not usable", stepdown, options.top));
    return std::nullopt;
  }
  return StepDown(path, options, diagnostics).run();
}

}  // namespace kerf
