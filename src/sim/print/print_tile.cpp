// Lays pieces column by column.
#include "sim/print/print_tile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kerf/base/limits.h"

namespace kerf::printing {
namespace {

/// A component of a direction below this clips nothing along its axis.
constexpr double kLevel = 1e-12;

struct ClippedRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  /// Clips to the x with low_bound <= a * x + b <= high_bound.
  void clip(double a, double b, double low_bound, double high_bound) {
    if (std::abs(a) < kLevel) {
      if (b < low_bound || b > high_bound) high = -std::numeric_limits<double>::infinity();
      return;
    }
    const double p = (low_bound - b) / a, q = (high_bound - b) / a;
    low = std::max(low, std::min(p, q));
    high = std::min(high, std::max(p, q));
  }
};

/// First and last column of an interval, within a tile.
struct ColumnRange {
  int first, last;
  ColumnRange(double low, double high, double pitch, int tile_first, int count) {
    const double start = std::max(std::ceil(low / pitch), static_cast<double>(tile_first));
    const double end = std::min(std::floor(high / pitch), static_cast<double>(tile_first + count - 1));
    first = start <= end ? static_cast<int>(start) : 0;
    last = start <= end ? static_cast<int>(end) : -1;
  }
};

/// Multiples of the golden ratio, less whole numbers: any few successive ones are spread evenly from -1/2 to
/// 1/2.
TileOffsets spread_offsets() {
  constexpr double kGolden = 0.618033988749895;
  TileOffsets offsets{};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double multiple = static_cast<double>(i) * kGolden;
    offsets[i] = multiple - std::floor(multiple) - 0.5;
  }
  return offsets;
}

}  // namespace

const TileOffsets& PrintTile::offsets_of(ColumnPositions positions) {
  static const TileOffsets on_grid{}, spread = spread_offsets();
  return positions == ColumnPositions::spread ? spread : on_grid;
}

PrintTile::PrintTile(const Frame& frame, int tile_x, int tile_y)
    : pitch_(frame.pitch),
      touch_(frame.touch),
      spread_(frame.positions == ColumnPositions::spread ? 0.5 * frame.pitch : 0.0),
      offsets_(offsets_of(frame.positions)),
      first_x_(tile_x * kTileSide),
      first_y_(tile_y * kTileSide),
      columns_x_(std::min(kTileSide, frame.nx - first_x_)),
      columns_y_(std::min(kTileSide, frame.ny - first_y_)),
      heads_(std::size_t{kTileSide} * kTileSide, kNoRun) {}

/// Calls visit(column, u, v) for the columns within `reach` of the centre line: u along it, v across. Half
/// open, so that each column belongs to only one of two collinear beads.
template <class Visit>
void PrintTile::for_each_column(const BeadPiece& p, double reach, const Visit& visit) const {
  const double end_y = p.from.y + p.length * p.along.y;
  const ColumnRange rows(std::min(p.from.y, end_y) - reach - spread_,
                         std::max(p.from.y, end_y) + reach + spread_, pitch_, first_y_, columns_y_);
  // Moved in Y by up to `spread_`, a column of the row may be that much further along and across.
  const double more_u = spread_ * std::abs(p.along.y), more_v = spread_ * std::abs(p.along.x);
  for (int j = rows.first; j <= rows.last; ++j) {
    const double y_of_row = j * pitch_ - p.from.y, x_of_row = offset(j - first_y_) * pitch_ - p.from.x;
    ClippedRange span;
    span.clip(p.along.x, y_of_row * p.along.y, -more_u, p.length + more_u);
    span.clip(-p.along.y, y_of_row * p.along.x, -reach - more_v, reach + more_v);
    const ColumnRange columns(span.low - x_of_row, span.high - x_of_row, pitch_, first_x_, columns_x_);
    for (int i = columns.first; i <= columns.last; ++i) {
      const double x = i * pitch_ + x_of_row, y = y_of_row + offset(i - first_x_) * pitch_;
      const double u = x * p.along.x + y * p.along.y, v = y * p.along.x - x * p.along.y;
      if (u < 0.0 || u >= p.length || std::abs(v) > reach) continue;
      visit((j - first_y_) * kTileSide + i - first_x_, u, std::abs(v));
    }
  }
}

/// Calls visit(column, distance from the centre of the wedge).
template <class Visit>
void PrintTile::for_each_wedge_column(const BeadPiece& p, const Visit& visit) const {
  const double reach = p.reach(), wide = reach + spread_;
  const ColumnRange rows(p.from.y - wide, p.from.y + wide, pitch_, first_y_, columns_y_);
  const ColumnRange columns(p.from.x - wide, p.from.x + wide, pitch_, first_x_, columns_x_);
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = columns.first; i <= columns.last; ++i) {
      const Point2 at{(i + offset(j - first_y_)) * pitch_ - p.from.x,
                      (j + offset(i - first_x_)) * pitch_ - p.from.y};
      if (dot(at, at) > reach * reach || dot(at, p.after) < 0.0 || dot(at, p.before) > 0.0) continue;
      visit((j - first_y_) * kTileSide + i - first_x_, length(at));
    }
  }
}

void PrintTile::add(const BeadPiece& piece, double contact_depth, PieceSums& sums,
                    std::vector<NozzleContact>& contacts) {
  switch (piece.kind) {
    case PieceKind::bead: return lay_bead(piece, contact_depth, sums, contacts);
    case PieceKind::wedge: return lay_wedge(piece, sums);
    case PieceKind::travel: return travel(piece, contact_depth, contacts);
  }
}

namespace {

/// Half the height of a section at this distance from its centre line.
double half_height(const BeadPiece& p, double v) {
  if (v <= p.flat) return p.round;
  const double aside = v - p.flat;
  return std::sqrt(std::max(0.0, p.round * p.round - aside * aside));
}

/// Half the width across the centre line of the columns that it passes through, approximately.
double centre_reach(const BeadPiece& p, double pitch) {
  return 0.5 * pitch * (std::abs(p.along.x) + std::abs(p.along.y));
}

/// Records a contact of the nozzle at u, or deepens the contact of the motion.
void meet(const BeadPiece& p, double u, double depth, std::vector<NozzleContact>& contacts) {
  const Point3 at{p.from.x + u * p.along.x, p.from.y + u * p.along.y, p.z + u * p.slope};
  if (contacts.empty() || contacts.back().step != p.step) {
    contacts.push_back({p.step, p.travelled + u, at, depth});
    return;
  }
  NozzleContact& contact = contacts.back();
  contact.depth = std::max(contact.depth, depth);
  if (p.travelled + u >= contact.distance) return;
  contact.distance = p.travelled + u;
  contact.at = at;
}

}  // namespace

void PrintTile::lay_bead(const BeadPiece& p, double contact_depth, PieceSums& sums,
                         std::vector<NozzleContact>& contacts) {
  const double reach = centre_reach(p, pitch_);
  for_each_column(p, p.reach(), [&](int column, double u, double v) {
    const double nozzle = p.z + u * p.slope;
    const bool on_centre_line = v <= reach;
    if (on_centre_line) {
      ++sums.centre;
      const double depth = height_over(column) - nozzle;
      if (depth > contact_depth) meet(p, u, depth, contacts);
    }
    const Laid laid = lay_section(p, column, nozzle, v, sums);
    sums.bare += on_centre_line && !laid.supported ? 1 : 0;
    sums.supported = sums.supported || laid.supported || laid.lies_near || laid.oldest < p.chain_start;
  });
}

void PrintTile::lay_wedge(const BeadPiece& p, PieceSums& sums) {
  for_each_wedge_column(p, [&](int column, double distance) { lay_section(p, column, p.z, distance, sums); });
}

/// Lays the interval of a section with its top at `nozzle`, at this distance from its centre line.
PrintTile::Laid PrintTile::lay_section(const BeadPiece& p, int column, double nozzle, double aside,
                                       PieceSums& sums) {
  const double half = half_height(p, aside), centre = nozzle - p.round;
  const auto low = static_cast<float>(centre - half), high = static_cast<float>(centre + half);
  const double bottom = centre - p.round;
  constexpr double kGap = 1.05;  // heights
  const Laid laid = lay(column, low, high, p.step,
                        {static_cast<float>(bottom), static_cast<float>(bottom - p.round),
                         static_cast<float>(bottom - 2.0 * kGap * p.round)});
  sums.full += static_cast<double>(high - low);
  sums.covered += static_cast<double>(laid.covered);
  return laid;
}

void PrintTile::travel(const BeadPiece& p, double contact_depth, std::vector<NozzleContact>& contacts) {
  const double lowest = std::min(p.z, p.z + p.length * p.slope);
  if (top_ - lowest <= contact_depth) return;
  for_each_column(p, centre_reach(p, pitch_), [&](int column, double u, double) {
    const double depth = height_over(column) - (p.z + u * p.slope);
    if (depth > contact_depth) meet(p, u, depth, contacts);
  });
}

/// The lowest run entirely above `height`; kNoRun if there is none.
std::uint32_t PrintTile::find_above(int column, float height) {
  std::uint32_t above = kNoRun;
  int walked = 0;
  for (std::uint32_t n = link(kNoRun, column); n != kNoRun && runs_[n].low > height; n = runs_[n].below) {
    above = n;
    if (++walked <= limits::kMaxIntervalsPerColumn) continue;
    too_deep_ = true;
    break;
  }
  return above;
}

/// Adds a run to a column. It is supported by material from below the bottom of the bead that reaches
/// `under.reach`.
PrintTile::Laid PrintTile::lay(int column, float low, float high, std::uint32_t step, Support under) {
  Laid laid;
  laid.supported = under.reach <= 0.0f;
  if (low < 0.0f) {  // the bed
    laid.covered = std::min(high, 0.0f) - low;
    low = 0.0f;
  }
  if (!(high > low) || too_deep_) return laid;
  const std::uint32_t above = find_above(column, high + touch_);
  MaterialRun joined{low, high, step, step, kNoRun};
  std::uint32_t next = link(above, column);
  while (next != kNoRun && runs_[next].high >= low - touch_) {
    const MaterialRun node = runs_[next];
    laid.covered += std::max(0.0f, std::min(high, node.high) - std::max(low, node.low));
    laid.supported = laid.supported || node.low < under.bottom - touch_;
    laid.oldest = std::min({laid.oldest, node.low_step, node.high_step});
    if (node.high >= joined.high - touch_) {
      joined.high_step = node.high_step;
      joined.high = std::max(joined.high, node.high);
    }
    if (node.low <= joined.low + touch_) {
      joined.low_step = node.low_step;
      joined.low = std::min(joined.low, node.low);
    }
    remove(above, column, next);
    next = link(above, column);
  }
  laid.supported = laid.supported || (next != kNoRun && runs_[next].high >= under.reach);
  laid.lies_near = next != kNoRun && runs_[next].high >= under.near;
  insert(above, column, joined);
  top_ = std::max(top_, static_cast<double>(joined.high));
  return laid;
}

void PrintTile::insert(std::uint32_t above, int column, const MaterialRun& node) {
  std::uint32_t number = free_;
  if (number == kNoRun) {
    number = static_cast<std::uint32_t>(runs_.size());
    runs_.push_back(node);
  } else {
    free_ = runs_[number].below;
    runs_[number] = node;
  }
  std::uint32_t& head = link(above, column);
  runs_[number].below = head;
  head = number;
  ++used_;
}

void PrintTile::remove(std::uint32_t above, int column, std::uint32_t node) {
  link(above, column) = runs_[node].below;
  runs_[node].below = free_;
  free_ = node;
  --used_;
}

void PrintTile::intervals(int column, std::vector<Interval>& out) const {
  const auto begin = static_cast<std::ptrdiff_t>(out.size());
  for (std::uint32_t n = heads_[static_cast<std::size_t>(column)]; n != kNoRun; n = runs_[n].below)
    out.push_back({runs_[n].low, runs_[n].high, runs_[n].low_step, runs_[n].high_step});
  std::reverse(out.begin() + begin, out.end());
}

}  // namespace kerf::printing
