// What both drawings are made of: straight pieces and arcs in the drawing's unit, layer by layer.
#pragma once

#include <string>
#include <vector>

#include "kerf/gcmc_drawing.h"
#include "kerf/geometry.h"
#include "kerf/toolpath.h"

namespace kerf::gcmc_drawing {

struct Piece {
  enum class Kind : std::uint8_t { rapid, line, arc, close };
  Kind kind = Kind::line;
  Point3 from, to;  // drawing's unit
  Point2 centre;    // arcs
  Turn turn = Turn::ccw;
  bool full_circle = false;
  std::size_t layer = 0;
  bool joined = false;  // begins where the piece before it in the toolpath ended, both cut or both rapid
};

struct Drawing {
  std::vector<Piece> pieces;
  std::vector<std::string> layers;  // layers[0] is what no layer was set for
  bool uses_no_layer = false;       // something is on layers[0]
};

Drawing drawing_of(const Toolpath& path, const GcmcDrawingOptions& options);

}  // namespace kerf::gcmc_drawing
