// Pictures of meshes.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/sim/mesh.h"

namespace kerf {

/// A section of the part in a picture: everything on the viewer's side of a plane is omitted, and the cut
/// face of the material is drawn in kSectionColour, without shading.
struct Section {
  Plane plane = Plane::yz;  // the section is parallel to it
  double at = 0.0;          // mm along the third axis, work coordinates
};
inline constexpr std::array<std::uint8_t, 3> kSectionColour{247, 226, 92};  // sRGB

/// What a picture shows besides the part: see kerf/job/outputs.h.
struct PictureMarks {
  bool axes = false;    // X, Y and Z from the work zero
  bool size = false;    // of what the picture shows
  bool legend = false;  // of its colours
  bool inches = false;  // of the sizes
  bool any() const { return axes || size || legend; }
};
/// The marks that can be asked for, by their names.
struct PictureMarkName {
  std::string_view name;
  bool PictureMarks::*member;
};
inline constexpr std::array<PictureMarkName, 3> kPictureMarks{
    {{"axes", &PictureMarks::axes}, {"size", &PictureMarks::size}, {"legend", &PictureMarks::legend}}};

/// The direction from which a picture is taken, its size, and its section.
struct View {
  Angle azimuth = degrees(-35);     // about Z; 0: from the front, along +Y
  Angle elevation = degrees(50);    // above the horizon; 90: from above
  int width = 1600, height = 1000;  // pixels
  std::optional<Section> section = {};
  PictureMarks marks = {};
  std::vector<Point3> room = {};  // points that are within the picture too
};
/// Unit vectors of a picture; `into` leads away from the viewer.
struct PictureAxes {
  Point3 right, up, into;
};
PictureAxes picture_axes(const View& view);
/// Whether the cut face of a section is visible: false in a view along its plane.
bool faces(const View& view, const Section& section);
/// The view "top", "bottom", "front", "back", "left", "right" or "iso"; nothing for other names.
std::optional<View> named_view(std::string_view name);

/// A line over a picture, drawn regardless of what is in front of it. Thin lines are below the others.
struct PictureLine {
  Point3 from, to;  // mm
  std::array<std::uint8_t, 3> colour{};
  bool is_thin = false;
  bool on_picture = false;  // x and y are pixels from the upper left corner
};
/// Calls its argument for each line.
using PictureLines = std::function<void(const std::function<void(const PictureLine&)>&)>;

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top
};
/// Draws a shaded mesh scaled to fill the picture, with vertices that no triangle uses. `colours`: one sRGB
/// colour per triangle, grey where missing. Width and height are clamped to 1 to 8192 pixels.
Image render(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view,
             const PictureLines& lines = {});

}  // namespace kerf
