// The corners that most corners are: four columns of one interval each around them, one surface above and one
// below. They are found row by row, and what the caps need to know of them is noted.
#include <vector>

#include "sim/mesh_build.h"

namespace kerf::meshing {
namespace {

/// A column of one interval, by its ends: 0 the low one, 1 the high one.
struct Single {
  bool is_one = false;
  float z[2];
  std::uint32_t step[2];
  std::uint64_t group[2];
};

void read_row(const Builder& builder, int j, std::vector<Single>& out) {
  const Columns& columns = builder.columns;
  out.resize(static_cast<std::size_t>(columns.nx()));
  for (int i = 0; i < columns.nx(); ++i) {
    Single& single = out[static_cast<std::size_t>(i)];
    single.is_one = columns.ends(i, j) == 2;
    if (!single.is_one) continue;
    const Interval run = columns.interval(i, j, 0);
    single = {true,
              {run.low, run.high},
              {run.low_step, run.high_step},
              {group_key(builder.options, run.low_step), group_key(builder.options, run.high_step)}};
  }
}

/// The four columns around a corner, by quadrant.
struct Around {
  const Single& a;
  const Single& b;
  const Single& c;
  const Single& d;

  bool all_single() const { return a.is_one && b.is_one && c.is_one && d.is_one; }
  FourHeights heights(int end) const { return four_heights(a.z[end], b.z[end], c.z[end], d.z[end]); }
  bool one_step(int end) const {
    return a.step[end] == b.step[end] && a.step[end] == c.step[end] && a.step[end] == d.step[end];
  }
  bool one_group(int end) const {
    return a.group[end] == b.group[end] && a.group[end] == c.group[end] && a.group[end] == d.group[end];
  }
};

bool scan_corner(const Builder& builder, int i, int j, const Around& around, CapSheet& top,
                 CapSheet& bottom) {
  const Columns& columns = builder.columns;
  if (!around.all_single() || columns.uneven(i, j)) return false;
  const FourHeights low = around.heights(0), high = around.heights(1);
  if (low.high >= high.low || !one_surface(columns, i, j, 1, high) || !one_surface(columns, i, j, 0, low))
    return false;
  const bool merges = builder.options.tolerance > Length();
  const auto may_go = [&](const FourHeights& heights, int end) {
    return (heights.low == heights.high && around.one_step(end)) || (merges && around.one_group(end));
  };
  bottom.add_simple(i, j, low.mean, may_go(low, 0));
  top.add_simple(i, j, high.mean, may_go(high, 1));
  return true;
}

}  // namespace

void scan_corners(const Builder& builder, int first, int end, CornerPlane& plane, CapSheet& top,
                  CapSheet& bottom) {
  const Columns& columns = builder.columns;
  std::vector<Single> south, north;
  if (first > 0 && first <= columns.ny()) read_row(builder, first - 1, south);
  for (int j = first; j < end; ++j) {
    top.begin_row(j);
    bottom.begin_row(j);
    if (j > columns.ny()) continue;
    std::uint8_t* simple = plane.row(j);
    std::fill_n(simple, columns.nx() + 1, std::uint8_t{0});
    if (j == columns.ny()) continue;
    read_row(builder, j, north);
    if (j > 0) {
      for (int i = 1; i < columns.nx(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Around around{south[k - 1], south[k], north[k - 1], north[k]};
        simple[i] = scan_corner(builder, i, j, around, top, bottom) ? 1 : 0;
      }
    }
    std::swap(south, north);
  }
}

}  // namespace kerf::meshing
