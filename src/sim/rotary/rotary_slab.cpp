// Cuts the rays of a slab, piece by piece of the motions.
#include "sim/rotary/rotary_slab.h"

#include <algorithm>
#include <cmath>

namespace kerf::sim {
namespace {

constexpr float kCrumb = 1e-5f;   // mm, shorter runs are dropped
constexpr double kJoined = 1e-3;  // mm; intervals of bodies of a tool that are closer are one

}  // namespace

double sector(const std::vector<Interval>& runs) {
  double sum = 0.0;
  for (const Interval& run : runs)
    sum += 0.5 * (static_cast<double>(run.high) * static_cast<double>(run.high) -
                  static_cast<double>(run.low) * static_cast<double>(run.low));
  return sum;
}

Slab::Slab(const RoundBar& bar, std::vector<std::vector<SlabRay>> rows, double hazard_depth)
    : bar_(bar), rows_(std::move(rows)), hazard_depth_(hazard_depth), low_(bar.x_high), high_(bar.x_low) {
  for (const std::vector<SlabRay>& row : rows_) {
    for (const SlabRay& ray : row) {
      low_ = std::min(low_, ray.x);
      high_ = std::max(high_, ray.x);
    }
  }
}

void Slab::cut(const RotaryMotion& motion, const RotaryTool& tool) {
  double rim = tool.cutting.rim();
  for (const Frusta& part : tool.touching) rim = std::max(rim, part.rim());
  const auto is_beside = [&](const RotaryMotion& m) {
    return std::min(m.from.x, m.to.x) - rim > high_ || std::max(m.from.x, m.to.x) + rim < low_;
  };
  if (is_beside(motion)) return;
  for (int n = 0; n < motion.pieces; ++n) {
    const RotaryMotion piece = motion.piece(n);
    if (!is_beside(piece)) cut_piece(piece, tool);
  }
}

void Slab::cut_piece(const RotaryMotion& piece, const RotaryTool& tool) {
  if (!piece.cuts) {
    for (const Frusta& part : tool.touching) apply(part, Pass::contact, HazardKind::rapid_in_stock, piece);
    return;
  }
  apply(tool.cutting, Pass::cut, HazardKind::spindle_off, piece);
  apply(tool.over_flute, Pass::contact, HazardKind::over_flute, piece);
  constexpr HazardKind kinds[] = {HazardKind::neck_contact, HazardKind::shank_contact,
                                  HazardKind::holder_contact};
  for (int part = 1; part < 4; ++part) apply(tool.touching[part], Pass::contact, kinds[part - 1], piece);
}

/// Applies a part to the rays that it can touch: those within its rim along the bar, and within the angles
/// under it.
void Slab::apply(const Frusta& part, Pass pass, HazardKind kind, const RotaryMotion& piece) {
  if (part.empty()) return;
  PartSweep sweep(part, piece, bar_);
  if (sweep.misses_bar() || sweep.low_x() > high_ || sweep.high_x() < low_) return;
  const auto around = static_cast<double>(rows_.size());
  const AngleRange angles = sweep.angles();
  const double low = angles.low + std::min(piece.turn_from, piece.turn_to);
  const double high = angles.high + std::max(piece.turn_from, piece.turn_to);
  const double first = angles.is_all ? 0.0 : std::floor(low / kTurn * around);
  const double last = angles.is_all ? around - 1.0 : std::floor(high / kTurn * around);
  const double count = std::min(last - first + 1.0, around);
  const double turns = std::floor(first / around);
  auto row = static_cast<std::size_t>(first - turns * around);
  double turn = turns * kTurn;
  for (double n = 0.0; n < count; n += 1.0) {
    for (const SlabRay& ray : rows_[row])
      if (!ray.runs->empty() && sweep.aim(ray.x, ray.angle, turn, static_cast<double>(ray.runs->back().high)))
        apply_to_ray(sweep, pass, kind, piece, ray);
    if (++row < rows_.size()) continue;
    row = 0;
    turn += kTurn;
  }
}

void Slab::apply_to_ray(PartSweep& sweep, Pass pass, HazardKind kind, const RotaryMotion& piece,
                        const SlabRay& ray) {
  covered_.clear();
  for (std::size_t body = 0; body < sweep.bodies(); ++body) sweep.cover(body, covered_);
  intervals_.clear();
  for (const RayInterval& found : covered_) {
    const auto joins = [&](const RayInterval& s) {
      return s.low <= found.high + kJoined && found.low <= s.high + kJoined;
    };
    const auto joined = std::find_if(intervals_.begin(), intervals_.end(), joins);
    if (joined == intervals_.end()) {
      intervals_.push_back(found);
    } else {
      *joined = {std::min(joined->low, found.low), std::max(joined->high, found.high)};
    }
  }
  RotaryContact contact;
  double surface = 0.0;
  for (const RayInterval& s : intervals_) {
    if (pass != Pass::cut && s.high - s.low <= hazard_depth_) continue;
    const double before = contact.depth;
    contact.volume += take(*ray.runs, s, piece.step, contact.depth);
    if (contact.depth > before) surface = s.high;
    if (ray.runs->empty()) break;
  }
  if (!(contact.volume > 0.0)) return;
  contact.volume *= ray.weight;
  if (result.removed.empty() || result.removed.back().first != piece.step)
    result.removed.emplace_back(piece.step, 0.0);
  result.removed.back().second += contact.volume;
  if (pass == Pass::cut && !piece.spindle_off) return;
  contact.depth = taken_by(piece.step, kind, ray.runs, contact.depth);
  contact.at.x = surface;
  if (contact.depth > hazard_depth_) note(kind, piece, sweep, ray, contact);
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
double Slab::take(std::vector<Interval>& runs, RayInterval s, std::uint32_t step, double& longest) {
  const auto low = static_cast<float>(s.low), high = static_cast<float>(s.high);
  if (!(high > runs.front().low) || !(low < runs.back().high)) return 0.0;
  double sum = 0.0;
  rest_.clear();
  for (const Interval& run : runs) {
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
  if (sum > 0.0) runs.assign(rest_.begin(), rest_.end());
  return sum;
}

/// `contact.at.x` is the distance of the point of contact from the axis.
void Slab::note(HazardKind kind, const RotaryMotion& piece, PartSweep& sweep, const SlabRay& ray,
                const RotaryContact& found) {
  RotaryContact& contact = result.contacts[{piece.step, kind}];
  contact.depth = std::max(contact.depth, found.depth);
  contact.volume += found.volume;
  if (contact.fraction <= piece.start_fraction) return;  // an earlier one is known
  const double t = sweep.first_contact(hazard_depth_);
  if (!(piece.fraction(t) < contact.fraction)) return;
  contact.fraction = piece.fraction(t);
  const TiltedRay seen = sweep.seen(t);
  contact.at = {ray.x, bar_.axis_y + found.at.x * seen.sine, bar_.axis_z + found.at.x * seen.cosine};
}

}  // namespace kerf::sim
