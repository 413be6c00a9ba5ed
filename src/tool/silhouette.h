// From a shape's measures to the half profile of its cutting part.
#pragma once

#include <string>

#include "kerf/tool.h"

namespace kerf::detail {

/// Builds a half profile; angles of arcs are signed sweeps in radians, positive counter-clockwise.
class Outline {
 public:
  Outline(double r, double z) { profile_.knots.push_back({r, z, 0.0}); }
  /// A straight segment; nothing where it would have no length.
  Outline& line_to(double r, double z);
  Outline& arc_to(double r, double z, double sweep);
  double r() const { return profile_.knots.back().r; }
  double z() const { return profile_.knots.back().z; }
  Profile take() { return std::move(profile_); }

 private:
  Profile profile_;
};

/// What a shape gives: its profile, or why there is none.
struct Cutting {
  ToolShape shape;             // with the measures that were not told
  Profile cutting, neck;       // the neck that belongs to the shape and does not cut
  std::string error;           // not empty: the measures do not fit together
  bool flute_assumed = false;  // usual_flute, as the shape does not tell it
  std::string warning;         // the flute ends before the cone has reached the diameter
};
/// The shape's measures are known to be finite and not negative, the required ones above 0.
Cutting cutting_of(const ToolShape& shape, Length neck_length);
/// Whether a shape of this kind cuts at its centre.
bool cuts_at_centre(const ToolShape& shape);
/// What is wrong with a drawn profile; empty if nothing.
std::string fault_of(const Profile& profile);

}  // namespace kerf::detail
