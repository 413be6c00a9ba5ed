// Records contacts: where along the step they start, their depth, and the material touched.
#include "sim/kernel/hazard_passes.h"

#include <algorithm>
#include <cmath>

namespace kerf::sim {
namespace {

/// Fraction of the step's path at which a contact with the column starts. In plan exact for the rim; a plunge
/// touches it at the height of the contact.
double start_of_contact(const Sweep& s, const LocalSweep& w, Point2 position, Real rim, Real low, Real high) {
  double fraction = 0.0;
  if (s.is_arc) {
    const double x = position.x, y = position.y;
    const double angle = std::atan2(s.ux * y - s.uy * x, s.ux * x + s.uy * y);
    constexpr double kTurn = 6.283185307179586;
    double ahead = s.turn > 0.0 ? angle : -angle;
    const double lead =
        std::min(3.0, static_cast<double>(rim) / s.radius);  // the rim arrives before the centre
    if (ahead < 0.0 && ahead + kTurn - lead < std::abs(s.turn)) ahead += kTurn;
    fraction = (ahead - lead) / std::abs(s.turn);
  } else if (s.length > 0.0) {
    const auto x = static_cast<Real>(position.x), y = static_cast<Real>(position.y);
    const Real u = x * w.cx + y * w.cy, v = y * w.cx - x * w.cy;
    fraction = static_cast<double>(u - std::sqrt(higher_real(rim * rim - v * v, 0)) - w.t_low) / s.length;
  } else if (s.z > s.z_end) {  // the height of the tip above its lowest point is the same in all columns
    fraction = (s.z - (s.z_end + static_cast<double>(high - low))) / (s.z - s.z_end);
  }
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto begin = static_cast<double>(s.start_fraction), end = static_cast<double>(s.end_fraction);
  return begin + fraction * (end - begin);
}

double position_of(const Real* positions, int column, const TileJob& job) {
  return positions == nullptr ? column * job.field->pitch : static_cast<double>(positions[column]);
}

/// The point of a level arc that is nearest in plan, in the frame of its centre.
Point2 nearest_on_arc(const Sweep& s, const LocalSweep& w, Point2 p) {
  constexpr double kTurn = 6.283185307179586;
  const double angle = std::atan2(s.ux * p.y - s.uy * p.x, s.ux * p.x + s.uy * p.y);
  double ahead = s.turn > 0.0 ? angle : -angle;
  if (ahead < 0.0) ahead += kTurn;
  const double r = length(p);
  if (r > 0.0 && ahead <= std::abs(s.turn)) return (s.radius / r) * p;
  const Point2 start{static_cast<double>(w.start_x), static_cast<double>(w.start_y)};
  const Point2 end{static_cast<double>(w.end_x), static_cast<double>(w.end_y)};
  return distance(p, start) < distance(p, end) ? start : end;
}

/// The lowest height of the solid over the square of a column that its axis crosses: a point is deeper there
/// than at the column's centre. kFar for other columns.
Real lowest_at_axis(const Sweep& s, const LocalSweep& w, const LaneSolid& solid, Point2 position,
                    double pitch) {
  Point2 axis;
  Real tip = w.z_low;
  if (s.is_arc) {
    axis = nearest_on_arc(s, w, position);
  } else {
    const double u =
        std::clamp(position.x * static_cast<double>(w.cx) + position.y * static_cast<double>(w.cy),
                   static_cast<double>(w.t_low), static_cast<double>(w.t_high));
    axis = {u * static_cast<double>(w.cx), u * static_cast<double>(w.cy)};
    if (w.slope != 0) tip = w.z + w.slope * static_cast<Real>(u);
  }
  const double reach = 0.5 * pitch * (1.0 + 1e-6);
  const bool crosses = std::abs(position.x - axis.x) <= reach && std::abs(position.y - axis.y) <= reach;
  return crosses ? tip + solid.bottom : kFar;
}

/// Records what a sweep from `low` to `high` touches in a column; returns whether that exceeds the ignored
/// length.
bool note_column(const TileJob& job, const Sweep& s, const LocalSweep& w, const Pass& pass,
                 const MicroContact& m, int lane, std::vector<Interval>& column, Contact& contact) {
  const int micro = m.micro;
  const Real low = m.low[lane], high = m.high[lane];
  column.clear();
  job.tile->intervals(micro * kLanes + lane, column);
  bool any = false;
  for (const Interval& run : column) {
    const Real a = higher_real(low, run.low), b = lower_real(high, run.high);
    if (!(b - a > pass.ignore)) continue;
    any = true;
    contact.removed += static_cast<double>(b - a) * static_cast<double>(m.weight[lane]);
    const Point2 position{static_cast<double>(m.x[lane]), static_cast<double>(m.y[lane])};
    const Real lowest = lowest_at_axis(s, w, *pass.solid, position, job.field->pitch);
    const Real deepest = higher_real(lower_real(a, lowest), run.low);
    contact.depth = std::max(contact.depth, static_cast<double>(run.high - deepest));
    const double fraction = start_of_contact(s, w, position, pass.solid->rim, low, b);
    if (fraction >= contact.fraction) continue;
    contact.fraction = fraction;
    const int super = micro / kSupers, inner = micro % kSupers;
    const int column_x = (super & 3) * 16 + (inner & 3) * 4 + lane % 4;
    const int column_y = (super >> 2) * 16 + (inner >> 2) * 4 + lane / 4;
    contact.at = {job.x + position_of(job.position_x, column_x, job),
                  job.y + position_of(job.position_y, column_y, job), static_cast<double>(a)};
  }
  return any;
}

}  // namespace

void note_contacts(const TileJob& job, const Sweep& sweep, const LocalSweep& view, const Pass& pass,
                   MicroContact& columns, Contact& contact) {
  std::vector<Interval> column;
  for (int i = 0; i < kLanes; ++i) {
    const bool touches = columns.low[i] < columns.high[i] &&
                         columns.low[i] < job.tile->micro_top[columns.micro] &&
                         note_column(job, sweep, view, pass, columns, i, column, contact);
    if (touches || pass.ignore == 0) continue;
    columns.low[i] = kFar;
    columns.high[i] = -kFar;
  }
}

void keep_contact(const TileJob& job, const Pass& pass, Contact& contact) {
  if (contact.fraction > 1.0 || contact.depth <= static_cast<double>(pass.report_above)) return;
  contact.removed *= job.field->pitch * job.field->pitch;
  job.contacts->push_back(contact);
}

PassList list_passes(const Sweep& sweep, const LaneTool& tool, Real ignore) {
  PassList list;
  const auto add = [&](const Pass& pass) { list.pass[list.count++] = pass; };
  const bool rapid = (sweep.passes & kPassRapid) != 0;
  const auto touching = [&](int bit, const LaneSolid& solid, HazardKind kind) {
    if ((sweep.passes & bit) == 0) return;
    add({.solid = &solid,
         .is_hazard = true,
         .kind = rapid ? HazardKind::rapid_in_stock : kind,
         .ignore = ignore});
  };
  // With the spindle stopped a cut still removes material, however little.
  const bool off = (sweep.passes & kPassSpindleOff) != 0;
  if ((sweep.passes & kPassCut) != 0)
    add({.solid = &tool.cutting, .is_hazard = off, .kind = HazardKind::spindle_off, .report_above = ignore});
  touching(kPassRapid, tool.touching[0], HazardKind::rapid_in_stock);
  touching(kPassOverFlute, tool.over_flute, HazardKind::over_flute);
  touching(kPassNeck, tool.touching[1], HazardKind::neck_contact);
  touching(kPassShank, tool.touching[2], HazardKind::shank_contact);
  touching(kPassHolder, tool.touching[3], HazardKind::holder_contact);
  return list;
}

}  // namespace kerf::sim
