// Motions as arrays: points, times, origins with their callers.
#include "app/shown/motions.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>

#include "app/shown/binary.h"

#include "kerf/path/estimate.h"
#include "kerf/path/report.h"

namespace kerf::app::view {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr Length kChord = mm(0.01);  // deviation of chords from their arc, below what a picture shows
constexpr int kMaxChords = 512;      // of one arc
constexpr std::size_t kPathHeader = 32;

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

/// The locations in the sources, each once, with the calls that led there.
class Origins {
 public:
  Origins(const OriginTable& table, const std::vector<std::string>& names)
      : table_(table), by_line_(names.size()) {
    for (std::size_t k = 0; k < names.size(); ++k) file_[names[k]] = static_cast<std::uint32_t>(k);
  }

  std::uint32_t number(OriginId id) {
    if (id == last_id_) return last_;
    last_id_ = id;
    last_ = find(id);
    return last_;
  }

  std::vector<std::uint32_t> files, lines, callers;

 private:
  std::uint32_t find(OriginId id) {
    if (id == OriginId::none) return kNone;
    std::uint32_t caller = kNone;
    const std::vector<Origin> calls = table_.callers(id);
    for (auto call = calls.rbegin(); call != calls.rend(); ++call) caller = add(*call, caller);
    return add(table_.resolve(id), caller);
  }

  std::uint32_t add(const Origin& origin, std::uint32_t caller) {
    const std::string* name = nullptr;
    std::uint32_t line = 0;
    if (const auto* text = std::get_if<TextLocation>(&origin)) {
      name = &text->file;
      line = text->line;
    } else if (const auto* call = std::get_if<CallLocation>(&origin)) {
      name = &call->file;
      line = call->line;
    } else if (const auto* drawing = std::get_if<DrawingLocation>(&origin)) {
      name = &drawing->file;
    } else {
      return kNone;
    }
    const std::uint32_t file = file_number(*name);
    std::uint32_t& known = number_of(file, line, caller);
    if (known == kNone) {
      known = static_cast<std::uint32_t>(files.size());
      files.push_back(file);
      lines.push_back(line);
      callers.push_back(caller);
    }
    return known;
  }

  std::uint32_t file_number(const std::string& name) {
    if (name == last_name_) return last_file_;
    const auto known = file_.find(name);
    last_name_ = name;
    last_file_ = known == file_.end() ? kNone : known->second;
    return last_file_;
  }

  /// The number of a location, kNone for a new one.
  std::uint32_t& number_of(std::uint32_t file, std::uint32_t line, std::uint32_t caller) {
    // Most locations are lines of one file without callers. Lines far beyond the number of origins, which a
    // script can state, take no memory.
    if (caller == kNone && file < by_line_.size() && line <= 4 * table_.size() + 1000) {
      std::vector<std::uint32_t>& numbers = by_line_[file];
      if (line >= numbers.size()) numbers.resize(std::max<std::size_t>(line + 1, 2 * numbers.size()), kNone);
      return numbers[line];
    }
    return number_.try_emplace({file, line, caller}, kNone).first->second;
  }

  const OriginTable& table_;
  std::unordered_map<std::string, std::uint32_t> file_;
  std::string last_name_;
  std::uint32_t last_file_ = kNone;
  std::vector<std::vector<std::uint32_t>> by_line_;  // of each file, by line
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> number_;  // others
  OriginId last_id_ = OriginId::none;
  std::uint32_t last_ = kNone;
};

/// The arrays of /path.
struct Arrays {
  std::vector<std::uint32_t> step, first_point, origin;
  std::vector<std::int32_t> tool;
  std::vector<float> seconds, feed, points, flow, power;
  std::vector<std::uint8_t> kind, bead;

  void add_point(Point3 p) {
    for (const double v : {p.x, p.y, p.z}) points.push_back(static_cast<float>(v));
  }
  void reserve(std::size_t motions) {
    for (auto* numbers : {&step, &first_point, &origin}) numbers->reserve(motions + 1);
    for (auto* numbers : {&seconds, &feed, &flow, &power}) numbers->reserve(motions);
    tool.reserve(motions);
    points.reserve(6 * motions);
    kind.reserve(motions);
    bead.reserve(motions);
  }
  std::uint32_t point_count() const { return static_cast<std::uint32_t>(points.size() / 3); }
  /// The points of a motion; none if a position is unknown.
  void add_points(const Step& s, const MotionContext& context);
  unsigned drawn = 7;  // axes that must be known
};

void Arrays::add_points(const Step& s, const MotionContext& context) {
  if (((s.unknown_axes() | context.unknown_from) & drawn) != 0) return;
  if (s.reference() == Reference::end_switches) return;
  add_point(context.from);
  if (s.kind() == StepKind::arc) {
    const ArcWalk walk = walk_of(s, context.from);
    const int chords = walk.chords(kChord, kMaxChords);
    for (int k = 1; k < chords; ++k) add_point(walk.at(static_cast<double>(k) / chords));
  }
  add_point(s.to());
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

/// Each motion has its own time and that of the steps since the motion before it, the last one also that of
/// the steps after it: together the time of the report.
Arrays arrays_of(const Toolpath& path, const std::optional<Machine>& machine, Origins& origins) {
  Arrays out;
  out.drawn = drawn_axes(path);
  const std::vector<float> seconds =
      machine ? step_seconds(path, *machine) : reported_seconds(path, ReportOptions{});
  const auto sum = [&](std::size_t first, std::size_t end) {
    double all = 0.0;
    for (std::size_t k = first; k < end; ++k) all += static_cast<double>(seconds[k]);
    return static_cast<float>(all);
  };
  out.reserve(path.size());
  BeamPower power(path);
  std::size_t next = 0;
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    out.step.push_back(static_cast<std::uint32_t>(context.index));
    out.first_point.push_back(out.point_count());
    out.tool.push_back(context.tool ? *context.tool : -1);
    out.origin.push_back(origins.number(s.origin()));
    out.kind.push_back(static_cast<std::uint8_t>(kind_of(s.kind())));
    out.feed.push_back(s.kind() == StepKind::rapid ? 0.0f : static_cast<float>(s.feed().mm_per_min()));
    out.flow.push_back(flow_of(path, context));
    out.power.push_back(power.at(context.index));
    out.bead.push_back(static_cast<std::uint8_t>(bead_of(path, context.index)));
    out.add_points(s, context);
    out.seconds.push_back(sum(next, context.index + 1));
    next = context.index + 1;
  });
  if (!out.seconds.empty()) out.seconds.back() += sum(next, path.size());
  out.first_point.push_back(out.point_count());
  return out;
}

}  // namespace

unsigned drawn_axes(const Toolpath& path) {
  constexpr unsigned kXY = 3, kZ = 4;
  bool known = false;
  for (const Step& s : path.steps()) known = known || (s.is_motion() && (s.unknown_axes() & kZ) == 0);
  return known ? kXY | kZ : kXY;
}

PathBody path_body(const Toolpath& path, std::uint32_t revision, const std::vector<std::string>& files,
                   const std::optional<Machine>& machine) {
  constexpr std::uint32_t kVersion = 1, kHasFlow = 1, kHasPower = 2, kHasBeads = 4;
  Origins origins(path.origins(), files);
  const Arrays arrays = arrays_of(path, machine, origins);
  const std::size_t motions = arrays.step.size();
  BinaryWriter out;
  out.reserve(kPathHeader + 36 * (motions + 1) + 12 * (arrays.point_count() + origins.files.size()));
  out.mark("KPTH");
  out.number(kVersion);
  out.number(revision);
  out.number(static_cast<std::uint32_t>(motions));
  out.number(arrays.point_count());
  out.number(static_cast<std::uint32_t>(origins.files.size()));
  const bool has_power =
      std::any_of(arrays.power.begin(), arrays.power.end(), [](float s) { return s > 0.0f; });
  const bool has_beads =
      std::any_of(arrays.bead.begin(), arrays.bead.end(), [](std::uint8_t kind) { return kind != 0; });
  out.number(kHasFlow | (has_power ? kHasPower : 0) | (has_beads ? kHasBeads : 0));
  out.number(0);
  out.array(arrays.step);
  out.array(arrays.first_point);
  out.array(arrays.tool);
  out.array(arrays.origin);
  out.array(arrays.seconds);
  out.array(arrays.feed);
  out.array(arrays.points);
  out.array(origins.files);
  out.array(origins.lines);
  out.array(origins.callers);
  out.array(arrays.kind);
  out.array(arrays.flow);
  if (has_power) out.array(arrays.power);
  if (has_beads) out.array(arrays.bead);
  return {out.take(), motions};
}

}  // namespace kerf::app::view
