// Energy per area: each motion with the beam on spreads its energy over the cells under the beam.
#include "kerf/sim/burn.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

#include "base/codes/files.h"
#include "base/codes/path.h"
#include "base/codes/sim.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr unsigned kXY = 3;              // axes, see Step::unknown_axes
constexpr double kCellsPerBeam = 5.0;    // across the beam, by default
constexpr double kFewestPerBeam = 3.0;   // across the beam, else its area is wrong
constexpr double kChordsPerBeam = 50.0;  // beam / deviation of a chord from its arc
constexpr std::size_t kBatch = 4096;     // lines between two reports of progress
constexpr double kUsual = 0.99;          // of the burnt area

/// A straight part of a motion with the beam on, or a beam at rest where both ends are equal.
struct Line {
  Point2 from, to;  // mm
  double joules = 0.0;
  Duration time{};
};

double watts_of(const step::LaserPower& beam, const BurnOptions& options) {
  if (beam.mode == LaserMode::off || !(beam.power > 0.0)) return 0.0;
  return options.full_power * std::min(beam.power / options.full_s, 1.0);
}

/// Calls its function for each line along which the beam is on.
class BeamReader {
 public:
  using Visit = std::function<void(const Line&)>;
  BeamReader(const Toolpath& path, const BurnOptions& options, Visit visit)
      : path_(path), options_(options), visit_(std::move(visit)) {}

  void run() {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      if (s.kind() == StepKind::laser_power) switch_beam(i);
      if (s.kind() == StepKind::dwell) dwell(s.dwell().time);
      if (s.is_cutting()) cut(i);
      if (s.is_motion()) after_cut_ = s.is_cutting();
      rest_.pass(s);
    }
  }
  std::optional<std::size_t> unknown, rotary, strong;  // the first step with each

 private:
  void switch_beam(std::size_t i) {
    beam_ = path_[i].laser_power();
    if (beam_.mode != LaserMode::off && beam_.power > options_.full_s && !strong) strong = i;
  }

  /// M4 is off while nothing moves, M3 after a rapid.
  void dwell(Duration time) {
    const double watts = watts_of(beam_, options_);
    if (!(watts > 0.0) || beam_.mode != LaserMode::constant || !after_cut_ || (rest_.unknown & kXY) != 0)
      return;
    visit_({xy(rest_.at), xy(rest_.at), watts * time.seconds(), time});
  }

  void cut(std::size_t i) {
    const Step& s = path_[i];
    const double watts = watts_of(beam_, options_), speed = s.feed().mm_per_min() / 60.0;  // mm/s
    if (!(watts > 0.0) || !(speed > 0.0)) return;
    if (((s.unknown_axes() | rest_.unknown) & kXY) != 0) {
      if (!unknown) unknown = i;
      return;
    }
    if (path_.extra(i) != nullptr && path_.extra(i)->abc && !rotary) rotary = i;
    if (s.kind() == StepKind::cut) return line(rest_.at, s.to(), watts, speed);
    const ArcWalk walk = walk_of(s, rest_.at);
    const int chords = std::max(1, walk.chords(options_.beam / kChordsPerBeam));
    Point3 last = rest_.at;
    for (int k = 1; k <= chords; ++k) {
      const Point3 at = k == chords ? s.to() : walk.at(static_cast<double>(k) / chords);
      line(last, at, watts, speed);
      last = at;
    }
  }

  void line(Point3 from, Point3 to, double watts, double speed) {
    const bool known = (rest_.unknown & 4u) == 0;
    const double way = known ? length(to - from) : distance(xy(from), xy(to));
    if (way > 0.0) visit_({xy(from), xy(to), watts * way / speed, seconds(way / speed)});
  }

  static Point2 xy(Point3 p) { return {p.x, p.y}; }

  const Toolpath& path_;
  const BurnOptions& options_;
  Visit visit_;
  PathPosition rest_;
  step::LaserPower beam_;
  bool after_cut_ = false;
};

/// Cells at a fraction of the beam, in squares that exist only where the beam passes.
class FineCells {
 public:
  static constexpr std::size_t kSide = 64;  // cells along a square's side
  FineCells(Point2 low, Point2 high, double cell)
      : low_(low), cell_(cell), nx_(count(high.x - low.x)), ny_(count(high.y - low.y)) {
    squares_.resize(squares_x() * ((ny() + kSide - 1) / kSide));
  }
  Point2 low() const { return low_; }
  double cell() const { return cell_; }
  std::size_t nx() const { return nx_; }
  std::size_t ny() const { return ny_; }
  float& at(std::size_t x, std::size_t y) {
    std::vector<float>& square = squares_[y / kSide * squares_x() + x / kSide];
    if (square.empty()) square.assign(kSide * kSide, 0.0F);
    return square[y % kSide * kSide + x % kSide];
  }
  /// Calls visit(x, y, value) for each cell with energy.
  template <class Visit>
  void for_burnt(const Visit& visit) const {
    for (std::size_t s = 0; s < squares_.size(); ++s)
      for (std::size_t k = 0; k < squares_[s].size(); ++k)
        if (squares_[s][k] > 0.0F)
          visit(s % squares_x() * kSide + k % kSide, s / squares_x() * kSide + k / kSide, squares_[s][k]);
  }

 private:
  std::size_t count(double length) const { return static_cast<std::size_t>(std::ceil(length / cell_)); }
  std::size_t squares_x() const { return (nx_ + kSide - 1) / kSide; }

  Point2 low_;
  double cell_;
  std::size_t nx_, ny_;
  std::vector<std::vector<float>> squares_;
};

/// Counts the cells of the squares that lines pass.
class PassedSquares {
 public:
  PassedSquares(const Box3& box, double radius, double cell)
      : low_{box.low.x - radius, box.low.y - radius}, side_(FineCells::kSide * cell), radius_(radius) {
    nx_ = number(box.high.x + radius - low_.x) + 1;
    passed_.resize(nx_ * (number(box.high.y + radius - low_.y) + 1));
  }
  void add(const Line& line) {
    const double length = std::hypot(line.to.x - line.from.x, line.to.y - line.from.y);
    const double pieces = std::max(1.0, std::ceil(length / side_));
    for (double k = 0.0; k < pieces; k += 1.0) {
      const Point2 a = line.from + (k / pieces) * (line.to - line.from);
      const Point2 b = line.from + ((k + 1.0) / pieces) * (line.to - line.from);
      mark({std::min(a.x, b.x) - radius_, std::min(a.y, b.y) - radius_},
           {std::max(a.x, b.x) + radius_, std::max(a.y, b.y) + radius_});
    }
  }
  double cells() const {
    const auto squares = static_cast<double>(std::count(passed_.begin(), passed_.end(), true));
    return squares * static_cast<double>(FineCells::kSide * FineCells::kSide);
  }

 private:
  std::size_t number(double from_low) const {
    return static_cast<std::size_t>(std::max(0.0, std::floor(from_low / side_)));
  }
  void mark(Point2 from, Point2 to) {
    const std::size_t last_x = std::min(number(to.x - low_.x), nx_ - 1);
    const std::size_t last_y = std::min(number(to.y - low_.y), passed_.size() / nx_ - 1);
    for (std::size_t y = number(from.y - low_.y); y <= last_y; ++y)
      for (std::size_t x = number(from.x - low_.x); x <= last_x; ++x) passed_[y * nx_ + x] = true;
  }

  Point2 low_;
  double side_, radius_;
  std::size_t nx_ = 0;
  std::vector<bool> passed_;
};

/// The cells under a line. Of the round beam, each point of the board gets the chord that passes over it.
class Spread {
 public:
  Spread(FineCells& cells, double radius) : cells_(cells), radius_(radius) {}

  void add(const Line& line) {
    const Point2 way = line.to - line.from;
    const double length = std::hypot(way.x, way.y);
    const double area = std::numbers::pi * radius_ * radius_;
    const int first = row(std::min(line.from.y, line.to.y) - radius_);
    const int last = row(std::max(line.from.y, line.to.y) + radius_);
    for (int iy = first; iy <= last; ++iy) {
      const double y = cells_.low().y + (iy + 0.5) * cells_.cell();
      const auto [low, high] = columns(line, way, length, y);
      for (int ix = low; ix <= high; ++ix) {
        const Point2 p{cells_.low().x + (ix + 0.5) * cells_.cell(), y};
        const double part = part_at(p - line.from, way, length);
        if (part > 0.0)
          cells_.at(static_cast<std::size_t>(ix), static_cast<std::size_t>(iy)) +=
              static_cast<float>(line.joules * part / area);
      }
    }
  }

 private:
  /// The part of the line's energy that has its beam over a point, `p` from the line's start.
  double part_at(Point2 p, Point2 way, double length) const {
    const double far = p.x * p.x + p.y * p.y, r2 = radius_ * radius_;
    if (!(length > 0.0)) return far <= r2 ? 1.0 : 0.0;
    const double along = (p.x * way.x + p.y * way.y) / length;
    const double half2 = r2 - (far - along * along);
    if (!(half2 > 0.0)) return 0.0;
    const double half = std::sqrt(half2);
    return std::max(0.0, std::min(along + half, length) - std::max(along - half, 0.0)) / length;
  }

  /// The columns of a row that the beam can reach.
  std::pair<int, int> columns(const Line& line, Point2 way, double length, double y) const {
    double low = std::min(line.from.x, line.to.x) - radius_,
           high = std::max(line.from.x, line.to.x) + radius_;
    if (std::abs(way.y) > 1e-9 * length && length > 0.0) {
      const double centre = line.from.x + way.x * (y - line.from.y) / way.y;
      const double reach = radius_ * length / std::abs(way.y);
      low = std::max(low, centre - reach), high = std::min(high, centre + reach);
    }
    return {index(low - cells_.low().x, cells_.nx()), index(high - cells_.low().x, cells_.nx())};
  }
  int row(double y) const { return index(y - cells_.low().y, cells_.ny()); }
  int index(double from_low, std::size_t count) const {
    return static_cast<int>(
        std::clamp(std::floor(from_low / cells_.cell()), 0.0, static_cast<double>(count) - 1.0));
  }

  FineCells& cells_;
  double radius_;
};

bool valid(const BurnOptions& options, Diagnostics& diagnostics) {
  const auto positive = [&](double value, std::string_view what) {
    if (value > 0.0 && std::isfinite(value)) return true;
    diagnostics.error(codes::bad_resolution, {},
                      fmt::format("{} must be a number above 0, not {}", what, number_text(value, 6)));
    return false;
  };
  const bool cell = options.cell == Length{} || positive(options.cell.mm(), "the cell of a burn");
  return positive(options.beam.mm(), "the beam of a laser") &&
         positive(options.full_power, "the power of a laser") &&
         positive(options.full_s, "the S of full power") && cell;
}

void warn(const BeamReader& beam, const Toolpath& path, const BurnOptions& options,
          Diagnostics& diagnostics) {
  if (beam.unknown)
    diagnostics.warning(codes::cut_at_unknown_place, path.origin_of(*beam.unknown),
                        "the beam is on at an unknown position; its burn is left out");
  if (beam.rotary)
    diagnostics.warning(codes::rotary_not_simulated, path.origin_of(*beam.rotary),
                        "rotary axes move with the beam on; the burn is that of X and Y alone");
  if (beam.strong)
    diagnostics
        .warning(codes::path_spindle_range, path.origin_of(*beam.strong),
                 fmt::format("S above {}, which is full power", number_text(options.full_s, 1)))
        .hint = "specify the S of full power with --max-s";
}

/// The side of the fine cells: as asked, but at most a third of the beam, and larger only where the
/// squares along the path had too many.
double fine_cell(const Toolpath& path, const Box3& box, const BurnOptions& options) {
  constexpr double kCoarser = 1.25;
  const double beam = options.beam.mm(), radius = 0.5 * beam;
  const auto limit = static_cast<double>(options.max_cells);
  const Point3 size = box.high - box.low;
  double cell = beam / kCellsPerBeam;
  if (options.cell > Length{}) cell = std::min(options.cell.mm(), beam / kFewestPerBeam);
  // Finer squares than these would be too many to be listed.
  const double side = std::max({std::sqrt((size.x + beam) * (size.y + beam) / limit), (size.x + beam) / limit,
                                (size.y + beam) / limit});
  cell = std::max(cell, side / static_cast<double>(FineCells::kSide));
  for (;; cell *= kCoarser) {
    PassedSquares passed(box, radius, cell);
    BeamReader(path, options, [&](const Line& line) { passed.add(line); }).run();
    if (passed.cells() <= std::max(limit, 4.0 * FineCells::kSide * FineCells::kSide)) return cell;
  }
}

/// Of the beam, mm. One narrower than three cells would miss the centres of cells: it is shown three cells
/// wide.
double shown_radius(double cell, const BurnOptions& options) {
  return 0.5 * std::max(options.beam.mm(), kFewestPerBeam * cell);
}

FineCells cells_of(const Toolpath& path, const Box3& box, const BurnOptions& options) {
  const double cell = fine_cell(path, box, options);
  const double margin = shown_radius(cell, options) + cell;
  return {{box.low.x - margin, box.low.y - margin}, {box.high.x + margin, box.high.y + margin}, cell};
}

/// A warning with the figure if the cells do not show the beam.
void warn_coarse(double cell, const BurnOptions& options, Diagnostics& diagnostics) {
  if (cell <= options.beam.mm() / kFewestPerBeam * (1.0 + 1e-9)) return;
  diagnostics
      .warning(codes::burn_coarse, {},
               fmt::format("the burn is shown by cells of {} mm, more than a third of the beam of {} mm: its "
                           "area and its highest energy are not exact",
                           number_text(cell, 3), number_text(options.beam.mm(), 3)))
      .hint = "map a smaller part of the program, or specify a wider beam with --spot";
}

/// The map: fine cells, or the mean of squares of them where they are too many or larger ones are asked for.
void fill_map(BurnMap& map, const FineCells& cells, const BurnOptions& options) {
  const double all = static_cast<double>(cells.nx()) * static_cast<double>(cells.ny());
  const auto max_cells = static_cast<double>(options.max_cells), asked = options.cell.mm() / cells.cell();
  const double along = std::ceil(std::max({std::sqrt(all / max_cells), std::round(asked), 1.0}));
  const auto n = static_cast<std::size_t>(along);
  map.cell = along * cells.cell();
  map.low = cells.low();
  map.nx = static_cast<int>((cells.nx() + n - 1) / n);
  map.ny = static_cast<int>((cells.ny() + n - 1) / n);
  map.joules_per_mm2.assign(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny), 0.0F);
  const float fraction = static_cast<float>(1.0 / (along * along));
  cells.for_burnt([&](std::size_t x, std::size_t y, float value) {
    map.joules_per_mm2[y / n * static_cast<std::size_t>(map.nx) + x / n] += fraction * value;
  });
}

void summarize(BurnMap& map, const FineCells& cells) {
  std::vector<float> burnt;
  cells.for_burnt([&](std::size_t x, std::size_t y, float value) {
    burnt.push_back(value);
    if (static_cast<double>(value) <= map.highest) return;
    map.highest = static_cast<double>(value);
    map.highest_at = {cells.low().x + (static_cast<double>(x) + 0.5) * cells.cell(),
                      cells.low().y + (static_cast<double>(y) + 0.5) * cells.cell()};
  });
  map.burnt_mm2 = static_cast<double>(burnt.size()) * cells.cell() * cells.cell();
  if (burnt.empty()) return;
  const auto usual =
      burnt.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(burnt.size() - 1));
  std::nth_element(burnt.begin(), usual, burnt.end());
  map.usual_highest = static_cast<double>(*usual);
}

}  // namespace

double BurnMap::at(Point2 p) const {
  const double x = std::floor((p.x - low.x) / cell), y = std::floor((p.y - low.y) / cell);
  if (!(x >= 0.0 && y >= 0.0 && x < nx && y < ny)) return 0.0;
  return static_cast<double>(joules_per_mm2[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
                                            static_cast<std::size_t>(x)]);
}

std::optional<BurnMap> map_burn(const Toolpath& path, const BurnOptions& options, Diagnostics& diagnostics,
                                Progress* progress) {
  if (!valid(options, diagnostics)) return std::nullopt;
  Box3 box;
  std::size_t lines = 0;
  BeamReader survey(path, options, [&](const Line& line) {
    box.add(Point3{line.from.x, line.from.y, 0.0});
    box.add(Point3{line.to.x, line.to.y, 0.0});
    ++lines;
  });
  survey.run();
  warn(survey, path, options, diagnostics);
  if (lines == 0) {
    const bool laser = path.has(StepKind::laser_power);
    diagnostics
        .error(
            codes::nothing_to_cut, path.size() > 0 ? path.origin_of(0) : Origin{},
            laser ? "the beam is never on during a motion at feed" : "the program switches no laser's beam")
        .hint = laser ? "" : "--dialect laser reads M3, M4 and S as a laser's";
    return std::nullopt;
  }
  if (progress != nullptr) progress->phase("burning");
  BurnMap map;
  FineCells cells = cells_of(path, box, options);
  warn_coarse(cells.cell(), options, diagnostics);
  Spread spread(cells, shown_radius(cells.cell(), options));
  std::size_t done = 0;
  bool stopped = false;
  BeamReader(path, options, [&](const Line& line) {
    if (done % kBatch == 0 && !stopped) {
      report(progress, static_cast<double>(done) / static_cast<double>(lines));
      stopped = stop_requested(progress);
    }
    ++done;
    if (stopped) return;
    spread.add(line);
    map.joules += line.joules;
    map.on = map.on + line.time;
  }).run();
  if (stopped) return std::nullopt;
  fill_map(map, cells, options);
  summarize(map, cells);
  return map;
}

}  // namespace kerf
