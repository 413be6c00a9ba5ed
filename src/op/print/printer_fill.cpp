// The printer: walls, fills, brims, ironing.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "base/codes/op.h"
#include "geom/medial/medial_axis.h"
#include "op/base/hatch.h"
#include "path/bead.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/op/printer.h"

namespace kerf {
namespace {

constexpr double kSliver = 0.2;     // of the width: narrower left-over parts are no parts
constexpr double kRowSlack = 1e-9;  // of a row: rounding of a height makes no row of its own
constexpr double kOblique = 0.3;    // of half the oblique end of a row, by which it is shortened
constexpr double kMinSine = 0.3;    // of an angle to the boundary; flatter ends are treated as this one
constexpr int kMaxWalls = 1000;
constexpr std::size_t kMaxRings = 100'000;
constexpr std::size_t kMaxOrdered =
    200'000;  // rows that are put in order; the time of a jump grows with them

}  // namespace

/// All points of a region that are at least `by` from its boundary; below 0 it grows.
std::optional<Region> Printer::shrunk(const Region& region, double by) {
  if (by == 0.0) return region;
  auto made = offset(region, mm(-by), region_options(), diagnostics_);
  if (!made) return std::nullopt;
  return std::move(made->region);
}

/// Closed beads along loops, the nearest next.
bool Printer::lay_loops(std::vector<Outline> loops, const BeadOptions& options) {
  std::vector<std::vector<Point2>> rings;
  for (const Outline& loop : loops) rings.push_back(flattened(loop, settings_.chord));
  while (!rings.empty()) {
    std::size_t best = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rings.size() && known_; ++i)
      for (const Point2 p : rings[i])
        if (const double d = distance(p, at_.xy()); d < nearest) nearest = d, best = i;
    if (!lay_along(from_seam(std::move(rings[best])), options)) return false;
    rings.erase(rings.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return true;
}

std::optional<Region> Printer::walls(const Region& region, int count) {
  if (!usable("walls")) return std::nullopt;
  if (region.empty() || count < 0 || count > kMaxWalls) {
    diagnostics_.error(
        region.empty() ? codes::op_empty : codes::op_option, where_,
        region.empty() ? "the region of the walls is empty" : "the number of walls must be from 0 to 1000");
    return std::nullopt;
  }
  const double width = settings_.width.mm(), apart = spacing().mm();
  for (int i = 0; i < count; ++i) {
    const auto centres = offset(region, mm(-(0.5 * width + i * apart)), region_options(), diagnostics_);
    if (!centres) return std::nullopt;
    if (i == 0 && centres->vanished > 0)
      diagnostics_.warning(codes::op_tool_wide, where_,
                           fmt::format("a wall of {:g} mm is too wide for a part of the region", width));
    if (!lay_loops(centres->region.loops, {i == 0 ? BeadKind::outer_wall : BeadKind::wall}))
      return std::nullopt;
  }
  return count == 0 ? region : shrunk(region, count * apart + 0.5 * (width - apart));
}

bool Printer::brim(const Region& region, int loops, Length gap) {
  if (!usable("a brim")) return false;
  const bool ok = !region.empty() && loops >= 0 && loops <= kMaxWalls && gap.mm() >= 0.0 &&
                  gap.mm() <= limits::kMaxCoordinate;
  if (!ok) {
    diagnostics_.error(region.empty() ? codes::op_empty : codes::op_option, where_,
                       region.empty() ? "the region of the brim is empty"
                                      : "a brim has 0 to 1000 loops and a gap of 0 mm or more");
    return false;
  }
  const double apart = spacing().mm(), first = gap.mm() + apart - 0.5 * settings_.width.mm();
  for (int i = loops - 1; i >= 0; --i) {
    const auto around = shrunk(region, -(first + i * apart));
    if (!around) return false;
    std::vector<Outline> outer;  // not inside of holes
    for (const Outline& loop : around->loops)
      if (area(loop) > 0.0) outer.push_back(loop);
    if (!lay_loops(std::move(outer), {BeadKind::skirt})) return false;
  }
  return true;
}

// ---- rows

/// Each row continues at the nearer end of a line of the next row, else at the nearest line that is left.
std::vector<FillRow> Printer::in_order(std::vector<FillRow> lines) const {
  std::vector<FillRow> ordered;
  std::vector<bool> used(lines.size());
  std::vector<std::size_t> first_of_row;  // lines are sorted by row
  for (std::size_t i = 0; i < lines.size(); ++i)
    while (first_of_row.size() <= lines[i].row) first_of_row.push_back(i);
  first_of_row.push_back(lines.size());
  first_of_row.push_back(lines.size());
  Point2 here = known_ ? at_.xy() : lines.empty() ? Point2{} : lines.front().from;
  std::size_t row = 0;
  for (std::size_t done = 0; done < lines.size(); ++done) {
    std::size_t best = lines.size();
    double nearest = std::numeric_limits<double>::infinity();
    const auto look = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        if (used[i]) continue;
        const double d = std::min(distance(here, lines[i].from), distance(here, lines[i].to));
        if (d < nearest) nearest = d, best = i;
      }
    };
    if (done > 0)
      look(first_of_row[row + 1], first_of_row[row + 2 < first_of_row.size() ? row + 2 : row + 1]);
    const double near = done > 0 && best < lines.size() ? 4.0 * settings_.width.mm() : 0.0;
    if (best == lines.size() || nearest > near) look(0, lines.size());
    FillRow line = lines[best];
    used[best] = true;
    if (distance(here, line.to) < distance(here, line.from)) std::swap(line.from, line.to);
    row = line.row;
    here = line.to;
    ordered.push_back(line);
  }
  return ordered;
}

/// A row ends square. Where the boundary is oblique, half of the end is beyond it and half is missing before
/// it; what is beyond would be printed twice, so the row is a little shorter.
FillRow shortened(FillRow line, const RegionSearch& search, double apart) {
  const Point2 way = line.to - line.from;
  const double full = length(way), probe = std::min(0.5 * apart, 0.25 * full);
  if (!(probe > 0.0)) return line;
  const Point2 along = 1.0 / full * way;
  const auto back = [&](Point2 inside) {
    const double clear = search.clearance(inside).value_or(Length{}).mm();
    const double sine = std::clamp(clear / probe, kMinSine, 1.0);
    return std::min(kOblique * 0.5 * apart * std::sqrt(1.0 - sine * sine) / sine, 0.25 * full);
  };
  const double start = back(line.from + probe * along), end = back(line.to - probe * along);
  line.from = line.from + start * along;
  line.to = line.to - end * along;
  return line;
}

/// Calls lay_row(line, distance of the rows) for parallel lines that end at the boundary.
template <class Lay>
bool Printer::run_rows(const Region& region, Angle angle, double spacing, Lay lay_row) {
  const Box2 box = bounds(rotated(region, {}, -1.0 * angle));
  const double height = box.high.y - box.low.y;
  const double rows = std::max(std::ceil(height / spacing - kRowSlack), 1.0);
  if (rows > static_cast<double>(kMaxOrdered)) {
    return room(settings_.max_steps + 1);
  }
  const RegionSearch search(region);
  std::vector<FillRow> lines;
  for (const op_detail::HatchLine& line : op_detail::hatch(region, angle, mm(spacing), kMaxOrdered))
    lines.push_back(shortened({line.from, line.to, line.row}, search, height / rows));
  if (!room(8 * lines.size())) return false;
  for (const FillRow& line : in_order(std::move(lines)))
    if (!lay_row(line, height / rows)) return false;
  return true;
}

std::optional<Region> Printer::fill_rows(const Region& region, const FillOptions& options) {
  const bool solid = options.density == 1.0;
  const double sides = settings_.side_overlap * height_.mm();
  BeadOptions bead{options.kind, {}, options.speed};
  if (bead.kind == BeadKind::none) bead.kind = solid ? BeadKind::solid_infill : BeadKind::infill;
  const bool done = run_rows(region, options.angle, spacing().mm() / options.density,
                             [&](const FillRow& line, double apart) {
                               // Solid rows share the height of the region evenly; a row narrower than high
                               // is as wide as high.
                               if (solid) bead.width = mm(std::max(apart + sides, height_.mm()));
                               return lay_along({line.from, line.to}, bead);
                             });
  if (!done) return std::nullopt;
  return Region{};
}

// ---- rings

/// Rings whose distances divide the largest inner circle of each part evenly.
std::optional<Region> Printer::fill_rings(const Region& region, const FillOptions& options) {
  BeadOptions bead{options.kind, {}, options.speed};
  const bool solid = options.density == 1.0;
  if (bead.kind == BeadKind::none) bead.kind = solid ? BeadKind::solid_infill : BeadKind::infill;
  std::vector<Region> left;
  for (const Figure& figure : figures(region)) {
    const auto part = make_region(figure, region_options(), diagnostics_);
    if (!part) return std::nullopt;
    const auto circle = largest_inscribed_circle(*part, region_options(), diagnostics_);
    if (!circle) continue;
    const double radius = circle->radius.mm(), wanted = spacing().mm() / options.density;
    const double rings = std::max(std::ceil(radius / wanted - kRowSlack), 1.0);
    if (rings > static_cast<double>(kMaxRings)) {
      room(settings_.max_steps + 1);
      return std::nullopt;
    }
    const double apart = radius / rings;
    if (solid) bead.width = mm(std::max(apart + settings_.side_overlap * height_.mm(), height_.mm()));
    for (double i = 0.0; i < rings; i += 1.0) {
      const auto outer = shrunk(*part, i * apart), centres = shrunk(*part, (i + 0.5) * apart);
      if (!outer || !centres) return std::nullopt;
      if (!centres->empty() && !lay_loops(centres->loops, bead)) return std::nullopt;
      if (!solid) continue;
      const auto covered = shrunk(*centres, -0.5 * apart);
      if (!covered) return std::nullopt;
      auto rest = combine(*outer, *covered, Boolean::subtract, region_options(), diagnostics_);
      if (!rest) return std::nullopt;
      left.push_back(std::move(rest->region));
    }
  }
  const auto all = unite(left, region_options(), diagnostics_);
  const double sliver = 0.5 * kSliver * settings_.width.mm();
  const auto core = all ? shrunk(*all, sliver) : std::nullopt;
  return core ? shrunk(*core, -sliver) : std::nullopt;
}

std::optional<Region> Printer::fill(const Region& region, const FillOptions& options) {
  if (!usable("a fill")) return std::nullopt;
  const double speed = options.speed.mm_per_min();
  const char* problem = !(options.density > 0.0 && options.density <= 1.0)
                            ? "the density of a fill must be above 0 and at most 1"
                        : !(speed >= 0.0 && speed <= limits::kMaxSpeed)
                            ? "the speed of a fill must be above 0 mm/min"
                        : !std::isfinite(options.angle.rad()) ? "the angle of a fill must be finite"
                                                              : nullptr;
  if (problem != nullptr) {
    diagnostics_.error(codes::op_option, where_, problem);
    return std::nullopt;
  }
  if (region.empty()) return Region{};
  return options.pattern == FillPattern::zigzag ? fill_rows(region, options) : fill_rings(region, options);
}

bool Printer::iron(const Region& region, const IroningOptions& options) {
  if (!usable("ironing")) return false;
  const double apart = options.spacing.mm(), speed = options.speed.mm_per_min();
  const char* problem =
      !(apart >= 0.01 && apart <= limits::kMaxBeadWidth) ? "the spacing of ironing must be from 0.01 to 20 mm"
      : !(options.flow >= 0.0 && options.flow <= 1.0)    ? "the flow of ironing must be from 0 to 1"
      : !(speed > 0.0 && speed <= limits::kMaxSpeed)     ? "the speed of ironing must be above 0 mm/min"
      : region.empty()                                   ? "the region of ironing is empty"
      : !std::isfinite(options.angle.rad())              ? "the angle of ironing must be finite"
                                                         : nullptr;
  if (problem != nullptr) {
    diagnostics_.error(region.empty() ? codes::op_empty : codes::op_option, where_, problem);
    return false;
  }
  return run_rows(region, options.angle, apart, [&](const FillRow& line, double rows) {
    if (!travel(line.from)) return false;
    const Point3 to{line.to.x, line.to.y, z_};
    const double volume = options.flow * rows * height_.mm() * distance(line.from, line.to);
    if (volume > 0.0)
      lay(to, 0.0, height_.mm(), volume, options.speed, BeadKind::ironing);
    else
      move(to, options.speed);
    return true;
  });
}

}  // namespace kerf
