// The checks of a toolpath by itself: one small function a rule, walked over all motions once.
#include "kerf/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "kerf/number.h"

namespace kerf {
namespace {

constexpr int kShownDecimals = 4;

/// What the whole toolpath tells before its motions are looked at.
struct Setting {
  const CheckOptions& options;
  bool laser = false;     // the beam is the tool: no spindle is asked for
  bool printing = false;  // beads are laid: neither spindle nor tool is asked for
};

Setting setting_of(const Toolpath& path, const CheckOptions& options) {
  Setting setting{options};
  for (const Step& s : path.steps()) {
    setting.laser = setting.laser || s.kind() == StepKind::laser_power;
    setting.printing = setting.printing || s.kind() == StepKind::extrude;
  }
  return setting;
}

bool needs_feed(const Step& s) {
  return s.is_cutting() || s.kind() == StepKind::probe || s.kind() == StepKind::extrude;
}

// ---- the rules: the message of what is wrong with a motion, or nothing

using Message = std::optional<std::string>;

Message no_feed(const Step& s, const MotionContext&, const Setting&) {
  if (!needs_feed(s) || s.feed().mm_per_min() != 0.0) return std::nullopt;
  return "a feed move without a feed: no F word came before it, or the last one was F0";
}

Message negative_feed(const Step& s, const MotionContext&, const Setting&) {
  if (!needs_feed(s) || s.feed().mm_per_min() >= 0.0) return std::nullopt;
  return fmt::format("a feed of {} mm/min; a feed must be above 0",
                     number_text(s.feed().mm_per_min(), kShownDecimals));
}

Message no_tool(const Step& s, const MotionContext& context, const Setting& setting) {
  if (!s.is_cutting() || context.tool || setting.laser || setting.printing) return std::nullopt;
  return "a cutting move before any tool change: nobody knows what cuts here";
}

Message spindle_off(const Step& s, const MotionContext& context, const Setting& setting) {
  if (!s.is_cutting() || setting.laser || setting.printing) return std::nullopt;
  if (context.spindle.turn != SpindleTurn::off) return std::nullopt;  // 0 rpm: its speed is set by hand
  if (!context.spindle_stated) return "a cutting move, and the program has not started the spindle";
  return "a cutting move while the spindle is switched off";
}

Message arc_radii(const Step& s, const MotionContext& context, const Setting& setting) {
  if (s.kind() != StepKind::arc) return std::nullopt;
  const ArcWalk walk = walk_of(s, context.from);
  const double apart = std::abs(walk.end_radius - walk.start_radius);
  const double share = setting.options.arc_radii_share * std::max(walk.start_radius, walk.end_radius);
  const double allowed =
      std::min(std::max(setting.options.arc_radii_apart.mm(), share), setting.options.arc_radii_limit.mm());
  if (apart <= allowed) return std::nullopt;
  return fmt::format("an arc that begins {} mm from its centre and ends {} mm from it: controllers refuse it",
                     number_text(walk.start_radius, kShownDecimals),
                     number_text(walk.end_radius, kShownDecimals));
}

struct Rule {
  Code code;
  Message (*test)(const Step&, const MotionContext&, const Setting&);
};
/// Further rules (limits of the machine, chip load) are further lines.
constexpr Rule kRules[] = {
    {Code::path_no_feed, no_feed},     {Code::path_negative_feed, negative_feed},
    {Code::path_no_tool, no_tool},     {Code::path_spindle_off, spindle_off},
    {Code::path_arc_radii, arc_radii},
};

/// Tells whether a motion takes part in runs of a rule: rapids between cuts do not end a run of cuts.
bool ends_runs(const Step& s) { return needs_feed(s); }

}  // namespace

std::string_view kind_of(const PathHazard& hazard) {
  constexpr std::string_view kPrefix = "path_";  // sets these codes apart from what readers say of their text
  return name_of(hazard.code).substr(kPrefix.size());
}

std::vector<PathHazard> check_path(const Toolpath& path, const CheckOptions& options) {
  const Setting setting = setting_of(path, options);
  std::vector<PathHazard> found;
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::array<std::size_t, std::size(kRules)> open;  // each rule's entry that the next motion may join
  open.fill(kNone);
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    for (std::size_t r = 0; r < open.size(); ++r) {
      Message message = kRules[r].test(s, context, setting);
      if (!message) {
        if (ends_runs(s)) open[r] = kNone;
      } else if (open[r] != kNone && found[open[r]].message == *message) {
        ++found[open[r]].steps;
      } else {
        open[r] = found.size();
        found.push_back(
            {kRules[r].code, static_cast<std::uint32_t>(context.index), 1, s.to(), std::move(*message)});
      }
    }
  });
  if (options.end == ProgramEnd::missing && path.size() > 0) {
    const auto last = static_cast<std::uint32_t>(path.size() - 1);
    Point3 at;
    for_each_motion(path, [&](const Step& s, const MotionContext&) { at = s.to(); });
    found.push_back({Code::path_no_program_end, last, 1, at,
                     "the program stops here without M2, M30 or a closing %: the file may be cut off"});
  }
  return found;
}

}  // namespace kerf
