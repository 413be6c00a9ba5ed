// The drawing that the dxf... commands make: lines, arcs, circles and polylines on layers.
#pragma once

#include <string>
#include <vector>

#include "kerf/drawing/drawing_files.h"
#include "kerf/geom/outline.h"

namespace kerf::design {

class Sketch {
 public:
  using Entity = decltype(DrawingEntity::shape);

  void add(const std::string& layer, int colour, Entity entity);
  bool empty() const { return entities_.empty(); }

  /// Whether lines and arcs that meet end to end become polylines.
  enum class Chains { joined, loose };
  /// The drawing in mm; the entities of a colour are shifted by its index times `stagger`.
  Drawing drawing(Chains chains, Point2 stagger = {}) const;

 private:
  struct Layer {
    std::string name;
    int colour = 7;
  };
  std::vector<Layer> layers_;            // in the order of their first entity
  std::vector<DrawingEntity> entities_;  // `layer` is an index into layers_
};

/// The vertices of a closed outline as those of a closed polyline.
drawing::Polyline polyline_of(const Outline& outline);
/// An open or closed outline of a polyline.
Outline outline_of(const drawing::Polyline& polyline);

}  // namespace kerf::design
