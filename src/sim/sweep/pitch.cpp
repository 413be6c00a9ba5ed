// The distance of the columns: as given, or chosen by the stock, the tools and where they cut.
#include "sim/sweep/pitch.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "base/codes/sim.h"
#include "base/number.h"
#include "sim/dexel/tile.h"

#include "kerf/base/limits.h"

namespace kerf::sim {
namespace {

constexpr double kMinPitch = 1e-4;         // mm; below it single precision does not suffice
constexpr double kDefaultColumns = 2.5e6;  // of the default resolution
constexpr double kDefaultFinest = 0.02, kDefaultCoarsest = 1.0;  // mm
constexpr double kMaxDefaultColumns = 5e7;  // the default resolution is made coarser for more
// A narrow cut has at least so many columns across, as long as the tiles that are cut and the whole stock
// have no more columns than these.
constexpr double kColumnsAcross = 3.0;
constexpr double kFewestAcross = 2.0;  // with fewer, cuts may be missing
constexpr double kMaxCutColumns = 1.2e7, kMaxFineColumns = 1e8;

/// The widest cut of the tool whose widest cut is narrowest; infinite if none cuts.
double narrowest_cut(const Survey& survey) {
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < survey.solids.size(); ++n) {
    const double depth = survey.deepest[n];
    const double width = depth > 0.0 ? 2.0 * survey.solids[n].cutting.reach_below(depth) : 0.0;
    if (width > 0.0) narrowest = std::min(narrowest, width);
  }
  return narrowest;
}

/// The tiles that motions below the top of a block reach.
class CutTiles {
 public:
  CutTiles(const Box3& block, double pitch)
      : block_(block),
        side_(kTileColumns * pitch),
        nx_(count(block.high.x - block.low.x)),
        ny_(count(block.high.y - block.low.y)),
        cut_(nx_ * ny_) {}

  void add(const Step& step, const MotionContext& motion, double radius) {
    if (std::min(motion.from.z, step.to().z) >= block_.high.z) return;
    if (step.kind() == StepKind::arc) {
      const Point2 c = step.arc().centre;
      const double r = std::hypot(step.to().x - c.x, step.to().y - c.y) + radius;
      return mark({c.x - r, c.y - r}, {c.x + r, c.y + r});
    }
    const Point2 from{motion.from.x, motion.from.y}, to{step.to().x, step.to().y};
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double pieces = std::clamp(std::ceil(length / side_), 1.0, kMaxPieces);
    for (double k = 0.0; k < pieces; k += 1.0) {
      const Point2 a = from + (k / pieces) * (to - from), b = from + ((k + 1.0) / pieces) * (to - from);
      mark({std::min(a.x, b.x) - radius, std::min(a.y, b.y) - radius},
           {std::max(a.x, b.x) + radius, std::max(a.y, b.y) + radius});
    }
  }
  double columns() const {
    const auto tiles = static_cast<double>(std::count(cut_.begin(), cut_.end(), true));
    return tiles * kTileColumns * kTileColumns;
  }

 private:
  static constexpr double kMaxPieces = 1e5;
  std::size_t count(double length) const { return static_cast<std::size_t>(std::ceil(length / side_)) + 1; }
  std::size_t number(double at, double low, std::size_t tiles) const {
    return static_cast<std::size_t>(
        std::clamp(std::floor((at - low) / side_), 0.0, static_cast<double>(tiles - 1)));
  }
  void mark(Point2 low, Point2 high) {
    if (high.x < block_.low.x || high.y < block_.low.y || low.x > block_.high.x || low.y > block_.high.y)
      return;
    const std::size_t last_x = number(high.x, block_.low.x, nx_), last_y = number(high.y, block_.low.y, ny_);
    for (std::size_t y = number(low.y, block_.low.y, ny_); y <= last_y; ++y)
      for (std::size_t x = number(low.x, block_.low.x, nx_); x <= last_x; ++x) cut_[y * nx_ + x] = true;
  }

  Box3 block_;
  double side_;  // of a tile
  std::size_t nx_, ny_;
  std::vector<bool> cut_;
};

double cut_columns(const Toolpath& path, const Survey& survey, const Box3& block, double pitch) {
  CutTiles tiles(block, pitch);
  for (MotionReader motion(path); motion.next();) {
    const auto number = survey.tool_of(motion.context());
    const auto tool = number ? survey.index.find(*number) : survey.index.end();
    if (!motion.step().is_cutting() || tool == survey.index.end()) continue;
    tiles.add(motion.step(), motion.context(), survey.solids[tool->second].cutting.rim);
  }
  return tiles.columns();
}

/// By the size of the stock; finer by steps of sqrt(2), so that small changes of a program keep it.
double default_pitch(const Toolpath& path, const Survey& survey, const Box3& block) {
  const double area = (block.high.x - block.low.x) * (block.high.y - block.low.y);
  const double by_size =
      std::max(std::clamp(std::sqrt(area / kDefaultColumns), kDefaultFinest, kDefaultCoarsest),
               std::sqrt(area / kMaxDefaultColumns));
  const double wanted = std::max(narrowest_cut(survey) / kColumnsAcross, kDefaultFinest);
  double pitch = by_size;
  while (pitch > wanted && 2.0 * area / (pitch * pitch) <= kMaxFineColumns) pitch /= std::sqrt(2.0);
  while (pitch < by_size && cut_columns(path, survey, block, pitch) > kMaxCutColumns) pitch *= std::sqrt(2.0);
  return std::min(pitch, by_size);
}

/// Warns of a default for which the work is too large.
void warn_of_coarse(double pitch, const Survey& survey, const Box3& block, Diagnostics& diagnostics) {
  const double width = narrowest_cut(survey), wanted = width / kColumnsAcross;
  if (width >= kFewestAcross * pitch) return;
  const double columns = (block.high.x - block.low.x) * (block.high.y - block.low.y) / (wanted * wanted);
  diagnostics
      .warning(
          codes::columns_coarse, {},
          fmt::format("a tool cuts {} mm wide, the columns of the simulation are {} mm apart: its cuts may "
                      "be missing in the part and in the volumes",
                      number_text(width, 3), number_text(pitch, 3)))
      .hint = columns > static_cast<double>(limits::kMaxColumns)
                  ? std::string("simulate a smaller stock around these cuts")
                  : fmt::format("try a resolution of {} mm", number_text(wanted, 3));
}

}  // namespace

std::optional<double> choose_pitch(const Toolpath& path, const Survey& survey,
                                   const SimulationOptions& options, const Stock& stock,
                                   Diagnostics& diagnostics) {
  const Point3 size = stock.block.size();
  double pitch = options.resolution.mm();
  if (pitch == 0.0 && stock.body) pitch = stock.body->pitch().value_or(Length()).mm();
  if (pitch == 0.0) {
    pitch = default_pitch(path, survey, stock.block);
    warn_of_coarse(pitch, survey, stock.block, diagnostics);
  }
  if (!std::isfinite(pitch) || pitch < kMinPitch) {
    diagnostics.error(
        codes::bad_resolution, {},
        fmt::format("the resolution is {} mm; expected a length of at least {} mm, or 0 for the default",
                    number_text(pitch, 9), number_text(kMinPitch, 4)));
    return std::nullopt;
  }
  pitch = std::min(pitch, std::max(size.x, size.y));  // at least one column
  const double columns = std::ceil(size.x / pitch) * std::ceil(size.y / pitch);
  const auto limit = static_cast<double>(std::min(options.max_columns, std::size_t{0xfffffff0}));
  if (columns <= limit) return pitch;
  // The finest pitch that is certainly allowed solves (x / p + 1) (y / p + 1) = limit, as the last column may
  // be narrower.
  const double area = size.x * size.y, edges = size.x + size.y, longest = std::max(size.x, size.y);
  const double root = std::sqrt(edges * edges + 4.0 * area * std::max(limit - 1.0, 0.0));
  const double possible = root > edges ? std::min(2.0 * area / (root - edges), longest) : longest;
  Diagnostic& error =
      diagnostics.error(codes::too_many_columns, {},
                        fmt::format("a resolution of {} mm needs {:.0f} columns; at most {:.0f} are allowed",
                                    number_text(pitch, 6), columns, limit));
  error.hint = fmt::format("try a resolution of {} mm", number_text(std::ceil(possible * 1e4) / 1e4, 4));
  return std::nullopt;
}

}  // namespace kerf::sim
