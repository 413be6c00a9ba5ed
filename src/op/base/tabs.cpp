// Tabs: cuts are divided where the axis comes within half a tab, and half the tool, of the centre of a tab.
// There a profile of heights holds the tool above the tab. For a triangular tab the profile is flat over the
// tool's diameter: a flat tool whose axis followed a mere triangle would cut its tip off.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "op/base/chains.h"
#include "op/base/tab_path.h"
#include "op/base/upwards.h"
#include "path/arc_parts.h"

#include "kerf/base/limits.h"
#include "kerf/op/operation.h"

namespace kerf {
namespace op_detail {
namespace {

constexpr double kStraight = 0.985;   // chord by length of a path that is straight enough for a tab
constexpr double kFromCorner = 0.5;   // of the diameter: a tab is this far from a corner, to be cut off there
constexpr double kShift = 0.125;      // of a tab's width: distance of the positions that are tried
constexpr double kAlike = 1e-6;       // of straightness, as on a circle
constexpr int kMaxShifts = 4000;      // positions tried for one tab
constexpr double kMaxCovered = 0.75;  // of the length of a path by tabs
constexpr double kNearZ = 1e-6;       // mm: the tool is at the top of a tab

double half_width(const TabOptions& o, Length diameter) {
  const Length length = o.length > Length{} ? o.length : diameter;
  return 0.5 * (length.mm() + diameter.mm());
}

/// How straight a closed path is about a length: chord by length.
double straightness(const Track& track, double s, double half) {
  return distance(track.at(s - half), track.at(s + half)) / (2.0 * half);
}

/// The positions of tabs on a closed path: on straight spans away from corners, as near to regular distances
/// as these permit. A tab across a corner, or across the finger of a joint, cannot be cut off along the edge.
class TabPositions {
 public:
  /// `half`: of the length that a tab rises over; `span`: of the length that has no corner.
  TabPositions(const Track& track, double half, double span) : track_(track), half_(half), span_(span) {}

  /// Adds a tab near to `regular`, within `window` of it where there is a straight span; else on one
  /// anywhere, and on a path without one where it is straightest.
  void add(double regular, double window) {
    double best = regular, straightest = -1.0;
    const auto found = [&](double reach) {
      const double step = std::max(kShift * half_, 2.0 * reach / kMaxShifts);
      for (int k = 0; 0.5 * k * step <= reach; ++k) {
        const double s = regular + (k % 2 == 0 ? 0.5 : -0.5) * (k + k % 2) * step;
        const double now = straightness(track_, s, span_);
        if (now > straightest + kAlike && is_free(s)) straightest = now, best = s;
        if (straightest >= kStraight) return true;
      }
      return false;
    };
    if (!found(window - half_) && any_left_) {
      const auto [near, at] = std::pair(straightest, best);
      any_left_ = found(0.5 * track_.length());
      if (!any_left_ && near >= 0.0) best = at;
    }
    positions_.push_back(best);
  }
  const std::vector<double>& all() const { return positions_; }

 private:
  /// Whether no other tab is there.
  bool is_free(double s) const {
    const double whole = track_.length();
    return std::all_of(positions_.begin(), positions_.end(), [&](double other) {
      const double way = std::abs(std::remainder(s - other, whole));
      return way >= 2.0 * half_;
    });
  }

  const Track& track_;
  double half_, span_;
  bool any_left_ = true;  // straight spans, perhaps
  std::vector<double> positions_;
};

/// A motion with a path parameter t from 0 to 1.
struct Cutting {
  bool arc = false;
  Point3 from, to;
  ArcWalk walk{};
  step::Arc shape{};
  Feed feed{};

  /// Seen from above.
  double length() const {
    return arc ? std::abs(walk.sweep) * walk.start_radius : distance(from.xy(), to.xy());
  }
  Point3 at(double t) const {
    if (t >= 1.0) return to;
    return arc ? walk.at(t) : from + t * (to - from);
  }
  /// Where the distance from a point is `radius`, in order.
  std::vector<double> meets(Point2 centre, double radius) const {
    std::vector<double> ts;
    const auto keep = [&](double t) {
      if (t > 0.0 && t < 1.0) ts.push_back(t);
    };
    if (!arc) {
      const Point2 d = to.xy() - from.xy(), e = from.xy() - centre;
      const double a = dot(d, d), b = dot(d, e), c = dot(e, e) - radius * radius, root = b * b - a * c;
      if (a > 0.0 && root > 0.0) keep((-b - std::sqrt(root)) / a), keep((-b + std::sqrt(root)) / a);
      return ts;
    }
    const Point2 arc_centre{walk.u, walk.v};
    const double d = distance(arc_centre, centre), r = walk.start_radius;
    if (!(d > 0.0) || d > r + radius || d < std::abs(r - radius)) return ts;
    const double towards = std::atan2(centre.y - arc_centre.y, centre.x - arc_centre.x);
    const double half = std::acos(std::clamp((r * r + d * d - radius * radius) / (2.0 * r * d), -1.0, 1.0));
    for (const double angle : {towards - half, towards + half}) {
      double turned = (walk.sweep > 0.0 ? 1.0 : -1.0) * (angle - walk.start_angle);
      turned -= 2.0 * std::numbers::pi * std::floor(turned / (2.0 * std::numbers::pi));
      for (; turned < std::abs(walk.sweep); turned += 2.0 * std::numbers::pi)
        keep(turned / std::abs(walk.sweep));
    }
    std::sort(ts.begin(), ts.end());
    return ts;
  }
};

class OverTabs {
 public:
  OverTabs(Toolpath& out, const std::vector<Tab>& tabs, const TabOptions& options, Length diameter)
      : out_(out),
        tabs_(tabs),
        options_(options),
        half_(half_width(options, diameter)),
        flat_(0.5 * diameter.mm()) {}

  void cut(const Step& s, Point3 from, OriginId origin) {
    Cutting c;
    c.arc = s.kind() == StepKind::arc;
    c.from = from, c.to = s.to(), c.feed = s.feed();
    if (c.arc) c.walk = walk_of(s, from), c.shape = s.arc();
    std::vector<double> ends{0.0, 1.0};
    for (const Tab& tab : tabs_) {
      for (const double t : c.meets(tab.at, half_)) ends.push_back(t);
      if (options_.shape == TabShape::triangular)
        for (const double t : c.meets(tab.at, flat_)) ends.push_back(t);
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 1; i < ends.size(); ++i)
      if (ends[i] > ends[i - 1]) part(c, ends[i - 1], ends[i], origin);
  }
  /// Where the tool is; it may be above the end of the last cut.
  Point3 here;

 private:
  /// The height that the tool must have, approaching path parameter `t` from the side of `beside`.
  double floor_at(const Cutting& c, double t, double beside) const {
    double floor = -INFINITY;
    const Point2 p = c.at(t).xy(), q = c.at(beside).xy();
    for (const Tab& tab : tabs_) {
      if (distance(q, tab.at) >= half_) continue;
      const double top = tab.bottom + options_.height.mm(), d = distance(p, tab.at);
      const double fraction =
          options_.shape == TabShape::rectangular ? 1.0 : std::clamp((half_ - d) / (half_ - flat_), 0.0, 1.0);
      floor = std::max(floor, tab.bottom + fraction * (top - tab.bottom));
    }
    return floor;
  }

  /// A part without an end of a tab: the floor is linear between its ends, and so is the height of the cut.
  void part(const Cutting& c, double t0, double t1, OriginId origin) {
    const double halfway = 0.5 * (t0 + t1), z0 = c.at(t0).z, z1 = c.at(t1).z;
    const double f0 = floor_at(c, t0, halfway), f1 = floor_at(c, t1, halfway);
    move(c, t0, t0, std::max(z0, f0), origin);
    // Where the cut passes through the floor.
    if ((z0 < f0) != (z1 < f1) && std::isfinite(f0)) {
      const double t = t0 + (t1 - t0) * (f0 - z0) / ((f0 - z0) + (z1 - f1));
      if (t > t0 && t < t1) {
        move(c, t0, t, c.at(t).z, origin);
        t0 = t;
      }
    }
    move(c, t0, t1, std::max(z1, f1), origin);
  }

  void move(const Cutting& c, double t0, double t1, double z, OriginId origin) {
    const Point3 end = c.at(t1);
    const Point3 to{end.x, end.y, z};
    const bool across = t1 > t0;
    if (!across && std::abs(here.z - z) <= kNearZ) return;
    const double along = across ? c.length() * (t1 - t0) : 0.0;
    if (c.arc && across) {
      step::Arc arc = c.shape;
      arc.feed = feed_down(c, here.z - z, along);
      add_part(out_, arc_part(arc, c.walk, t0, t1, here, to), origin);
    } else {
      out_.add(step::Cut{to, feed_down(c, here.z - z, along)}, origin);
    }
    here = to;
  }
  /// The feed of the cut, less where it descends more steeply than the original did.
  Feed feed_down(const Cutting& c, double drop, double along) const {
    const double usual = c.from.z - c.to.z;  // drop of the whole cut
    if (!(drop > kNearZ) || (drop - kNearZ) * c.length() <= usual * along) return c.feed;
    const Feed plunge = options_.plunge > Feed{} ? options_.plunge : 0.5 * c.feed;
    return std::min(c.feed, plunge / (drop / std::hypot(drop, along)));
  }

  Toolpath& out_;
  const std::vector<Tab>& tabs_;
  const TabOptions& options_;
  double half_, flat_;
};

}  // namespace

bool valid(const TabOptions& o, Length diameter, Diagnostics& diagnostics) {
  const auto in_range = [](Length v, double least) {
    return v.mm() >= least && v.mm() <= limits::kMaxCoordinate;
  };
  const bool good = in_range(o.height, 0) && in_range(o.length, 0) && in_range(o.spacing, 0) && o.count > 0 &&
                    o.plunge >= Feed{} && diameter > Length{} && diameter.mm() <= limits::kMaxToolSize;
  if (!good)
    diagnostics.error(
        codes::pass_option, {},
        fmt::format("{} tabs {:g} mm high and {:g} mm long, {:g} mm apart, for a tool of {:g} mm "
                    "are not possible",
                    o.count, o.height.mm(), o.length.mm(), o.spacing.mm(), diameter.mm()));
  return good;
}

void ShortPaths::add(const Track& track, double wanted, double has, const Origin& where) {
  ++count_;
  if (count_ > 1 && track.length() >= length_) return;
  length_ = track.length(), wanted_ = wanted, has_ = has;
  at_ = track.at(0.0), where_ = where;
}

void ShortPaths::report(Diagnostics& diagnostics) const {
  if (count_ == 0) return;
  const std::string path = fmt::format("{:.4g} mm at {:.6g}, {:.6g}", length_, at_.x, at_.y);
  diagnostics.warning(
      codes::pass_refused, where_,
      count_ == 1
          ? fmt::format("a path of {} is too short for {:g} tabs; it has {:g}", path, wanted_, has_)
          : fmt::format("{} paths are too short for their tabs; the shortest, of {}, has {:g} of {:g}",
                        count_, path, has_, wanted_));
}

std::vector<Tab> tabs_along(const Track& track, double bottom, const TabOptions& options, Length diameter,
                            const Origin& where, ShortPaths& short_paths) {
  const double half = half_width(options, diameter), whole = track.length();
  const double wanted =
      options.spacing > Length{} ? std::max(std::round(whole / options.spacing.mm()), 1.0) : options.count;
  const double maximum = std::floor(kMaxCovered * whole / (2.0 * half)), count = std::min(wanted, maximum);
  if (count < wanted) short_paths.add(track, wanted, count, where);
  TabPositions positions(track, half, half + kFromCorner * diameter.mm());
  for (double i = 0.0; i < count; i += 1.0) positions.add(whole * (i + 0.5) / count, 0.5 * whole / count);
  std::vector<Tab> tabs;
  for (const double s : positions.all()) tabs.push_back({track.at(s), bottom});
  return tabs;
}

namespace {

/// Appends the steps `first` to `end` of a path, which start at `here`; cuts rise over the tabs.
void add_over_tabs(Toolpath& out, const Toolpath& path, std::size_t first, std::size_t end,
                   std::optional<Point3> here, const std::vector<Tab>& tabs, const TabOptions& options,
                   Length diameter) {
  OverTabs over(out, tabs, options, diameter);
  double top = -INFINITY;
  for (const Tab& tab : tabs) top = std::max(top, tab.bottom + options.height.mm());
  if (here) over.here = *here;
  for (std::size_t i = first; i < end; ++i) {
    const Step& s = path[i];
    const bool low = s.is_cutting() && here && s.unknown_axes() == 0 && path.extra(i) == nullptr &&
                     (s.kind() != StepKind::arc || s.arc().plane == Plane::xy) &&
                     std::min(here->z, s.to().z) < top;
    if (low) {
      over.cut(s, *here, out.copy_origin(path, i));
    } else {
      out.add_copy(path, i);
      if (s.is_motion()) over.here = s.to();
    }
    if (s.is_motion()) here = s.unknown_axes() == 0 ? std::optional(s.to()) : std::nullopt;
  }
}

constexpr double kLevel = 1e-6;  // mm: heights that are one level
const double kWeld = Tolerance{}.weld.mm();

/// Cuts between two rapids.
struct Chain {
  std::size_t first = 0, end = 0;
  Point3 start;
};

class TabPass {
 public:
  TabPass(const Toolpath& path, const TabOptions& options, Length diameter, double reach,
          Diagnostics& diagnostics)
      : path_(path), options_(options), diameter_(diameter), reach_(reach), diagnostics_(diagnostics) {
    find_chains();
  }

  /// Tabs on the closed paths at the bottom.
  std::vector<Tab> placed() const {
    std::vector<Tab> tabs;
    ShortPaths short_paths;
    for (const Chain& chain : chains_)
      if (const auto track = loop_of(chain); track && !is_near(*track, tabs))
        for (const Tab& tab :
             tabs_along(*track, bottom_, options_, diameter_, path_.origin_of(chain.first), short_paths))
          tabs.push_back(tab);
    short_paths.report(diagnostics_);
    if (tabs.empty())
      diagnostics_.warning(codes::pass_refused, {}, "no closed path is cut to the lowest level; no tabs");
    return tabs;
  }

  std::optional<Toolpath> run(std::vector<Tab> tabs) {
    tabs_ = std::move(tabs);
    Toolpath out;
    std::size_t next = 0;
    const auto copy_to = [&](std::size_t end) {
      for (; next < end; ++next) out.add_copy(path_, next);
    };
    for (const Chain& chain : chains_) {
      copy_to(chain.first);
      add_over_tabs(out, path_, chain.first, chain.end, chain.start, tabs_of(chain), options_, diameter_);
      next = chain.end;
      if (out.size() > options_.max_steps) {
        diagnostics_.error(codes::pass_option, {}, fmt::format("more than {} steps", options_.max_steps));
        return std::nullopt;
      }
    }
    copy_to(path_.size());
    return out;
  }

 private:
  void find_chains() {
    std::optional<Point3> here;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      if (!s.is_motion()) continue;
      if (s.is_cutting() && here) {
        if (chains_.empty() || closed_) chains_.push_back({i, i, *here});
        chains_.back().end = i + 1, closed_ = false;
        bottom_ = std::min(bottom_, s.to().z);
      } else {
        closed_ = true;
      }
      here = s.unknown_axes() == 0 ? std::optional(s.to()) : std::nullopt;
    }
  }

  /// The closed path of a chain on the bottom, if it is one.
  std::optional<Track> loop_of(const Chain& chain) const {
    Outline outline;
    bool started = false;
    Point3 here = chain.start;
    for (std::size_t i = chain.first; i < chain.end; ++i) {
      const Step& s = path_[i];
      if (!s.is_motion()) continue;
      const bool level = s.is_cutting() && std::abs(here.z - bottom_) <= kLevel &&
                         std::abs(s.to().z - bottom_) <= kLevel && here.xy() != s.to().xy();
      const bool circle = s.kind() == StepKind::arc && here.xy() == s.to().xy();
      if (level ||
          (circle && std::abs(s.to().z - bottom_) <= kLevel && std::abs(here.z - bottom_) <= kLevel)) {
        if (!started) outline.start = here.xy(), started = true;
        add_segment(outline, s, here);
        if (const auto from = loop_start(outline)) return Track(loop_from(outline, *from), kWeld);
      }
      here = s.to();
    }
    return std::nullopt;
  }
  bool is_near(const Track& track, const std::vector<Tab>& tabs) const {
    return std::any_of(tabs.begin(), tabs.end(), [&](const Tab& tab) {
      return distance(track.at(track.nearest(tab.at)), tab.at) <= reach_;
    });
  }
  /// The tabs on the path of a chain.
  std::vector<Tab> tabs_of(const Chain& chain) const {
    std::vector<Tab> near;
    for (const Tab& tab : tabs_) {
      Point3 here = chain.start;
      for (std::size_t i = chain.first; i < chain.end; ++i) {
        const Step& s = path_[i];
        if (!s.is_motion()) continue;
        Outline outline;
        outline.start = here.xy();
        if (here.xy() != s.to().xy() || s.kind() == StepKind::arc) {
          add_segment(outline, s, here);
          const Track track(outline, 0.0);
          if (!track.empty() && distance(track.at(track.nearest(tab.at)), tab.at) <= reach_) {
            near.push_back(tab);
            break;
          }
        }
        here = s.to();
      }
    }
    return near;
  }

  const Toolpath& path_;
  const TabOptions& options_;
  Length diameter_;
  double reach_;
  Diagnostics& diagnostics_;
  std::vector<Chain> chains_;
  std::vector<Tab> tabs_;
  double bottom_ = INFINITY;
  bool closed_ = false;
};

}  // namespace

std::optional<Toolpath> over_tabs(const Toolpath& path, std::vector<Tab> tabs, double reach,
                                  const TabOptions& options, Length diameter, Diagnostics& diagnostics) {
  return TabPass(path, options, diameter, reach, diagnostics).run(std::move(tabs));
}

}  // namespace op_detail

/// Of the diameter: cuts this near to a tab's centre are along its path.
constexpr double kReach = 0.3;

std::optional<Toolpath> add_tabs(const Toolpath& path, const TabOptions& options, Length diameter,
                                 Diagnostics& diagnostics) {
  if (!op_detail::valid(options, diameter, diagnostics)) return std::nullopt;
  if (!(options.height > Length{})) return path;
  if (!op_detail::counts_upwards(path, "tabs", diagnostics)) return std::nullopt;
  op_detail::TabPass pass(path, options, diameter, kReach * diameter.mm(), diagnostics);
  return pass.run(pass.placed());
}

}  // namespace kerf
