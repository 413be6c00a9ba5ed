// From the dimensions of a shape to the half profile of its cutting part.
#pragma once

#include <string>

#include "kerf/tool/tool.h"

namespace kerf::detail {

/// Builds a half profile; angles of arcs are signed sweeps in radians, positive counter-clockwise.
class Outline {
 public:
  Outline(double r, double z) { profile_.knots.push_back({r, z, 0.0}); }
  /// A straight segment; nothing if its length is zero.
  Outline& line_to(double r, double z);
  Outline& arc_to(double r, double z, double sweep);
  double r() const { return profile_.knots.back().r; }
  double z() const { return profile_.knots.back().z; }
  Profile take() { return std::move(profile_); }

 private:
  Profile profile_;
};

/// The profile of a shape, or the reason why there is none.
struct Cutting {
  ToolShape shape;             // with default dimensions filled in
  Profile cutting, neck;       // the non-cutting neck of the shape
  std::string error;           // not empty: the dimensions are inconsistent
  bool flute_assumed = false;  // usual_flute
  std::string warning;         // the flute ends before the cone reaches the diameter
};
/// Requires finite dimensions that are not negative, the required ones above 0.
Cutting cutting_of(const ToolShape& shape, Length neck_length);
/// Whether a shape of this kind cuts at its centre.
bool cuts_at_centre(const ToolShape& shape);
/// The fault of a drawn profile; empty if it is valid.
std::string fault_of(const Profile& profile);

}  // namespace kerf::detail
