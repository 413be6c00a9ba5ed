// Checks the input of a simulation before anything is cut: stock, tools, and steps that are not simulated.
#include "sim/sweep/survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/sim.h"
#include "base/names.h"
#include "base/number.h"
#include "base/parallel.h"
#include "sim/sweep/pitch.h"
#include "sim/sweep/plan.h"

#include "kerf/base/limits.h"

namespace kerf::sim {
namespace {

/// Sideways contacts below this are rounding, even with a hazard depth of 0, mm.
constexpr double kMinClearance = 1e-4;

bool stock_is_valid(const Stock& stock, Diagnostics& diagnostics) {
  const Box3& block = stock.block;
  const Point3 size = block.size();
  if (!finite(block.low) || !finite(block.high) || !(size.x > 0.0) || !(size.y > 0.0) || !(size.z > 0.0)) {
    diagnostics.error(codes::stock_empty, {},
                      "the stock is empty: its length, width and height must be above 0");
    return false;
  }
  const double largest = std::max({size.x, size.y, size.z});
  const double reach = std::max(std::max(length(block.low), length(block.high)) / limits::kMaxCoordinate,
                                largest / limits::kMaxStockSize);
  if (reach <= 1.0) return true;
  diagnostics.error(codes::stock_empty, {},
                    fmt::format("the stock measures {} x {} x {} mm; at most {} mm can be simulated",
                                number_text(size.x, 3), number_text(size.y, 3), number_text(size.z, 3),
                                number_text(limits::kMaxStockSize, 0)));
  return false;
}

class Surveyor {
 public:
  Surveyor(const Toolpath& path, const ToolTable& tools, const Stock& stock, double clearance,
           Diagnostics& diagnostics)
      : path_(path),
        tools_(tools),
        centre_(0.5 * (stock.block.low + stock.block.high)),
        top_(stock.block.high.z),
        clearance_(clearance),
        diagnostics_(diagnostics) {}

  /// The motions from step `first` to the one before `last`.
  Survey run(std::size_t first, std::size_t last) {
    if (tools_.tools().size() == 1) survey_.only_tool = tools_.tools().begin()->first;
    survey_.judges_spindle = path_.has(StepKind::spindle) && !path_.has(StepKind::laser_power);
    for (MotionReader motion(path_, first); motion.next() && motion.context().index < last;)
      check_motion(motion.step(), motion.context());
    return std::move(survey_);
  }

 private:
  void check_motion(const Step& step, const MotionContext& context) {
    check_position(step, context);
    check_extras(step, context);
    const std::optional<int> number = survey_.tool_of(context);
    const bool is_known = number && (number == known_tool_ || find_tool(*number));
    if (!step.is_cutting()) return;
    if (!number) return no_tool(context);
    if (!is_known) no_such_tool(*number, context);
    if (is_known) note_depth(*number, std::min(context.from.z, step.to().z));
    if (step.kind() == StepKind::arc && is_walked(context) &&
        chord_count(walk_of(step, context.from)).too_coarse)
      diagnostics_.warning(codes::coarse_arc, path_.origin_of(context.index),
                           "the arc is so long that its chords are coarser than the tolerance");
    constexpr unsigned kXY = 3;
    const unsigned unknown_start = step.kind() == StepKind::arc ? context.unknown_from & kXY : 0u;
    if ((step.unknown_axes() | unknown_start) != 0)
      warn_unknown_position(step.unknown_axes() | unknown_start, context);
  }

  /// Makes the solids of a tool at its first use. False if it has no shape.
  bool find_tool(int number) {
    if (survey_.index.count(number) == 0) {
      const Tool* tool = tools_.find(number);
      if (tool == nullptr) return false;
      survey_.index[number] = static_cast<std::uint32_t>(survey_.solids.size());
      survey_.solids.push_back(make_tool_solids(tool->silhouette, mm(clearance_)));
      survey_.deepest.push_back(0.0);
    }
    known_tool_ = number;
    return true;
  }

  void note_depth(int number, double z) {
    double& deepest = survey_.deepest[survey_.index[number]];
    deepest = std::max(deepest, top_ - z);
  }

  void check_position(const Step& step, const MotionContext& context) {
    Point3 arc_centre = centre_;
    if (step.kind() == StepKind::arc) {
      const Point2 c = step.arc().centre;
      arc_centre = centre_ + Point3{c.x, c.y, 0.0};
    }
    if (is_near(step.to()) && is_near(arc_centre)) return;
    diagnostics_.error(codes::motion_out_of_range, path_.origin_of(context.index),
                       fmt::format("the motion goes farther than {} km from the stock",
                                   number_text(limits::kMaxCoordinate * 1e-6, 0)));
  }

  bool is_near(Point3 position) const {
    const Point3 offset = position - centre_;
    return dot(offset, offset) < limits::kMaxCoordinate * limits::kMaxCoordinate;
  }

  void check_extras(const Step& step, const MotionContext& context) {
    if (step.kind() == StepKind::extrude)
      once(codes::extrusion_not_simulated, context,
           "extruding motions are not simulated in a program that cuts");
    const MotionExtra* extra = path_.extra(context.index);
    if (extra == nullptr) return;
    // A, B and C that stay at 0, as a post's "A0." at the start, turn nothing.
    const bool turns = extra->abc && (extra->reference_abc != 0 || *extra->abc != std::array<double, 3>{});
    if (turns)
      once(codes::rotary_not_simulated, context,
           "rotary axes are not simulated here; the tool axis is assumed to be Z throughout, see --rotary");
    if (!extra->z_correction.empty())
      once(codes::z_correction_not_simulated, context, "Z corrections by probed points are not simulated");
  }

  void no_such_tool(int number, const MotionContext& context) {
    if (std::find(missing_.begin(), missing_.end(), number) != missing_.end()) return;
    missing_.push_back(number);
    Diagnostic& error = diagnostics_.error(codes::no_such_tool, path_.origin_of(context.index),
                                           fmt::format("tool {} cuts here, but has no shape", number));
    error.hint = fmt::format("specify tool {}, e.g. \"square d=3.175 flute=12.7\"", number);
  }

  void no_tool(const MotionContext& context) {
    if (std::exchange(reported_no_tool_, true)) return;
    Diagnostic& error = diagnostics_.error(codes::no_tool_chosen, path_.origin_of(context.index),
                                           "cut before the first tool change");
    error.hint = "specify exactly one tool; it is then used until the first tool change";
  }

  void warn_unknown_position(unsigned axes, const MotionContext& context) {
    constexpr unsigned kAxisZ = 4;
    std::vector<std::string> unknown, assumed;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((axes >> axis & 1u) == 0) continue;
      unknown.emplace_back(1, "XYZ"[axis]);
      if (axis < 2) assumed.push_back(fmt::format("{}0", "XYZ"[axis]));
    }
    std::string message = fmt::format("cut at an unknown position: {} {} not known; ",
                                      list_text(unknown, "and"), unknown.size() == 1 ? "is" : "are");
    if (!assumed.empty()) message += fmt::format("assuming {}", list_text(assumed, "and"));
    if ((axes & kAxisZ) != 0)
      message += assumed.empty() ? "nothing is cut without Z" : "; nothing is cut without Z";
    once(codes::cut_at_unknown_place, context, std::move(message));
  }

  void once(Code code, const MotionContext& context, std::string message) {
    if (std::find(reported_.begin(), reported_.end(), code) != reported_.end()) return;
    reported_.push_back(code);
    diagnostics_.warning(code, path_.origin_of(context.index), std::move(message));
  }

  const Toolpath& path_;
  const ToolTable& tools_;
  Point3 centre_;
  double top_;
  double clearance_;
  Diagnostics& diagnostics_;
  Survey survey_;
  std::optional<int> known_tool_;  // of the previous motion
  std::vector<int> missing_;
  std::vector<Code> reported_;
  bool reported_no_tool_ = false;
};

/// Adds the tools of a later section of the path.
void add_tools(Survey& survey, Survey&& section) {
  std::vector<const std::pair<const int, std::uint32_t>*> in_order(section.solids.size());
  for (const auto& tool : section.index) in_order[tool.second] = &tool;
  for (const auto* tool : in_order) {
    const auto [known, is_new] =
        survey.index.try_emplace(tool->first, static_cast<std::uint32_t>(survey.solids.size()));
    if (is_new) {
      survey.solids.push_back(std::move(section.solids[tool->second]));
      survey.deepest.push_back(0.0);
    }
    double& deepest = survey.deepest[known->second];
    deepest = std::max(deepest, section.deepest[tool->second]);
  }
}

/// Surveys sections of the path in parallel. If any has a diagnostic, the whole path is surveyed again in
/// order, so that diagnostics appear once and in order.
Survey survey_of(const Toolpath& path, const ToolTable& tools, const Stock& stock, double clearance,
                 unsigned threads, Diagnostics& diagnostics) {
  constexpr std::size_t kSection = 1 << 16;  // steps
  const std::size_t count = path.size() / kSection + 1;
  std::vector<Diagnostics> diagnostics_of(count);
  std::vector<Survey> found(count);
  const auto survey_section = [&](std::size_t n) {
    found[n] =
        Surveyor(path, tools, stock, clearance, diagnostics_of[n]).run(n * kSection, (n + 1) * kSection);
  };
  parallel_for(threads, count, survey_section, [] { return false; });
  const bool is_quiet = std::all_of(diagnostics_of.begin(), diagnostics_of.end(),
                                    [](const auto& d) { return d.list().empty(); });
  if (!is_quiet) return Surveyor(path, tools, stock, clearance, diagnostics).run(0, path.size());
  for (std::size_t n = 1; n < count; ++n) add_tools(found[0], std::move(found[n]));
  return std::move(found[0]);
}

}  // namespace

std::optional<Setup> set_up(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                            const SimulationOptions& options, Diagnostics& diagnostics) {
  if (!stock_is_valid(stock, diagnostics)) return std::nullopt;
  const std::size_t errors_before = diagnostics.errors();
  const double clearance = std::max(options.hazard_depth.mm(), kMinClearance);
  Setup setup{{}, survey_of(path, tools, stock, clearance, thread_count(options.threads), diagnostics)};
  const std::optional<double> pitch = choose_pitch(path, setup.survey, options, stock, diagnostics);
  if (!pitch || diagnostics.errors() != errors_before) return std::nullopt;
  setup.pitch = mm(*pitch);
  setup.survey.surroundings = {options.rapid_rates, options.spoilboard};
  // Parts above short flutes that enter a no-go solid are contacts of neck, shank or holder only.
  if (options.role == SolidRole::no_go)
    for (ToolSolids& solids : setup.survey.solids) solids.over_flute = {};
  return setup;
}

}  // namespace kerf::sim
