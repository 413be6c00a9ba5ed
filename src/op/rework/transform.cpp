// Transforms and copies of a finished toolpath.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

#include "base/codes/op.h"
#include "op/base/pass_state.h"
#include "op/base/upwards.h"
#include "op/rework/moved_steps.h"
#include "path/arc_parts.h"
#include "path/firmware_retraction.h"

#include "kerf/base/limits.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr int kMaxCopies = 10'000;   // in a row or column
constexpr double kQuarter = 1e-12;   // rad: a rotation this close to quarter turns keeps the planes of arcs
constexpr double kSamePoint = 1e-6;  // mm
constexpr unsigned kAllAxes = 7;
constexpr double kAbovePrint = 2.0;  // mm, of the way between copies of a print

/// Why a step cannot be copied elsewhere: beads and, along the axis about which the work turns, cuts around
/// it can.
std::string_view fault_of_copy(const Toolpath& path, std::size_t i, const Copies& copies) {
  const MotionExtra* extra = path.extra(i);
  if (extra != nullptr && extra->abc && extra->z_correction.empty() && extra->lock == SpindleLock::none) {
    if (copies.rows > 1) return "the work turns about X, so that it can be repeated in columns only";
    if ((*extra->abc)[1] != 0.0 || (*extra->abc)[2] != 0.0) return "it turns B or C";
    if (path[i].reference() == Reference::work) return {};
  }
  if (path[i].kind() == StepKind::extrude) return {};
  return fault_of_move(path, i);
}

/// Whether a print has purge lines: beads without a kind before those that have one.
bool is_purge(const Toolpath& path, std::size_t i) {
  const BeadKind kind = path.extrude(i).kind;
  return kind == BeadKind::none || kind == BeadKind::custom || kind == BeadKind::purge;
}
bool lays(const Toolpath& path, std::size_t i) {
  return path[i].kind() == StepKind::extrude && path.extrude(i).volume > Volume();
}

bool refuse(const Toolpath& path, std::size_t i, std::string_view why, Diagnostics& diagnostics) {
  diagnostics.error(codes::pass_refused, path.origin_of(i), fmt::format("not possible here: {}", why));
  return false;
}

/// The matrix of a transform.
class Map {
 public:
  explicit Map(const PathTransform& t) : t_(t) {
    const double turn = t.rotate.deg();
    // Quarter turns are exact.
    const double quarters = std::round(turn / 90.0);
    exact_ = std::abs(turn - 90.0 * quarters) < kQuarter;
    c_ = std::cos(t.rotate.rad()), s_ = std::sin(t.rotate.rad());
    if (exact_) {
      const int k = static_cast<int>(std::fmod(std::fmod(quarters, 4.0) + 4.0, 4.0));
      c_ = std::array{1.0, 0.0, -1.0, 0.0}[static_cast<std::size_t>(k)];
      s_ = std::array{0.0, 1.0, 0.0, -1.0}[static_cast<std::size_t>(k)];
    }
  }
  /// Whether arcs in the planes XZ and YZ stay arcs in one of them.
  bool keeps_planes() const { return exact_ && t_.scale == 1.0; }
  bool mirrors() const { return t_.mirror != Mirror::none; }
  bool turns() const { return s_ != 0.0 || !exact_; }
  bool swaps_axes() const { return exact_ && c_ == 0.0; }
  Point2 operator()(Point2 p) const {
    Point2 d = t_.scale * (p - t_.centre);
    if (t_.mirror == Mirror::x) d.x = -d.x;
    if (t_.mirror == Mirror::y) d.y = -d.y;
    return t_.centre + Point2{c_ * d.x - s_ * d.y, s_ * d.x + c_ * d.y} + t_.move.xy();
  }
  Point3 operator()(Point3 p) const {
    const Point2 flat = (*this)(p.xy());
    return {flat.x, flat.y, p.z + t_.move.z};
  }

 private:
  const PathTransform& t_;
  double c_ = 1.0, s_ = 0.0;
  bool exact_ = true;
};

unsigned mapped_axes(unsigned bits, const Map& map) {
  if (!map.turns()) return bits;
  if (map.swaps_axes()) return (bits & 4u) | ((bits & 1u) << 1) | ((bits & 2u) >> 1);
  return (bits & 3u) != 0 ? bits | 3u : bits;
}

class Transform {
 public:
  Transform(const Toolpath& path, const PathTransform& options, Diagnostics& diagnostics)
      : path_(path), options_(options), map_(options), diagnostics_(diagnostics) {}

  std::optional<Toolpath> run() {
    out_.reserve(path_.size());
    MachineAxes machine(3u | (options_.move.z != 0.0 ? 4u : 0u));
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      std::string_view why = fault_of_move(path_, i);
      if (why.empty()) why = machine.pass(s, before_.at);
      const unsigned flat = s.unknown_axes() & 3u;
      const bool one = s.is_motion() && s.reference() == Reference::work && (flat == 1u || flat == 2u);
      if (why.empty() && one && map_.turns() && !is_still(s)) why = "X or Y alone is unknown";
      if (!why.empty()) {
        refuse(path_, i, why, diagnostics_);
        return std::nullopt;
      }
      const std::size_t first = out_.size();
      if (s.kind() == StepKind::arc) {
        if (!arc(i)) return std::nullopt;
      } else {
        const std::size_t added = out_.add_copy(path_, i);
        if (s.is_motion()) finish(added, s);
      }
      for (std::size_t k = first; k < out_.size(); ++k) after_.pass(out_[k]);
      before_.pass(s);
    }
    return std::move(out_);
  }

 private:
  /// Whether X and Y stay where they are.
  bool is_still(const Step& s) const {
    return s.to().xy() == before_.at.xy() && ((s.unknown_axes() ^ before_.unknown) & 3u) == 0;
  }

  /// The end of a motion. An unknown axis has the distance from where it was before.
  void finish(std::size_t added, const Step& s) {
    if (s.reference() != Reference::work) return finish_at_machine(added, s);
    Point3 to = map_(s.to());
    unsigned unknown = mapped_axes(s.unknown_axes(), map_);
    const Point3 way = to - map_(before_.at);
    for (int axis = 0; axis < 3; ++axis)
      if ((unknown >> axis & 1u) != 0) to[axis] = after_.at[axis] + way[axis];
    if ((s.unknown_axes() & 3u) != 0 && is_still(s)) {
      to.x = after_.at.x, to.y = after_.at.y;
      unknown = (unknown & 4u) | (after_.unknown & 3u);
    }
    // The end of an arc stays on its circle.
    const unsigned third = s.kind() == StepKind::arc ? 1u << axes_of(out_[added].arc().plane).w : kAllAxes;
    if (s.kind() != StepKind::arc || (unknown != 0 && (unknown & ~third) == 0)) out_.set_end(added, to);
    if (unknown != 0) out_.set_unknown_axes(added, unknown);
    out_.set_named_axes(added, mapped_axes(s.named_axes(), map_));
  }
  /// To the same position of the machine; the other axes stay where they are.
  void finish_at_machine(std::size_t added, const Step& s) {
    Point3 to = after_.at;
    for (int axis = 0; axis < 3; ++axis)
      if ((s.reference_axes() >> axis & 1u) != 0) to[axis] = s.to()[axis];
    out_.set_end(added, to);
    out_.set_unknown_axes(added, after_.unknown | s.reference_axes());
  }

  /// An arc in XZ or YZ after quarter turns and mirrors. Both planes have Z as an axis, so only the direction
  /// of the other one matters: XZ is seen from +Y, YZ from +X.
  step::Arc upright(step::Arc arc) const {
    const bool was_xz = arc.plane == Plane::xz;
    const Point2 centre = map_(was_xz ? Point2{arc.centre.x, arc.to.y} : Point2{arc.to.x, arc.centre.x});
    const Point2 axis = map_(was_xz ? Point2{1.0, 0.0} : Point2{0.0, 1.0}) - map_(Point2{});
    const bool is_xz = std::abs(axis.x) > std::abs(axis.y);
    const double along = is_xz ? axis.x : axis.y;
    const bool flips = was_xz == is_xz ? along < 0.0 : along > 0.0;
    arc.plane = is_xz ? Plane::xz : Plane::yz;
    arc.centre = {is_xz ? centre.x : centre.y, arc.centre.y + options_.move.z};
    arc.to = map_(arc.to);
    if (flips) arc.turn = arc.turn == Turn::ccw ? Turn::cw : Turn::ccw;
    return arc;
  }

  bool arc(std::size_t i) {
    const Step& s = path_[i];
    step::Arc arc = s.arc();
    const OriginId origin = out_.copy_origin(path_, i);
    if (arc.plane == Plane::xy) {
      arc.to = map_(arc.to), arc.centre = map_(arc.centre);
      if (map_.mirrors()) arc.turn = arc.turn == Turn::ccw ? Turn::cw : Turn::ccw;
      finish(out_.add(arc, origin), s);
      return true;
    }
    if (map_.keeps_planes()) {
      finish(out_.add(upright(arc), origin), s);
      return true;
    }
    if (!before_.is_known() || s.unknown_axes() != 0)
      return refuse(path_, i, "an arc starts or ends at an unknown position", diagnostics_);
    for (const Point3 p : chords_of(s, before_.at, options_.chord, limits::kMaxChords))
      out_.add(step::Cut{map_(p), s.feed()}, origin);
    return true;
  }

  const Toolpath& path_;
  const PathTransform& options_;
  Map map_;
  Diagnostics& diagnostics_;
  Toolpath out_;
  PathPosition before_, after_;  // in both paths
};

bool in_range(double v) { return std::abs(v) <= limits::kMaxCoordinate; }

}  // namespace

std::optional<Toolpath> transformed(const Toolpath& path, const PathTransform& t, Diagnostics& diagnostics) {
  if (!(t.scale > 0.0 && t.scale <= 1e6 && in_range(t.move.x) && in_range(t.move.y) && in_range(t.move.z) &&
        in_range(t.centre.x) && in_range(t.centre.y) && in_range(t.rotate.deg()) && t.chord > Length{})) {
    diagnostics.error(
        codes::pass_option, {},
        fmt::format("a scale of {:g}, a rotation by {:g} degrees or the distances are out of range", t.scale,
                    t.rotate.deg()));
    return std::nullopt;
  }
  const bool nothing =
      t.scale == 1.0 && t.mirror == Mirror::none && t.rotate == Angle{} && t.move == Point3{};
  if (nothing) return path;
  return Transform(path, t, diagnostics).run();
}

namespace {

/// Whether a step may be part of a closed path on the level `z`.
bool is_level(const Toolpath& path, std::size_t i, Point3 from) {
  const Step& s = path[i];
  return s.is_cutting() && s.unknown_axes() == 0 && path.extra(i) == nullptr && s.to().z == from.z &&
         (s.kind() == StepKind::cut || (s.arc().plane == Plane::xy && s.arc().extra_turns == 0));
}

std::uint64_t key_of(Point2 p) {
  const auto x = static_cast<std::int64_t>(std::llround(p.x / kSamePoint)),
             y = static_cast<std::int64_t>(std::llround(p.y / kSamePoint));
  return static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ull ^ static_cast<std::uint64_t>(y);
}

class LoopReverser {
 public:
  explicit LoopReverser(const Toolpath& path) : path_(path) {}

  Toolpath run() {
    std::optional<Point3> here;
    std::size_t i = 0;
    while (i < path_.size()) {
      if (here && is_level(path_, i, *here)) {
        i = level_run(i, *here);
        here = path_[i - 1].to();
        continue;
      }
      out_.add_copy(path_, i);
      if (path_[i].is_motion())
        here = path_[i].unknown_axes() == 0 ? std::optional(path_[i].to()) : std::nullopt;
      ++i;
    }
    return std::move(out_);
  }

 private:
  /// Copies the steps on one level from `first` on, with reversed loops; the step after them.
  std::size_t level_run(std::size_t first, Point3 start) {
    std::size_t end = first;
    Point3 here = start;
    while (end < path_.size() && is_level(path_, end, here)) here = path_[end++].to();
    // A loop ends where the path comes back to a point of it.
    std::unordered_map<std::uint64_t, std::size_t> seen{{key_of(start.xy()), first}};
    std::size_t copied = first;
    for (std::size_t i = first; i < end; ++i) {
      const auto [at, is_new] = seen.emplace(key_of(path_[i].to().xy()), i + 1);
      if (is_new) continue;
      const std::size_t from = at->second;
      if (distance(point_before(from, first, start).xy(), path_[i].to().xy()) > 2.0 * kSamePoint) continue;
      for (; copied < from; ++copied) out_.add_copy(path_, copied);
      reverse(from, i + 1, point_before(from, first, start));
      copied = i + 1;
      seen.clear();
      seen.emplace(key_of(path_[i].to().xy()), i + 1);
    }
    for (; copied < end; ++copied) out_.add_copy(path_, copied);
    return end;
  }
  Point3 point_before(std::size_t i, std::size_t first, Point3 start) const {
    return i == first ? start : path_[i - 1].to();
  }

  void reverse(std::size_t first, std::size_t end, Point3 start) {
    for (std::size_t i = end; i-- > first;) {
      Point3 to = i == first ? start : path_[i - 1].to();
      // The loop ends exactly where it did.
      if (i == first) to = path_[end - 1].to();
      const OriginId origin = out_.copy_origin(path_, i);
      if (path_[i].kind() == StepKind::cut) {
        out_.add(step::Cut{to, path_[i].feed()}, origin);
        continue;
      }
      step::Arc arc = path_[i].arc();
      arc.to = to;
      arc.turn = arc.turn == Turn::ccw ? Turn::cw : Turn::ccw;
      out_.add(arc, origin);
    }
  }

  const Toolpath& path_;
  Toolpath out_;
};

}  // namespace

Toolpath reversed_loops(const Toolpath& path) { return LoopReverser(path).run(); }

namespace {

/// What decides where the tool goes: copies that cannot start with it are refused.
constexpr StateParts kGuides = bit_of(StatePart::work_zero) | bit_of(StatePart::tool) |
                               bit_of(StatePart::tool_length) | bit_of(StatePart::rotary);

class Repeater {
 public:
  Repeater(const Toolpath& path, const Copies& copies, Diagnostics& diagnostics)
      : path_(path), copies_(copies), diagnostics_(diagnostics), state_(path, out_, diagnostics) {}

  std::optional<Toolpath> run() {
    MachineAxes machine((copies_.columns > 1 ? 1u : 0u) | (copies_.rows > 1 ? 2u : 0u));
    PathPosition at;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      std::string_view why = fault_of_copy(path_, i, copies_);
      if (why.empty()) why = machine.pass(path_[i], at.at);
      if (why.empty() && cuts_from_unknown(i, at))
        why = "a cut starts where X or Y is unknown; in a copy it would start at the end of the copy before";
      at.pass(path_[i]);
      if (why.empty()) continue;
      refuse(path_, i, why, diagnostics_);
      return std::nullopt;
    }
    for (std::size_t i = 0; i < path_.size(); ++i)
      has_kinds_ = has_kinds_ || (lays(path_, i) && !is_purge(path_, i));
    std::size_t first = 0;
    while (first < path_.size()) {
      std::size_t end = first + 1;
      while (end < path_.size() && path_[end].kind() != StepKind::tool_change &&
             path_[end].kind() != StepKind::end)
        ++end;
      if (!section(first, end)) return std::nullopt;
      first = end;
    }
    return std::move(out_);
  }

 private:
  /// In a print, motions without a bead are travel.
  bool cuts_from_unknown(std::size_t i, const PathPosition& from) const {
    const Step& s = path_[i];
    const bool cuts = path_.has(StepKind::extrude) ? lays(path_, i) : s.is_cutting();
    return cuts && (from.unknown & ~s.unknown_axes() & 3u) != 0;
  }

  struct Range {
    std::size_t first, end;
  };
  /// Without the motions to positions of the machine before the first cut, and from those after the last one
  /// on: they are not repeated.
  Range without_machine(std::size_t first, std::size_t end) const {
    const bool print = path_.has(StepKind::extrude);
    Range found{first, end};
    bool cuts = false;
    for (std::size_t i = first; i < end; ++i) {
      if (path_[i].is_motion() && path_[i].reference() != Reference::work) {
        if (!cuts) found.first = i + 1;
        if (found.end == end) found.end = i;
      } else if (print ? lays(path_, i) : path_[i].is_cutting()) {
        cuts = true;
        found.end = end;
      }
    }
    if (!cuts) found.first = first;
    return found;
  }

  /// The steps with one tool: what is before the first motion, the copies, and what is after the last one.
  bool section(std::size_t first, std::size_t end) {
    std::size_t from = end, to = first;
    double high = -INFINITY;
    const auto is_part = [&](std::size_t i) { return lays(path_, i) && !(has_kinds_ && is_purge(path_, i)); };
    bool waits = false;  // for the first bead
    for (std::size_t i = first; i < end; ++i) waits = waits || is_part(i);
    const bool prints = waits;
    const Range range = without_machine(first, end);
    for (std::size_t i = range.first; i < range.end; ++i) {
      if (!path_[i].is_motion()) continue;
      // What is before a print, as purge lines, is not repeated.
      waits = waits && !is_part(i);
      if (waits) continue;
      if (prints && path_[i].reference() == Reference::end_switches)
        return refuse(path_, i, "the print is homed within", diagnostics_);
      from = std::min(from, i), to = i + 1;
      if ((path_[i].unknown_axes() & 4u) == 0) high = std::max(high, path_[i].to().z);
    }
    if (prints) high += kAbovePrint;
    if (from >= to) {
      for (std::size_t i = first; i < end; ++i) out_.add_copy(path_, i);
      return true;
    }
    for (std::size_t i = first; i < from; ++i) out_.add_copy(path_, i);
    wanted_ = state_.before(from);
    restored_ = kAllState & ~set_before_cut(path_, from, to) & ~bit_of(StatePart::filament);
    // The first motion turns the axes itself.
    if (path_.extra(from) != nullptr && path_.extra(from)->abc) restored_ &= ~bit_of(StatePart::rotary);
    const PathPosition start = wanted_.position;
    for (int row = 0; row < copies_.rows; ++row)
      for (int k = 0; k < copies_.columns; ++k) {
        // Every other row is cut from its end.
        const int column = row % 2 == 0 ? k : copies_.columns - 1 - k;
        const bool again = row + k > 0;
        const Point3 by{column * copies_.pitch.x, row * copies_.pitch.y, 0.0};
        if (again && !start_again(from, to, high)) return false;
        move_above(from, high, by);
        if (!copy(from, to, by, again)) return false;
      }
    if (path_.motion_before(path_.size()) >= end) rise(to - 1, high);  // the next tool starts elsewhere
    return finish_section(start, {from, to}, end);
  }

  /// What follows the copies, from where the last one is: axes that do not move stay there, others go where
  /// the program parks them.
  bool finish_section(PathPosition before, Range copied, std::size_t end) {
    for (std::size_t i = copied.first; i < copied.end; ++i) before.pass(path_[i]);
    for (std::size_t i = copied.end; i < end; ++i) {
      if (path_[i].is_motion())
        park(i, before);
      else
        out_.add_copy(path_, i);
      before.pass(path_[i]);
    }
    return true;
  }
  void park(std::size_t i, const PathPosition& before) {
    const Step& s = path_[i];
    Point3 to = end_of(s, before, {});
    for (int axis = 0; axis < 3; ++axis)
      if (s.to()[axis] == before.at[axis] && (s.reference_axes() >> axis & 1u) == 0)
        to[axis] = state_.now().position.at[axis];
    move(i, to, {});
  }

  void rise(std::size_t origin, double high) {
    const PathPosition here = state_.now().position;
    if (here.is_known() && here.at.z < high)
      out_.add(step::Rapid{{here.at.x, here.at.y, high}}, out_.copy_origin(path_, origin));
  }

  /// From the end of a copy: up, and the state that the source's first motion finds.
  bool start_again(std::size_t from, std::size_t to, double high) {
    // A beam without heights needs none between copies.
    const bool flat = path_.has(StepKind::laser_power) && high == -INFINITY;
    if ((state_.now().position.unknown & (flat ? 3u : kAllAxes)) != 0)
      return refuse(path_, to - 1, "the position after a copy is unknown", diagnostics_);
    rise(from, high);
    const StateParts lost = state_.restore(wanted_, restored_, from);
    if ((lost & kGuides) != 0)
      return refuse(path_, from,
                    fmt::format("copies cannot start as the program does, which sets {} later",
                                to_text(lost & kGuides)),
                    diagnostics_);
    state_.warn(lost, from, "further copies");
    return true;
  }

  void rapid(Point3 to, std::size_t origin) {
    if (state_.now().position.at != to) out_.add(step::Rapid{to}, out_.copy_origin(path_, origin));
  }
  /// Across at the height between copies to where the program's first motion with the tool starts, if that is
  /// known, or ends, where these are lower: the tool does not come from where it does in the program.
  void move_above(std::size_t from, double high, Point3 by) {
    const Step& first = path_[from];
    const bool is_high = first.kind() == StepKind::rapid && first.to().z >= high;
    if (!state_.now().position.is_known() || is_high) return;
    const Point3 start = wanted_.position.at + by, end = first.to() + by;
    if (wanted_.position.is_known()) {
      if (state_.now().position.at == start) return;
      const double level = std::max(start.z, high);
      rapid({start.x, start.y, level}, from);
      rapid(start, from);
    } else if (first.kind() == StepKind::rapid && first.unknown_axes() == 0) {
      rapid({end.x, end.y, std::max(end.z, high)}, from);
    }
  }

  /// The end of a motion of a copy. Unknown axes that are known here move by the same distance; on the way to
  /// a position of the machine the other axes stay where they are.
  Point3 end_of(const Step& s, const PathPosition& before, Point3 by) {
    const Point3 here = state_.now().position.at;
    const bool to_machine = s.reference() != Reference::work;
    Point3 end = s.to() + by;
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned bit = 1u << axis;
      if (to_machine && (s.reference_axes() & bit) != 0)
        end[axis] = s.to()[axis];
      else if (to_machine || (s.unknown_axes() & bit) != 0)
        end[axis] = here[axis] + s.to()[axis] - before.at[axis];
    }
    return end;
  }

  bool copy(std::size_t from, std::size_t to, Point3 by, bool again) {
    PathPosition before = wanted_.position;  // in the source
    bool extruded = !again;
    for (std::size_t i = from; i < to; ++i) {
      if (out_.size() >= copies_.max_steps)
        return refuse(path_, i, fmt::format("more than {} steps", copies_.max_steps), diagnostics_);
      const Step& s = path_[i];
      const bool firmware = s.kind() == StepKind::verbatim &&
                            read_firmware_retraction(path_.text(i)).line != RetractionLine::none;
      if (!extruded && (firmware || s.kind() == StepKind::extrude)) {
        extruded = true;
        state_.warn(state_.restore(wanted_, bit_of(StatePart::filament), i), i, "further copies");
      }
      if (!s.is_motion() || !again)
        out_.add_copy(path_, i);
      else
        move(i, end_of(s, before, by), by);
      before.pass(s);
    }
    return true;
  }

  void move(std::size_t i, Point3 end, Point3 by) {
    const Step& s = path_[i];
    const OriginId origin = out_.copy_origin(path_, i);
    const unsigned unknown = (s.unknown_axes() & state_.now().position.unknown) | s.reference_axes();
    if (s.kind() == StepKind::arc) {
      step::Arc arc = s.arc();
      arc.to = end;
      if (arc.plane == Plane::xy)
        arc.centre = arc.centre + by.xy();
      else
        arc.centre.x += arc.plane == Plane::yz ? by.y : by.x;
      out_.add(arc, origin);
    } else if (s.kind() == StepKind::rapid) {
      out_.add(step::Rapid{end}, origin);
    } else if (s.kind() == StepKind::extrude) {
      step::Extrude bead = path_.extrude(i);
      bead.to = end;
      out_.add(bead, origin);
    } else {
      out_.add(step::Cut{end, s.feed()}, origin);
    }
    if (unknown != 0) out_.set_unknown_axes(out_.size() - 1, unknown);
    if (s.reference() != Reference::work)
      out_.set_reference(out_.size() - 1, s.reference(), s.reference_axes());
    if (const MotionExtra* extra = path_.extra(i)) out_.set_extra(out_.size() - 1, *extra);
  }

  const Toolpath& path_;
  const Copies& copies_;
  Diagnostics& diagnostics_;
  Toolpath out_;
  op_detail::PassState state_;
  PathState wanted_;  // before the first motion of the section in the source
  StateParts restored_ = kAllState;
  bool has_kinds_ = false;  // of beads
};

}  // namespace

std::optional<Toolpath> repeated(const Toolpath& path, const Copies& copies, Diagnostics& diagnostics) {
  const auto good = [](int count, double pitch) {
    return count >= 1 && count <= kMaxCopies && in_range(pitch) && in_range(pitch * count) &&
           (count == 1 || pitch != 0.0);
  };
  if (!good(copies.columns, copies.pitch.x) || !good(copies.rows, copies.pitch.y)) {
    diagnostics.error(codes::pass_option, {},
                      fmt::format("{} columns {:g} mm apart and {} rows {:g} mm apart are not possible",
                                  copies.columns, copies.pitch.x, copies.rows, copies.pitch.y));
    return std::nullopt;
  }
  if (copies.columns == 1 && copies.rows == 1) return path;
  if (!op_detail::counts_upwards(path, "rapids between copies", diagnostics)) return std::nullopt;
  return Repeater(path, copies, diagnostics).run();
}

}  // namespace kerf
