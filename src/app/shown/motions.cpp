// Motions as pages draw them: points, times, what they are part of.
#include "app/shown/motions.h"

#include "app/shown/block_maker.h"

#include "kerf/path/estimate.h"
#include "kerf/path/report.h"

namespace kerf::app::view {
namespace {

constexpr Length kChord = mm(0.01);  // deviation of chords from their arc, below what a picture shows
constexpr int kMaxChords = 512;      // of one arc

enum class Kind : std::uint8_t { rapid, cut, arc, probe, extrude };

Kind kind_of(StepKind kind) {
  switch (kind) {
    case StepKind::cut: return Kind::cut;
    case StepKind::arc: return Kind::arc;
    case StepKind::probe: return Kind::probe;
    case StepKind::extrude: return Kind::extrude;
    case StepKind::rapid:
    case StepKind::dwell:
    case StepKind::tool_change:
    case StepKind::spindle:
    case StepKind::coolant:
    case StepKind::path_mode:
    case StepKind::temperature:
    case StepKind::fan:
    case StepKind::laser_power:
    case StepKind::layer:
    case StepKind::note:
    case StepKind::verbatim:
    case StepKind::pause:
    case StepKind::end:
    case StepKind::close_path:
    case StepKind::store_home:
    case StepKind::work_zero:
    case StepKind::tool_length:
    case StepKind::unresolved:
    case StepKind::motion_limits:
    case StepKind::extruder: break;
  }
  return Kind::rapid;
}

/// The points that a motion is drawn along; none if a position is unknown. `drawn`: the axes that must be
/// known.
void find_points(const Step& s, const MotionContext& context, unsigned drawn, std::vector<Point3>& points) {
  points.clear();
  if (((s.unknown_axes() | context.unknown_from) & drawn) != 0) return;
  if (s.reference() == Reference::end_switches) return;
  points.push_back(context.from);
  if (s.kind() == StepKind::arc) {
    const ArcWalk walk = walk_of(s, context.from);
    const int chords = walk.chords(kChord, kMaxChords);
    for (int k = 1; k < chords; ++k) points.push_back(walk.at(static_cast<double>(k) / chords));
  }
  points.push_back(s.to());
}

/// mm3/s of a bead at its feed; 0 for other motions.
float flow_of(const Toolpath& path, const MotionContext& context) {
  const Step& s = path[context.index];
  if (s.kind() != StepKind::extrude || !(s.feed() > Feed())) return 0.0f;
  const double seconds = (mm(distance(context.from, s.to())) / s.feed()).seconds();
  const double volume = path.extrude(context.index).volume.mm3();
  return seconds > 0.0 && volume > 0.0 ? static_cast<float>(volume / seconds) : 0.0f;
}

/// What a bead is part of.
BeadKind bead_of(const Toolpath& path, std::size_t step) {
  return path[step].kind() == StepKind::extrude ? path.extrude(step).kind : BeadKind::none;
}

/// The S of the beam at each motion, 0 where it is off.
class BeamPower {
 public:
  explicit BeamPower(const Toolpath& path) : path_(path) {}
  /// For steps in ascending order.
  float at(std::size_t motion) {
    for (; next_ < motion; ++next_)
      if (path_[next_].kind() == StepKind::laser_power) state_ = path_[next_].laser_power();
    const bool is_on = state_.mode != LaserMode::off && path_[motion].kind() != StepKind::rapid;
    return is_on ? static_cast<float>(state_.power) : 0.0f;
  }

 private:
  const Toolpath& path_;
  std::size_t next_ = 0;
  step::LaserPower state_;
};

}  // namespace

unsigned drawn_axes(const Toolpath& path) {
  constexpr unsigned kXY = 3, kZ = 4;
  bool known = false;
  for (const Step& s : path.steps()) known = known || (s.is_motion() && (s.unknown_axes() & kZ) == 0);
  return known ? kXY | kZ : kXY;
}

// Each motion has its own time and that of the steps since the motion before it, the last one also that of
// the steps after it: together the time of the report.
PathBlocks path_blocks(const Toolpath& path, const PathInputs& inputs) {
  const std::vector<float> seconds =
      inputs.machine ? step_seconds(path, *inputs.machine) : reported_seconds(path, ReportOptions{});
  const auto sum = [&](std::size_t first, std::size_t end) {
    double all = 0.0;
    for (std::size_t k = first; k < end; ++k) all += static_cast<double>(seconds[k]);
    return static_cast<float>(all);
  };
  const unsigned drawn = drawn_axes(path);
  BlockMaker maker(path.origins(), inputs.files);
  BeamPower power(path);
  std::vector<Point3> points;
  std::size_t next = 0;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    ShownMotion motion;
    motion.step = static_cast<std::uint32_t>(context.index);
    motion.kind = static_cast<std::uint8_t>(kind_of(s.kind()));
    motion.tool = context.tool ? *context.tool : -1;
    motion.origin = s.origin();
    motion.seconds = sum(next, context.index + 1);
    motion.feed = s.kind() == StepKind::rapid ? 0.0f : static_cast<float>(s.feed().mm_per_min());
    motion.flow = flow_of(path, context);
    motion.power = power.at(context.index);
    motion.bead = static_cast<std::uint8_t>(bead_of(path, context.index));
    find_points(s, context, drawn, points);
    maker.add(motion, points);
    next = context.index + 1;
  });
  maker.add_seconds(sum(next, path.size()));
  return maker.finish(inputs.before, inputs.revision);
}

}  // namespace kerf::app::view
