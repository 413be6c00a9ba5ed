// Turns of helices that later turns cover: found by their points in XY.
#include "sim/sweep/covered.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <unordered_map>

#include "sim/sweep/plan.h"

namespace kerf::sim {
namespace {

/// An arc seen from above.
struct Plan {
  double u = 0.0, v = 0.0, start_radius = 0.0, end_radius = 0.0, start_angle = 0.0, sweep = 0.0;
  bool operator==(const Plan&) const = default;
};

struct PlanHash {
  std::size_t operator()(const Plan& plan) const {
    std::uint64_t hash = 0;
    for (const double value : {plan.u, plan.v, plan.start_radius, plan.start_angle, plan.sweep}) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
    }
    return static_cast<std::size_t>(hash >> 16);
  }
};

/// The last arc of its plan.
struct Last {
  std::size_t step = 0;
  double start_z = 0.0, end_z = 0.0;
};

class CoveredArcs {
 public:
  CoveredArcs(const Survey& survey, double height) : survey_(survey) {
    for (std::size_t k = 0; k < survey.solids.size(); ++k) {
      const ToolSolids& tool = survey.solids[k];
      const double flutes = std::min(tool.cutting.top, bottom_of_others(tool));
      usable_.push_back(tool.cutting.one_envelope && survey.deepest[k] < std::min(flutes, height));
    }
  }
  bool any_usable() const { return std::find(usable_.begin(), usable_.end(), true) != usable_.end(); }

  void add(const Step& step, const MotionContext& context) {
    const std::optional<int> number = survey_.tool_of(context);
    if (!step.is_cutting() || step.kind() == StepKind::extrude || !is_usable(number, context)) {
      last_.clear();
      return;
    }
    if (step.kind() != StepKind::arc) return;
    const ArcWalk walk = walk_of(step, context.from);
    if (walk.plane != Plane::xy) return;
    const Plan plan{walk.u, walk.v, walk.start_radius, walk.end_radius, walk.start_angle, walk.sweep};
    const auto [last, is_new] = last_.try_emplace(plan);
    if (!is_new && last->second.start_z >= walk.start_w && last->second.end_z >= walk.end_w)
      covered_.push_back(last->second.step);
    last->second = {context.index, walk.start_w, walk.end_w};
  }

  std::vector<std::size_t> take() {
    std::sort(covered_.begin(), covered_.end());
    return std::move(covered_);
  }

 private:
  /// A motion with a tool that reaches no deeper than its flutes, at known positions, with the spindle on.
  bool is_usable(std::optional<int> number, const MotionContext& context) {
    if (!number || context.unknown_from != 0 || survey_.spindle_off(context)) return false;
    const auto tool = survey_.index.find(*number);
    if (tool == survey_.index.end() || !usable_[tool->second]) return false;
    if (tool_ != tool->second) last_.clear();
    tool_ = tool->second;
    return true;
  }

  const Survey& survey_;
  std::vector<bool> usable_;  // tools
  std::optional<std::uint32_t> tool_;
  std::unordered_map<Plan, Last, PlanHash> last_;  // since the last motion that is no such cut
  std::vector<std::size_t> covered_;
};

}  // namespace

std::vector<std::size_t> covered_arcs(const Toolpath& path, const Survey& survey, double height) {
  CoveredArcs found(survey, height);
  if (!path.has(StepKind::arc) || !found.any_usable()) return {};
  for (MotionReader motion(path); motion.next();) found.add(motion.step(), motion.context());
  return found.take();
}

}  // namespace kerf::sim
