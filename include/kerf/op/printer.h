// Printing: layers of beads with walls, fills, brims, vases, ironing, and the travel between them.
//
//   Printer printer({.width = mm(0.45), .height = mm(0.2), .speed = mm_per_min(3000)}, diagnostics);
//   printer.start({.nozzle = 210, .bed = 60});
//   for (int i = 0; i < 10; ++i) {
//     printer.next_layer();
//     const auto inside = printer.walls(region, 2);
//     if (inside) printer.fill(*inside, {.angle = degrees(i % 2 == 0 ? 45 : 135)});
//   }
//   printer.finish();
//   const Toolpath path = printer.take();
//
// Frame: work coordinates, mm, Z0 is the bed. Beads have the cross-section of path/bead.h. Neighbouring beads
// of walls and solid fills are `width - side_overlap * height` apart: with 0 their round sides touch; with
// 0.2146 (1 - pi/4) the volume of the gaps between the round sides equals what overlaps, as in slicers.
//
// Errors (codes 10001 to 10006) go to Diagnostics: settings out of range, numbers that are not finite, empty
// regions, too many steps. A call with an error adds no step.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/geom/region.h"
#include "kerf/path/check.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// Appends a run of axes (bits 1, 2, 4 for X, Y, Z) to their end switches; their positions are unknown then.
void add_home(Toolpath& path, unsigned axes, OriginId origin);
/// Appends steps that switch off the fans and heaters that are on at the end of a path.
void switch_off(Toolpath& path, OriginId origin);

/// Where closed walls start and end.
enum class Seam : std::uint8_t {
  nearest,  ///< at the point nearest to the nozzle
  rear      ///< at the point with the largest Y, of several the one with the smallest X: a line up the back
};

struct PrinterSettings {
  Length width = mm(0.45), height = mm(0.2);  ///< of beads; width >= height > 0
  Length filament = mm(1.75);                 ///< diameter
  Feed speed = mm_per_min(3000);              ///< of beads
  Feed first_layer_speed{};                   ///< 0: `speed`
  Feed travel_speed = mm_per_min(9000);
  VolumeFlow max_flow{};       ///< of the hot end; beads that need more are slower. 0: no limit
  double flow = 1.0;           ///< factor of all extruded volumes, (0, 2]
  double side_overlap = 0.08;  ///< of neighbouring beads, as a fraction of the height, [0, 0.5]
  Length retract = mm(0.8);    ///< filament drawn back before a travel of `min_travel` or more; 0: none
  Feed retract_speed = mm_per_min(2400);
  Length min_travel = mm(1.5);
  Length hop{};   ///< by which the nozzle rises for such a travel
  Length wipe{};  ///< length of the way back along the bead, over which the filament is drawn back
  Seam seam = Seam::nearest;
  Length chord = mm(0.01);  ///< of the straight beads that arcs are printed as
  std::size_t max_steps = limits::kMaxGeneratedSteps;
};

struct PrintStart {
  double nozzle = 0.0, bed = 0.0;  ///< C; 0: not heated
  double lift = 5.0;               ///< Z after homing
};
struct PrintFinish {
  double lift = 10.0;  ///< by which the nozzle rises at the end, mm
};

enum class FillPattern : std::uint8_t {
  zigzag,     ///< parallel beads in alternating directions
  concentric  ///< rings parallel to the boundary
};
struct FillOptions {
  FillPattern pattern = FillPattern::zigzag;
  Angle angle{};                   ///< of the beads of a zigzag, from +x
  double density = 1.0;            ///< of the beads, (0, 1]; 1 is solid
  BeadKind kind = BeadKind::none;  ///< none: solid_infill or infill
  Feed speed{};                    ///< 0: that of the settings
};
struct IroningOptions {
  Length spacing = mm(0.1);
  Angle angle{};
  double flow = 0.0;  ///< extruded, as a fraction of what fills a layer between the rows; 0: nothing
  Feed speed = mm_per_min(1200);
};
struct BeadOptions {
  BeadKind kind = BeadKind::none;
  Length width{};  ///< 0: that of the settings
  Feed speed{};    ///< likewise
};

/// A row of a fill.
struct FillRow {
  Point2 from, to;
  std::size_t row = 0;
};

/// Makes the steps of a print. The state (position, layer, filament drawn back) is that after the last call.
class Printer {
 public:
  /// With errors in the settings all calls do nothing.
  Printer(const PrinterSettings& settings, Diagnostics& diagnostics, const Origin& where = {});

  const PrinterSettings& settings() const { return settings_; }
  bool valid() const { return valid_; }
  /// The origin of the steps and messages from here on.
  void set_origin(const Origin& where);
  /// The top of the present layer; 0 before the first.
  double z() const { return z_; }
  Length height() const { return height_; }
  /// Distance of neighbouring beads.
  Length spacing() const;
  /// Volume of beads so far, without filament drawn back and returned.
  Volume printed() const { return mm3(printed_); }

  /// Heats the bed and the nozzle, runs the axes to their end switches, and lifts the nozzle.
  void start(const PrintStart& start);
  /// Draws the filament back, lifts the nozzle, switches heaters and fan off.
  void finish(const PrintFinish& finish = {});
  /// A layer above the last one; nothing: of the height of the settings. False with an error.
  bool next_layer(std::optional<Length> height = {});

  /// To a point of the layer without printing, with the rules of the settings.
  bool travel(Point2 to);
  /// A bead along a path, with a travel to its start. A closed one starts at the seam.
  bool bead(const Outline& path, const BeadOptions& options = {});
  /// Walls inside of a region, whose boundary is the outside of the part; the outermost is the first. Returns
  /// the region that is left inside; a wall that is too wide for a part of the region is a warning.
  std::optional<Region> walls(const Region& region, int count);
  /// Fills a region up to its boundary. Returns the part that beads are too wide for: nothing, except of
  /// concentric fills.
  std::optional<Region> fill(const Region& region, const FillOptions& options = {});
  /// `loops` beads around a region from the outside to the inside, the last one `gap` beside it.
  bool brim(const Region& region, int loops, Length gap = {});
  /// A wall along a closed path (the centre of the bead), rising without a seam from the present layer, which
  /// has to be printed there, to `top`. The first turn grows from nothing, the last one ends level.
  bool vase(const Outline& path, double top);
  /// Runs over a region at the height of the layer, to smooth it.
  bool iron(const Region& region, const IroningOptions& options = {});

  /// Other steps between those of the printer, such as fans. They must not move the nozzle.
  Toolpath& path() { return path_; }
  Toolpath take() { return std::move(path_); }

 private:
  bool expect(double value, bool holds, const char* what, const char* rule);
  void check_settings();
  void check_speeds();
  bool usable(const char* call) const;
  bool room(std::size_t steps);
  RegionOptions region_options() const;
  double filament_area() const;
  Feed bead_feed(Feed speed, double area) const;
  void move(Point3 to, Feed feed);
  void draw_back();
  void push_back();
  void lay(Point3 to, double width, double height, double volume, Feed feed, BeadKind kind);
  bool lay_along(const std::vector<Point2>& points, const BeadOptions& options);
  std::vector<Point2> from_seam(std::vector<Point2> points) const;
  bool lay_loops(std::vector<Outline> loops, const BeadOptions& options);
  std::optional<Region> shrunk(const Region& region, double by);
  std::optional<Region> fill_rings(const Region& region, const FillOptions& options);
  std::optional<Region> fill_rows(const Region& region, const FillOptions& options);
  std::vector<FillRow> in_order(std::vector<FillRow> lines) const;
  template <class Lay>
  bool run_rows(const Region& region, Angle angle, double spacing, Lay lay_row);

  PrinterSettings settings_;
  Diagnostics& diagnostics_;
  Origin where_;
  OriginId origin_ = OriginId::none;
  Toolpath path_;
  Point3 at_;
  bool known_ = false;  // the position
  bool valid_ = true, first_layer_ = true;
  double z_ = 0.0, drawn_back_ = 0.0, printed_ = 0.0;  // mm, mm of filament, mm3
  Length height_;
  std::vector<Point2> last_;  // points of the last chain of beads, for wiping
};

}  // namespace kerf
