// Rows of a tool that touches a surface: the maximum, over samples of its end, of the surface less the
// height of the tool there.
#include "op/mesh/surface_rows.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/pace.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

constexpr int kSamples = 10;                          // of a tool's radius
constexpr int kHeights = 2000;                        // of a tool's profile, closer together at its tip
constexpr double kMaxValues = 20'000'000;             // of the surface; 160 MB
constexpr double kMaxComparisons = 20'000'000'000.0;  // of a point of the tool with the surface: a minute
constexpr double kSameRadius = 1e-9;                  // mm

/// The height of a tool's surface above its tip at a distance from the axis, no higher than it is.
class ToolEnd {
 public:
  explicit ToolEnd(const Tool& tool) {
    const double top = std::min(tool.flute.mm(), 2 * tool.diameter.mm());
    double widest = 0.0;
    for (int i = 0; i <= kHeights; ++i) {
      const double t = static_cast<double>(i) / kHeights;
      heights_.push_back(top * t * t);
      widest = std::max(widest, tool.silhouette.cutting.radius_at(heights_.back()));
      radii_.push_back(widest);
    }
  }
  double at(double distance) const {
    const auto found = std::lower_bound(radii_.begin(), radii_.end(), distance - kSameRadius);
    const auto index = found - radii_.begin();
    return heights_[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, index - 1))];
  }

 private:
  std::vector<double> heights_, radii_;
};

/// A point of the tool's end: where it is from the axis, in X, and how high.
struct EndPoint {
  double dx = 0.0, lift = 0.0;
};
struct EndRow {
  double dy = 0.0;
  std::vector<EndPoint> points;
};

std::vector<EndRow> end_rows(const Tool& tool, double radius, double step) {
  const ToolEnd end(tool);
  std::vector<EndRow> rows;
  for (int k = -kSamples; k <= kSamples; ++k) {
    EndRow row{k * step, {}};
    const double rim = std::sqrt(std::max(0.0, radius * radius - row.dy * row.dy));
    const auto add = [&](double dx) {
      row.points.push_back({dx, end.at(std::min(std::hypot(dx, row.dy), radius))});
    };
    add(-rim);
    for (int i = -kSamples; i <= kSamples; ++i)
      if (std::abs(i * step) < rim) add(i * step);
    add(rim);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Evenly spaced values from `low` to `high`.
struct Axis {
  double low = 0.0, high = 0.0;
  std::size_t count = 2;

  double at(std::size_t i) const {
    return i + 1 == count ? high
                          : low + static_cast<double>(i) * (high - low) / static_cast<double>(count - 1);
  }
  /// The position of a value in steps, within the axis.
  double steps(double value) const {
    const double last = static_cast<double>(count - 1);
    return std::clamp((value - low) / (high - low) * last, 0.0, last);
  }
};

/// `values` at a position between two of them.
double between(const std::vector<double>& values, double position) {
  const std::size_t i = std::min(static_cast<std::size_t>(position), values.size() - 2);
  return values[i] + (values[i + 1] - values[i]) * (position - static_cast<double>(i));
}

/// A row without the points that a straight line between others passes within a tolerance.
std::vector<Point3> simplified(const std::vector<Point3>& row, double within) {
  std::vector<bool> keep(row.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> work{{0, row.size() - 1}};
  while (!work.empty()) {
    const auto [a, b] = work.back();
    work.pop_back();
    double far = within;
    std::size_t at = 0;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double t = (row[i].x - row[a].x) / (row[b].x - row[a].x);
      const double off = std::abs(row[i].z - (row[a].z + (row[b].z - row[a].z) * t));
      if (off > far) far = off, at = i;
    }
    if (at == 0) continue;
    keep[at] = true;
    work.push_back({a, at});
    work.push_back({at, b});
  }
  std::vector<Point3> kept;
  for (std::size_t i = 0; i < row.size(); ++i)
    if (keep[i]) kept.push_back(row[i]);
  return kept;
}

/// The samples of the surface, and the rows that follow from them.
class Rows {
 public:
  Rows(const HeightFunction& surface, const Tool& tool, const SurfaceRowOptions& options,
       Diagnostics& diagnostics)
      : surface_(surface), tool_(tool), options_(options), diagnostics_(diagnostics) {}

  std::optional<std::vector<std::vector<Point3>>> run() {
    if (!check() || !sample()) return std::nullopt;
    const std::vector<EndRow> ends = end_rows(tool_, radius_, step_);
    std::vector<std::vector<Point3>> rows;
    Pace pace(options_.progress, "rows of the surface", 1);
    for (std::size_t j = 0; j < rows_; ++j) {
      if (pace.stops(j, rows_)) return std::nullopt;
      std::vector<Point3> row =
          touching(ends, std::min(options_.low.y + static_cast<double>(j) * over_, options_.high.y));
      if (j % 2 == 1) std::reverse(row.begin(), row.end());
      rows.push_back(simplified(row, options_.simplification.mm()));
    }
    return rows;
  }

 private:
  bool refuse(Code code, const std::string& text) {
    diagnostics_.error(code, options_.where, text);
    return false;
  }

  bool check() {
    const Point2 size = options_.high - options_.low;
    const auto usable = [](double v) { return v > 0.0 && v <= limits::kMaxStockSize; };
    if (!usable(size.x) || !usable(size.y))
      return refuse(codes::op_option, fmt::format("surface: a rectangle of {:g} x {:g} mm", size.x, size.y));
    if (!(options_.stepover > 0.0 && options_.stepover <= 1.0))
      return refuse(codes::op_option,
                    fmt::format("stepover must be above 0 and at most 1, not {:g}", options_.stepover));
    radius_ = tool_.diameter.mm() / 2;
    step_ = radius_ / kSamples;
    over_ = options_.stepover * tool_.diameter.mm();
    const double columns = std::ceil(size.x / step_) + 1, lines = std::ceil(size.y / step_) + 1;
    const double rows = std::ceil(size.y / over_) + 1;
    if ((columns + 2 * kSamples) * (lines + 2 * kSamples) > kMaxValues ||
        rows * columns * 2 * kSamples * 2 * kSamples > kMaxComparisons)
      return refuse(codes::op_limit, fmt::format("surface: {:g} x {:g} mm is too large for a tool of {:g} mm",
                                                 size.x, size.y, tool_.diameter.mm()));
    columns_ = {options_.low.x, options_.high.x, static_cast<std::size_t>(columns)};
    rows_ = static_cast<std::size_t>(rows);
    at_x_ = {options_.low.x - radius_, options_.high.x + radius_, columns_.count + 2 * kSamples};
    at_y_ = {options_.low.y - radius_, options_.high.y + radius_,
             static_cast<std::size_t>(lines) + 2 * kSamples};
    return true;
  }

  bool sample() {
    values_.resize(at_y_.count, std::vector<double>(at_x_.count));
    Pace pace(options_.progress, "heights of the surface", 1);
    for (std::size_t j = 0; j < at_y_.count; ++j) {
      if (pace.stops(j, at_y_.count)) return false;
      for (std::size_t i = 0; i < at_x_.count; ++i) {
        const Point2 p{at_x_.at(i), at_y_.at(j)};
        const double z = surface_(p);
        if (!(std::abs(z) <= limits::kMaxCoordinate))
          return refuse(codes::op_option,
                        fmt::format("surface: at X{:g} Y{:g} it is not a finite number up to {:g}", p.x, p.y,
                                    limits::kMaxCoordinate));
        values_[j][i] = z;
      }
    }
    return true;
  }

  std::vector<Point3> touching(const std::vector<EndRow>& ends, double y) const {
    std::vector<double> best(columns_.count, -limits::kMaxCoordinate), line(at_x_.count);
    for (const EndRow& end : ends) {
      const double position = at_y_.steps(y + end.dy);
      const std::size_t j = std::min(static_cast<std::size_t>(position), at_y_.count - 2);
      const double part = position - static_cast<double>(j);
      for (std::size_t i = 0; i < line.size(); ++i)
        line[i] = values_[j][i] + (values_[j + 1][i] - values_[j][i]) * part;
      for (const EndPoint& point : end.points)
        for (std::size_t i = 0; i < best.size(); ++i)
          best[i] = std::max(best[i], between(line, at_x_.steps(columns_.at(i) + point.dx)) - point.lift);
    }
    std::vector<Point3> row;
    for (std::size_t i = 0; i < best.size(); ++i) row.push_back({columns_.at(i), y, best[i]});
    return row;
  }

  const HeightFunction& surface_;
  const Tool& tool_;
  const SurfaceRowOptions& options_;
  Diagnostics& diagnostics_;
  double radius_ = 0.0, step_ = 0.0, over_ = 0.0;  // mm
  Axis columns_, at_x_, at_y_;
  std::size_t rows_ = 0;
  std::vector<std::vector<double>> values_;  // of the surface, by Y and X
};

}  // namespace

std::optional<std::vector<std::vector<Point3>>> surface_rows(const HeightFunction& surface, const Tool& tool,
                                                             const SurfaceRowOptions& options,
                                                             Diagnostics& diagnostics) {
  return Rows(surface, tool, options, diagnostics).run();
}

}  // namespace kerf
