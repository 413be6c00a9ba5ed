// The rotary simulator: motions become sequences of tool poses. Slabs of the bar are cut pose by pose in time
// order, several slabs in parallel.
#include "kerf/sim/rotary.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "base/codes/sim.h"
#include "base/number.h"
#include "base/parallel.h"
#include "sim/rotary/rotary_tool.h"
#include "sim/sweep/solid.h"
#include "sim/sweep/survey.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace sim {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Number of rays at the default distance: a motion along a small bar takes hundredths of a second. The time
/// grows with the third power of the number of rays along a line, as the poses become denser too.
constexpr double kUsualRays = 1e5;
constexpr double kFinest = 0.02, kCoarsest = 1.0;  // mm, of the default distance of rays
constexpr double kMinSpacing = 1e-3;               // mm, of any distance
constexpr double kMaxPoses = 1e8;                  // a run of hours
constexpr double kMaxReach = 1e6;                  // mm
constexpr int kSlabRows = 8;                       // rays along the bar per slab
const Length kProfileChord = mm(0.001);            // frusta for arcs of a tool
const Length kPathChord = mm(0.002);               // chords for arcs of the path
constexpr double kClearance = 1e-4;                // mm, shallower sideways contacts are rounding
constexpr float kCrumb = 1e-5f;                    // mm, shorter runs are dropped

struct RotaryTool {
  Frusta cutting;
  Frusta touching[4];  // as ToolPart numbers them
  Frusta over_flute;
};

RotaryTool make_rotary_tool(const Silhouette& tool) {
  RotaryTool out;
  const Length none, clearance = mm(kClearance);
  out.cutting = Frusta(tool.cutting, kProfileChord, none);
  const Silhouette whole = held(tool);
  const Profile* parts[] = {&whole.cutting, &whole.neck, &whole.shank, &whole.holder};
  for (int k = 0; k < 4; ++k) out.touching[k] = Frusta(*parts[k], kProfileChord, clearance);
  out.over_flute = Frusta(radius_above_flutes(tool) - kClearance, out.cutting.top(), kAboveAll);
  return out;
}

/// A straight section of a motion, with a uniform turn of the bar.
struct RotaryMotion {
  Point3 from, to;                                  // mm, work coordinates
  double turn_from = 0.0, turn_to = 0.0;            // radians, A
  double start_fraction = 0.0, end_fraction = 1.0;  // fractions of the step's path
  std::uint32_t step = 0, tool = 0;
  bool cuts = false, spindle_off = false;
  int poses = 1;

  Point3 at(double t) const { return from + t * (to - from); }
  double turn(double t) const { return turn_from + t * (turn_to - turn_from); }
};

/// Reads motions and tools from the toolpath and reports what cannot be simulated.
class RotaryMotionReader {
 public:
  RotaryMotionReader(const Toolpath& path, const ToolTable& table, const RoundBar& bar, double spacing,
                     Diagnostics& diagnostics)
      : path_(path), table_(table), bar_(bar), spacing_(spacing), diagnostics_(diagnostics) {}

  bool run();
  std::vector<RotaryMotion> motions;
  std::vector<RotaryTool> tools;

 private:
  void add(const Step& step, const MotionContext& context);
  std::optional<std::uint32_t> tool_of(const Step& step, const MotionContext& context);
  void push(RotaryMotion motion);
  double turn_at(const MotionExtra* extra, const MotionContext& context);

  const Toolpath& path_;
  const ToolTable& table_;
  const RoundBar& bar_;
  double spacing_;
  Diagnostics& diagnostics_;
  std::map<int, std::uint32_t> index_;
  std::map<int, bool> reported_missing_;
  double turn_ = 0.0, poses_ = 0.0;
  bool judges_spindle_ = false, reported_other_axes_ = false, reported_no_tool_ = false;
};

bool RotaryMotionReader::run() {
  bool has_spindle = false, has_laser = false;
  for (const Step& step : path_.steps()) {
    has_spindle = has_spindle || step.kind() == StepKind::spindle;
    has_laser = has_laser || step.kind() == StepKind::laser_power;
  }
  judges_spindle_ = has_spindle && !has_laser;
  const std::size_t errors = diagnostics_.errors();
  for_each_motion(path_, [&](const Step& step, const MotionContext& context) { add(step, context); });
  if (poses_ > kMaxPoses)
    diagnostics_
        .error(codes::rotary_limit, {},
               fmt::format("the job needs {:.0f} tool positions; the limit is {:.0f}", poses_, kMaxPoses))
        .hint = "use a coarser resolution";
  return diagnostics_.errors() == errors;
}

double RotaryMotionReader::turn_at(const MotionExtra* extra, const MotionContext& context) {
  if (extra == nullptr || !extra->abc) return turn_;
  const auto& abc = *extra->abc;
  if ((abc[1] != 0.0 || abc[2] != 0.0) && !std::exchange(reported_other_axes_, true))
    diagnostics_.warning(codes::rotary_not_simulated, path_.origin_of(context.index),
                         "the axes B and C are not simulated; only A turns the bar");
  return degrees(abc[0]).rad();
}

std::optional<std::uint32_t> RotaryMotionReader::tool_of(const Step& step, const MotionContext& context) {
  std::optional<int> number = context.tool;
  if (!number && table_.tools().size() == 1) number = table_.tools().begin()->first;
  if (!number) {
    if (step.is_cutting() && !std::exchange(reported_no_tool_, true))
      diagnostics_.error(codes::no_tool_chosen, path_.origin_of(context.index),
                         "cut before the first tool change");
    return std::nullopt;
  }
  if (const auto it = index_.find(*number); it != index_.end()) return it->second;
  const Tool* tool = table_.find(*number);
  if (tool == nullptr) {
    if (step.is_cutting() && !std::exchange(reported_missing_[*number], true))
      diagnostics_.error(codes::no_such_tool, path_.origin_of(context.index),
                         fmt::format("tool {} cuts here, but has no shape", *number));
    return std::nullopt;
  }
  const auto index = static_cast<std::uint32_t>(tools.size());
  tools.push_back(make_rotary_tool(tool->silhouette));
  return index_[*number] = index;
}

void RotaryMotionReader::push(RotaryMotion motion) {
  if (!(length(motion.from) < kMaxReach) || !(length(motion.to) < kMaxReach)) {
    diagnostics_.error(codes::motion_out_of_range, path_.origin_of(motion.step),
                       "the motion goes too far from the work zero");
    return;
  }
  const double turned = std::abs(motion.turn_to - motion.turn_from) * 0.5 * bar_.diameter;
  const double count = std::ceil(std::max(distance(motion.from, motion.to), turned) / spacing_);
  poses_ += count + 1.0;
  motion.poses = static_cast<int>(std::clamp(count, 1.0, kMaxPoses));
  motions.push_back(motion);
}

void RotaryMotionReader::add(const Step& step, const MotionContext& context) {
  const double turn_from = turn_;
  turn_ = turn_at(path_.extra(context.index), context);
  if (step.kind() == StepKind::probe || step.kind() == StepKind::extrude) return;
  const auto tool = tool_of(step, context);
  if (!tool) return;
  RotaryMotion motion;
  motion.from = context.from;
  motion.to = step.to();
  motion.turn_from = turn_from;
  motion.turn_to = turn_;
  motion.step = static_cast<std::uint32_t>(context.index);
  motion.tool = *tool;
  motion.cuts = step.is_cutting();
  motion.spindle_off = judges_spindle_ && spindle_stopped(context);
  // Motions to unknown positions neither cut nor are reported, as in the simulator for three axes.
  constexpr unsigned kZ = 4;
  if ((step.unknown_axes() & kZ) != 0 || (!motion.cuts && step.unknown_axes() != 0)) return;
  if ((context.unknown_from & kZ) != 0)
    motion.from.z = std::max(motion.to.z, bar_.axis_z + 0.5 * bar_.diameter);
  const bool walked = step.kind() == StepKind::arc && is_walked(context);
  const unsigned needed = motion.cuts ? 3u : 7u;  // a rapid is only certain at its end
  if ((context.unknown_from & needed) != 0 && !walked)
    motion.from = {motion.to.x, motion.to.y, motion.from.z};
  if (!walked) return push(motion);
  const ArcWalk walk = walk_of(step, context.from);
  const int count = walk.chords(kPathChord);
  for (int k = 0; k < count; ++k) {
    RotaryMotion chord = motion;
    chord.start_fraction = static_cast<double>(k) / count;
    chord.end_fraction = (k + 1.0) / count;
    chord.from = walk.at(chord.start_fraction);
    chord.to = walk.at(chord.end_fraction);
    chord.turn_from = turn_from + chord.start_fraction * (turn_ - turn_from);
    chord.turn_to = turn_from + chord.end_fraction * (turn_ - turn_from);
    push(chord);
  }
}

struct RotaryContact {
  double fraction = 2.0;
  Point3 at;
  double depth = 0.0, volume = 0.0;
};
using Contacts = std::map<std::pair<std::uint32_t, HazardKind>, RotaryContact>;

/// Several rows of rays, cut by all motions.
class Slab {
 public:
  Slab(RotaryWorkpiece& workpiece, int first, int last, double hazard_depth)
      : work_(workpiece), first_(first), last_(last), hazard_depth_(hazard_depth), bar_(workpiece.bar) {}

  void cut(const RotaryMotion& motion, const RotaryTool& tool);
  std::vector<std::pair<std::uint32_t, double>> removed;  // mm3 by step, in order
  Contacts contacts;

 private:
  enum class Pass : std::uint8_t { cut, contact };
  struct Pose {
    Point3 tip;
    double turn, fraction;
    const RotaryMotion* motion;
  };
  void apply(const Frusta& part, Pass pass, HazardKind kind, const Pose& pose);
  void apply_to_ray(const Frusta& part, Pass pass, HazardKind kind, const Pose& pose, const TiltedRay& seen,
                    std::vector<Interval>& ray);
  std::vector<Interval>& ray_at(int i, int j) {
    return work_.rays[static_cast<std::size_t>(j) * static_cast<std::size_t>(work_.along) +
                      static_cast<std::size_t>(i)];
  }
  double take(std::vector<Interval>& ray, RayInterval s, std::uint32_t step, double& longest);
  double taken_by(std::uint32_t step, HazardKind kind, const void* ray, double more);
  void note(HazardKind kind, const Pose& pose, Point3 at, double depth, double volume);

  RotaryWorkpiece& work_;
  int first_, last_;  // rays along the bar, both included
  double hazard_depth_;
  const RoundBar& bar_;
  struct Taken {
    std::uint32_t step = kStockSurface;
    std::unordered_map<const void*, double> of_ray;  // mm
  };
  std::array<Taken, 8> taken_;  // by HazardKind
  std::vector<RayInterval> intervals_;
  std::vector<Interval> rest_;
};

void Slab::cut(const RotaryMotion& motion, const RotaryTool& tool) {
  const double low = bar_.x_low + (first_ + 0.5) * work_.dx, high = bar_.x_low + (last_ + 0.5) * work_.dx;
  double rim = tool.cutting.rim();
  for (const Frusta& part : tool.touching) rim = std::max(rim, part.rim());
  if (std::min(motion.from.x, motion.to.x) - rim > high || std::max(motion.from.x, motion.to.x) + rim < low)
    return;
  for (int k = 0; k <= motion.poses; ++k) {
    const double t = static_cast<double>(k) / motion.poses;
    const Pose pose{motion.at(t), motion.turn(t),
                    motion.start_fraction + t * (motion.end_fraction - motion.start_fraction), &motion};
    if (pose.tip.x - rim > high || pose.tip.x + rim < low) continue;
    if (!motion.cuts) {
      for (const Frusta& part : tool.touching) apply(part, Pass::contact, HazardKind::rapid_in_stock, pose);
      continue;
    }
    apply(tool.cutting, Pass::cut, HazardKind::spindle_off, pose);
    apply(tool.over_flute, Pass::contact, HazardKind::over_flute, pose);
    constexpr HazardKind kinds[] = {HazardKind::neck_contact, HazardKind::shank_contact,
                                    HazardKind::holder_contact};
    for (int part = 1; part < 4; ++part) apply(tool.touching[part], Pass::contact, kinds[part - 1], pose);
  }
}

/// Applies a part to the rays that it can touch: those within its rim along the bar, and within the angles
/// under it.
void Slab::apply(const Frusta& part, Pass pass, HazardKind kind, const Pose& pose) {
  if (part.empty()) return;
  const double radius = 0.5 * bar_.diameter, rim = part.rim();
  const double bottom = pose.tip.z + part.bottom() - bar_.axis_z, beside = pose.tip.y - bar_.axis_y;
  if (std::hypot(std::max(std::abs(beside) - rim, 0.0), std::max(bottom, 0.0)) >= radius) return;
  const auto row = [&](double x) { return (x - bar_.x_low) / work_.dx - 0.5; };
  const int i0 = std::max(first_, static_cast<int>(std::ceil(row(pose.tip.x - rim))));
  const int i1 = std::min(last_, static_cast<int>(std::floor(row(pose.tip.x + rim))));
  double low = 0.0, high = kTurn;
  if (bottom > 0.0) {
    low = std::min(std::atan2(-beside - rim, bottom), 0.0) + pose.turn;
    high = std::max(std::atan2(-beside + rim, bottom), 0.0) + pose.turn;
  }
  const int around = work_.around;
  const double first = std::ceil(low / kTurn * around - 0.5);
  const int count = std::min(static_cast<int>(std::floor(high / kTurn * around - 0.5) - first) + 1, around);
  const int start = static_cast<int>(first - std::floor(first / around) * around);
  for (int n = 0; n < count; ++n) {
    const int j = (start + n) % around;
    const double angle = (j + 0.5) * kTurn / around - pose.turn;
    TiltedRay seen{0.0, -beside, bar_.axis_z - pose.tip.z, -std::sin(angle), std::cos(angle)};
    for (int i = i0; i <= i1; ++i) {
      seen.x = bar_.x_low + (i + 0.5) * work_.dx - pose.tip.x;
      apply_to_ray(part, pass, kind, pose, seen, ray_at(i, j));
    }
  }
}

void Slab::apply_to_ray(const Frusta& part, Pass pass, HazardKind kind, const Pose& pose,
                        const TiltedRay& seen, std::vector<Interval>& ray) {
  if (ray.empty()) return;
  const auto reach = static_cast<double>(ray.back().high);
  if (seen.z + std::max(reach * seen.cosine, 0.0) <= part.bottom()) return;
  intervals_.clear();
  part.intersect(seen, reach, intervals_);
  double volume = 0.0, longest = 0.0, surface = 0.0;
  for (const RayInterval& s : intervals_) {
    if (pass != Pass::cut && s.high - s.low <= hazard_depth_) continue;
    const double before = longest;
    volume += take(ray, s, pose.motion->step, longest);
    if (longest > before) surface = std::min(s.high, reach);
  }
  if (!(volume > 0.0)) return;
  volume *= work_.dx * kTurn / work_.around;
  if (removed.empty() || removed.back().first != pose.motion->step)
    removed.emplace_back(pose.motion->step, 0.0);
  removed.back().second += volume;
  if (pass == Pass::cut && !pose.motion->spindle_off) return;
  const Point3 at{pose.tip.x + seen.x, bar_.axis_y + surface * seen.sine,
                  bar_.axis_z + surface * seen.cosine};
  const double depth = taken_by(pose.motion->step, kind, &ray, longest);
  if (depth > hazard_depth_) note(kind, pose, at, depth, volume);
}

/// The total length that contacts of one kind of a step have removed from a ray, after adding `more`: a
/// motion enters in small steps.
double Slab::taken_by(std::uint32_t step, HazardKind kind, const void* ray, double more) {
  Taken& taken = taken_[static_cast<std::size_t>(kind)];
  if (taken.step != step) taken.of_ray.clear();
  taken.step = step;
  return taken.of_ray[ray] += more;
}

/// Subtracts an interval from a ray. Returns the integral of r over the removed runs, and raises `longest` to
/// the longest of them.
double Slab::take(std::vector<Interval>& ray, RayInterval s, std::uint32_t step, double& longest) {
  const auto low = static_cast<float>(s.low), high = static_cast<float>(s.high);
  if (!(high > ray.front().low) || !(low < ray.back().high)) return 0.0;
  double sum = 0.0;
  rest_.clear();
  for (const Interval& run : ray) {
    const float from = std::max(run.low, low), to = std::min(run.high, high);
    if (!(to > from)) {
      rest_.push_back(run);
      continue;
    }
    const auto a = static_cast<double>(from), b = static_cast<double>(to);
    sum += 0.5 * (b * b - a * a);
    longest = std::max(longest, b - a);
    if (from > run.low + kCrumb) rest_.push_back({run.low, from, run.low_step, step});
    if (run.high > to + kCrumb) rest_.push_back({to, run.high, step, run.high_step});
  }
  if (sum > 0.0) ray.assign(rest_.begin(), rest_.end());
  return sum;
}

void Slab::note(HazardKind kind, const Pose& pose, Point3 at, double depth, double volume) {
  RotaryContact& contact = contacts[{pose.motion->step, kind}];
  if (pose.fraction < contact.fraction) {
    contact.fraction = pose.fraction;
    contact.at = at;
  }
  contact.depth = std::max(contact.depth, depth);
  contact.volume += volume;
}

void merge(const Contacts& from, Contacts& into) {
  for (const auto& [key, contact] : from) {
    const auto [it, is_new] = into.try_emplace(key, contact);
    if (is_new) continue;
    if (contact.fraction < it->second.fraction) {
      it->second.fraction = contact.fraction;
      it->second.at = contact.at;
    }
    it->second.depth = std::max(it->second.depth, contact.depth);
    it->second.volume += contact.volume;
  }
}

/// The bar before the first cut; nothing, with an error appended, if it is invalid.
std::optional<RotaryWorkpiece> make_bar(const RoundBar& bar, const SimulationOptions& options,
                                        Diagnostics& diagnostics) {
  const double size = bar.x_high - bar.x_low, girth = std::numbers::pi * bar.diameter;
  if (!(bar.diameter > 0.0) || !(size > 0.0) || !(bar.diameter <= limits::kMaxBarSize) ||
      !(size <= limits::kMaxBarSize) ||
      !(std::abs(bar.x_low) + std::abs(bar.axis_y) + std::abs(bar.axis_z) < kMaxReach)) {
    diagnostics.error(codes::stock_empty, {}, "the bar has no volume, or is larger than 10 m");
    return std::nullopt;
  }
  double pitch = options.resolution.mm();
  if (pitch == 0.0) pitch = std::clamp(std::sqrt(size * girth / kUsualRays), kFinest, kCoarsest);
  if (!std::isfinite(pitch) || pitch < kMinSpacing) {
    diagnostics.error(codes::bad_resolution, {},
                      fmt::format("the resolution is {} mm; expected at least {} mm", number_text(pitch, 9),
                                  number_text(kMinSpacing, 4)));
    return std::nullopt;
  }
  constexpr double kMinAround = 16.0;
  const double along = std::ceil(size / pitch), around = std::max(std::ceil(girth / pitch), kMinAround);
  if (along * around > static_cast<double>(options.max_columns)) {
    diagnostics.error(codes::rotary_limit, {},
                      fmt::format("a resolution of {} mm needs {:.0f} rays; at most {} are allowed",
                                  number_text(pitch, 4), along * around, options.max_columns));
    return std::nullopt;
  }
  RotaryWorkpiece work;
  work.bar = bar;
  work.along = static_cast<int>(along);
  work.around = static_cast<int>(around);
  work.dx = size / along;
  work.rays.assign(static_cast<std::size_t>(along * around),
                   {Interval{0.0f, static_cast<float>(0.5 * bar.diameter), kStockSurface, kStockSurface}});
  return work;
}

}  // namespace
}  // namespace sim

Volume RotaryWorkpiece::volume() const {
  double sum = 0.0;
  for (const std::vector<Interval>& ray : rays)
    for (const Interval& run : ray)
      sum += 0.5 * (static_cast<double>(run.high) * static_cast<double>(run.high) -
                    static_cast<double>(run.low) * static_cast<double>(run.low));
  return mm3(sum * dx * sim::kTurn / around);
}

std::optional<RotarySimulation> simulate_rotary(const Toolpath& path, const ToolTable& tools,
                                                const RoundBar& bar, const SimulationOptions& options,
                                                Diagnostics& diagnostics, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  auto work = sim::make_bar(bar, options, diagnostics);
  if (!work) return std::nullopt;
  const double girth_pitch = std::numbers::pi * bar.diameter / work->around;
  sim::RotaryMotionReader reader(path, tools, bar, 0.5 * std::min(work->dx, girth_pitch), diagnostics);
  if (!reader.run()) return std::nullopt;
  RotarySimulation result{
      .workpiece = std::move(*work), .stock = {}, .removed = {}, .hazards = {}, .removed_by_step = {}};
  result.stock = result.workpiece.volume();
  if (progress != nullptr) progress->phase("cutting");
  std::vector<sim::Slab> slabs;
  for (int row = 0; row < result.workpiece.along; row += sim::kSlabRows)
    slabs.emplace_back(result.workpiece, row, std::min(row + sim::kSlabRows, result.workpiece.along) - 1,
                       options.hazard_depth.mm());
  std::size_t started = 0;
  parallel_for(
      thread_count(options.threads), slabs.size(),
      [&](std::size_t n) {
        for (const sim::RotaryMotion& motion : reader.motions)
          slabs[n].cut(motion, reader.tools[motion.tool]);
      },
      [&] {
        report(progress, std::min(1.0, static_cast<double>(++started) / static_cast<double>(slabs.size())));
        return result.stopped = result.stopped || stop_requested(progress);
      });
  std::vector<double> by_step(path.size(), 0.0);
  sim::Contacts contacts;
  for (const sim::Slab& slab : slabs) {
    for (const auto& [step, volume] : slab.removed) by_step[step] += volume;
    sim::merge(slab.contacts, contacts);
  }
  double removed = 0.0;
  for (const double volume : by_step) {
    removed += volume;
    result.removed_by_step.push_back(static_cast<float>(volume));
  }
  result.removed = mm3(removed);
  for (const auto& [key, c] : contacts)
    result.hazards.push_back({key.second, key.first, c.at, mm(c.depth), mm3(c.volume)});
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace kerf
