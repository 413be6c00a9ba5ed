// The nearest place on the outline of half a tool, and on which side of it a place lies.
#include "sim/exact/tool_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sweep/solid.h"
#include "tool/arc.h"

#include "kerf/geometry.h"

namespace kerf::sim {
namespace {

/// Nearer to the outline than this its own normal is the direction, mm: a difference of places has none left.
constexpr double kOnOutline = 1e-9;
/// Pieces that turn right by less than this, radians, go on in one direction: rounding of their ends.
constexpr double kSameWay = 1e-9;

}  // namespace

struct ToolDistance::Nearest {
  double distance2 = std::numeric_limits<double>::infinity();
  double r = 0.0, z = 0.0;                // the place
  double normal_r = 0.0, normal_z = 0.0;  // of the outline there, outwards; of an arc
  const ProfileElement* line = nullptr;   // the piece, if it is a line
  bool is_end = false;                    // the place is an end of its piece
  double bend = 0.0;                      // of the distance, if it is none

  bool take(double from_r, double from_z, double to_r, double to_z) {
    const double dr = from_r - to_r, dz = from_z - to_z;
    const double square = dr * dr + dz * dz;
    if (square >= distance2) return false;
    distance2 = square;
    r = to_r;
    z = to_z;
    return true;
  }
};

ToolDistance::ToolDistance(const Silhouette& tool) {
  const Silhouette whole = held(tool);
  std::vector<Knot> knots;
  for (const ToolPart part : {ToolPart::cutting, ToolPart::neck, ToolPart::shank, ToolPart::holder}) {
    const Profile& profile = whole.part(part);
    if (profile.empty()) continue;
    // Parts that stand on each other are one outline: there is no surface between them.
    if (!knots.empty() && profile.bottom() > knots.back().z) {
      add_region(knots);
      knots.clear();
    }
    if (!knots.empty()) knots.back().bulge = 0.0;
    knots.insert(knots.end(), profile.knots.begin(), profile.knots.end());
    rim_ = std::max(rim_, profile.max_radius());
  }
  add_region(knots);
  bottom_ = pieces_.empty() ? 0.0 : pieces_.front().z0;
  is_convex_ = turns_left();
}

double ToolDistance::per_square(const ProfileElement& piece) {
  const double dr = piece.r1 - piece.r0, dz = piece.z1 - piece.z0;
  return 1.0 / (dr * dr + dz * dz);
}

/// Whether two pieces, one after the other, are one upright line: flutes and shank of one width.
bool ToolDistance::goes_on(const ProfileElement& before, const ProfileElement& next) {
  return before.side == 0.0 && next.side == 0.0 && before.r1 == next.r0 && before.z1 == next.z0 &&
         before.r0 == before.r1 && next.r0 == next.r1;
}

/// Whether the outline is one and never turns right.
bool ToolDistance::turns_left() const {
  const auto way_at = [](const ProfileElement& piece, double r, double z) {
    return piece.side == 0.0 ? Point2{piece.r1 - piece.r0, piece.z1 - piece.z0}
                             : Point2{piece.centre_z - z, r - piece.centre_r};
  };
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const ProfileElement& piece = pieces_[k];
    if (piece.side < 0.0) return false;
    if (k == 0) continue;
    const ProfileElement& before = pieces_[k - 1];
    if (before.r1 != piece.r0 || before.z1 != piece.z0) return false;
    const Point2 in = way_at(before, before.r1, before.z1), out = way_at(piece, piece.r0, piece.z0);
    if (cross(in, out) < -kSameWay * length(in) * length(out)) return false;
  }
  return !pieces_.empty();
}

void ToolDistance::add_region(const std::vector<Knot>& knots) {
  if (knots.size() < 2) return;
  const auto add = [&](const Knot& a, const Knot& b) {
    if ((a.r == b.r && a.z == b.z) || a.z >= kAboveAll)
      return;  // nothing is ever near the end of what holds it
    ProfileElement piece = piece_between(a, b);
    if (!pieces_.empty() && goes_on(pieces_.back(), piece)) {
      piece.r0 = pieces_.back().r0;
      piece.z0 = pieces_.back().z0;
      piece.per_length2 = per_square(piece);
      pieces_.pop_back();
    }
    pieces_.push_back(piece);
  };
  add({0.0, knots.front().z, 0.0}, knots.front());
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) add(knots[k], knots[k + 1]);
  add({knots.back().r, knots.back().z, 0.0}, {0.0, knots.back().z, 0.0});
}

ToolDistance::ProfileElement ToolDistance::piece_between(const Knot& a, const Knot& b) {
  ProfileElement piece{.r0 = a.r, .z0 = a.z, .r1 = b.r, .z1 = b.z};
  piece.per_length2 = per_square(piece);
  if (a.z != b.z) piece.r_per_z = (b.r - a.r) / (b.z - a.z);
  if (a.bulge == 0.0) return piece;
  const detail::ProfileArc arc = detail::profile_arc(a, b);
  piece.side = a.bulge > 0.0 ? 1.0 : -1.0;
  piece.centre_r = arc.r;
  piece.centre_z = arc.z;
  piece.radius = arc.radius;
  return piece;
}

double ToolDistance::radius_at(const ProfileElement& piece, double z) {
  if (piece.side == 0.0) return piece.r0 + piece.r_per_z * (z - piece.z0);
  const double height = z - piece.centre_z;
  return piece.centre_r +
         piece.side * std::sqrt(std::max(0.0, piece.radius * piece.radius - height * height));
}

bool ToolDistance::is_inside(double rho, double z) const {
  for (const ProfileElement& piece : pieces_)
    if (piece.z0 <= z && z < piece.z1) return rho < radius_at(piece, z);
  return false;
}

void ToolDistance::look_at_line(const ProfileElement& piece, double rho, double z, Nearest& nearest) {
  const double dr = piece.r1 - piece.r0, dz = piece.z1 - piece.z0;
  const double share =
      std::clamp(((rho - piece.r0) * dr + (z - piece.z0) * dz) * piece.per_length2, 0.0, 1.0);
  if (!nearest.take(rho, z, piece.r0 + share * dr, piece.z0 + share * dz)) return;
  nearest.line = &piece;
  nearest.is_end = share == 0.0 || share == 1.0;
  nearest.bend = 0.0;
}

void ToolDistance::look_at_arc(const ProfileElement& piece, double rho, double z, Nearest& nearest) {
  const double r = rho - piece.centre_r, h = z - piece.centre_z;
  const double begin_r = piece.r0 - piece.centre_r, begin_z = piece.z0 - piece.centre_z;
  const double end_r = piece.r1 - piece.centre_r, end_z = piece.z1 - piece.centre_z;
  const double length = std::sqrt(r * r + h * h);
  // No arc of a profile is longer than half a circle, as it never goes down.
  const bool between = piece.side * (begin_r * h - begin_z * r) >= 0.0 &&
                       piece.side * (r * end_z - h * end_r) >= 0.0 && length > 0.0;
  const auto set_normal = [&] {
    nearest.line = nullptr;
    nearest.is_end = !between;
    nearest.bend = between ? piece.side / length : 0.0;
    nearest.normal_r = piece.side * (nearest.r - piece.centre_r) / piece.radius;
    nearest.normal_z = piece.side * (nearest.z - piece.centre_z) / piece.radius;
  };
  if (between) {
    const double scale = piece.radius / length;
    if (nearest.take(rho, z, piece.centre_r + scale * r, piece.centre_z + scale * h)) set_normal();
    return;
  }
  if (nearest.take(rho, z, piece.r0, piece.z0)) set_normal();
  if (nearest.take(rho, z, piece.r1, piece.z1)) set_normal();
}

TurnedDistance ToolDistance::at(double rho, double z) const {
  Nearest nearest;
  for (const ProfileElement& piece : pieces_)
    piece.side == 0.0 ? look_at_line(piece, rho, z, nearest) : look_at_arc(piece, rho, z, nearest);
  const double distance = std::sqrt(nearest.distance2);
  const double sign = is_inside(rho, z) ? -1.0 : 1.0;
  const double per_distance = sign / std::max(distance, kOnOutline);
  const double bend = nearest.is_end ? per_distance : nearest.bend;
  if (distance >= kOnOutline)
    return {sign * distance, per_distance * (rho - nearest.r), per_distance * (z - nearest.z), bend};
  if (nearest.line == nullptr) return {sign * distance, nearest.normal_r, nearest.normal_z, bend};
  const ProfileElement& line = *nearest.line;
  const double per_length = std::sqrt(line.per_length2);
  return {sign * distance, per_length * (line.z1 - line.z0), per_length * (line.r0 - line.r1), bend};
}

}  // namespace kerf::sim
