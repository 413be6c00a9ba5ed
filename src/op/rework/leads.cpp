// Leads and a finishing pass for the closed paths of a finished toolpath.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

#include "base/codes/op.h"
#include "op/base/chains.h"
#include "op/base/lead.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kRoughed = 2.0;  // of the allowance: a path this near to a roughing pass has no more on it
constexpr double kMaxSamples = 1e6;  // of a path

constexpr Point3 kUnknown{NAN, NAN, NAN};  // equals no position

/// A way around a closed path: where it starts on the path, and its leads if they fit.
struct Way {
  Track track;
  double s = 0.0;
  Lead in{}, out{};
};

class LeadPass {
 public:
  LeadPass(const Toolpath& path, const LeadOptions& options, Diagnostics& diagnostics)
      : path_(path),
        options_(options),
        diagnostics_(diagnostics),
        chains_(loop_chains(path)),
        walls_(walls_of(chains_)),
        weld_(options.tolerance.weld.mm()),
        free_(options.part == PartSide::right ? 1.0 : -1.0) {}

  std::optional<Led> run() {
    if (std::none_of(chains_.begin(), chains_.end(), [](const LoopChain& c) { return c.plain; }))
      diagnostics_.warning(codes::pass_refused, {},
                           "no closed path on one level; no leads, no finishing pass");
    for (const LoopChain& chain : chains_) {
      if (!chain.plain) continue;
      const std::size_t approach = approach_of(chain);
      if (approach == path_.size()) continue;
      while (next_ < approach) copy(next_++);
      if (!loop(chain, approach)) return std::nullopt;
    }
    while (next_ < path_.size()) copy(next_++);
    return Led{std::move(out_), std::move(whole_)};
  }

 private:
  void copy(std::size_t i) {
    if (path_[i].is_motion()) here_ = path_[i].unknown_axes() == 0 ? path_[i].to() : kUnknown;
    out_.add_copy(path_, i);
  }
  void rapid(Point3 to, std::size_t origin) {
    if (to == here_) return;
    out_.add(step::Rapid{to}, out_.copy_origin(path_, origin));
    here_ = to;
  }
  void cut(Point3 to, Feed feed, OriginId origin) {
    if (to == here_) return;
    out_.add(step::Cut{to, feed}, origin);
    here_ = to;
  }

  bool is_rapid_at(std::size_t i, Point2 at) const {
    const Step& s = path_[i];
    return s.kind() == StepKind::rapid && s.unknown_axes() == 0 && path_.extra(i) == nullptr &&
           distance(s.to().xy(), at) <= weld_;
  }
  /// The first step of the rapids that lead to above the start of a chain. One past the last step, with a
  /// warning, where they do not start and end above the material.
  std::size_t approach_of(const LoopChain& chain) const {
    std::size_t approach = path_.size();
    bool above = chain.start.z >= options_.top;
    for (std::size_t i = chain.first; i-- > next_;) {
      if (!path_[i].is_motion()) continue;
      if (!is_rapid_at(i, chain.start.xy())) break;
      approach = i, above = above && path_[i].to().z >= options_.top;
    }
    if (approach < path_.size() && above && is_left_upwards(chain)) return approach;
    keeps(chain, "it is not reached and left by rapids above the material");
    return path_.size();
  }
  bool is_left_upwards(const LoopChain& chain) const {
    for (std::size_t i = chain.end; i < path_.size(); ++i)
      if (path_[i].is_motion())
        return is_rapid_at(i, path_[chain.end - 1].to().xy()) && path_[i].to().z >= options_.top;
    return true;
  }
  void keeps(const LoopChain& chain, std::string_view why) const {
    diagnostics_.warning(codes::pass_refused, path_.origin_of(chain.first),
                         fmt::format("the closed path at {:.6g}, {:.6g} is kept as it is: {}", chain.start.x,
                                     chain.start.y, why));
  }

  /// Whether the circle of a lead, or the one around its line, crosses no closed path.
  bool fits(const Lead& lead, const Track& track, double s) const {
    const Point2 beyond = beyond_wall(lead, track, s, free_);
    if (lead.kind == LeadKind::arc) return walls_.permits_circle(beyond, lead.size.mm());
    return walls_.permits_circle(0.5 * (beyond + track.at(s)), 0.5 * lead.size.mm());
  }
  /// A lead where it fits, else none, with a warning.
  Lead fitting(const Lead& lead, const Track& track, double s, const LoopChain& chain,
               std::string_view name) const {
    if (lead.kind == LeadKind::none || !(lead.size > Length{})) return {};
    if (fits(lead, track, s)) return lead;
    const Point2 at = track.at(s);
    diagnostics_.warning(
        codes::pass_refused, path_.origin_of(chain.first),
        fmt::format("the {} of {:g} mm at {:.6g}, {:.6g} does not fit between closed paths; left out", name,
                    lead.size.mm(), at.x, at.y));
    return {};
  }
  Way way_of(Track track, double s, const Lead& in, const Lead& out, const LoopChain& chain) const {
    Way way{std::move(track), s, {}, {}};
    way.in = fitting(in, way.track, s, chain, "lead-in");
    way.out = fitting(out, way.track, s + options_.overlap.mm(), chain, "lead-out");
    return way;
  }

  /// Where the tool goes down.
  Point2 entry_of(const Way& way) const {
    const Point2 wall = way.track.at(way.s);
    if (way.in.kind == LeadKind::none) return wall;
    const Point2 beyond = beyond_wall(way.in, way.track, way.s, free_);
    return way.in.kind == LeadKind::line ? beyond : beyond - way.in.size.mm() * way.track.direction(way.s);
  }
  void quarter(Point2 to, Point2 centre, Feed feed, OriginId origin) {
    step::Arc arc;
    arc.to = {to.x, to.y, here_.z}, arc.centre = centre, arc.feed = feed;
    arc.turn = free_ > 0.0 ? Turn::ccw : Turn::cw;
    out_.add(arc, origin);
    here_ = arc.to;
  }
  void lead_in(const Way& way, Feed feed, OriginId origin) {
    const Point2 wall = way.track.at(way.s);
    if (way.in.kind == LeadKind::line) cut({wall.x, wall.y, here_.z}, feed, origin);
    if (way.in.kind == LeadKind::arc)
      quarter(wall, beyond_wall(way.in, way.track, way.s, free_), feed, origin);
  }
  /// The overlap and the way off the path.
  void lead_out(const Way& way, Feed feed, OriginId origin) {
    const double end = way.s + options_.overlap.mm();
    if (end > way.s)
      here_ = add_along(out_, way.track, way.s, end, here_, here_.z, feed, origin, weld_, options_.max_steps);
    if (way.out.kind == LeadKind::none) return;
    const Point2 beyond = beyond_wall(way.out, way.track, end, free_);
    if (way.out.kind == LeadKind::line) return cut({beyond.x, beyond.y, here_.z}, feed, origin);
    quarter(beyond + way.out.size.mm() * way.track.direction(end), beyond, feed, origin);
  }

  bool loop(const LoopChain& chain, std::size_t approach) {
    Lead in = options_.lead_in, out = options_.lead_out;
    Track track(chain.outline, weld_);
    Region paths;
    const std::vector<Way> rough = rough_ways(chain, in, out, paths);
    if (!rough.empty()) {
      // Where the roughing pass has no lead, that of the last one stays within what it has cut.
      const Lead own{LeadKind::arc, options_.finish};
      for (const Way& way : rough) {
        if (way.in.kind == LeadKind::none) in = own;
        if (way.out.kind == LeadKind::none) out = own;
      }
    }
    const bool whole = is_roughed(track, paths);
    const Way last = way_of(std::move(track), 0.0, in, out, chain);
    double travel = chain.start.z;
    // The rapids that led to the start of the path lead to the first way down.
    const Point2 first = entry_of(rough.empty() ? last : rough.front());
    for (std::size_t i = approach; i < chain.first; ++i) {
      if (!path_[i].is_motion()) {
        copy(i);
        continue;
      }
      travel = std::max(travel, path_[i].to().z);
      rapid({first.x, first.y, path_[i].to().z}, i);
    }
    for (const Way& way : rough) rough_pass(chain, way, travel);
    go_to(chain, entry_of(last), travel);
    if (whole) whole_.push_back(out_.size());
    last_pass(chain, last);
    next_ = chain.end;
    return leave(chain);
  }

  std::vector<Way> rough_ways(const LoopChain& chain, const Lead& in, const Lead& out, Region& paths) const {
    std::vector<Way> ways;
    if (!(options_.finish > Length{})) return ways;
    Diagnostics unused;
    Region found;
    const auto aside = offset_path(chain.outline, free_ * options_.finish, {}, unused);
    for (const Outline& outline : aside ? *aside : std::vector<Outline>{}) {
      Track track(outline, weld_);
      if (!track.closed() || track.empty()) continue;
      if (!keeps_clear(track)) {
        keeps(chain,
              fmt::format("another closed path is less than {:g} mm away", 2.0 * options_.finish.mm()));
        return {};
      }
      found.loops.push_back(outline);
      const double s = track.nearest(chain.start.xy());
      ways.push_back(way_of(std::move(track), s, in, out, chain));
    }
    if (ways.empty())
      keeps(chain, fmt::format("there is no path at a distance of {:g} mm from it", options_.finish.mm()));
    paths = std::move(found);
    return ways;
  }
  /// Whether a roughing pass keeps away from all closed paths, other ones too.
  bool keeps_clear(const Track& track) const {
    const double finish = options_.finish.mm();
    const double step = std::max(0.5 * finish, track.length() / kMaxSamples);
    for (double s = 0.0; s < track.length(); s += step)
      if (!walls_.permits_circle(track.at(s), 0.75 * finish)) return false;
    return true;
  }
  /// Whether the roughing passes have left no more than the allowance anywhere.
  bool is_roughed(const Track& track, const Region& rough) const {
    if (rough.empty()) return false;
    const Walls passes(rough, 0.0, 0.0);
    const double enough = kRoughed * options_.finish.mm();
    const double step = std::max(enough, track.length() / kMaxSamples);
    for (double s = 0.0; s < track.length(); s += step)
      if (passes.permits_circle(track.at(s), enough)) return false;
    return true;
  }

  /// To above a way down, which is not that of the pass before.
  void go_to(const LoopChain& chain, Point2 entry, double travel) {
    if (here_.xy() == entry && here_.z >= chain.start.z) return;
    rapid({here_.x, here_.y, std::max(here_.z, travel)}, chain.first);
    rapid({entry.x, entry.y, here_.z}, chain.first);
    rapid({entry.x, entry.y, chain.start.z}, chain.first);
  }

  void rough_pass(const LoopChain& chain, const Way& way, double travel) {
    go_to(chain, entry_of(way), travel);
    cut({here_.x, here_.y, chain.bottom}, chain.plunge, out_.copy_origin(path_, chain.first));
    const OriginId origin = out_.copy_origin(path_, chain.level);
    lead_in(way, chain.feed, origin);
    here_ = add_along(out_, way.track, way.s, way.s + way.track.length(), here_, chain.bottom, chain.feed,
                      origin, weld_, options_.max_steps);
    lead_out(way, chain.feed, origin);
    rapid({here_.x, here_.y, std::max(here_.z, travel)}, chain.first);
  }

  /// The path itself, step by step.
  void last_pass(const LoopChain& chain, const Way& way) {
    for (std::size_t i = chain.first; i < chain.level; ++i) {
      if (path_[i].is_motion())
        cut({here_.x, here_.y, path_[i].to().z}, path_[i].feed(), out_.copy_origin(path_, i));
      else
        copy(i);
    }
    lead_in(way, chain.feed, out_.copy_origin(path_, chain.level));
    for (std::size_t i = chain.level; i < chain.end; ++i) copy(i);
    lead_out(way, path_[chain.end - 1].feed(), out_.copy_origin(path_, chain.end - 1));
  }

  /// Rapids that led straight up from the end of the path do so from where the tool is now.
  bool leave(const LoopChain& chain) {
    if (out_.size() > options_.max_steps) {
      diagnostics_.error(codes::pass_option, {}, fmt::format("more than {} steps", options_.max_steps));
      return false;
    }
    const Point2 end = path_[chain.end - 1].to().xy();
    for (; next_ < path_.size(); ++next_) {
      if (!path_[next_].is_motion()) {
        copy(next_);
        continue;
      }
      if (!is_rapid_at(next_, end) || path_[next_].to().z < here_.z) break;
      rapid({here_.x, here_.y, path_[next_].to().z}, next_);
    }
    return true;
  }

  const Toolpath& path_;
  const LeadOptions& options_;
  Diagnostics& diagnostics_;
  std::vector<LoopChain> chains_;
  Walls walls_;
  double weld_, free_;
  Toolpath out_;
  std::vector<std::size_t> whole_;
  std::size_t next_ = 0;
  Point3 here_ = kUnknown;
};

}  // namespace

std::optional<Led> add_leads(const Toolpath& path, const LeadOptions& options, Diagnostics& diagnostics) {
  for (const auto& [length, what] : {std::pair(options.lead_in.size, "size of the lead-in"),
                                     {options.lead_out.size, "size of the lead-out"},
                                     {options.overlap, "overlap"},
                                     {options.finish, "finishing allowance"}}) {
    if (length >= Length{} && length.mm() <= limits::kMaxToolSize) continue;
    diagnostics.error(codes::pass_option, {},
                      fmt::format("the {} is {:g}; it must be 0 mm or more", what, length.mm()));
    return std::nullopt;
  }
  if (!std::isfinite(options.top)) {
    diagnostics.error(codes::pass_option, {}, "the Z of the surface must be a number");
    return std::nullopt;
  }
  return LeadPass(path, options, diagnostics).run();
}

}  // namespace kerf
