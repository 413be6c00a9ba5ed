// The light on the surfaces of a picture: a key light with shadows, a fill light, and the sky.
#pragma once

#include <array>
#include <cstdint>

#include "sim/render/samples.h"
#include "sim/render/srgb.h"

#include "kerf/sim/render.h"

namespace kerf::rendering {

/// A colour that depends on how much of the sky nearby surfaces hide.
struct Tone {
  Colour open;  // all of the sky is visible
  Colour loss;  // what is missing where nothing of it is
};
inline Tone operator+(const Tone& a, const Tone& b) { return {a.open + b.open, a.loss + b.loss}; }
inline Tone operator*(double k, const Tone& a) { return {k * a.open, k * a.loss}; }

class Lights {
 public:
  Lights(const Scene& scene, const View& view);
  /// Without it there are no shadows.
  void draw_shadows();
  Colour background(int sample_row) const;
  /// Of a sample, or of a point near it with a normal.
  Tone tone(const Sample& sample, double x, double y) const;
  Tone tone(std::uint32_t triangle, double depth, Point3 normal, double x, double y) const;

 private:
  double lit_fraction(Point3 p, Point3 normal) const;

  const Scene& scene_;
  const Srgb srgb_;
  const Colour sky_top_, sky_low_, section_colour_;
  Projection sun_;
  Point3 light_, fill_, half_;  // half_: of a mirror that reflects the sun towards the viewer
  Target shadow_;
};

}  // namespace kerf::rendering
