// A path ready to be compiled: its operations in the order of travel, with all parameters, in mm of its
// drawing.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kerf/base/origin.h"
#include "kerf/geom/geometry.h"

namespace kerf::pathdxf {

/// To B, to D, or with support bars of height D in a cut to B.
enum class Depth : std::uint8_t { full, mark, bars };

/// Heights and depths of one milling operation; nothing: not specified anywhere.
struct MillingValues {
  Depth depth = Depth::full;
  double feed = 0.0;             // mm/min
  std::optional<double> b, d;    // mm, depths
  std::optional<double> infeed;  // mm
  double bar_length = 0.0;       // P, mm; with Depth::bars
  double bar_distance = 0.0;     // U, mm; with Depth::bars
  std::string comment;           // Q
};

struct MillSegment {
  bool is_arc = false;
  Point2 start, end;
  Point2 centre;             // of arcs
  double radius = 0.0;       // of arcs
  double start_angle = 0.0;  // radians, of arcs
  double turn = 0.0;         // radians, of arcs: above 0 counter-clockwise
  MillingValues values;
  std::optional<double> sweep_height;  // of travel to this segment
  Origin where;
};

/// Along the cut, mm.
inline double length_of(const MillSegment& s) {
  return s.is_arc ? std::abs(s.turn) * s.radius : distance(s.start, s.end);
}

struct Chain {
  std::vector<MillSegment> segments;
  std::optional<double> infeed;       // I
  std::optional<double> first_depth;  // W: sweepless milling
};
struct Drill {
  Point2 at;
  MillingValues values;
  std::optional<double> cycle_from;  // C: height to which the tool returns at once
};
struct Helix {
  Point2 centre;
  double radius = 0.0;  // of the outer edge
  MillingValues values;
};
struct Sweep {
  Point2 to;
  std::optional<double> height;  // S; nothing: that of the path
};
struct Path;
struct Embedding {
  std::shared_ptr<const Path> path;
  Point2 start, end;   // of the embedded path, in this one
  double raise = 0.0;  // H
};

struct Operation {
  std::variant<Chain, Drill, Helix, Sweep, Embedding> what;
  Origin where;
};

struct Probe {
  Point2 at;
  double thickness = 0.0;  // T
  double raise = 0.0;      // H
  double feed = 0.0;       // Z
  std::string label;       // L
  Origin where;
};

struct Path {
  std::string name, name_in_file;
  Origin where;          // of its start marker
  double tool = 0.0;     // O, mm
  double top = 0.0;      // T, mm
  double highest = 0.0;  // mm, the highest T, with H, of this path and those embedded in it
  double sweep = 0.0;    // S, mm
  double feed = 0.0;     // mm/min
  std::string material, suffix;
  Point2 start, end;
  std::vector<Operation> operations;
  std::vector<Probe> probes;
  int nesting = 0;          // levels of embedded paths
  bool has_probes = false;  // own ones, or of embedded paths
};

}  // namespace kerf::pathdxf
