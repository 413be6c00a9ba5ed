// Levelling of motions, and heights with formulas.
#include "kerf/op/level.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/pathdxf.h"
#include "base/formula.h"
#include "base/number.h"
#include "op/base/upwards.h"
#include "path/arc_parts.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

constexpr unsigned kXY = 3, kZ = 4, kXYZ = 7;                // bits of axes, see Step::unknown_axes
constexpr std::size_t kLineSamples = 4;                      // between two edges of the surface
constexpr double kArcStep = 5.0 * std::numbers::pi / 180.0;  // radians between samples of an arc
constexpr std::size_t kMaxSamples = 2'000'000;               // of one motion
constexpr double kLargestArc = 0.9 * std::numbers::pi;       // radians, of a part of a divided arc
constexpr Length kChord = mm(0.001);                         // of arcs that are not parallel to XY
constexpr double kSameFraction = 1e-12;

/// A motion as a curve over the fraction of its way.
struct Curve {
  Point3 from, to;
  std::optional<ArcWalk> arc;

  Point3 at(double t) const { return arc ? arc->at(t) : from + t * (to - from); }
};

struct Sample {
  double t = 0.0;
  double correction = 0.0;
};

/// Fractions at which the line from a to b crosses the line from p to q.
void add_crossing(Point2 a, Point2 b, Point2 p, Point2 q, std::vector<double>& out) {
  const Point2 way = b - a, edge = q - p;
  const double det = cross(way, edge);
  if (det == 0.0) return;
  const double t = cross(p - a, edge) / det, u = cross(p - a, way) / det;
  if (t > 0.0 && t < 1.0 && u >= 0.0 && u <= 1.0) out.push_back(t);
}

class Leveller {
 public:
  Leveller(const Toolpath& path, const HeightMap& map, const LevelOptions& options, LevelReport& report,
           Diagnostics& diagnostics, Progress* progress)
      : path_(path),
        map_(map),
        options_(options),
        report_(report),
        diagnostics_(diagnostics),
        progress_(progress) {}

  std::optional<Toolpath> run() {
    out_.add(step::Note{std::string(kLevelledMark)}, OriginId::none);
    MotionReader motion(path_);
    bool has_motion = motion.next();
    for (std::size_t i = 0; i < path_.size() && !failed_; ++i) {
      if (stop_requested(progress_)) return std::nullopt;
      if (has_motion && motion.context().index == i) {
        take(motion.step(), motion.context());
        has_motion = motion.next();
      } else {
        out_.add_copy(path_, i);
      }
    }
    if (!failed_) check_largest();
    return failed_ ? std::nullopt : std::optional(std::move(out_));
  }

 private:
  Diagnostic& fail(Code code, std::size_t i, std::string message) {
    failed_ = true;
    return diagnostics_.error(code, path_.origin_of(i), std::move(message));
  }
  double weight(double z) const { return options_.keep_above && z >= *options_.keep_above ? 0.0 : 1.0; }
  void take(const Step& s, const MotionContext& context);
  bool stays(const Step& s, const MotionContext& context);
  const std::optional<Point2>& next_position(std::size_t i);
  void correct(const Step& s, const MotionContext& context);
  void sample(const Curve& curve, std::vector<Sample>& samples);
  void note_correction(double correction, Point2 at, std::size_t i);
  void add(const Step& s, std::size_t i, Point3 to, double fraction, OriginId origin, bool is_first);
  void add_arc(const Step& s, const ArcWalk& walk, double t0, double t1, Point3 to, OriginId origin,
               bool is_first);
  void mark(const Step& s, std::size_t added, bool is_first);
  void check_largest();

  const Toolpath& path_;
  const HeightMap& map_;
  const LevelOptions& options_;
  LevelReport& report_;
  Diagnostics& diagnostics_;
  Progress* progress_;
  Toolpath out_;
  bool failed_ = false, has_cut_ = false;
  std::size_t lowest_step_ = 0, highest_step_ = 0;
  std::optional<Point2> next_known_;
  std::size_t searched_to_ = 0;  // steps up to here were searched for it
  std::vector<double> breaks_;
  std::vector<Sample> samples_;
};

/// Whether a motion is copied: its height or next position is unknown, or it is above the levelled range.
bool Leveller::stays(const Step& s, const MotionContext& context) {
  if (s.kind() == StepKind::probe || (s.unknown_axes() & kZ) != 0 || s.reference_axes() != 0) return true;
  if ((s.unknown_axes() & kXY) != 0 && !next_position(context.index)) return true;
  if (weight(s.to().z) > 0.0) return false;
  return (context.unknown_from & kZ) != 0 || weight(context.from.z) == 0.0;
}

/// The first known position in XY from motion `i` on: heights before it are corrected for it, so that the
/// tool gets there without a change of height.
const std::optional<Point2>& Leveller::next_position(std::size_t i) {
  if (i < searched_to_) return next_known_;
  next_known_.reset();
  for (searched_to_ = i; searched_to_ < path_.size() && !next_known_; ++searched_to_) {
    const Step& s = path_[searched_to_];
    if (s.is_motion() && (s.unknown_axes() & kXY) == 0) next_known_ = s.to().xy();
  }
  return next_known_;
}

void Leveller::take(const Step& s, const MotionContext& context) {
  const std::size_t i = context.index;
  const MotionExtra* extra = path_.extra(i);
  if (extra != nullptr && extra->abc) {
    fail(codes::level_motion, i, "motions with rotary axes cannot be levelled");
    return;
  }
  if (extra != nullptr && !extra->z_correction.empty()) {
    fail(codes::level_motion, i, "the height has a formula over measured values").hint =
        "apply the measured values, with --measured: they correct the heights without --level";
    return;
  }
  if (stays(s, context)) {
    const bool is_elsewhere = (s.unknown_axes() & kXYZ) != 0 || s.reference_axes() != 0;
    if (is_elsewhere && s.is_cutting()) {
      fail(codes::level_motion, i,
           "the position of this cut in the work is unknown; its height cannot be corrected")
          .hint = "move to a known X, Y and Z in work coordinates (G90) before the cuts";
      return;
    }
    if (is_elsewhere) ++report_.unchanged;
    out_.add_copy(path_, i);
    return;
  }
  if (out_.size() > options_.max_steps) {
    fail(codes::level_motion, i, fmt::format("more than {} steps", options_.max_steps));
    return;
  }
  correct(s, context);
}

/// The corrections along a curve, at least where the surface has edges.
void Leveller::sample(const Curve& curve, std::vector<Sample>& samples) {
  breaks_.assign({0.0, 1.0});
  const double sweep = curve.arc ? std::abs(curve.arc->sweep) : 0.0;
  const auto chords = static_cast<std::size_t>(std::ceil(std::min(sweep / kArcStep, 1e6)));
  for (std::size_t k = 1; k < chords; ++k)
    breaks_.push_back(static_cast<double>(k) / static_cast<double>(chords));
  std::sort(breaks_.begin(), breaks_.end());
  const std::size_t coarse = breaks_.size();
  for (std::size_t k = 1; k < coarse && breaks_.size() < kMaxSamples; ++k) {
    const double t0 = breaks_[k - 1], t1 = breaks_[k];
    const Point2 a = curve.at(t0).xy(), b = curve.at(t1).xy();
    Box2 box;
    box.add(a);
    box.add(b);
    std::vector<double> crossings;
    map_.edges(box, [&](Point2 p, Point2 q) { add_crossing(a, b, p, q, crossings); });
    for (const double t : crossings) breaks_.push_back(t0 + t * (t1 - t0));
  }
  std::sort(breaks_.begin(), breaks_.end());
  samples.clear();
  const auto add_sample = [&](double t) {
    const Point3 p = curve.at(t);
    const double w = weight(curve.from.z) + t * (weight(curve.to.z) - weight(curve.from.z));
    samples.push_back({t, w == 0.0 ? 0.0 : w * map_.at(p.xy())});
  };
  for (std::size_t k = 0; k + 1 < breaks_.size(); ++k) {
    if (breaks_[k + 1] - breaks_[k] < kSameFraction) continue;
    for (std::size_t m = 0; m <= kLineSamples; ++m)
      add_sample(breaks_[k] + (breaks_[k + 1] - breaks_[k]) * static_cast<double>(m) / (kLineSamples + 1));
  }
  add_sample(1.0);
}

void Leveller::correct(const Step& s, const MotionContext& context) {
  const std::size_t i = context.index;
  Curve curve{context.from, s.to(), std::nullopt};
  if (s.kind() == StepKind::arc) curve.arc = walk_of(s, context.from);
  const OriginId origin = out_.copy_origin(path_, i);
  // From an unknown position the way is unknown: only the end is corrected.
  const bool is_plain = context.unknown_from == 0 && (s.unknown_axes() & kXY) == 0;
  const bool is_vertical = distance(curve.from.xy(), curve.to.xy()) == 0.0 && !curve.arc;
  if (!is_plain || is_vertical) {
    const Point2 at = (s.unknown_axes() & kXY) == 0 ? s.to().xy() : *next_position(i);
    const double c = weight(s.to().z) * map_.at(at);
    if (s.is_cutting()) note_correction(c, at, i);
    return add(s, i, {s.to().x, s.to().y, s.to().z + c}, 1.0, origin, true);
  }
  sample(curve, samples_);
  const double span = curve.arc ? std::abs(curve.arc->sweep) : 0.0;
  const double tolerance = options_.tolerance.mm();
  std::size_t parts = 0;
  for (std::size_t k = 0; k + 1 < samples_.size();) {
    // The last sample that a straight correction from k reaches within the tolerance of those between.
    double low = -HUGE_VAL, high = HUGE_VAL;
    std::size_t best = k + 1;
    for (std::size_t j = k + 1; j < samples_.size(); ++j) {
      const double run = samples_[j].t - samples_[k].t,
                   rise = samples_[j].correction - samples_[k].correction;
      if (rise / run >= low && rise / run <= high) best = j;
      low = std::max(low, (rise - tolerance) / run);
      high = std::min(high, (rise + tolerance) / run);
      if (low > high) break;
    }
    // A divided arc has parts below half a turn.
    const bool is_whole = k == 0 && best + 1 == samples_.size();
    while (!is_whole && best > k + 1 && span * (samples_[best].t - samples_[k].t) > kLargestArc) --best;
    const Sample& end = samples_[best];
    Point3 to = end.t == 1.0 ? s.to() : curve.at(end.t);
    to.z += end.correction;
    if (s.is_cutting()) note_correction(end.correction, to.xy(), i);
    if (curve.arc && !is_whole)
      add_arc(s, *curve.arc, samples_[k].t, end.t, to, origin, parts == 0);
    else
      add(s, i, to, end.t - samples_[k].t, origin, parts == 0);
    ++parts;
    k = best;
  }
  if (s.is_cutting()) note_correction(samples_[0].correction, curve.from.xy(), i);
  if (parts > 1) ++report_.divided;
}

/// Part of an arc: one of the same sweep.
void Leveller::add_arc(const Step& s, const ArcWalk& walk, double t0, double t1, Point3 to, OriginId origin,
                       bool is_first) {
  if (add_part(out_, arc_part(s.arc(), walk, t0, t1, walk.at(t0), to), origin))
    mark(s, out_.size() - 1, is_first);
}

void Leveller::add(const Step& s, std::size_t i, Point3 to, double fraction, OriginId origin, bool is_first) {
  std::size_t added = 0;
  if (s.kind() == StepKind::rapid) {
    added = out_.add(step::Rapid{to}, origin);
  } else if (s.kind() == StepKind::arc) {
    step::Arc arc = s.arc();
    arc.to = to;
    added = out_.add(arc, origin);
  } else if (s.kind() == StepKind::extrude) {
    step::Extrude bead = path_.extrude(i);
    bead.to = to;
    if (fraction < 1.0) bead.volume = fraction * bead.volume;
    added = out_.add(bead, origin);
  } else {
    added = out_.add(step::Cut{to, s.feed()}, origin);
  }
  mark(s, added, is_first);
}

void Leveller::mark(const Step& s, std::size_t added, bool is_first) {
  if (s.unknown_axes() != 0) out_.set_unknown_axes(added, s.unknown_axes());
  if (s.named_axes() != 0) out_.set_named_axes(added, s.named_axes() | kZ);
  if (s.rests_before() && is_first) out_.set_rests_before(added);
}

void Leveller::note_correction(double correction, Point2 at, std::size_t i) {
  if (!has_cut_ || correction < report_.lowest) {
    report_.lowest = correction;
    report_.lowest_at = at;
    lowest_step_ = i;
  }
  if (!has_cut_ || correction > report_.highest) {
    report_.highest = correction;
    report_.highest_at = at;
    highest_step_ = i;
  }
  has_cut_ = true;
  report_.outside = std::max(report_.outside, map_.distance_outside(at));
}

void Leveller::check_largest() {
  const bool is_low = -report_.lowest > report_.highest;
  const double largest = is_low ? report_.lowest : report_.highest;
  if (std::abs(largest) <= options_.max_correction.mm()) return;
  const Point2 at = is_low ? report_.lowest_at : report_.highest_at;
  fail(codes::level_correction, is_low ? lowest_step_ : highest_step_,
       fmt::format("the correction at {}, {} is {} mm; the maximum is {} mm", fixed_text(at.x, 3),
                   fixed_text(at.y, 3), fixed_text(largest, 3), number_text(options_.max_correction.mm(), 3)))
      .hint = "heights are above Z0 of the work coordinates; check the map, or specify a larger maximum";
}

/// Arcs that are not parallel to XY become chords.
std::optional<Toolpath> with_flat_arcs(const Toolpath& path, bool& failed, Diagnostics& diagnostics) {
  bool has_any = false;
  for (std::size_t i = 0; i < path.size() && !has_any; ++i)
    has_any = path[i].kind() == StepKind::arc && path[i].arc().plane != Plane::xy;
  if (!has_any) return std::nullopt;
  Toolpath out;
  MotionReader motion(path);
  bool has_motion = motion.next();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_motion = has_motion && motion.context().index == i;
    const Step& s = path[i];
    if (s.kind() != StepKind::arc || s.arc().plane == Plane::xy) {
      out.add_copy(path, i);
    } else {
      const MotionContext& context = motion.context();
      if (!can_be_divided(s, {context.from, context.unknown_from})) {
        diagnostics.error(codes::level_motion, path.origin_of(i), "an arc starts at an unknown position");
        failed = true;
        return std::nullopt;
      }
      const OriginId origin = out.copy_origin(path, i);
      for (const Point3 p : chords_of(s, context.from, kChord)) {
        const std::size_t added = out.add(step::Cut{p, s.feed()}, origin);
        if (s.unknown_axes() != 0) out.set_unknown_axes(added, s.unknown_axes());
        if (const MotionExtra* extra = path.extra(i)) out.set_extra(added, *extra);
      }
    }
    if (is_motion) has_motion = motion.next();
  }
  return out;
}

/// The last zero that the program sets at the position of its own probe.
std::optional<std::size_t> probed_zero(const Toolpath& path) {
  bool probed = false;
  std::optional<std::size_t> zero;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step& s = path[i];
    if (s.kind() == StepKind::probe) probed = true;
    if (s.kind() != StepKind::work_zero || !probed) continue;
    const step::WorkZero set = s.work_zero();
    if ((set.kind == ZeroKind::here || set.kind == ZeroKind::shift) && (set.axes & kZ) != 0) zero = i;
  }
  return zero;
}

bool has_note(const Toolpath& path, std::string_view mark) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::note && path.text(i).find(mark) != std::string_view::npos) return true;
  return false;
}

/// The first zero in Z that the program sets at the tool's height by G10 L20, without a probe before it.
std::optional<std::size_t> zero_at_the_tool(const Toolpath& path) {
  for (std::size_t i = 0; i < path.size() && path[i].kind() != StepKind::probe; ++i) {
    if (path[i].kind() != StepKind::work_zero) continue;
    const step::WorkZero set = path[i].work_zero();
    if (set.kind == ZeroKind::here && (set.axes & kZ) != 0) return i;
  }
  return std::nullopt;
}

/// Appends the errors and warnings of programs that are corrected already; false after an error.
bool can_be_levelled(const Toolpath& path, Diagnostics& diagnostics) {
  const auto refuse = [&](const Origin& where, const char* message, const char* hint) {
    diagnostics.error(codes::level_twice, where, message).hint = hint;
    return false;
  };
  if (has_note(path, kLevelledMark))
    return refuse(
        {}, "the program says that it follows a measured surface; levelled again, it would follow it twice",
        "level the program that it was made from");
  if (const auto zero = zero_at_the_tool(path))
    return refuse(
        path.origin_of(*zero),
        "the program sets its Z zero at the height of the tool (G10 L20), which levelling changes: what "
        "follows would be corrected twice",
        "set the zero before the program starts, or by G92");
  if (const auto zero = probed_zero(path))
    diagnostics
        .warning(
            codes::level_twice, path.origin_of(*zero),
            "the program sets its Z zero by its own probe: the height of the surface there is corrected by "
            "the probe and by the map")
        .hint = "use a map whose height is 0 where the program probes";
  return op_detail::counts_upwards(path, "corrected heights", diagnostics);
}

}  // namespace

std::optional<Toolpath> level(const Toolpath& path, const HeightMap& map, const LevelOptions& options,
                              LevelReport& report, Diagnostics& diagnostics, Progress* progress) {
  report = {};
  if (!can_be_levelled(path, diagnostics)) return std::nullopt;
  bool failed = false;
  const std::optional<Toolpath> flat = with_flat_arcs(path, failed, diagnostics);
  if (failed) return std::nullopt;
  return Leveller(flat ? *flat : path, map, options, report, diagnostics, progress).run();
}

bool is_corrected(const Toolpath& path) { return has_note(path, kCorrectedMark); }

bool has_height_formulas(const Toolpath& path) {
  for (std::size_t i = 0; i < path.size(); ++i)
    if (const MotionExtra* extra = path.extra(i); extra != nullptr && !extra->z_correction.empty())
      return true;
  return false;
}

std::optional<Toolpath> apply_heights(const Toolpath& path, const std::map<int, double>& values,
                                      Diagnostics& diagnostics) {
  const auto value_of = [&](int variable) {
    const auto known = values.find(variable);
    return known == values.end() ? std::nullopt : std::optional(known->second);
  };
  Toolpath out;
  out.reserve(path.size() + 1);
  out.add(step::Note{std::string(kCorrectedMark)}, OriginId::none);
  bool good = true;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::size_t added = out.add_copy(path, i);
    const MotionExtra* extra = path.extra(i);
    if (extra == nullptr || extra->z_correction.empty()) continue;
    FormulaFault fault;
    const auto z = evaluate_formula(extra->z_correction, value_of, fault);
    if (!z || std::abs(*z) > limits::kMaxCoordinate) {
      diagnostics.error(codes::heights_formula, path.origin_of(i),
                        fault.kind == FormulaFault::Kind::unknown_variable
                            ? fmt::format("no value for {} in the formula of a height", fault.symbol)
                            : std::string("the formula of a height has no value"));
      good = false;
      continue;
    }
    const Point3 to = path[i].to();
    out.set_end(added, {to.x, to.y, *z});
    MotionExtra rest = *extra;
    rest.z_correction.clear();
    out.set_extra(added, std::move(rest));
  }
  return good ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace kerf
