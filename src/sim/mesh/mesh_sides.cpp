// The plain parts of the block's sides: strips between the vertices of the upper and the lower cap. A strip
// ends at the sides of squares, so that the mesh of some of them has the triangles of the whole.
#include <algorithm>
#include <array>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {

/// Two columns have one interval each, the same one, and may be covered by one triangle.
bool BlockSides::are_alike(int i, int j, int other_i, int other_j) const {
  std::array<Interval, 2> one;
  const Runs a = columns_.runs(i, j, one[0]), b = columns_.runs(other_i, other_j, one[1]);
  const auto key = [this](std::uint32_t step) {
    return options_.tolerance > Length() ? group_key(options_, step) : step;
  };
  return a.size() == 1 && b.size() == 1 && a[0].low == b[0].low && a[0].high == b[0].high &&
         key(a[0].low_step) == key(b[0].low_step) && key(a[0].high_step) == key(b[0].high_step);
}

/// A corner is plain if the columns beside it are alike, and those behind them, so that no slope changes its
/// height. At the block's corner there is one column only.
BlockSides::BlockSides(const Columns& columns, const MeshOptions& options)
    : columns_(columns), options_(options) {
  const int nx = columns.nx(), ny = columns.ny();
  const auto find = [](int count, const auto& test) {
    Side side(static_cast<std::size_t>(count) + 1, 0);
    for (int k = 0; k <= count; ++k)
      side[static_cast<std::size_t>(k)] =
          test(std::max(k - 1, 0), std::min(k, count - 1)) ? std::uint8_t{1} : std::uint8_t{0};
    return side;
  };
  const auto of_row = [&](int j, int behind) {
    return find(nx, [&, j, behind](int before, int after) {
      return are_alike(before, j, after, j) && are_alike(before, j, before, behind) &&
             are_alike(after, j, after, behind);
    });
  };
  const auto of_column = [&](int i, int behind) {
    return find(ny, [&, i, behind](int before, int after) {
      return are_alike(i, before, i, after) && are_alike(i, before, behind, before) &&
             are_alike(i, after, behind, after);
    });
  };
  low_y_ = of_row(0, std::min(1, ny - 1));
  high_y_ = of_row(ny - 1, std::max(ny - 2, 0));
  low_x_ = of_column(0, std::min(1, nx - 1));
  high_x_ = of_column(nx - 1, std::max(nx - 2, 0));
}

bool BlockSides::is_plain_around(const Side& side, int k) {
  const int last = static_cast<int>(side.size()) - 1;
  return is_plain(side, std::max(k - 1, 0)) && is_plain(side, k) && is_plain(side, std::min(k + 1, last));
}

bool BlockSides::is_optional(int i, int j) const {
  const bool on_x = is_on_x_side(i), on_y = is_on_y_side(j);
  if (!on_x && !on_y) return false;
  return (!on_y || is_plain_around(along_x(j), i)) && (!on_x || is_plain_around(along_y(i), j));
}

/// The strips of one side.
class BlockSides::Strip {
 public:
  Strip(const CapSheet& top, const CapSheet& bottom,
        std::span<const std::vector<std::uint32_t>> wall_vertices, Mesh& mesh)
      : top_(top), bottom_(bottom), wall_vertices_(wall_vertices), mesh_(mesh) {}

  /// The line of a side's corners, at this number along the other axis. `turned`: their numbers increase to
  /// the left as seen from outside.
  struct Line {
    bool along_x;
    int at;
    bool turned;
  };
  void add(const Side& plain, const Line& line) {
    const int count = static_cast<int>(plain.size()) - 1;
    for (int first = 0; first < count;) {
      int end = first;
      while (end < count && is_plain(plain, end) && is_plain(plain, end + 1) &&
             (end == first || end % kSquare != 0))
        ++end;
      if (end > first) fill(line, first, end, count);
      first = std::max(end, first + 1);
    }
  }

 private:
  struct Vertex {
    int at;
    std::uint32_t number;
  };

  std::vector<Vertex> vertices(const CapSheet& sheet, const Line& line, int first, int end, int count) const {
    std::vector<Vertex> found;
    for (int k = first; k <= end; ++k) {
      // The quadrant of the column in the block: after the corner, but before the last one.
      const int along = k < count ? 1 : 0, across = line.at == 0 ? 1 : 0;
      const int i = line.along_x ? k : line.at, j = line.along_x ? line.at : k;
      const std::uint32_t number =
          sheet.vertex_on_side(i, j, line.along_x ? along + 2 * across : across + 2 * along, wall_vertices_);
      if (number != kNone) found.push_back({k, number});
    }
    return found;
  }
  void fill(const Line& line, int first, int end, int count) {
    const std::vector<Vertex> low = vertices(bottom_, line, first, end, count);
    const std::vector<Vertex> high = vertices(top_, line, first, end, count);
    std::size_t l = 0, h = 0;
    while (l + 1 < low.size() || h + 1 < high.size()) {
      const bool go_low = h + 1 == high.size() || (l + 1 < low.size() && low[l + 1].at <= high[h + 1].at);
      const std::uint32_t next = go_low ? low[l + 1].number : high[h + 1].number;
      std::array<std::uint32_t, 3> corners{low[l].number, next, high[h].number};
      if (line.turned) std::swap(corners[0], corners[1]);
      mesh_.triangles.insert(mesh_.triangles.end(), corners.begin(), corners.end());
      mesh_.step.push_back(kStockSurface);
      ++(go_low ? l : h);
    }
  }

  const CapSheet &top_, &bottom_;
  std::span<const std::vector<std::uint32_t>> wall_vertices_;
  Mesh& mesh_;
};

void BlockSides::add_strips(const CapSheet& top, const CapSheet& bottom,
                            std::span<const std::vector<std::uint32_t>> wall_vertices, Mesh& mesh) const {
  Strip strip(top, bottom, wall_vertices, mesh);
  strip.add(low_y_, {true, 0, false});
  strip.add(high_y_, {true, columns_.ny(), true});
  strip.add(low_x_, {false, 0, true});
  strip.add(high_x_, {false, columns_.nx(), false});
}

}  // namespace kerf::meshing
