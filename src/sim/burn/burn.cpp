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

/// The cells under a line. Of the round beam, each point of the board gets the chord that passes over it.
class Spread {
 public:
  Spread(BurnMap& map, double radius) : map_(map), radius_(radius) {}

  void add(const Line& line) {
    const Point2 way = line.to - line.from;
    const double length = std::hypot(way.x, way.y);
    const double area = std::numbers::pi * radius_ * radius_;
    const int first = row(std::min(line.from.y, line.to.y) - radius_);
    const int last = row(std::max(line.from.y, line.to.y) + radius_);
    for (int iy = first; iy <= last; ++iy) {
      const double y = map_.low.y + (iy + 0.5) * map_.cell;
      const auto [low, high] = columns(line, way, length, y);
      for (int ix = low; ix <= high; ++ix) {
        const Point2 p{map_.low.x + (ix + 0.5) * map_.cell, y};
        const double part = part_at(p - line.from, way, length);
        if (part > 0.0) cell(ix, iy) += static_cast<float>(line.joules * part / area);
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
    return {index(low - map_.low.x, map_.nx), index(high - map_.low.x, map_.nx)};
  }
  int row(double y) const { return index(y - map_.low.y, map_.ny); }
  int index(double from_low, int count) const {
    return static_cast<int>(std::clamp(std::floor(from_low / map_.cell), 0.0, count - 1.0));
  }
  float& cell(int ix, int iy) {
    return map_.joules_per_mm2[static_cast<std::size_t>(iy) * static_cast<std::size_t>(map_.nx) +
                               static_cast<std::size_t>(ix)];
  }

  BurnMap& map_;
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

/// The empty map of a box; its cells are larger than given if there were too many.
BurnMap map_of(const Box3& box, double radius, const BurnOptions& options) {
  BurnMap map;
  const double cell = options.cell > Length{} ? options.cell.mm() : options.beam.mm() / kCellsPerBeam;
  const Point3 size = box.high - box.low;
  // With a margin of a beam on all sides, or of a cell if that is larger.
  const double width = size.x + 2.0 * radius, height = size.y + 2.0 * radius;
  const auto cells = static_cast<double>(options.max_cells);
  map.cell = std::max({cell, std::sqrt(width * height / cells), (width + height) * 4.0 / cells});
  const double margin = std::max(radius, map.cell) + map.cell;
  map.low = {box.low.x - margin, box.low.y - margin};
  map.nx = static_cast<int>(std::ceil((size.x + 2.0 * margin) / map.cell));
  map.ny = static_cast<int>(std::ceil((size.y + 2.0 * margin) / map.cell));
  map.joules_per_mm2.assign(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny), 0.0F);
  return map;
}

void summarize(BurnMap& map) {
  std::vector<float> burnt;
  for (std::size_t i = 0; i < map.joules_per_mm2.size(); ++i) {
    const float value = map.joules_per_mm2[i];
    if (!(value > 0.0F)) continue;
    burnt.push_back(value);
    if (static_cast<double>(value) <= map.highest) continue;
    map.highest = static_cast<double>(value);
    const auto nx = static_cast<std::size_t>(map.nx);
    map.highest_at = {map.low.x + (static_cast<double>(i % nx) + 0.5) * map.cell,
                      map.low.y + (static_cast<double>(i / nx) + 0.5) * map.cell};
  }
  map.burnt_mm2 = static_cast<double>(burnt.size()) * map.cell * map.cell;
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
  BurnMap map = map_of(box, 0.5 * options.beam.mm(), options);
  // A beam narrower than a cell would miss the centres of cells: it is spread over the cell.
  Spread spread(map, std::max(0.5 * options.beam.mm(), map.cell));
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
  summarize(map);
  return map;
}

}  // namespace kerf
