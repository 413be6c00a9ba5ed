// Reads roads out of a toolpath.
#include "sim/print/roads.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <vector>

#include "kerf/limits.h"
#include "kerf/number.h"

namespace kerf::printing {
namespace {

constexpr double kStanding = 1e-6;         // mm in the plan; a move of less lays no road
constexpr double kUsualLayer = 0.2;        // mm, where nothing tells a height
constexpr Length kTravelChord = mm(0.05);  // how far a travel's chords may stray from its arc
constexpr int kMaxChords = 10'000;
/// A width that the comments tell may be so far (as a share) from what E gives. Rounded E words and slicers
/// that reckon with rectangles stay below; another filament diameter (2.85 for 1.75) is far above.
constexpr double kWidthSlack = 0.3;

bool same_place(Point3 a, Point3 b) {
  return distance(a.xy(), b.xy()) <= kStanding && std::abs(a.z - b.z) <= kSameLevel;
}

/// Which layers lie below: nozzle heights, each higher than the one before it.
class Levels {
 public:
  explicit Levels(double bed) : bed_(bed) {}

  /// The nozzle has come to `z` by a move that does not print.
  void enter(double z) {
    while (!stack_.empty() && stack_.back() > z + kSameLevel) stack_.pop_back();
    if (stack_.empty() || stack_.back() < z - kSameLevel) stack_.push_back(z);
  }
  /// The nozzle has come to `z` while printing roads of this height.
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
  ExtrusionReader(const Toolpath& path, const PrintOptions& options, RoadSink& sink, Diagnostics* diagnostics)
      : path_(path), options_(options), sink_(sink), diagnostics_(diagnostics), levels_(options.bed.mm()) {}

  void run() {
    for_each_motion(path_, [&](const Step& step, const MotionContext& context) {
      if (ended_) return;
      ended_ = !sink_.goes_on();
      if (!ended_) motion(step, context);
    });
    finish_chain();
    tell_widths();
  }

 private:
  void motion(const Step& step, const MotionContext& context) {
    const bool known = context.unknown_from == 0 && step.unknown_axes() == 0;
    if (step.kind() == StepKind::extrude) return extrude(step, context, known);
    if (step.to() == context.from && step.kind() != StepKind::arc) return;  // a line with a feed only
    finish_chain();
    if (known) travel(step, context);
  }

  void travel(const Step& step, const MotionContext& context) {
    const auto number = static_cast<std::uint32_t>(context.index);
    if (step.kind() != StepKind::arc) return sink_.travel(number, context.from, step.to());
    const ArcWalk walk = walk_of(step, context.from);
    const int chords = walk.chords(kTravelChord, kMaxChords);
    Point3 from = context.from;
    for (int i = 1; i <= chords; ++i) {
      const Point3 to = i == chords ? step.to() : walk.at(i / static_cast<double>(chords));
      sink_.travel(number, from, to);
      from = to;
    }
  }

  void extrude(const Step& step, const MotionContext& context, bool known) {
    const double told = path_.extrude(context.index).volume.mm3();
    const double volume = std::isfinite(told) ? told : 0.0;
    const bool stands = distance(context.from.xy(), step.to().xy()) <= kStanding;
    if (stands || !(volume > 0.0)) {
      finish_chain();
      push(context, volume, stands);
      if (known && !stands) travel(step, context);
      return;
    }
    if (!known) {
      finish_chain();
      return warn_once(said_place_, Code::print_at_unknown_place, context.index,
                       "the program extrudes here before it has said where X, Y and Z are; that is left out");
    }
    lay(step, context, volume);
  }

  /// Filament pushed or drawn back on the spot, or drawn back while the nozzle moves.
  void push(const MotionContext& context, double volume, bool stands) {
    if (!(volume > 0.0)) {
      drawn_back_ -= volume;
      return;
    }
    const double repaid = std::min(drawn_back_, volume);
    drawn_back_ -= repaid;
    if (stands && volume > repaid)
      sink_.blob(static_cast<std::uint32_t>(context.index), context.from, volume - repaid);
  }

  void lay(const Step& step, const MotionContext& context, double volume) {
    Road road;
    road.step = static_cast<std::uint32_t>(context.index);
    road.from = context.from;
    road.to = step.to();
    const Point2 way = road.to.xy() - road.from.xy();
    road.length = length(way);
    road.along = 1.0 / road.length * way;
    road.volume = volume;
    road.goes_on = last_.has_value();
    find_section(road);
    if (!(road.section.width <= limits::kMaxBeadWidth)) {
      finish_chain();
      sink_.blob(road.step, road.from, volume);
      return sink_.travel(road.step, road.from, road.to);
    }
    if (last_) sink_.corner(*last_, road);
    if (!last_) first_ = road;
    last_ = road;
    sink_.road(road);
  }

  void find_section(Road& road) {
    const step::Extrude bead = path_.extrude(road.step);
    const double area = road.volume / road.length;
    if (road.goes_on)
      levels_.climb(road.from.z, chain_height_);
    else
      levels_.enter(road.from.z);
    road.level = levels_.level();
    chain_height_ = find_height(road, bead, area);
    road.section = section_of(area, chain_height_);
    if (!(bead.width.mm() > 0.0) || !(bead.height.mm() > 0.0)) return;
    const double told = bead.width.mm();
    told_length_ += road.length;
    if (std::abs(road.section.width - told) <= kWidthSlack * told) return;
    if (differing_length_ == 0.0) differing_ = {road.step, road.section.width, told};
    differing_length_ += road.length;
  }

  double find_height(const Road& road, const step::Extrude& bead, double area) {
    if (bead.height.mm() >= kSameLevel) return bead.height.mm();
    if (options_.layer_height) return options_.layer_height->mm();
    const double left = bead.width.mm() > 0.0 ? height_of(area, bead.width.mm()) : 0.0;
    if (left >= kSameLevel) return left;
    if (road.goes_on) return chain_height_;
    if (levels_.step() > kSameLevel) return levels_.step();
    if (chain_height_ > 0.0) return chain_height_;
    warn_once(
        said_height_, Code::print_height_unknown, road.step,
        fmt::format("nothing tells how high the layers are, as the nozzle prints at Z{}; {} mm is taken",
                    number_text(road.from.z, 3), number_text(kUsualLayer, 3)));
    return kUsualLayer;
  }

  void finish_chain() {
    if (!last_) return;
    if (same_place(first_.from, last_->to)) {
      sink_.corner(*last_, first_);
    } else {
      sink_.free_begin(first_);
      sink_.free_end(*last_);
    }
    last_.reset();
  }

  void warn_once(bool& said, Code code, std::size_t step, std::string message) {
    if (said || diagnostics_ == nullptr) return;
    said = true;
    Diagnostic& warning = diagnostics_->warning(code, path_.origin_of(step), std::move(message));
    if (code == Code::print_height_unknown) warning.hint = "tell it, e.g. --layer-height 0.2";
  }

  void tell_widths() {
    if (diagnostics_ == nullptr || !(differing_length_ > told_length_ / 2.0)) return;
    diagnostics_
        ->warning(Code::print_width_differs, path_.origin_of(differing_.step),
                  fmt::format("by what is extruded the road is {} mm wide, by the comments {}; so it is with "
                              "most of the roads",
                              number_text(differing_.width, 3), number_text(differing_.told, 3)))
        .hint = "is the filament as thick as it is taken for? tell it, e.g. --filament 2.85";
  }

  struct Differing {
    std::uint32_t step = 0;
    double width = 0.0, told = 0.0;  // mm
  };

  const Toolpath& path_;
  const PrintOptions& options_;
  RoadSink& sink_;
  Diagnostics* diagnostics_;
  Levels levels_;
  std::optional<Road> last_;  // of the chain that is open
  Road first_;                // of the same chain
  double chain_height_ = 0.0;
  double drawn_back_ = 0.0;  // mm3
  double told_length_ = 0.0, differing_length_ = 0.0;
  Differing differing_;
  bool said_place_ = false, said_height_ = false, ended_ = false;
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

void for_each_road(const Toolpath& path, const PrintOptions& options, RoadSink& sink,
                   Diagnostics* diagnostics) {
  ExtrusionReader(path, options, sink, diagnostics).run();
}

}  // namespace kerf::printing

namespace kerf {

Volume road_volume(Length length, Length width, Length height) {
  const double w = width.mm(), h = height.mm();
  return mm3(length.mm() * ((w - h) * h + std::numbers::pi / 4.0 * h * h));
}

}  // namespace kerf
