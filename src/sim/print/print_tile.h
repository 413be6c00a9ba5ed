// The material of a print in a square of columns: runs that grow by union. And the pieces that are laid:
// beads, the round wedges of their corners and ends; and travels, which lay nothing but may hit material.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim/print/beads.h"

namespace kerf::printing {

inline constexpr int kTileSide = 64;  // columns along a tile's edge
inline constexpr std::uint32_t kNoRun = 0xffffffffu;
/// Columns are at (k + kShift) * pitch in X and Y: off all round numbers, so that no column lies on the
/// line between two beads.
inline constexpr double kShift = 0.381966;

/// Positions of columns: on the grid, or each moved off it by less than half the pitch, so that beads along X
/// or Y meet them at all distances from their centre lines, and sums over them are right for such beads too.
enum class ColumnPositions : std::uint8_t { on_grid, spread };

/// The grid of columns of a print.
struct Frame {
  double x = 0.0, y = 0.0;  // mm, of column 0, 0
  double bed = 0.0;         // Z
  double pitch = 0.0;       // mm
  int nx = 0, ny = 0;
  float touch = 0.0f;  // closer runs are joined: rounding
  ColumnPositions positions = ColumnPositions::on_grid;
};

/// The kind of a piece.
enum class PieceKind : std::uint8_t { bead, wedge, travel };

/// Coordinates are relative to column 0, 0 and the bed.
struct BeadPiece {
  PieceKind kind = PieceKind::bead;
  std::uint32_t step = 0, layer = 0;
  std::uint32_t bead = 0;         // number in its batch
  std::uint32_t chain_start = 0;  // step of the first bead of its chain
  Point2 from;                    // mm, of the centre line; the centre of a wedge
  Point2 along;                   // unit vector
  double length = 0.0;            // mm
  double travelled = 0.0;         // mm of the motion before this piece
  double z = 0.0, slope = 0.0;    // nozzle at `from`, and its rise per mm
  double flat = 0.0;              // half the width of the section's rectangle
  double round = 0.0;             // half the section's height
  // A wedge is the set of p, relative to its centre, with after.p >= 0 and before.p <= 0; a zero vector clips
  // nothing.
  Point2 after, before;

  double reach() const { return flat + round; }  // from the centre line of a bead or the centre of a wedge
};

/// Sums of laying a piece in a tile, over columns.
struct PieceSums {
  double full = 0.0;                   // height of the piece
  double covered = 0.0;                // of this, in existing material or below the bed
  std::uint32_t centre = 0, bare = 0;  // columns of the centre line; those with nothing below
  bool supported = false;              // by material below or near below, or by that of another chain
};

/// A contact of the nozzle with material.
struct NozzleContact {
  std::uint32_t step = 0;
  double distance = 0.0;  // mm from the start of the motion to the first contact
  Point3 at;              // position of the first contact, relative to the frame
  double depth = 0.0;     // mm, maximum
};

/// By row and column of a tile: how far its columns are moved in X and in Y, in pitches.
using TileOffsets = std::array<double, kTileSide>;

class PrintTile {
 public:
  struct MaterialRun {
    float low, high;  // mm above the bed
    std::uint32_t low_step, high_step;
    std::uint32_t below;  // the next run below, kNoRun for none
  };

  PrintTile(const Frame& frame, int tile_x, int tile_y);

  /// Lays a bead or wedge, or tests a travel; `contact_depth` as in PrintOptions.
  void add(const BeadPiece& piece, double contact_depth, PieceSums& sums,
           std::vector<NozzleContact>& contacts);

  /// Appends the runs of a column, lowest first.
  void intervals(int column, std::vector<Interval>& out) const;
  /// Position of a column, relative to column 0, 0 of the frame.
  Point2 position(int column) const {
    const int i = column % kTileSide, j = column / kTileSide;
    return {(first_x_ + i + offset(j)) * pitch_, (first_y_ + j + offset(i)) * pitch_};
  }
  std::size_t runs() const { return used_; }
  /// True if a column exceeded the maximum number of runs; nothing was laid in it afterwards.
  bool too_deep() const { return too_deep_; }

 private:
  struct Laid {
    float covered = 0.0f;
    bool supported = false;                                            // by material below
    bool lies_near = false;                                            // over material: see Support
    std::uint32_t oldest = std::numeric_limits<std::uint32_t>::max();  // step of the oldest material touched
  };
  /// The bottom of the bead; the height that material below must reach to support it; and the height from
  /// which on the bead sags onto the material, as onto the support structures that slicers print a layer
  /// below.
  struct Support {
    float bottom, reach, near;
  };
  template <class Visit>
  void for_each_column(const BeadPiece& piece, double reach, const Visit& visit) const;
  template <class Visit>
  void for_each_wedge_column(const BeadPiece& piece, const Visit& visit) const;
  void lay_bead(const BeadPiece& piece, double contact_depth, PieceSums& sums,
                std::vector<NozzleContact>& contacts);
  void lay_wedge(const BeadPiece& piece, PieceSums& sums);
  void travel(const BeadPiece& piece, double contact_depth, std::vector<NozzleContact>& contacts);
  Laid lay_section(const BeadPiece& piece, int column, double nozzle, double aside, PieceSums& sums);
  Laid lay(int column, float low, float high, std::uint32_t step, Support under);
  std::uint32_t find_above(int column, float height);
  void insert(std::uint32_t above, int column, const MaterialRun& node);
  void remove(std::uint32_t above, int column, std::uint32_t node);
  std::uint32_t& link(std::uint32_t above, int column) {
    return above == kNoRun ? heads_[static_cast<std::size_t>(column)] : runs_[above].below;
  }
  double height_over(int column) const {  // height of the material above the bed
    const std::uint32_t head = heads_[static_cast<std::size_t>(column)];
    return head == kNoRun ? 0.0 : static_cast<double>(runs_[head].high);
  }

  static const TileOffsets& offsets_of(ColumnPositions positions);
  double offset(int row) const { return offsets_[static_cast<std::size_t>(row)]; }

  double pitch_;
  float touch_;
  double spread_;  // mm; maximum distance of a column from its position on the grid, in X and Y
  const TileOffsets& offsets_;
  int first_x_, first_y_, columns_x_, columns_y_;
  std::vector<std::uint32_t> heads_;  // the highest run of each column
  std::vector<MaterialRun> runs_;
  std::uint32_t free_ = kNoRun;  // free runs, linked by `below`
  std::size_t used_ = 0;
  double top_ = 0.0;  // of all columns
  bool too_deep_ = false;
};

}  // namespace kerf::printing
