// The material of a print in a square of columns: runs that grow by union. And the pieces that are laid:
// roads, the round wedges of their corners and ends, and travels, which lay nothing but may hit something.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "sim/print/roads.h"

namespace kerf::printing {

inline constexpr int kTileSide = 64;  // columns along a tile's edge
inline constexpr std::uint32_t kNoNode = 0xffffffffu;
/// Columns stand at (k + kShift) * pitch along X and Y: a place that no round number hits, so that no column
/// stands on the line in which two roads meet.
inline constexpr double kShift = 0.381966;

/// How the columns of a print stand.
struct Frame {
  double x = 0.0, y = 0.0;  // mm, of column 0, 0
  double bed = 0.0;         // Z
  double pitch = 0.0;       // mm
  int nx = 0, ny = 0;
  float touch = 0.0f;  // runs no farther apart than this are one: what rounding leaves
};

/// What a piece does in its columns.
enum class PieceKind : std::uint8_t { road, wedge, travel };

/// Coordinates are relative to column 0, 0 and the bed.
struct BeadPiece {
  PieceKind kind = PieceKind::road;
  std::uint32_t step = 0, layer = 0;
  std::uint32_t road = 0;         // number in its batch
  std::uint32_t chain_begin = 0;  // step of the first road of its chain
  Point2 from;                    // mm, of the middle line; the middle of a wedge
  Point2 along;                   // unit vector
  double length = 0.0;            // mm
  double begin = 0.0;             // mm of its move that other pieces make before it
  double z = 0.0, slope = 0.0;    // the nozzle at `from`, and its rise for each mm
  double flat = 0.0;              // half the width of the section's rectangle
  double round = 0.0;             // half the section's height
  // A wedge is where after.p >= 0 and before.p <= 0, p counted from its middle; a zero vector bounds nothing.
  Point2 after, before;

  double reach() const { return flat + round; }  // from the middle line, of a road or wedge
};

/// What laying the pieces of a tile counted, by piece. Heights add up columns.
struct Sums {
  double full = 0.0;                   // height of the piece, all of it
  double covered = 0.0;                // of this, where there was material already, or below the bed
  std::uint32_t middle = 0, bare = 0;  // columns of the middle line; of these, with nothing below
  bool held = false;                   // by what lies below, or by another chain's material
};

/// Where the nozzle goes through material.
struct NozzleContact {
  std::uint32_t step = 0;
  double way = 0.0;    // mm from the move's begin, of the first contact
  Point3 at;           // there, relative to the frame
  double depth = 0.0;  // mm, the largest
};

class PrintTile {
 public:
  struct MaterialRun {
    float low, high;  // mm above the bed
    std::uint32_t low_step, high_step;
    std::uint32_t below;  // the next run down, kNoNode for none
  };

  PrintTile(const Frame& frame, int tile_x, int tile_y);

  /// Lays a road or wedge, or tests a travel; `contact_depth` as in PrintOptions.
  void add(const BeadPiece& piece, double contact_depth, Sums& sums, std::vector<NozzleContact>& contacts);

  /// Appends the runs of a column, lowest first.
  void intervals(int column, std::vector<Interval>& out) const;
  std::size_t runs() const { return used_; }
  /// True once a column held more runs than are walked past; what followed there was not laid.
  bool too_deep() const { return too_deep_; }

 private:
  struct Laid {
    float covered = 0.0f;
    bool rests = false;                                                // on something below
    std::uint32_t oldest = std::numeric_limits<std::uint32_t>::max();  // step of what it met
  };
  /// The road's bottom, and how far up what lies below must come to support it.
  struct Support {
    float bottom, reach;
  };
  template <class Visit>
  void for_each_column(const BeadPiece& piece, double reach, const Visit& visit) const;
  template <class Visit>
  void for_each_wedge_column(const BeadPiece& piece, const Visit& visit) const;
  void lay_road(const BeadPiece& piece, double contact_depth, Sums& sums,
                std::vector<NozzleContact>& contacts);
  void lay_wedge(const BeadPiece& piece, Sums& sums);
  void travel(const BeadPiece& piece, double contact_depth, std::vector<NozzleContact>& contacts);
  Laid lay_section(const BeadPiece& piece, int column, double nozzle, double aside, Sums& sums);
  Laid lay(int column, float low, float high, std::uint32_t step, Support under);
  std::uint32_t find_above(int column, float height);
  void insert(std::uint32_t above, int column, const MaterialRun& node);
  void take_out(std::uint32_t above, int column, std::uint32_t node);
  std::uint32_t& link(std::uint32_t above, int column) {
    return above == kNoNode ? heads_[static_cast<std::size_t>(column)] : nodes_[above].below;
  }
  double height_over(int column) const {  // of the highest material over the bed
    const std::uint32_t head = heads_[static_cast<std::size_t>(column)];
    return head == kNoNode ? 0.0 : static_cast<double>(nodes_[head].high);
  }

  double pitch_;
  float touch_;
  int first_x_, first_y_, columns_x_, columns_y_;
  std::vector<std::uint32_t> heads_;  // the highest run of each column
  std::vector<MaterialRun> nodes_;
  std::uint32_t free_ = kNoNode;  // nodes that are not used, chained by `below`
  std::size_t used_ = 0;
  double top_ = 0.0;  // of all columns
  bool too_deep_ = false;
};

}  // namespace kerf::printing
