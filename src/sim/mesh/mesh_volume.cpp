// The volume that a mesh should enclose, from the columns that it was made of.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "sim/mesh/column_faces.h"

#include "kerf/sim/mesh.h"

namespace kerf {
namespace meshing {

VolumeRange volume_range(const Faces& faces, double pitch, double moved) {
  // Bound of the distance between the sides of columns and the walls of the mesh, in pitches; derivation in
  // docs/decisions/0023-mesh-verification.md.
  constexpr double kSideFraction = 1.0;
  return {mm3(faces.volume), mm3(kSideFraction * pitch * faces.sides + moved * (faces.ends + faces.sides))};
}

namespace {

/// Total height of the symmetric difference of two columns with one interval each.
double unshared_height(float low_a, float high_a, float low_b, float high_b) {
  if (low_a < high_b && low_b < high_a)
    return std::abs(height(low_a, low_b)) + std::abs(height(high_a, high_b));
  return height(low_a, high_a) + height(low_b, high_b);
}

class BlockFaces {
 public:
  explicit BlockFaces(const Columns& columns) : columns_(columns), size_(columns.frame().bounds.size()) {}

  /// The faces of a row of squares.
  Faces of_squares(int square_y) const {
    Faces faces;
    for (int square_x = 0; square_x < columns_.squares_x(); ++square_x) add_square(square_x, square_y, faces);
    return faces;
  }

 private:
  void add_square(int square_x, int square_y, Faces& faces) const {
    const int first_i = square_x * kSquare, end_i = std::min(first_i + kSquare, columns_.nx());
    const int first_j = square_y * kSquare, end_j = std::min(first_j + kSquare, columns_.ny());
    for (int j = first_j; j < end_j; ++j) {
      // Columns of full width with both neighbours in the same square: their numbers are contiguous.
      const int inner_end = j + 1 < end_j ? end_i - 1 : first_i;
      if (columns_.square(square_x, square_y).many == nullptr) {
        add_plain(first_i, inner_end, j, faces);
      } else {
        add_mixed(first_i, inner_end, j, faces);
      }
      for (int i = inner_end; i < end_i; ++i) add_column(i, j, faces);
    }
  }

  /// Columns of one interval each, with such neighbours to the right and above; none of them is narrower.
  void add_plain(int first, int end, int j, Faces& faces) const {
    if (first >= end) return;
    const ColumnSquare& square = columns_.square_of(first, j);
    const std::size_t at = Columns::cell(first, j);
    const float *low = square.low->z.data() + at, *high = square.high->z.data() + at;
    const double pitch = columns_.pitch(), count = end - first;
    double length = count * height(low[0], high[0]), bare = 0.0;
    if (!square.is_uniform()) {
      const auto columns = static_cast<std::size_t>(end - first);
      length =
          square.is_low_level ? on_one_floor(high, low[0], columns, bare) : any(low, high, columns, bare);
    }
    faces.volume += pitch * pitch * length;
    faces.ends += 2.0 * pitch * pitch * count;
    faces.sides += pitch * bare;
  }

  /// Columns with any number of intervals; faster for those with one interval whose neighbours to the right
  /// and above have one, too.
  void add_mixed(int first, int end, int j, Faces& faces) const {
    const ColumnSquare& square = columns_.square_of(first, j);
    const auto is_one = [&](std::size_t c) { return square.many->first[c + 1] - square.many->first[c] == 1; };
    const double pitch = columns_.pitch();
    double length = 0.0, bare = 0.0, count = 0.0;
    for (int i = first; i < end; ++i) {
      const std::size_t c = Columns::cell(i, j);
      if (is_one(c) && is_one(c + 1) && is_one(c + kSquare)) {
        length += any(square.low->z.data() + c, square.high->z.data() + c, 1, bare);
        count += 1.0;
      } else {
        add_column(i, j, faces);
      }
    }
    faces.volume += pitch * pitch * length;
    faces.ends += 2.0 * pitch * pitch * count;
    faces.sides += pitch * bare;
  }

  /// Total length of columns; adds the uncovered length of their sides to `bare`.
  static double any(const float* low, const float* high, std::size_t count, double& bare) {
    double length = 0.0;
    for (std::size_t c = 0; c < count; ++c) {
      length += height(low[c], high[c]);
      for (const std::size_t other : {c + 1, c + kSquare})
        bare += unshared_height(low[c], high[c], low[other], high[other]);
    }
    return length;
  }

  /// The same for columns with low ends at one height, without branches, so that it is vectorised.
  static double on_one_floor(const float* high, float floor, std::size_t count, double& bare) {
    constexpr std::size_t kLanes = 4;
    std::array<double, kLanes> lengths{}, sides{};
    const auto add = [&](std::size_t c, std::size_t lane) {
      lengths[lane] += height(floor, high[c]);
      sides[lane] += std::abs(height(high[c], high[c + 1])) + std::abs(height(high[c], high[c + kSquare]));
    };
    const std::size_t whole = count / kLanes * kLanes;
    for (std::size_t c = 0; c < whole; c += kLanes)
      for (std::size_t lane = 0; lane < kLanes; ++lane) add(c + lane, lane);
    for (std::size_t c = whole; c < count; ++c) add(c, c - whole);
    bare += (sides[0] + sides[1]) + (sides[2] + sides[3]);
    return (lengths[0] + lengths[1]) + (lengths[2] + lengths[3]);
  }

  void add_column(int i, int j, Faces& faces) const {
    const double wide = width(i, size_.x), deep = width(j, size_.y);
    std::array<Interval, 3> one;  // for columns that keep no intervals
    const Runs runs = columns_.runs(i, j, one[0]);
    for (const Interval& run : runs) faces.volume += wide * deep * height(run.low, run.high);
    faces.ends += 2.0 * wide * deep * static_cast<double>(runs.size());
    if (i + 1 < columns_.nx()) faces.sides += deep * unshared(runs, columns_.runs(i + 1, j, one[1]), height);
    if (j + 1 < columns_.ny()) faces.sides += wide * unshared(runs, columns_.runs(i, j + 1, one[2]), height);
  }

  /// The last column may be narrower.
  double width(int i, double size) const {
    return std::clamp(size - i * columns_.pitch(), 0.0, columns_.pitch());
  }

  const Columns& columns_;
  Point3 size_;
};

Faces faces_of(const Columns& columns, unsigned threads) {
  if (!columns.has_material()) return {};
  const BlockFaces block(columns);
  std::vector<Faces> bands(static_cast<std::size_t>(columns.squares_y()));
  parallel_for(
      thread_count(threads), bands.size(),
      [&](std::size_t band) { bands[band] = block.of_squares(static_cast<int>(band)); },
      [] { return false; });
  Faces sum;
  for (const Faces& faces : bands) {
    sum.volume += faces.volume;
    sum.ends += faces.ends;
    sum.sides += faces.sides;
  }
  return sum;
}

double farthest(const Box3& box) {
  if (box.empty()) return 0.0;
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(box.low[axis]), std::abs(box.high[axis])});
  return largest;
}

}  // namespace
}  // namespace meshing

VolumeRange mesh_volume(const ColumnGrid& columns, const MeshOptions& options) {
  return mesh_volume(MeshColumns(columns, options.threads), options);
}

VolumeRange mesh_volume(const MeshColumns& made, const MeshOptions& options) {
  const meshing::Columns& columns = made.body().columns;
  const double farthest = meshing::farthest(columns.frame().bounds);
  return meshing::volume_range(meshing::faces_of(columns, options.threads), columns.pitch(),
                               options.tolerance.mm() + meshing::rounding(farthest));
}

MeshCheck check_mesh(const Mesh& mesh) { return check_mesh(mesh.positions, mesh.triangles); }

bool verify_mesh(const Mesh& mesh, const VolumeRange& volume, Diagnostics& diagnostics) {
  return verify_mesh(mesh.positions, mesh.triangles, volume, diagnostics);
}

}  // namespace kerf
