// Splits the half profile of a tool into convex pieces.
#include "sim/sweep/solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tool/arc.h"

namespace kerf::sim {
namespace {

/// Radii and centres closer than this are equal, mm; far below the precision of a profile.
constexpr double kSameRadius = 1e-9;
/// Steps in radius at which an underside is sampled to find its convex hull.
constexpr int kHullSamples = 512;
/// Maximum number of frusta per concave arc; with a chord tolerance of 0.5 um enough for a radius of 100 m.
constexpr int kMaxFrusta = 4096;

Cap flat_cap(double height, double rim) { return {.flat = rim, .height = height}; }

/// A straight flank, which is a cylinder where the radii are equal.
ConvexPiece frustum(double r0, double z0, double r1, double z1) {
  ConvexPiece piece;
  piece.rim = std::max(r0, r1);
  piece.lower = flat_cap(z0, piece.rim);
  piece.upper = flat_cap(-z1, piece.rim);
  if (std::abs(r1 - r0) < kSameRadius) return piece;
  const double slope = (z1 - z0) / std::abs(r1 - r0);
  if (r1 > r0) {
    piece.lower = {.curve = CapCurve::cone, .flat = r0, .height = z0, .slope = slope};
  } else {
    piece.upper = {.curve = CapCurve::cone, .flat = r1, .height = -z1, .slope = slope};
  }
  return piece;
}

Cap arc_cap(double flat, double height, double centre_r, double centre_z, double radius) {
  const bool on_axis = std::abs(centre_r) < kSameRadius;
  return {.curve = on_axis ? CapCurve::ball : CapCurve::torus,
          .flat = flat,
          .height = height,
          .centre_r = on_axis ? 0.0 : centre_r,
          .centre_z = centre_z,
          .radius = radius};
}

/// A zone bounded by an arc that bulges away from the axis.
ConvexPiece zone(const Knot& a, const Knot& b) {
  const detail::ProfileArc arc = detail::profile_arc(a, b);
  const bool has_equator = arc.z > a.z && arc.z < b.z;
  ConvexPiece piece;
  piece.rim = has_equator ? arc.r + arc.radius : std::max(a.r, b.r);
  piece.lower = flat_cap(a.z, piece.rim);
  piece.upper = flat_cap(-b.z, piece.rim);
  if (arc.z > a.z) piece.lower = arc_cap(a.r, a.z, arc.r, arc.z, arc.radius);
  if (arc.z < b.z) piece.upper = arc_cap(b.r, -b.z, arc.r, -arc.z, arc.radius);
  return piece;
}

/// Frusta for a concave arc. Their knots lie outside it by 2/3 of the chord error, so that the volume is
/// right.
void add_concave_arc(const Knot& a, const Knot& b, double chord_error, std::vector<ConvexPiece>& pieces) {
  constexpr double kBeyond = 2.0 / 3.0;
  const detail::ProfileArc arc = detail::profile_arc(a, b);
  const double sweep = 4.0 * std::atan(a.bulge);
  const double step = 2.0 * std::acos(1.0 - std::min(chord_error / kBeyond / arc.radius, 1.0));
  const int count = std::clamp(static_cast<int>(std::ceil(std::abs(sweep) / step)), 1, kMaxFrusta);
  const double radius = arc.radius * (1.0 + kBeyond * (1.0 - std::cos(0.5 * sweep / count)));
  const double start = std::atan2(a.z - arc.z, a.r - arc.r);
  double r0 = a.r, z0 = a.z;
  for (int k = 1; k <= count; ++k) {
    const double angle = start + sweep * k / count;
    const double r1 = k == count ? b.r : std::max(0.0, arc.r + radius * std::cos(angle));
    const double z1 = k == count ? b.z : std::clamp(arc.z + radius * std::sin(angle), z0, b.z);
    if (z1 > z0) pieces.push_back(frustum(r0, z0, r1, z1));
    r0 = r1;
    z0 = z1;
  }
}

std::vector<ConvexPiece> pieces_of(const Profile& profile, double chord) {
  std::vector<ConvexPiece> pieces;
  for (std::size_t i = 0; i + 1 < profile.knots.size(); ++i) {
    const Knot& a = profile.knots[i];
    const Knot& b = profile.knots[i + 1];
    if (!(b.z > a.z)) continue;  // a step
    if (a.bulge > 0.0) {
      pieces.push_back(zone(a, b));
    } else if (a.bulge < 0.0) {
      add_concave_arc(a, b, chord, pieces);
    } else {
      pieces.push_back(frustum(a.r, a.z, b.r, b.z));
    }
  }
  return pieces;
}

void shrink_cap(Cap& cap, double shrink, double rim) {
  if (cap.curve == CapCurve::flat) {
    cap.flat = rim;
    return;
  }
  if (cap.curve == CapCurve::cone) cap.height += cap.slope * std::max(shrink - cap.flat, 0.0);
  cap.flat = std::max(cap.flat - shrink, 0.0);
  if (cap.curve == CapCurve::cone) return;
  cap.radius -= shrink;
  if (cap.radius <= 0.0) cap = flat_cap(cap.height, rim);
}

void shrink_pieces(std::vector<ConvexPiece>& pieces, double shrink) {
  for (ConvexPiece& piece : pieces) {
    piece.rim -= shrink;
    shrink_cap(piece.lower, shrink, piece.rim);
    shrink_cap(piece.upper, shrink, piece.rim);
  }
  std::erase_if(pieces, [](const ConvexPiece& piece) { return piece.rim <= 0.0; });
}

bool never_shrinks_upwards(const std::vector<ConvexPiece>& pieces) {
  double rim = 0.0;
  for (const ConvexPiece& piece : pieces) {
    const double start = piece.lower.curve == CapCurve::flat ? piece.rim : piece.lower.flat;
    if (piece.upper.curve != CapCurve::flat || start < rim - kSameRadius) return false;
    rim = piece.rim;
  }
  return true;
}

/// Of one envelope, removes the pieces whose underside is hidden by those below them.
void drop_hidden(std::vector<ConvexPiece>& pieces) {
  double rim = 0.0;
  std::erase_if(pieces, [&](const ConvexPiece& piece) {
    const bool hidden = piece.rim <= rim + kSameRadius;
    rim = std::max(rim, piece.rim);
    return hidden;
  });
}

double underside_at(const std::vector<ConvexPiece>& pieces, double rho, double top) {
  double low = top;
  for (const ConvexPiece& piece : pieces)
    if (rho <= piece.rim) low = std::min(low, piece.lower.at(rho));
  return low;
}

/// Lines below the underside: the edges of the lower convex hull of a staircase below it.
void find_cull_lines(Solid& solid) {
  struct Corner {
    double rho, height;
  };
  std::vector<Corner> hull{{0.0, solid.bottom}};
  for (int k = 0; k < kHullSamples; ++k) {
    const Corner next{solid.rim * (k + 1) / kHullSamples,
                      underside_at(solid.pieces, solid.rim * k / kHullSamples, solid.top)};
    const auto turns_up = [&](const Corner& a, const Corner& b) {
      return (b.rho - a.rho) * (next.height - a.height) > (b.height - a.height) * (next.rho - a.rho);
    };
    while (hull.size() > 1 && !turns_up(hull[hull.size() - 2], hull.back())) hull.pop_back();
    hull.push_back(next);
  }
  // Fractions of the rim at which hull edges are chosen; denser outside, where a ball is steep.
  constexpr double kFractions[kCullLines] = {0.0, 0.25, 0.45, 0.65, 0.82, 0.95};
  for (int i = 0; i < kCullLines; ++i) {
    std::size_t edge = 0;
    while (edge + 2 < hull.size() && hull[edge + 1].rho <= kFractions[i] * solid.rim) ++edge;
    const Corner a = hull[edge], b = hull[edge + 1];
    const double slope = (b.height - a.height) / (b.rho - a.rho);
    solid.lines[i] = {a.height - slope * a.rho, slope};
  }
}

}  // namespace

double Cap::at(double rho) const {
  if (rho <= flat) return height;
  switch (curve) {
    case CapCurve::flat: return height;
    case CapCurve::cone: return height + slope * (rho - flat);
    case CapCurve::ball:
    case CapCurve::torus: break;
  }
  const double out = std::max(rho - centre_r, 0.0);
  return std::max(height, centre_z - std::sqrt(std::max(radius * radius - out * out, 0.0)));
}

double Solid::reach_below(double height) const {
  // The underside does not fall outwards, so bisection finds the last radius below the height.
  double low = 0.0, high = rim;
  if (underside_at(pieces, rim, top) < height) return rim;
  for (int n = 0; n < 60; ++n) {
    const double midpoint = 0.5 * (low + high);
    (underside_at(pieces, midpoint, top) < height ? low : high) = midpoint;
  }
  return low;
}

Solid make_solid(const Profile& profile, Length chord, Length shrink) {
  Solid solid;
  if (profile.empty()) return solid;
  solid.pieces = pieces_of(profile, chord.mm());
  solid.bottom = profile.bottom();
  solid.top = profile.top();
  solid.one_envelope = never_shrinks_upwards(solid.pieces);
  if (solid.one_envelope) drop_hidden(solid.pieces);
  if (shrink.mm() > 0.0) shrink_pieces(solid.pieces, shrink.mm());
  for (const ConvexPiece& piece : solid.pieces) solid.rim = std::max(solid.rim, piece.rim);
  if (!solid.empty()) find_cull_lines(solid);
  return solid;
}

double radius_above_flutes(const Silhouette& tool) {
  if (tool.cutting.empty()) return 0.0;
  const double flutes = tool.cutting.knots.back().r;
  for (const Profile* part : {&tool.neck, &tool.shank, &tool.holder})
    if (!part->empty()) return std::min(flutes, part->knots.front().r);
  return flutes;
}

Silhouette held(Silhouette tool) {
  for (Profile* part : {&tool.holder, &tool.shank, &tool.neck}) {
    if (part->empty()) continue;
    part->knots.back().bulge = 0.0;
    part->knots.push_back({part->knots.back().r, part->top() + kAboveAll, 0.0});
    return tool;
  }
  if (tool.cutting.empty()) return tool;
  const double radius = tool.cutting.knots.back().r, top = tool.cutting.top();
  if (radius > 0.0) tool.shank.knots = {{radius, top, 0.0}, {radius, top + kAboveAll, 0.0}};
  return tool;
}

Solid make_cylinder(double radius, double bottom, double top) {
  Profile profile;
  profile.knots = {{radius, bottom, 0.0}, {radius, top, 0.0}};
  return make_solid(profile, Length(), Length());
}

}  // namespace kerf::sim
