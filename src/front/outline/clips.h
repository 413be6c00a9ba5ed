// What the clips of an SVG leave of outlines.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "front/outline/entity_shapes.h"

#include "kerf/geom/region.h"

namespace kerf::outline_front {

class Clips {
 public:
  Clips(const dxf::Drawing& drawing, ShapeConverter& maker, RegionOptions options, Diagnostics& diagnostics)
      : drawing_(drawing), maker_(maker), options_(std::move(options)), diagnostics_(diagnostics) {}

  /// Whether an outline lies in the area of a clip as a whole.
  bool holds(std::uint32_t clip, const Outline& outline);
  /// What a figure, filled by a rule, shows; nothing after an error.
  std::optional<Region> area(std::uint32_t clip, const std::vector<PaintedOutline>& figure);
  /// The pieces of a line in the area.
  std::optional<std::vector<Outline>> pieces(std::uint32_t clip, const Outline& line);

 private:
  /// Of a clip and those around it; null after an error.
  const Region* region(std::uint32_t clip);
  std::optional<Region> own_region(const dxf::Clip& clip);

  const dxf::Drawing& drawing_;
  ShapeConverter& maker_;
  const RegionOptions options_;
  Diagnostics& diagnostics_;
  std::map<std::uint32_t, std::optional<Region>> regions_;
};

}  // namespace kerf::outline_front
