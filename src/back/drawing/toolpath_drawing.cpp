// Toolpaths as the entities of a drawing.
#include "kerf/drawing/toolpath_drawing.h"

#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "back/drawing/shapes.h"
#include "back/drawing/strokes.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"

namespace kerf {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSamePoint = 1e-5;   // mm; G-code has three or four decimals
constexpr double kSameRadius = 1e-3;  // mm between the radii of an arc that is drawn as one arc
constexpr double kParallel = 1e-9;    // mm, deviation of a chord from the direction of the previous one
constexpr double kRapidWidth = 0.5;   // of a cut's line
constexpr double kUnknownHole = 1.0;  // mm, diameter
constexpr int kToolColours[] = {5, 1, 3, 6, 30, 4, 140, 200};  // blue, red, green ...
constexpr int kRapidColour = 8, kByLayer = 256, kPlainColour = 7;

/// The shapes drawn so far, to find repeated ones.
class Drawn {
 public:
  /// False if the entity at `index`, the drawing's last, equals an earlier one.
  bool is_new(const Drawing& drawing, std::size_t index) {
    const DrawingEntity& entity = drawing.entities[index];
    const std::size_t key = std::visit([](const auto& shape) { return hash(shape); }, entity.shape);
    const auto [first, last] = seen_.equal_range(key);
    for (auto it = first; it != last; ++it) {
      const DrawingEntity& other = drawing.entities[it->second];
      if (other.layer == entity.layer && other.shape == entity.shape) return false;
    }
    seen_.emplace(key, index);
    return true;
  }

 private:
  static std::size_t mixed(std::size_t hash, double value) {
    return static_cast<std::size_t>(hash * 1'099'511'628'211u) ^ std::hash<double>{}(value);
  }
  static std::size_t hash(const drawing::Line& l) {
    return mixed(mixed(mixed(mixed(0, l.x1), l.y1), l.x2), l.y2);
  }
  static std::size_t hash(const drawing::Arc& a) { return mixed(mixed(mixed(1, a.x), a.y), a.start); }
  static std::size_t hash(const drawing::Circle& c) { return mixed(mixed(mixed(2, c.x), c.y), c.radius); }
  static std::size_t hash(const drawing::Polyline& p) {
    std::size_t all = 3;
    for (const drawing::Vertex& v : p.vertices) all = mixed(mixed(mixed(all, v.x), v.y), v.bulge);
    return all;
  }
  static std::size_t hash(const drawing::Text&) { return 4; }

  std::unordered_multimap<std::size_t, std::size_t> seen_;
};

class Sketcher final : public drawings::StrokeSink {
 public:
  Sketcher(const Toolpath& path, const ToolpathDrawingOptions& options) : path_(path), options_(options) {
    scale_ = options.unit == DrawingUnit::inch ? 1.0 / kMmPerInch : 1.0;
  }
  Drawing draw();
  void stroke(const drawings::Stroke& stroke) override;
  void setting(std::size_t step) override;

 private:
  enum class Closing : std::uint8_t { where_it_meets, always };
  void cut(const drawings::Stroke& stroke);
  void arc(const ArcWalk& walk);
  void chord_to(Point3 to);
  void line_to(Point3 to);
  void bulge_to(double bulge, Point3 to);
  void flush(Closing closing = Closing::where_it_meets);
  void hole();
  template <class Shape>
  void add(Shape shape);
  std::size_t layer_named(const std::string& name, int colour, LineKind line, double width);
  std::size_t cut_layer();
  /// Whether a chain ends at its start point.
  bool meets(const std::vector<drawing::Vertex>& chain) const {
    if (chain.size() < 3) return false;
    const auto &a = chain.front(), &b = chain.back();
    return std::hypot(a.x - b.x, a.y - b.y) <= kSamePoint * scale_;
  }
  bool idle_beam() const { return has_beam_ && !(beam_.mode != LaserMode::off && beam_.power > 0.0); }

  const Toolpath& path_;
  const ToolpathDrawingOptions& options_;
  double scale_ = 1.0;
  Drawing drawing_;
  Drawn drawn_;
  std::unordered_map<std::string, std::size_t> layers_;
  std::optional<std::size_t> named_layer_;
  std::optional<int> tool_;
  std::size_t tools_ = 0;

  Point3 at_;
  Point3 chord_from_;             // where the last line of the chain starts, if that is a chord
  bool chord_continues_ = false;  // the next chord of the same arc may lengthen it
  bool has_beam_ = false;
  step::LaserPower beam_;
  // The chain being drawn.
  bool rapid_ = false, went_down_ = false;
  std::vector<drawing::Vertex> chain_;
  std::optional<ArcWalk> only_arc_;
};

std::size_t Sketcher::layer_named(const std::string& name, int colour, LineKind line, double width) {
  const auto [it, is_new] = layers_.emplace(name, drawing_.layers.size());
  if (is_new) drawing_.layers.push_back({name, colour, colour_of_index(colour), width, line});
  return it->second;
}

std::size_t Sketcher::cut_layer() {
  if (named_layer_) return *named_layer_;
  if (!tool_) return layer_named("cuts", kPlainColour, LineKind::solid, 1.0);
  std::string name = fmt::format("T{}", *tool_);
  const auto known = options_.tool_names.find(*tool_);
  if (known != options_.tool_names.end()) name += " " + known->second;
  const int colour = kToolColours[tools_ % std::size(kToolColours)];
  const std::size_t before = drawing_.layers.size(), layer = layer_named(name, colour, LineKind::solid, 1.0);
  if (drawing_.layers.size() > before) ++tools_;
  return layer;
}

template <class Shape>
void Sketcher::add(Shape shape) {
  const std::size_t layer =
      rapid_ ? layer_named("rapids", kRapidColour, LineKind::dashed, kRapidWidth) : cut_layer();
  drawings::add(drawing_, layer, std::move(shape));
  if (!drawn_.is_new(drawing_, drawing_.entities.size() - 1)) drawing_.entities.pop_back();
}

void Sketcher::line_to(Point3 to) { bulge_to(0.0, to); }

void Sketcher::bulge_to(double bulge, Point3 to) {
  if (chain_.empty()) chain_.push_back({at_.x * scale_, at_.y * scale_, 0.0});
  chain_.back().bulge = bulge;
  chain_.push_back({to.x * scale_, to.y * scale_, 0.0});
  at_ = to;
}

/// Draws the chain; the next stroke starts a new one.
void Sketcher::flush(Closing closing) {
  chord_continues_ = false;
  std::vector<drawing::Vertex> chain = std::exchange(chain_, {});
  const std::optional<ArcWalk> walk = std::exchange(only_arc_, std::nullopt);
  if (chain.empty() && went_down_) hole();
  went_down_ = false;
  if (chain.size() < 2) return;
  if (walk) {
    const double radius = walk->start_radius * scale_, u = walk->u * scale_, v = walk->v * scale_;
    if (std::abs(walk->sweep) >= kTurn) return add(drawing::Circle{u, v, radius});
    const double first = radians(walk->start_angle).deg();
    const double last = radians(walk->start_angle + walk->sweep).deg();
    return add(drawing::Arc{u, v, radius, std::min(first, last), std::max(first, last)});
  }
  const auto &a = chain.front(), &b = chain.back();
  if (chain.size() == 2 && a.bulge == 0.0) return add(drawing::Line{a.x, a.y, b.x, b.y});
  const bool meets_start = meets(chain);
  if (meets_start) chain.pop_back();
  const bool closed = meets_start || (closing == Closing::always && chain.size() > 2);
  add(drawing::Polyline{std::move(chain), closed});
}

void Sketcher::hole() {
  const auto known = options_.tool_diameters.find(tool_.value_or(-1));
  const double diameter = known == options_.tool_diameters.end() ? kUnknownHole : known->second.mm();
  if (!rapid_ && diameter > 0.0)
    add(drawing::Circle{at_.x * scale_, at_.y * scale_, 0.5 * diameter * scale_});
}

/// An arc in XY; several turns are drawn as one.
void Sketcher::arc(const ArcWalk& walk) {
  const double sweep = std::copysign(std::min(std::abs(walk.sweep), kTurn), walk.sweep);
  const bool full = std::abs(walk.sweep) >= kTurn;
  const bool even = std::abs(walk.start_radius - walk.end_radius) <= kSameRadius;
  const bool alone = chain_.empty() && even;
  // Two parts, because some programs misread a bulge of more than half a circle.
  const int parts = std::abs(sweep) > std::numbers::pi ? 2 : 1;
  const double bulge = std::tan(0.25 * sweep / parts);
  for (int k = 1; k <= parts; ++k) {
    const double fraction = std::abs(sweep) / std::abs(walk.sweep) * k / parts;
    bulge_to(bulge, walk.at(k == parts && !full ? 1.0 : fraction));
  }
  const Point3 end = walk.at(1.0);
  only_arc_ = alone ? std::optional(walk) : std::nullopt;
  if (!full) return;
  flush();
  const double rest = std::fmod(walk.sweep, kTurn);
  if (std::abs(rest) * walk.start_radius > kSamePoint) bulge_to(std::tan(0.25 * rest), end);
  at_ = end;
}

/// A chord of an arc that does not lie in XY. The chords of an arc in a vertical plane are one line from
/// above.
void Sketcher::chord_to(Point3 to) {
  const double ax = at_.x - chord_from_.x, ay = at_.y - chord_from_.y, bx = to.x - at_.x, by = to.y - at_.y;
  const bool straight_on = chord_continues_ &&
                           std::abs(ax * by - ay * bx) <= kParallel * std::hypot(ax, ay) &&
                           ax * bx + ay * by > 0.0;
  if (straight_on) {
    chain_.pop_back();
    at_ = chord_from_;
  } else {
    chord_from_ = at_;
  }
  line_to(to);
  chord_continues_ = true;
}

void Sketcher::cut(const drawings::Stroke& stroke) {
  if (stroke.arc != nullptr) return arc(*stroke.arc);
  if (stroke.is_chord) {
    only_arc_.reset();
    return chord_to(stroke.to);
  }
  if (std::hypot(stroke.to.x - at_.x, stroke.to.y - at_.y) > kSamePoint) {
    only_arc_.reset();
    return line_to(stroke.to);
  }
  if (!chain_.empty()) flush();  // the next pass starts
  went_down_ = went_down_ || stroke.to.z < at_.z;
}

void Sketcher::stroke(const drawings::Stroke& stroke) {
  constexpr unsigned kInPlan = 3;  // X and Y
  const Step& s = path_[stroke.step];
  const bool known = (stroke.unknown_to & kInPlan) == 0;
  const bool probes = s.kind() == StepKind::probe;
  const bool rapid = s.kind() == StepKind::rapid || (s.is_cutting() && idle_beam());
  if (rapid != rapid_ || !known || probes) flush();
  rapid_ = rapid;
  const bool drawn = !rapid || options_.rapids == RapidLines::drawn;
  if (known && (stroke.unknown_from & kInPlan) == 0 && drawn && !probes) cut(stroke);
  at_ = stroke.to;
  if (!stroke.ends_step) return;
  chord_continues_ = false;
  if (meets(chain_)) flush();  // so that the next pass along it is recognised as a repetition
}

void Sketcher::setting(std::size_t i) {
  const Step& s = path_[i];
  if (s.kind() == StepKind::tool_change) {
    flush();
    tool_ = s.tool_change().tool;
  } else if (s.kind() == StepKind::layer) {
    flush();
    const step::Layer layer = path_.layer(i);
    const int colour = layer.colour > 0 && layer.colour < kByLayer ? layer.colour : kPlainColour;
    named_layer_ = layer_named(layer.name, colour, LineKind::solid, 1.0);
  } else if (s.kind() == StepKind::laser_power) {
    has_beam_ = true;
    beam_ = s.laser_power();
  } else if (s.kind() == StepKind::close_path && !rapid_) {
    flush(Closing::always);
  }
}

Drawing Sketcher::draw() {
  drawing_.unit = options_.unit;
  drawing_.title = options_.title;
  drawing_.layers.clear();
  drawings::StrokeOptions walk;
  walk.chord = options_.chord;
  drawings::walk_strokes(path_, walk, *this);
  flush();
  if (drawing_.layers.empty()) drawing_.layers.emplace_back();
  drawings::set_widths(drawing_);
  return std::move(drawing_);
}

}  // namespace

Drawing toolpath_drawing(const Toolpath& path, const ToolpathDrawingOptions& options) {
  return Sketcher(path, options).draw();
}

}  // namespace kerf
