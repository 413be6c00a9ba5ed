// Levelling: a toolpath follows a measured surface; corrected heights become numbers.
//
//   std::optional<HeightMap> map = HeightMap::make(points, where, diagnostics);
//   LevelReport report;
//   std::optional<Toolpath> levelled = level(path, *map, {.max_correction = mm(1)}, report, diagnostics);
//
// Coordinates are mm, work coordinates, Z up. A map has the height of the surface above its nominal height
// Z0, which is added to the heights of motions.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/origin.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// A surface through measured points. Points of a complete grid (within 0.05 mm): bilinear in each cell.
/// Other points: flat triangles (Delaunay). Points on one line: linear between neighbours. Outside of the
/// area the height is that of the nearest position of its boundary.
class HeightMap {
 public:
  /// Nothing, with an error, for no point, or more points than 5,000 that are no grid.
  static std::optional<HeightMap> make(std::vector<Point3> points, const Origin& where,
                                       Diagnostics& diagnostics);
  HeightMap(HeightMap&&) noexcept;
  HeightMap& operator=(HeightMap&&) noexcept;
  ~HeightMap();

  double at(Point2 p) const;
  /// Of the measured points.
  const Box2& bounds() const;
  /// The distance of a position from the bounds, mm; 0 inside.
  double distance_outside(Point2 p) const;
  /// Calls visit(a, b) for the lines near `box` where the surface may have an edge.
  void edges(const Box2& box, const std::function<void(Point2, Point2)>& visit) const;

 private:
  struct Body;
  explicit HeightMap(std::unique_ptr<Body> body);
  std::unique_ptr<Body> body_;
};

/// The points, by index, whose height differs from the plane through their eight neighbours by more than 0.05
/// mm and far more than those of the other points do: dirt under the probe, contact without the surface. None
/// of fewer than 9 points, or more than 5,000.
std::vector<std::size_t> outliers_of(const std::vector<Point3>& points);

struct LevelOptions {
  Length max_correction = mm(2);     // larger ones are an error
  Length tolerance = mm(0.004);      // of a motion from the surface; with rounding, cuts are within 0.01 mm
  std::optional<double> keep_above;  // mm: motions whose ends are at this Z or above stay
  std::size_t max_steps = 100'000'000;  // of the result
};

struct LevelReport {
  double lowest = 0.0, highest = 0.0;  // corrections of cuts, mm
  Point2 lowest_at, highest_at;
  std::size_t divided = 0;    // motions that became several
  std::size_t unchanged = 0;  // motions whose position is unknown in work coordinates
  double outside = 0.0;       // mm, the largest distance of a cut from the map's area
};

/// The text of a note at the start of a levelled program; posts write it as a comment, which readers keep.
inline constexpr std::string_view kLevelledMark = "heights follow a measured surface";

/// The same of a program whose heights were corrected by measured values.
inline constexpr std::string_view kCorrectedMark = "heights are corrected by measured values";
/// Whether a program has that note.
bool is_corrected(const Toolpath& path);

/// Straight motions are divided where the surface under them is not straight, arcs where it is not a plane or
/// helix; each part of an arc is an arc. Of a motion from an unknown position only the end is corrected.
/// Nothing, with an error, if a correction is too large, the program is levelled already or counts Z
/// downwards, or the path has rotary motions or formulas for heights.
std::optional<Toolpath> level(const Toolpath& path, const HeightMap& map, const LevelOptions& options,
                              LevelReport& report, Diagnostics& diagnostics, Progress* progress = nullptr);

/// Replaces heights that have a formula (MotionExtra::z_correction) by its value, with a note of it at the
/// start. Nothing, with an error, if a formula uses a variable without value.
std::optional<Toolpath> apply_heights(const Toolpath& path, const std::map<int, double>& values,
                                      Diagnostics& diagnostics);
/// Whether any height has a formula.
bool has_height_formulas(const Toolpath& path);

}  // namespace kerf
