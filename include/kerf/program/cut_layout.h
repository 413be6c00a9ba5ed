// The layout of the shapes of a cutting job: mirrored, turned, scaled, repeated in a grid, then moved so that
// work zero is where the job wants it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/op/rows.h"
#include "kerf/stock/stock.h"

namespace kerf {

struct ArtShape;  // program/cut_job.h

/// Which axis changes its sign.
enum class ArtMirror : std::uint8_t { none, x, y };

struct CutLayout {
  ArtMirror mirror = ArtMirror::none;
  Angle rotate{};
  double scale = 1.0;
  Length fit_width{}, fit_height{};  ///< of all copies together; 0: not fitted. With both the smaller scale
  int columns = 1, rows = 1;
  Length gap{};     ///< between copies
  Length margin{};  ///< around the shapes
  /// The point of the box around the shapes and the margin that becomes work zero; nothing: the drawing's
  /// own, or `zero`.
  std::optional<ZeroCorner> origin;
  std::optional<Point2> zero;  ///< the point of the drawing that becomes work zero
  Point2 move{};               ///< at last
  Length thickness{};          ///< of a block below the shapes and their margin; 0: none
};
using CutLayoutKey = CutKeyOf<CutLayout>;
/// Keys of a job, and options of the command.
const std::vector<CutLayoutKey>& cut_layout_keys();

/// Lays out the shapes. Nothing, with an error, if they cannot be laid out so; else the box around them and
/// the margin.
std::optional<Box2> lay_out(const CutLayout& layout, std::vector<ArtShape>& shapes, const Origin& where,
                            Diagnostics& diagnostics);

}  // namespace kerf
