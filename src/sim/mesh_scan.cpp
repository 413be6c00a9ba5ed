// The corners that most corners are: four columns of one interval each around them, one surface above and one
// below. They are found row by row, and the caps are told of those that may not be dropped.
#include <cstring>
#include <vector>

#include "sim/mesh_build.h"

namespace kerf::meshing {
namespace {

constexpr float kNowhere = 1e30f;

/// The ends of a row of columns that are of one interval, each array one number a column; those of others meet
/// no column's. Keys are what merged columns must have in common: the steps, or their groups.
struct Row {
  explicit Row(int nx) : low(size(nx)), high(size(nx)), low_key(size(nx)), high_key(size(nx)) {}
  static std::size_t size(int nx) { return static_cast<std::size_t>(nx); }
  std::vector<float> low, high;
  std::vector<std::uint32_t> low_key, high_key;
};

class Scanner {
 public:
  Scanner(const Columns& columns, const MeshOptions& options, CapSheet& top, CapSheet& bottom)
      : columns_(columns),
        options_(options),
        merges_(options.tolerance > Length()),
        top_(top),
        bottom_(bottom),
        south_(columns.nx()),
        north_(columns.nx()) {}

  void run(int first, int end, CornerPlane& plane) {
    if (first > 0) read(first - 1, south_);
    for (int j = first; j < end; ++j) {
      std::uint8_t* const simple = plane.row(j);
      std::fill_n(simple, columns_.nx() + 1, std::uint8_t{0});
      if (j == columns_.ny()) return;
      read(j, north_);
      if (j > 0 && !columns_.uneven(0, j)) scan(j, simple);
      std::swap(south_, north_);
    }
  }

 private:
  void read(int j, Row& row) const;
  void read_keys(const Ends& ends, std::size_t at, std::size_t count, bool is_uniform,
                 std::uint32_t* out) const;
  void scan(int j, std::uint8_t* simple);
  void compare(int begin, int end, std::uint8_t* simple) const;
  void look_again(int i, int j, std::uint8_t& simple) const;
  void need(int i, int j);

  const Columns& columns_;
  const MeshOptions& options_;
  bool merges_;
  CapSheet &top_, &bottom_;
  Row south_, north_;
};

void Scanner::read_keys(const Ends& ends, std::size_t at, std::size_t count, bool is_uniform,
                        std::uint32_t* out) const {
  const std::uint32_t* const step = ends.step.data() + at;
  if (!merges_) {
    std::copy_n(step, count, out);
  } else if (is_uniform) {
    std::fill_n(out, count, group_key(options_, step[0]));
  } else {
    for (std::size_t k = 0; k < count; ++k) out[k] = group_key(options_, step[k]);
  }
}

void Scanner::read(int j, Row& row) const {
  for (int first = 0; first < columns_.nx(); first += kSquare) {
    const Square& square = columns_.square_of(first, j);
    const auto to = static_cast<std::size_t>(first);
    const auto count = static_cast<std::size_t>(std::min(kSquare, columns_.nx() - first));
    const std::size_t at = Columns::cell(0, j);
    std::copy_n(square.low->z.data() + at, count, row.low.data() + to);
    std::copy_n(square.high->z.data() + at, count, row.high.data() + to);
    read_keys(*square.low, at, count, square.is_uniform, row.low_key.data() + to);
    read_keys(*square.high, at, count, square.is_uniform, row.high_key.data() + to);
    if (square.many == nullptr) continue;
    for (std::size_t k = 0; k < count; ++k) {
      if (square.many->first[at + k + 1] - square.many->first[at + k] == 1) continue;
      row.low[to + k] = kNowhere;
      row.high[to + k] = -kNowhere;
    }
  }
}

/// Corners of a row whose four columns differ by less than any wall. Without branches, several at a time.
void Scanner::compare(int begin, int end, std::uint8_t* simple) const {
  const auto limit = static_cast<float>(kSlopeShare * columns_.pitch());
  const float *sl = south_.low.data(), *nl = north_.low.data(), *sh = south_.high.data(),
              *nh = north_.high.data();
  for (int i = begin; i < end; ++i) {
    const float low_low = std::min(std::min(sl[i - 1], sl[i]), std::min(nl[i - 1], nl[i]));
    const float low_high = std::max(std::max(sl[i - 1], sl[i]), std::max(nl[i - 1], nl[i]));
    const float high_low = std::min(std::min(sh[i - 1], sh[i]), std::min(nh[i - 1], nh[i]));
    const float high_high = std::max(std::max(sh[i - 1], sh[i]), std::max(nh[i - 1], nh[i]));
    const int flat = static_cast<int>(low_high - low_low <= limit) &
                     static_cast<int>(high_high - high_low <= limit) & static_cast<int>(low_high < high_low);
    simple[i] = static_cast<std::uint8_t>(flat);
  }
}

/// A corner with a higher step, which may yet be a slope.
void Scanner::look_again(int i, int j, std::uint8_t& simple) const {
  const auto k = static_cast<std::size_t>(i);
  const auto around = [k](const std::vector<float>& south, const std::vector<float>& north) {
    return four_heights(south[k - 1], south[k], north[k - 1], north[k]);
  };
  const FourHeights low = around(south_.low, north_.low), high = around(south_.high, north_.high);
  simple = low.high < high.low && one_surface(columns_, i, j, 1, high) && one_surface(columns_, i, j, 0, low)
               ? 1
               : 0;
}

/// Tells the caps of a simple corner if they may not drop it.
void Scanner::need(int i, int j) {
  const auto k = static_cast<std::size_t>(i);
  const auto alike = [k](const auto& south, const auto& north) {
    return south[k - 1] == south[k] && south[k] == north[k - 1] && north[k - 1] == north[k];
  };
  const bool low = alike(south_.low_key, north_.low_key) && (merges_ || alike(south_.low, north_.low));
  const bool high = alike(south_.high_key, north_.high_key) && (merges_ || alike(south_.high, north_.high));
  if (!low) bottom_.need(i, j);
  if (!high) top_.need(i, j);
}

void Scanner::scan(int j, std::uint8_t* simple) {
  const int end = columns_.uneven(columns_.nx() - 1, j) ? columns_.nx() - 1 : columns_.nx();
  for (int first = 0; first < end; first += kSquare) {
    const int stop = std::min(first + kSquare, end);
    int begin = std::max(first, 1);
    if (j % kSquare != 0 && columns_.square_of(first, j).is_uniform) {
      // Only the corners on the square's low side have other columns beside them.
      std::fill(simple + first + 1, simple + stop, std::uint8_t{1});
      if (first == 0) continue;
      compare(begin, begin + 1, simple);
      if (simple[begin] == 0) look_again(begin, j, simple[begin]);
      if (simple[begin] != 0) need(begin, j);
      continue;
    }
    compare(begin, stop, simple);
    for (; begin < stop; ++begin) {
      if (simple[begin] == 0) look_again(begin, j, simple[begin]);
      if (simple[begin] != 0) need(begin, j);
    }
  }
}

}  // namespace

void scan_corners(const Columns& columns, const MeshOptions& options, int band, CornerPlane& plane,
                  CapSheet& top, CapSheet& bottom) {
  const int first = band * kSquare;
  if (first > columns.ny()) return;
  Scanner(columns, options, top, bottom).run(first, std::min(first + kSquare, columns.ny() + 1), plane);
}

}  // namespace kerf::meshing
