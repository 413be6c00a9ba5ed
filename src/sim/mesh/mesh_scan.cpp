// Finds the simple corners, by far the majority: four columns of one interval each, with one surface above
// and one below. Works row by row, and records in the caps the corners that are needed.
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {
namespace {

/// Low ends above all high ones, which mark columns without exactly one interval, and positions outside the
/// grid.
constexpr float kMany = 1e30f, kOutside = 2e30f;

/// The ends of a row of columns with one interval each, as arrays with one number per column and two more on
/// both sides. Keys must be equal for columns to be merged: steps, or their groups.
class Row {
 public:
  static constexpr std::size_t kBefore = 2;
  explicit Row(int nx)
      : low_(size(nx), kOutside),
        high_(size(nx), -kOutside),
        low_key_(size(nx)),
        high_key_(size(nx)),
        level_(size(nx) / kSquare + 1) {}
  float* low() { return low_.data() + kBefore; }
  float* high() { return high_.data() + kBefore; }
  const float* low() const { return low_.data() + kBefore; }
  const float* high() const { return high_.data() + kBefore; }
  std::uint32_t* low_key() { return low_key_.data() + kBefore; }
  std::uint32_t* high_key() { return high_key_.data() + kBefore; }
  const std::uint32_t* low_key() const { return low_key_.data() + kBefore; }
  const std::uint32_t* high_key() const { return high_key_.data() + kBefore; }
  void set_outside() {
    std::fill(low_.begin(), low_.end(), kOutside);
    std::fill(high_.begin(), high_.end(), -kOutside);
    std::fill(level_.begin(), level_.end(), std::array<const Ends*, 2>{});
  }
  /// Whether the row already has these level ends (0: low ones) of the square with column `first`; records
  /// them.
  bool has(std::size_t end, int first, const Ends& ends, bool is_level) {
    const Ends*& mine = level_[static_cast<std::size_t>(first / kSquare)][end];
    if (is_level && mine == &ends) return true;
    mine = is_level ? &ends : nullptr;
    return false;
  }

 private:
  static std::size_t size(int nx) { return static_cast<std::size_t>(nx) + 2 * kBefore; }
  std::vector<float> low_, high_;
  std::vector<std::uint32_t> low_key_, high_key_;
  std::vector<std::array<const Ends*, 2>> level_;  // by square: its ends in this row, if level
};

/// Four columns in a row; the two inner ones are the neighbours in question.
struct Line {
  std::array<float, 4> low, high;
};

enum class Answer : std::uint8_t { no, yes, unknown };

/// Whether the neighbours' ends continue each other, see meshing::continues.
Answer continues(const Line& line, int end, double limit) {
  const std::array<float, 4>& z = end == 0 ? line.low : line.high;
  const double rise = static_cast<double>(z[2]) - static_cast<double>(z[1]);
  if (std::abs(rise) <= limit) return Answer::yes;
  if (line.low[0] == kMany || line.low[3] == kMany) return Answer::unknown;
  const auto rises_on = [&](std::size_t k) {
    return line.low[k] < line.high[k + 1] && line.low[k + 1] < line.high[k] &&
           meshing::continues_rise(rise, static_cast<double>(z[k + 1]) - static_cast<double>(z[k]));
  };
  return rises_on(0) || rises_on(2) ? Answer::yes : Answer::no;
}

class Scanner {
 public:
  Scanner(const Columns& columns, const MeshOptions& options, CapSheet& top, CapSheet& bottom)
      : columns_(columns),
        options_(options),
        merges_(options.tolerance > Length()),
        limit_(kSlopeFraction * columns.pitch()),
        top_(top),
        bottom_(bottom),
        rows_(4, Row(columns.nx())),
        alike_(static_cast<std::size_t>(columns.nx())) {}

  void run(int first, int end, CornerPlane& plane) {
    for (int j = first - 2; j <= first; ++j) read(j, row(j));
    for (int j = first; j < end; ++j) {
      std::uint8_t* const simple = plane.row(j);
      std::fill_n(simple, columns_.nx() + 1, std::uint8_t{0});
      read(j + 1, row(j + 1));
      if (j > 0 && j < columns_.ny() && !columns_.uneven(0, j)) scan(j, simple);
    }
  }

 private:
  /// Whether the low ends of the columns may differ.
  enum class Lows : std::uint8_t { any, level };
  /// The columns of row j. The last four rows are kept.
  Row& row(int j) { return rows_[static_cast<std::size_t>(j + 4) % 4]; }
  const Row& row(int j) const { return rows_[static_cast<std::size_t>(j + 4) % 4]; }
  void read(int j, Row& row) const;
  void read_keys(const Ends& ends, std::size_t at, std::size_t count, bool is_level,
                 std::uint32_t* out) const;
  void scan(int j, std::uint8_t* simple);
  void scan_range(int first, int end, int j, Lows lows, std::uint8_t* simple);
  void compare(int first, int end, int j, std::uint8_t* simple);
  void compare_highs(int first, int end, int j, std::uint8_t* simple);
  bool continue_each_other(int i, int j, int dx, int dy, int end) const;
  bool joined(int i, int j, int end) const;
  bool is_simple(int i, int j) const;
  void need(int i, int j);

  const Columns& columns_;
  const MeshOptions& options_;
  bool merges_;
  double limit_;  // maximum step that is not a wall, mm
  CapSheet &top_, &bottom_;
  std::vector<Row> rows_;
  std::vector<std::uint8_t> alike_;  // 1: the corner's columns have equal keys
};

void Scanner::read_keys(const Ends& ends, std::size_t at, std::size_t count, bool is_level,
                        std::uint32_t* out) const {
  const std::uint32_t* const step = ends.step.data() + at;
  if (!merges_) {
    std::copy_n(step, count, out);
  } else if (is_level) {
    std::fill_n(out, count, group_key(options_, step[0]));
  } else {
    for (std::size_t k = 0; k < count; ++k) out[k] = group_key(options_, step[k]);
  }
}

void Scanner::read(int j, Row& row) const {
  if (j < 0 || j >= columns_.ny()) {
    row.set_outside();
    return;
  }
  for (int first = 0; first < columns_.nx(); first += kSquare) {
    const ColumnSquare& square = columns_.square_of(first, j);
    const auto count = static_cast<std::size_t>(std::min(kSquare, columns_.nx() - first));
    const std::size_t at = Columns::cell(0, j);
    const bool is_one = square.many == nullptr;
    if (!row.has(0, first, *square.low, is_one && square.is_low_level)) {
      std::copy_n(square.low->z.data() + at, count, row.low() + first);
      read_keys(*square.low, at, count, square.is_low_level, row.low_key() + first);
    }
    if (!row.has(1, first, *square.high, is_one && square.is_high_level)) {
      std::copy_n(square.high->z.data() + at, count, row.high() + first);
      read_keys(*square.high, at, count, square.is_high_level, row.high_key() + first);
    }
    if (is_one) continue;
    for (std::size_t k = 0; k < count; ++k) {
      if (square.many->first[at + k + 1] - square.many->first[at + k] == 1) continue;
      row.low()[static_cast<std::size_t>(first) + k] = kMany;
      row.high()[static_cast<std::size_t>(first) + k] = -kMany;
    }
  }
}

/// Marks the corners whose four columns differ by less than a wall, and those with equal keys. Without
/// branches, so that it is vectorised.
void Scanner::compare(int first, int end, int j, std::uint8_t* simple) {
  const auto limit = static_cast<float>(limit_);
  const Row &south = row(j - 1), &north = row(j);
  const float *sl = south.low(), *nl = north.low(), *sh = south.high(), *nh = north.high();
  for (int i = first; i < end; ++i) {
    const float low_low = std::min(std::min(sl[i - 1], sl[i]), std::min(nl[i - 1], nl[i]));
    const float low_high = std::max(std::max(sl[i - 1], sl[i]), std::max(nl[i - 1], nl[i]));
    const float high_low = std::min(std::min(sh[i - 1], sh[i]), std::min(nh[i - 1], nh[i]));
    const float high_high = std::max(std::max(sh[i - 1], sh[i]), std::max(nh[i - 1], nh[i]));
    const int flat = static_cast<int>(low_high - low_low <= limit) &
                     static_cast<int>(high_high - high_low <= limit) & static_cast<int>(low_high < high_low);
    simple[i] = static_cast<std::uint8_t>(flat);
  }
  const std::uint32_t *slk = south.low_key(), *nlk = north.low_key(), *shk = south.high_key(),
                      *nhk = north.high_key();
  std::uint8_t* const alike = alike_.data();
  for (int i = first; i < end; ++i) {
    const std::uint32_t other = (slk[i - 1] ^ slk[i]) | (slk[i] ^ nlk[i - 1]) | (nlk[i - 1] ^ nlk[i]) |
                                (shk[i - 1] ^ shk[i]) | (shk[i] ^ nhk[i - 1]) | (nhk[i - 1] ^ nhk[i]);
    alike[i] = static_cast<std::uint8_t>(other == 0);
  }
}

/// meshing::continues for a column and the next one, with any number of intervals.
bool Scanner::continue_each_other(int i, int j, int dx, int dy, int end) const {
  std::array<Interval, 4> one;
  return meshing::continues(
      {columns_.runs(i - dx, j - dy, one[0]), columns_.runs(i, j, one[1]),
       columns_.runs(i + dx, j + dy, one[2]), columns_.runs(i + 2 * dx, j + 2 * dy, one[3])},
      end, end, columns_.pitch());
}

/// compare for columns with equal low ends.
void Scanner::compare_highs(int first, int end, int j, std::uint8_t* simple) {
  const auto limit = static_cast<float>(limit_);
  const float low = row(j).low()[first];
  const Row &south = row(j - 1), &north = row(j);
  const float *s = south.high(), *n = north.high();
  const std::uint32_t *sk = south.high_key(), *nk = north.high_key();
  std::uint8_t* const alike = alike_.data();
  for (int i = first; i < end; ++i) {
    const float lowest = std::min(std::min(s[i - 1], s[i]), std::min(n[i - 1], n[i]));
    const float highest = std::max(std::max(s[i - 1], s[i]), std::max(n[i - 1], n[i]));
    simple[i] = static_cast<std::uint8_t>(static_cast<int>(highest - lowest <= limit) &
                                          static_cast<int>(low < lowest));
  }
  for (int i = first; i < end; ++i) {
    const std::uint32_t other = (sk[i - 1] ^ sk[i]) | (sk[i] ^ nk[i - 1]) | (nk[i - 1] ^ nk[i]);
    alike[i] = static_cast<std::uint8_t>(other == 0);
  }
}

/// Whether the ends of the four columns around a corner continue each other, as slopes do. The columns have
/// one interval each, and a common height with material.
bool Scanner::joined(int i, int j, int end) const {
  for (const int k : {-1, 0}) {  // rows, and columns
    Line along, across;
    for (int n = 0; n < 4; ++n) {
      const auto at = static_cast<std::size_t>(n);
      along.low[at] = row(j + k).low()[i - 2 + n];
      along.high[at] = row(j + k).high()[i - 2 + n];
      across.low[at] = row(j - 2 + n).low()[i + k];
      across.high[at] = row(j - 2 + n).high()[i + k];
    }
    Answer answer = continues(along, end, limit_);
    if (answer == Answer::no || (answer == Answer::unknown && !continue_each_other(i - 1, j + k, 1, 0, end)))
      return false;
    answer = continues(across, end, limit_);
    if (answer == Answer::no || (answer == Answer::unknown && !continue_each_other(i + k, j - 1, 0, 1, end)))
      return false;
  }
  return true;
}

/// Whether a corner with a higher step is simple, as the step may be a slope.
bool Scanner::is_simple(int i, int j) const {
  const auto around = [i](const float* south, const float* north) {
    return four_heights(south[i - 1], south[i], north[i - 1], north[i]);
  };
  const FourHeights low = around(row(j - 1).low(), row(j).low());
  const FourHeights high = around(row(j - 1).high(), row(j).high());
  const auto one_surface = [&](const FourHeights& heights, int end) {
    return heights.high - heights.low <= limit_ || joined(i, j, end);
  };
  return low.high < high.low && one_surface(high, 1) && one_surface(low, 0);
}

/// Records a simple corner in the caps that need it.
void Scanner::need(int i, int j) {
  const auto alike = [i](const auto* south, const auto* north) {
    return south[i - 1] == south[i] && south[i] == north[i - 1] && north[i - 1] == north[i];
  };
  const Row &south = row(j - 1), &north = row(j);
  const bool low = alike(south.low_key(), north.low_key()) && (merges_ || alike(south.low(), north.low()));
  const bool high =
      alike(south.high_key(), north.high_key()) && (merges_ || alike(south.high(), north.high()));
  if (!low) bottom_.need(i, j);
  if (!high) top_.need(i, j);
}

void Scanner::scan_range(int first, int end, int j, Lows lows, std::uint8_t* simple) {
  constexpr std::uint64_t kAll = 0x0101010101010101u;
  lows == Lows::level ? compare_highs(first, end, j, simple) : compare(first, end, j, simple);
  while (first < end) {
    std::uint64_t eight = 0;
    if (merges_ && first + 8 <= end) {
      std::uint64_t alike = 0;
      std::memcpy(&eight, simple + first, sizeof eight);
      std::memcpy(&alike, alike_.data() + first, sizeof alike);
      eight &= alike;
    }
    const int next = std::min(first + 8, end);
    for (; first < next && eight != kAll; ++first) {
      if (simple[first] == 0) simple[first] = is_simple(first, j) ? 1 : 0;
      if (simple[first] != 0) need(first, j);
    }
    first = next;
  }
}

void Scanner::scan(int j, std::uint8_t* simple) {
  const int end = columns_.uneven(columns_.nx() - 1, j) ? columns_.nx() - 1 : columns_.nx();
  for (int first = 0; first < end; first += kSquare) {
    const int stop = std::min(first + kSquare, end);
    const ColumnSquare& square = columns_.square_of(first, j);
    const bool is_level = square.many == nullptr && square.is_low_level && j % kSquare != 0;
    // Only corners on a square's low sides have columns of other squares.
    scan_range(std::max(first, 1), is_level ? first + 1 : stop, j, Lows::any, simple);
    if (is_level && square.is_high_level) {
      std::fill(simple + first + 1, simple + stop, std::uint8_t{1});
    } else if (is_level) {
      scan_range(first + 1, stop, j, Lows::level, simple);
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
