// Caps: the upper and lower surfaces of the columns. A corner is not needed if the columns around it are
// level and have one step; right triangles are only halved at needed corners.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {
namespace {

/// Flags of entries, see CapSheet.
constexpr std::uint32_t kMany = 0x80000000u, kNew = 0x40000000u;

}  // namespace

CapSheet::CapSheet(const Columns& columns, const MeshOptions& options, const CornerPlane& plane,
                   const BlockSides& sides, Side side)
    : columns_(columns),
      options_(options),
      plane_(plane),
      sides_(sides),
      side_(side),
      blocks_x_(columns.squares_x() + 1),
      blocks_y_(columns.squares_y() + 1),
      blocks_(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y_)),
      whole_(blocks_.size(), kNone),
      heights_(blocks_.size()),
      bands_(static_cast<std::size_t>(blocks_y_)) {}

CapBlock& CapSheet::block(int i, int j) {
  auto& mine = blocks_[block_number(i, j)];
  if (!mine) mine = store_.make();
  return *mine;
}

void CapSheet::need(int i, int j) {
  if (!is_whole(i, j)) block(i, j).needed[Columns::cell(i, j)] = 1;
}

void CapSheet::take_entry(int i, int j, std::uint32_t entry) {
  if (is_whole(i, j)) {
    whole_[block_number(i, j)] = entry;
    return;
  }
  need(i, j);
  bands_[static_cast<std::size_t>(j / kSquare)].taken.push_back({{i, j}, entry});
}

/// For corners of squares and for needed corners only.
std::uint32_t& CapSheet::entry(int i, int j) {
  const std::size_t block = block_number(i, j);
  if (is_whole(i, j)) return whole_[block];
  return bands_[static_cast<std::size_t>(j / kSquare)].entries[blocks_[block]->index(Columns::cell(i, j))];
}

void CapSheet::store_height(int i, int j, double z) {
  if (!simplifies()) return;
  heights_[block_number(i, j)].push_back(
      {static_cast<std::uint16_t>(Columns::cell(i, j)), static_cast<float>(z)});
}

/// Takes a corner at which one surface has all four columns, but that is not simple.
void CapSheet::take_whole(Builder& walls, Sheet& sheet, int i, int j) {
  const bool is_level = level(i, j);
  const bool has_moved =
      sheet.x != columns_.corner_x(i) || sheet.y != columns_.corner_y(j) || columns_.uneven(i, j);
  const bool is_optional = simplifies() ? is_level || (!has_moved && of_one_group(i, j)) : is_level;
  store_height(i, j, sheet.z);
  const std::uint32_t vertex = has_moved && !is_optional ? walls.vertex(sheet) : sheet.vertex;
  if (vertex == kNone && is_optional) return;
  take_entry(i, j, vertex);
}

void CapSheet::take_corner(Builder& walls, CornerRow& row, const Corner& corner, int i, int j) {
  std::array<int, 4> ranks{};
  int empty = 0;
  for (int q = 0; q < 4; ++q) {
    const int ends = corner.ends[static_cast<std::size_t>(q)];
    if (ends == 0) ++empty;
    const int end = side_ == Side::bottom ? 0 : ends - 1;
    ranks[static_cast<std::size_t>(q)] = ends == 0 ? -1 : row.rank(corner, q, end);
  }
  if (empty == 4) return;
  if (sides_.is_optional(i, j)) {
    store_height(i, j, row.sheet(corner, *std::max_element(ranks.begin(), ranks.end())).z);
    return;
  }
  if (std::all_of(ranks.begin(), ranks.end(), [&](int r) { return r == ranks[0]; })) {
    take_whole(walls, row.sheet(corner, ranks[0]), i, j);
    return;
  }
  const int highest = *std::max_element(ranks.begin(), ranks.end());
  const bool one_surface =
      std::all_of(ranks.begin(), ranks.end(), [&](int r) { return r < 0 || r == highest; });
  if (one_surface) store_height(i, j, row.sheet(corner, highest).z);
  std::array<std::uint32_t, 4> vertices{kNone, kNone, kNone, kNone};
  for (std::size_t q = 0; q < 4; ++q)
    if (ranks[q] >= 0) vertices[q] = walls.vertex(row.sheet(corner, ranks[q]));
  auto& by_quadrant = bands_[static_cast<std::size_t>(j / kSquare)].by_quadrant;
  take_entry(i, j, kMany + static_cast<std::uint32_t>(by_quadrant.size()));
  by_quadrant.push_back(vertices);
}

void CapSheet::take(Builder& walls, CornerRow& row, int j) {
  for (const int i : row.numbers()) {
    const Corner& corner = row.corner(i);
    if (!corner.simple) {
      take_corner(walls, row, corner, i, j);
      continue;
    }
    const Sheet& sheet = row.sheet(corner, side_ == Side::bottom ? 0 : 1);
    if (sheet.vertex == kNone) continue;
    take_entry(i, j, sheet.vertex);
  }
}

/// Whether the ends of the four columns around a corner, none of them empty, have one height and one step.
bool CapSheet::level(int i, int j) const {
  const int end = end_of(i, j);
  const double z = columns_.z(i, j, end);
  const std::uint32_t step = columns_.step(i, j, end);
  for (int q = 0; q < 3; ++q) {
    const int ci = column_x(i, q), cj = column_y(j, q), e = end_of(ci, cj);
    if (columns_.z(ci, cj, e) != z || columns_.step(ci, cj, e) != step) return false;
  }
  return true;
}

bool CapSheet::of_one_group(int i, int j) const {
  const auto group_at = [&](int q) {
    const int ci = column_x(i, q), cj = column_y(j, q);
    return group_key(options_, columns_.step(ci, cj, end_of(ci, cj)));
  };
  const std::uint32_t group = group_at(0);
  return group == group_at(1) && group == group_at(2) && group == group_at(3);
}

/// Whether a corner without a vertex, which is needed or the corner of a square, will have triangles: none of
/// its four columns is empty, or those in the block are plain at its sides.
bool CapSheet::is_new_vertex(int i, int j) const {
  if (plane_.simple(i, j) || sides_.is_optional(i, j)) return true;
  for (int q = 0; q < 4; ++q)
    if (columns_.ends(column_x(i, q), column_y(j, q)) == 0) return false;
  return true;
}

void CapSheet::add_vertex(Band& band, int i, int j) {
  if (i > columns_.nx() || j > columns_.ny()) return;
  std::uint32_t& mine = entry(i, j);
  if (mine != kNone || !is_new_vertex(i, j)) return;
  double sum = 0.0;
  for (int q = 0; q < 4; ++q) {  // on the block's sides, the column inside has the same height
    const int ci = std::clamp(column_x(i, q), 0, columns_.nx() - 1);
    const int cj = std::clamp(column_y(j, q), 0, columns_.ny() - 1);
    sum += static_cast<double>(ends_of(columns_.square_of(ci, cj)).z[Columns::cell(ci, cj)]);
  }
  mine = kNew + static_cast<std::uint32_t>(band.positions.size() / 3);
  const Point3 at = columns_.frame().bounds.low + Point3{columns_.corner_x(i), columns_.corner_y(j), sum / 4};
  for (int axis = 0; axis < 3; ++axis) band.positions.push_back(static_cast<float>(at[axis]));
}

/// Allocates the entries of a band's needed corners and numbers them by row.
void CapSheet::number_corners(Band& band, int number) {
  std::uint32_t count = 0;
  for (int x = 0; x < blocks_x_; ++x) {
    CapBlock* const known = blocks_[block_number(x * kSquare, number * kSquare)].get();
    if (known == nullptr) continue;
    for (std::size_t row = 0; row < kSquare; ++row) {
      known->before[row] = count;
      std::uint8_t* const needed = known->needed.data() + row * kSquare;
      std::uint8_t in_row = 0;
      for (std::size_t k = 0; k < kSquare; k += sizeof(std::uint64_t)) {
        std::uint64_t eight = 0;
        std::memcpy(&eight, needed + k, sizeof eight);
        for (std::size_t c = k; eight != 0 && c < k + sizeof eight; ++c)
          if (needed[c] != 0)
            needed[c] = static_cast<std::uint8_t>((needed[c] & CapBlock::kOnSide) | ++in_row);
      }
      count += in_row;
    }
  }
  band.entries.assign(count, kNone);
  band.positions.reserve(3 * (std::size_t{count} + static_cast<std::size_t>(blocks_x_)));
  for (const auto& [at, entry] : band.taken) this->entry(at.x, at.y) = entry;
}

/// Halving the triangles at an inner corner of a square adds two triangles; at a corner on its side, one in
/// each of the two squares.
void CapSheet::add_vertices(int number) {
  Band& band = bands_[static_cast<std::size_t>(number)];
  number_corners(band, number);
  for (int x = 0; x < blocks_x_; ++x) add_vertex(band, x * kSquare, number * kSquare);
  band.max_triangles = 2 * static_cast<std::size_t>(columns_.squares_x());
  for_needed(number, [&](int i, int j) {
    const bool on_side = j % kSquare == 0;
    band.max_triangles += on_side ? 1 : 2;
    band.below += on_side ? 1 : 0;
    add_vertex(band, i, j);
  });
}

void CapSheet::assign_ranges(MeshCounts& counts) {
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    Band& band = bands_[b];
    band.first_vertex = counts.vertices;
    band.first_triangle = counts.triangles;
    counts.vertices += band.positions.size() / 3;
    if (b + 1 < bands_.size()) counts.triangles += band.max_triangles + bands_[b + 1].below;
  }
}

/// The triangles of a square, between corners that are numbered from its low corner.
class CapSheet::Triangles {
 public:
  Triangles(const CapSheet& sheet, int square_x, int square_y)
      : wide_(std::min(kSquare, sheet.columns_.nx() - square_x * kSquare)),
        deep_(std::min(kSquare, sheet.columns_.ny() - square_y * kSquare)) {
    for (int k = 0; k < 4; ++k)
      blocks_[static_cast<std::size_t>(k)] =
          sheet.blocks_[sheet.block_number((square_x + k % 2) * kSquare, (square_y + k / 2) * kSquare)].get();
  }

  /// Calls work(a, b, apex) for each triangle in the block.
  template <class Work>
  void each(const Work& work) const {
    const GridCorner sw{0, 0}, se{kSquare, 0}, ne{kSquare, kSquare}, nw{0, kSquare};
    halve(sw, ne, se, work);
    halve(ne, sw, nw, work);
  }
  bool is_on_side(GridCorner n) const {
    return (n.x == wide_ && wide_ < kSquare) || (n.y == deep_ && deep_ < kSquare);
  }

 private:
  bool is_needed(GridCorner n) const {
    const CapBlock* const block =
        blocks_[static_cast<unsigned>(n.x) / kSquare + 2 * (static_cast<unsigned>(n.y) / kSquare)];
    return block != nullptr && block->halves(Columns::cell(n.x, n.y));
  }
  template <class Work>
  void halve(GridCorner a, GridCorner b, GridCorner apex, const Work& work) const {
    const GridCorner midpoint{(a.x + b.x) / 2, (a.y + b.y) / 2};
    const bool smallest = std::abs(a.x - b.x) == 1;
    if (!smallest && is_needed(midpoint)) {
      halve(apex, a, midpoint, work);
      halve(b, apex, midpoint, work);
      return;
    }
    const auto inside = [this](GridCorner n) {
      return GridCorner{std::min(n.x, wide_), std::min(n.y, deep_)};
    };
    a = inside(a);
    b = inside(b);
    apex = inside(apex);
    if ((a.x == b.x && b.x == apex.x) || (a.y == b.y && b.y == apex.y)) return;  // beyond the block
    work(a, b, apex);
  }

  int wide_, deep_;  // columns of the square that are in the grid
  std::array<const CapBlock*, 4> blocks_;
};

/// Makes vertices of the corners on the block's sides at which triangles end that extend beyond it.
void CapSheet::need_on_side(int square_x, int square_y) {
  const Triangles triangles(*this, square_x, square_y);
  const auto mark = [&](GridCorner n) {
    const int i = square_x * kSquare + n.x, j = square_y * kSquare + n.y;
    if (!triangles.is_on_side(n) || is_whole(i, j)) return;
    std::uint8_t& needed = block(i, j).needed[Columns::cell(i, j)];
    if (needed == 0) needed = CapBlock::kOnSide;
  };
  triangles.each([&](GridCorner a, GridCorner b, GridCorner apex) {
    for (const GridCorner n : {a, b, apex}) mark(n);
  });
}

/// Adds the triangles of a square to the mesh.
class CapSheet::Cover {
 public:
  Cover(CapSheet& sheet, int square_x, int number, std::span<const std::vector<std::uint32_t>> wall_vertices,
        Mesh& mesh)
      : square_(sheet.columns_.square(square_x, number)),
        ends_(sheet.ends_of(square_)),
        up_(sheet.side_ == Side::top),
        all_(sheet, square_x, number),
        band_(sheet.bands_[static_cast<std::size_t>(number)]),
        triangles_(mesh.triangles.data()),
        step_(mesh.step.data()) {
    for (int k = 0; k < 4; ++k) {
      const int x = square_x + k % 2, y = number + k / 2;
      const std::size_t at = sheet.block_number(x * kSquare, y * kSquare);
      const auto number_of_band = static_cast<std::size_t>(y);
      const Band& band = sheet.bands_[number_of_band];
      corners_[static_cast<std::size_t>(k)] = {
          sheet.blocks_[at].get(),
          band.entries.data(),
          sheet.whole_[at],
          static_cast<std::uint32_t>(band.first_vertex),
          &band,
          number_of_band < wall_vertices.size() ? wall_vertices[number_of_band].data() : nullptr};
    }
  }

  void run() {
    all_.each([this](GridCorner a, GridCorner b, GridCorner apex) { add(a, b, apex); });
  }

 private:
  /// Data of the block and the band that a corner of the square belongs to.
  struct Known {
    const CapBlock* block = nullptr;
    const std::uint32_t* entries = nullptr;
    std::uint32_t whole = kNone;
    std::uint32_t first_vertex = 0;
    const Band* band = nullptr;
    const std::uint32_t* wall_vertices = nullptr;
  };
  const Known& known(GridCorner n) const {
    return corners_[static_cast<unsigned>(n.x) / kSquare + 2 * (static_cast<unsigned>(n.y) / kSquare)];
  }
  void add(GridCorner a, GridCorner b, GridCorner apex);
  std::uint32_t vertex(GridCorner corner, GridCorner column, bool& at_wall) const;

  const ColumnSquare& square_;
  const Ends& ends_;
  bool up_;
  Triangles all_;
  Band& band_;
  std::uint32_t *triangles_, *step_;  // the mesh's
  std::array<Known, 4> corners_;
};

void CapSheet::Cover::add(GridCorner a, GridCorner b, GridCorner apex) {
  const int sx = a.x + b.x + apex.x, sy = a.y + b.y + apex.y;
  // The column at a corner of the triangle that is inside the triangle.
  const auto inner = [&](GridCorner n) {
    return GridCorner{3 * n.x <= sx ? n.x : n.x - 1, 3 * n.y <= sy ? n.y : n.y - 1};
  };
  const GridCorner column = inner(apex);
  const std::size_t cell = Columns::cell(column.x, column.y);
  if (square_.many != nullptr && square_.many->first[cell + 1] == square_.many->first[cell]) return;
  const int turn = (b.x - a.x) * (apex.y - a.y) - (b.y - a.y) * (apex.x - a.x);
  if ((turn > 0) != up_) std::swap(a, b);
  bool at_wall = false;
  const std::uint32_t va = vertex(a, inner(a), at_wall), vb = vertex(b, inner(b), at_wall),
                      vc = vertex(apex, column, at_wall);
  if (va == vb || vb == vc || vc == va) return;
  const std::size_t t = band_.first_triangle + band_.triangles++;
  if (at_wall) band_.at_walls.push_back(t);
  triangles_[3 * t] = va;
  triangles_[3 * t + 1] = vb;
  triangles_[3 * t + 2] = vc;
  step_[t] = ends_.step[cell];
}

std::uint32_t CapSheet::Cover::vertex(GridCorner corner, GridCorner column, bool& at_wall) const {
  const Known& known = this->known(corner);
  const std::size_t cell = Columns::cell(corner.x, corner.y);
  assert(cell == 0 || known.block != nullptr);
  const std::uint32_t entry = cell == 0 ? known.whole : known.entries[known.block->index(cell)];
  assert(entry != kNone);
  if ((entry & (kNew | kMany)) == kNew) return known.first_vertex + entry - kNew;
  at_wall = true;
  if (entry < kNew) return known.wall_vertices[entry];
  const auto quadrant = static_cast<std::size_t>((column.x - corner.x + 1) + 2 * (column.y - corner.y + 1));
  return known.wall_vertices[known.band->by_quadrant[entry - kMany][quadrant]];
}

std::uint32_t CapSheet::vertex_on_side(int i, int j, int quadrant,
                                       std::span<const std::vector<std::uint32_t>> wall_vertices) const {
  const auto number = static_cast<std::size_t>(j / kSquare);
  const Band& band = bands_[number];
  const std::size_t at = block_number(i, j), cell = Columns::cell(i, j);
  std::uint32_t entry = whole_[at];
  if (!is_whole(i, j)) {
    if (blocks_[at] == nullptr || blocks_[at]->needed[cell] == 0) return kNone;
    entry = band.entries[blocks_[at]->index(cell)];
  }
  if (entry == kNone) return kNone;
  if ((entry & (kNew | kMany)) == kNew) return static_cast<std::uint32_t>(band.first_vertex) + entry - kNew;
  if (entry < kNew) return wall_vertices[number][entry];
  return wall_vertices[number][band.by_quadrant[entry - kMany][static_cast<std::size_t>(quadrant)]];
}

void CapSheet::fill(int number, std::span<const std::vector<std::uint32_t>> wall_vertices, Mesh& mesh) {
  const Band& band = bands_[static_cast<std::size_t>(number)];
  std::copy(band.positions.begin(), band.positions.end(), mesh.positions.data() + 3 * band.first_vertex);
  if (number >= columns_.squares_y()) return;
  for (int x = 0; x < columns_.squares_x(); ++x) Cover(*this, x, number, wall_vertices, mesh).run();
}

void CapSheet::close_gaps(Mesh& mesh, std::size_t& end, std::vector<std::size_t>& at_walls) const {
  for (const Band& band : bands_) {
    const std::size_t first = band.first_triangle, gap = first - end;
    if (gap != 0) {
      std::copy_n(mesh.step.data() + first, band.triangles, mesh.step.data() + end);
      std::copy_n(mesh.triangles.data() + 3 * first, 3 * band.triangles, mesh.triangles.data() + 3 * end);
    }
    for (const std::size_t t : band.at_walls) at_walls.push_back(t - gap);
    end += band.triangles;
  }
}

}  // namespace kerf::meshing
