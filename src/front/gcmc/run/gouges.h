// Where the tool of tracepath_comp() comes nearer to the path than its radius: what it cuts into.
//
// tracepath_comp() looks one corner ahead, as the real program does, and so enters and leaves inside corners
// and passages that are narrower than the tool. Its motions are recorded and compared with the whole path.
#pragma once

#include <vector>

#include "geom/base/line_arc.h"

namespace kerf::gcmc {

/// A compensated path while it is cut; lengths in native units.
struct CompensatedTrace {
  std::vector<Point2> path;  // its corners
  bool closed = false;
  double width = 0.0;            // the distance that the tool's centre keeps
  std::vector<LineArc> motions;  // of the centre, without rapids
};

struct Gouge {
  std::size_t corner = 0;  // the nearest corner of the path
  Point2 at;               // on the path, where the tool cuts deepest
  double depth = 0.0;      // the width less the distance of the centre
};

/// The deepest gouge at each corner, in the order of the path.
std::vector<Gouge> find_gouges(const CompensatedTrace& trace);

}  // namespace kerf::gcmc
