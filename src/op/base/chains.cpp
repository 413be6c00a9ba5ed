// Chains of cuts of a finished toolpath.
#include "op/base/chains.h"

#include <algorithm>
#include <optional>

#include "path/state.h"

namespace kerf::op_detail {
namespace {

const double kWeld = Tolerance{}.weld.mm();
constexpr double kWallTolerance = 1e-4;  // mm: a circle may touch the path that it leads to
constexpr double kShortest = 1e-3;       // mm, of a closed path
constexpr std::size_t kMaxLeadIn = 2;    // segments; an arc has two

bool is_level(const Toolpath& path, std::size_t i, double z) {
  if (!is_plain_cut(path, i) || path[i].to().z != z) return false;
  return path[i].kind() == StepKind::cut ||
         (path[i].kind() == StepKind::arc && path[i].arc().plane == Plane::xy &&
          path[i].arc().extra_turns == 0);
}

/// The chain of the steps `first` to `end` that starts at `start`, if it is a loop.
std::optional<LoopChain> loop_of(const Toolpath& path, std::size_t first, std::size_t end, Point3 start) {
  LoopChain chain{first, first, end, start, start.z, {}, {}, {}, true};
  Outline seen{start.xy(), {}};
  std::size_t closed = 0;  // segments
  Point3 here = start;
  for (std::size_t i = first; i < end; ++i) {
    const Step& s = path[i];
    // Passes around the path would need the state of each part of it.
    if (!seen.segments.empty() && (part_set_by(s) & ~bit_of(StatePart::layer)) != 0) return std::nullopt;
    if (!s.is_motion()) continue;
    const bool down = seen.segments.empty() && is_plain_cut(path, i) && s.kind() == StepKind::cut &&
                      s.to().xy() == here.xy() && s.to().z <= here.z;
    if (down) {
      chain.bottom = s.to().z, chain.plunge = s.feed(), chain.level = i + 1;
    } else {
      if (!is_level(path, i, chain.bottom)) return std::nullopt;
      if (seen.segments.empty()) chain.level = i, chain.feed = s.feed();
      add_segment(seen, s, here);
      if (const auto from = closed == 0 ? loop_start(seen) : std::nullopt) {
        closed = seen.segments.size(), chain.plain = *from == 0;
        chain.outline = loop_from(seen, *from);
      }
    }
    here = s.to();
  }
  if (closed == 0) return std::nullopt;
  chain.plain = chain.plain && closed == seen.segments.size();
  return chain;
}

}  // namespace

bool is_transparent(StepKind kind) {
  switch (kind) {
    case StepKind::note:
    case StepKind::layer:
    case StepKind::verbatim:
    case StepKind::close_path:
    case StepKind::path_mode:
    case StepKind::dwell:
    case StepKind::spindle:
    case StepKind::coolant: return true;
    case StepKind::rapid:
    case StepKind::cut:
    case StepKind::arc:
    case StepKind::tool_change:
    case StepKind::probe:
    case StepKind::extrude:
    case StepKind::temperature:
    case StepKind::fan:
    case StepKind::laser_power:
    case StepKind::pause:
    case StepKind::end:
    case StepKind::store_home:
    case StepKind::work_zero:
    case StepKind::tool_length:
    case StepKind::unresolved:
    case StepKind::motion_limits:
    case StepKind::extruder: return false;
  }
  return false;
}

bool is_plain_cut(const Toolpath& path, std::size_t i) {
  return path[i].is_cutting() && path[i].unknown_axes() == 0 && path.extra(i) == nullptr;
}

std::size_t end_of_chain(const Toolpath& path, std::size_t first) {
  std::size_t end = first + 1;
  for (std::size_t i = end; i < path.size(); ++i) {
    if (path[i].is_cutting())
      end = i + 1;
    else if (!is_transparent(path[i].kind()))
      break;
  }
  return end;
}

void add_segment(Outline& outline, const Step& s, Point3 from) {
  if (s.kind() != StepKind::arc) {
    outline.segments.push_back({s.to().xy(), {}});
    return;
  }
  const ArcWalk walk = walk_of(s, from);
  outline.segments.push_back({walk.at(0.5).xy(), walk.at(0.25).xy()});
  outline.segments.push_back({s.to().xy(), walk.at(0.75).xy()});
}

Outline loop_from(const Outline& outline, std::size_t vertex) {
  Outline loop{outline.point(vertex), {}};
  loop.segments.assign(outline.segments.begin() + static_cast<std::ptrdiff_t>(vertex),
                       outline.segments.end());
  loop.segments.back().to = loop.start;
  return loop;
}

std::optional<std::size_t> loop_start(const Outline& outline) {
  const std::size_t last = outline.segments.size();
  for (std::size_t k = 0; k < std::min(last, kMaxLeadIn + 1); ++k)
    if (distance(outline.point(k), outline.point(last)) <= 2.0 * kWeld &&
        Track(loop_from(outline, k), kWeld).length() > kShortest)
      return k;
  return std::nullopt;
}

std::vector<LoopChain> loop_chains(const Toolpath& path) {
  std::vector<LoopChain> chains;
  std::optional<Point3> here;
  for (std::size_t i = 0; i < path.size();) {
    const Step& s = path[i];
    std::size_t end = i + 1;
    if (s.is_cutting()) {
      end = end_of_chain(path, i);
      if (here)
        if (auto chain = loop_of(path, i, end, *here)) chains.push_back(std::move(*chain));
    }
    for (; i < end; ++i)
      if (path[i].is_motion())
        here = path[i].unknown_axes() == 0 ? std::optional(path[i].to()) : std::nullopt;
  }
  return chains;
}

Walls walls_of(const std::vector<LoopChain>& chains) {
  Region region;
  for (const LoopChain& chain : chains) region.loops.push_back(chain.outline);
  return Walls(region, 0.0, kWallTolerance);
}

}  // namespace kerf::op_detail
