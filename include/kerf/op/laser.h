// Laser operations: lines, cuts beside the width of the beam, fills and pictures by scan lines, test grids,
// frames.
//
//   const LaserOptions slow{.power = 0.8, .feed = mm_per_min(600), .passes = 2};
//   const auto cut = laser_cut(part, {.laser = slow, .kerf = mm(0.15)}, diagnostics);
//   append(path, cut->path);
//
// Frame: work coordinates, mm. No operation moves Z: its steps have an unknown Z, and the focus is where the
// user has set it. The beam has power 0 in each rapid and is switched off at the end, so that programs do the
// same with and without GRBL's laser mode.
//
// Errors (codes 10xxx) go to Diagnostics, as in operation.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/limits.h"
#include "kerf/op/operation.h"

namespace kerf {

struct LaserOptions {
  double power = 1.0;                   ///< fraction of full power, [0, 1]
  double full_s = 1000.0;               ///< the S word of full power ($30 in GRBL)
  LaserMode mode = LaserMode::dynamic;  ///< M4: the controller scales the power with the speed; or M3
  Feed feed{};                          ///< > 0
  int passes = 1;
  Tolerance tolerance{};
  std::size_t max_steps = limits::kMaxGeneratedSteps;
  std::string name{};            ///< of the operation, in messages
  Origin where{};                ///< of the steps and messages
  Progress* progress = nullptr;  ///< may stop the work: then there is no value, and no error
};

/// The beam follows outlines, open or closed, the inner ones first; all passes of one before the next.
std::optional<Operation> laser_lines(const std::vector<Outline>& outlines, const LaserOptions& options,
                                     Diagnostics& diagnostics);

struct LaserCutOptions {
  LaserOptions laser{};
  Length kerf{};                            ///< width of the slot that the beam leaves
  ContourSide side = ContourSide::outside;  ///< outside: the region remains; inside: it is cut out
  Lead lead_in{}, lead_out{};               ///< in what falls off; left out where they do not fit
  Length overlap{};                         ///< how far the beam continues beyond its start
};
/// Along the boundary of a region, half a kerf beside it; holes before what surrounds them. Parts that are
/// narrower than the kerf are a warning, or an error where nothing is left.
std::optional<Operation> laser_cut(const Region& region, const LaserCutOptions& options,
                                   Diagnostics& diagnostics);

/// Of the scan lines of fills and pictures.
struct ScanOptions {
  Length interval = mm(0.1);  ///< distance of the lines, > 0; of a picture also the size of a pixel
  /// How far the beam moves on with power 0 beyond both ends of a line, where the axes accelerate.
  Length overscan = mm(2);
  bool one_way = false;  ///< all lines in one direction, not alternately in both
};

/// All of a region by parallel lines at `angle` from +x.
std::optional<Operation> laser_fill(const Region& region, Angle angle, const ScanOptions& scan,
                                    const LaserOptions& options, Diagnostics& diagnostics);

/// Pixels in rows from the top; 0 is black, 255 white.
struct GreyPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;
};
/// A picture with its position and width on the board.
struct PlacedPicture {
  GreyPicture picture;
  Point2 at;  ///< lower left corner, mm
  Length width;
};
enum class PictureTones : std::uint8_t {
  grey,   ///< the power is that of the pixel
  dither  ///< points at full power, whose density is the darkness (error diffusion)
};
struct LaserPictureOptions {
  LaserOptions laser{};  ///< the power of black
  ScanOptions scan{};
  Point2 at{};     ///< lower left corner, mm
  Length width{};  ///< on the board, > 0; pixels are square
  PictureTones tones = PictureTones::grey;
  double min_power = 0.0;  ///< of the lightest tone that is not white; a fraction as `power`
  double gamma = 1.0;      ///< the darkness, from 0 to 1, is raised to this power
  bool negative = false;   ///< white is burnt instead of black
};
/// A picture by horizontal lines from the bottom to the top. White pixels are not burnt.
std::optional<Operation> laser_picture(const GreyPicture& picture, const LaserPictureOptions& options,
                                       Diagnostics& diagnostics);

/// Cells in rows of one feed and columns of one power.
struct LaserTestOptions {
  LaserOptions laser{};  ///< power and feed are those of the labels
  ScanOptions scan{};
  Point2 at{};                   ///< lower left corner, mm
  std::vector<double> powers{};  ///< of the columns, from the left
  std::vector<Feed> feeds{};     ///< of the rows, from the top
  Length cell_width = mm(10);
  Length cell_height{};   ///< 0: a cell is a single line
  Length gap = mm(4);     ///< between cells
  Length label_height{};  ///< of the feeds on the left and the powers (%) below; 0: none
};
/// A test grid, from the top row down, each row from the left.
std::optional<Operation> laser_test(const LaserTestOptions& options, Diagnostics& diagnostics);

/// Around a box, to show where the work will be. With power 0 the beam stays off.
std::optional<Operation> laser_frame(const Box2& box, const LaserOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
