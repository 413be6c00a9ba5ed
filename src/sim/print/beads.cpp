// Reads the beads of a toolpath.
#include "sim/print/beads.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/codes/sim.h"
#include "base/number.h"

#include "kerf/base/limits.h"

namespace kerf::printing {
namespace {

constexpr double kNoLength = 1e-6;         // mm in plan; a shorter motion lays no bead
constexpr double kNoVolume = 0.01;         // mm3; less is rounding of E words
constexpr double kUsualLayer = 0.2;        // mm, if the height is unknown
constexpr Length kTravelChord = mm(0.05);  // chord tolerance of travel arcs
/// Maximum relative difference of a width in comments from that given by E. Rounded E words and slicers with
/// rectangular sections stay below it; another filament diameter (2.85 for 1.75) is far above.
constexpr double kWidthSlack = 0.3;

bool same_position(Point3 a, Point3 b) {
  return distance(a.xy(), b.xy()) <= kNoLength && std::abs(a.z - b.z) <= kSameLevel;
}

/// The layers below: increasing nozzle heights.
class Levels {
 public:
  explicit Levels(double bed) : bed_(bed) {}

  /// The nozzle has reached `z` by a motion that does not print.
  void enter(double z) {
    while (!stack_.empty() && stack_.back() > z + kSameLevel) stack_.pop_back();
    if (stack_.empty() || stack_.back() < z - kSameLevel) stack_.push_back(z);
  }
  /// The nozzle has reached `z` while printing beads of this height.
  void climb(double z, double height) {
    const double steps = std::floor((z - stack_.back() + kSameLevel) / height);
    if (steps >= 1.0) stack_.push_back(stack_.back() + steps * height);
  }
  double level() const { return stack_.back(); }
  double step() const { return level() - (stack_.size() > 1 ? stack_[stack_.size() - 2] : bed_); }

 private:
  double bed_;
  std::vector<double> stack_;
};

class ExtrusionReader {
 public:
  ExtrusionReader(const Toolpath& path, const PrintOptions& options, BeadSink& sink, Diagnostics* diagnostics)
      : path_(path), options_(options), sink_(sink), diagnostics_(diagnostics), levels_(options.bed.mm()) {}

  void run() {
    for_each_motion(path_, [&](const Step& step, const MotionContext& context) {
      if (ended_) return;
      ended_ = !sink_.wants_more();
      if (!ended_) motion(step, context);
    });
    finish_chain();
    warn_of_widths();
  }

 private:
  void motion(const Step& step, const MotionContext& context) {
    const bool known = context.unknown_from == 0 && step.unknown_axes() == 0;
    if (step.kind() == StepKind::extrude) return extrude(step, context, known);
    if (step.to() == context.from && step.kind() != StepKind::arc) return;  // only the feed changes
    finish_chain();
    if (known) travel(step, context);
  }

  void travel(const Step& step, const MotionContext& context) {
    const auto number = static_cast<std::uint32_t>(context.index);
    if (step.kind() != StepKind::arc) return sink_.travel(number, context.from, step.to());
    const ArcWalk walk = walk_of(step, context.from);
    const int chords = walk.chords(kTravelChord, limits::kMaxChords);
    Point3 from = context.from;
    for (int i = 1; i <= chords; ++i) {
      const Point3 to = i == chords ? step.to() : walk.at(i / static_cast<double>(chords));
      sink_.travel(number, from, to);
      from = to;
    }
  }

  void extrude(const Step& step, const MotionContext& context, bool known) {
    const double extruded = path_.extrude(context.index).volume.mm3();
    const double volume = std::isfinite(extruded) ? extruded : 0.0;
    const bool stationary = distance(context.from.xy(), step.to().xy()) <= kNoLength;
    if (stationary || !(volume > 0.0)) {
      finish_chain();
      push(context, volume, stationary);
      if (known && !stationary) travel(step, context);
      return;
    }
    const double missing = return_filament(context, volume);
    if (!known) {
      finish_chain();
      sink_.unplaced(volume - missing);
      return report_unknown_position(context.index);
    }
    if (missing <= kNoVolume) return lay(step, context.index, context.from, volume);
    // Nothing comes out until what was drawn back has returned.
    finish_chain();
    const Point3 start = context.from + missing / volume * (step.to() - context.from);
    sink_.travel(static_cast<std::uint32_t>(context.index), context.from, start);
    if (volume - missing > kNoVolume) lay(step, context.index, start, volume - missing);
  }

  /// What of the volume returns filament that was drawn back.
  double return_filament(const MotionContext& context, double volume) {
    double& retracted = retracted_[extruder_at(context.index)];
    const double returned = std::min(retracted, volume);
    retracted -= returned;
    return returned;
  }

  /// The extruder in use at a step; steps are passed in their order.
  int extruder_at(std::size_t step) {
    if (!path_.has(StepKind::extruder)) return extruder_;
    for (; passed_ < step; ++passed_)
      if (path_[passed_].kind() == StepKind::extruder) extruder_ = path_[passed_].extruder().number;
    return extruder_;
  }

  /// Filament extruded or retracted without motion, or retracted while moving.
  void push(const MotionContext& context, double volume, bool stationary) {
    if (!(volume > 0.0)) {
      retracted_[extruder_at(context.index)] -= volume;
      return;
    }
    const double repaid = return_filament(context, volume);
    if (stationary && volume > repaid)
      sink_.blob(static_cast<std::uint32_t>(context.index), context.from, volume - repaid);
  }

  void lay(const Step& step, std::size_t index, Point3 from, double volume) {
    Bead bead;
    bead.step = static_cast<std::uint32_t>(index);
    bead.from = from;
    bead.to = step.to();
    const Point2 offset = bead.to.xy() - bead.from.xy();
    bead.length = length(offset);
    bead.along = 1.0 / bead.length * offset;
    bead.volume = volume;
    bead.continues = last_.has_value();
    find_section(bead);
    if (!(bead.section.width <= limits::kMaxBeadWidth)) {
      finish_chain();
      sink_.blob(bead.step, bead.from, volume);
      return sink_.travel(bead.step, bead.from, bead.to);
    }
    if (last_) sink_.corner(*last_, bead);
    if (!last_) first_ = bead;
    last_ = bead;
    laid_ = true;
    sink_.bead(bead);
  }

  void find_section(Bead& bead) {
    const step::Extrude extrusion = path_.extrude(bead.step);
    const double area = bead.volume / bead.length;
    if (bead.continues)
      levels_.climb(bead.from.z, chain_height_);
    else
      levels_.enter(bead.from.z);
    bead.level = levels_.level();
    chain_height_ = find_height(bead, extrusion, area);
    bead.section = section_of(area, chain_height_);
    if (!(extrusion.width.mm() > 0.0) || !(extrusion.height.mm() > 0.0)) return;
    const double commented = extrusion.width.mm();
    commented_length_ += bead.length;
    if (std::abs(bead.section.width - commented) <= kWidthSlack * commented) return;
    if (differing_length_ == 0.0) differing_ = {bead.step, bead.section.width, commented};
    differing_length_ += bead.length;
  }

  double find_height(const Bead& bead, const step::Extrude& extrusion, double area) {
    if (extrusion.height.mm() >= kSameLevel) return extrusion.height.mm();
    if (options_.layer_height) return options_.layer_height->mm();
    const double left = extrusion.width.mm() > 0.0 ? height_of(area, extrusion.width.mm()) : 0.0;
    if (left >= kSameLevel) return left;
    if (bead.continues) return chain_height_;
    if (levels_.step() > kSameLevel) return levels_.step();
    if (chain_height_ > 0.0) return chain_height_;
    warn_once(warned_height_, codes::print_height_unknown, bead.step,
              fmt::format("the layer height at Z{} is unknown; assuming {} mm", number_text(bead.from.z, 3),
                          number_text(kUsualLayer, 3)));
    return kUsualLayer;
  }

  void finish_chain() {
    if (!last_) return;
    if (same_position(first_.from, last_->to)) {
      sink_.corner(*last_, first_);
    } else {
      sink_.free_start(first_);
      sink_.free_end(*last_);
    }
    last_.reset();
  }

  /// Before the first bead it is a purge line, which starts where the homing has left the nozzle.
  void report_unknown_position(std::size_t step) {
    constexpr const char* kText = "extrusion at an unknown position: X, Y or Z is not known; ignored";
    if (laid_) return warn_once(warned_position_, codes::print_at_unknown_place, step, kText);
    if (diagnostics_ != nullptr && !std::exchange(noted_position_, true))
      diagnostics_->note(codes::print_at_unknown_place, path_.origin_of(step), kText);
  }

  void warn_once(bool& warned, Code code, std::size_t step, std::string message) {
    if (warned || diagnostics_ == nullptr) return;
    warned = true;
    Diagnostic& warning = diagnostics_->warning(code, path_.origin_of(step), std::move(message));
    if (code == codes::print_height_unknown) warning.hint = "specify it, e.g. --layer-height 0.2";
  }

  void warn_of_widths() {
    if (diagnostics_ == nullptr || !(differing_length_ > commented_length_ / 2.0)) return;
    diagnostics_
        ->warning(
            codes::print_width_differs, path_.origin_of(differing_.step),
            fmt::format("the bead is {} mm wide by the extruded volume, but {} mm by the comments, as for "
                        "most beads",
                        number_text(differing_.width, 3), number_text(differing_.commented, 3)))
        .hint = "check the filament diameter and specify it, e.g. --filament 2.85";
  }

  struct Differing {
    std::uint32_t step = 0;
    double width = 0.0, commented = 0.0;  // mm
  };

  const Toolpath& path_;
  const PrintOptions& options_;
  BeadSink& sink_;
  Diagnostics* diagnostics_;
  Levels levels_;
  std::optional<Bead> last_;  // last bead of the open chain
  Bead first_;                // its first bead
  double chain_height_ = 0.0;
  std::map<int, double> retracted_;  // mm3, by extruder
  int extruder_ = 0;
  std::size_t passed_ = 0;  // steps
  double commented_length_ = 0.0, differing_length_ = 0.0;
  Differing differing_;
  bool laid_ = false, ended_ = false;
  bool noted_position_ = false, warned_position_ = false, warned_height_ = false;
};

}  // namespace

Section section_of(double area, double height) {
  const double round = std::numbers::pi / 4.0 * height * height;
  if (area >= round) return {height + (area - round) / height, height};
  const double diameter = std::sqrt(4.0 * area / std::numbers::pi);
  return {diameter, diameter};
}

double height_of(double area, double width) {
  // (1 - pi/4) h^2 - width h + area = 0, the smaller root; at the round section h is the width.
  constexpr double kCorners = 1.0 - std::numbers::pi / 4.0;
  if (area > std::numbers::pi / 4.0 * width * width) return 0.0;
  const double root = std::sqrt(width * width - 4.0 * kCorners * area);
  return 2.0 * area / (width + root);
}

void for_each_bead(const Toolpath& path, const PrintOptions& options, BeadSink& sink,
                   Diagnostics* diagnostics) {
  ExtrusionReader(path, options, sink, diagnostics).run();
}

}  // namespace kerf::printing
