// The survey of a print and its columns.
#include "sim/print/print_survey.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/sim.h"
#include "base/number.h"

#include "kerf/base/limits.h"

namespace kerf::printing {
namespace {

constexpr double kFinestPitch = 0.02;     // mm, of a chosen pitch
constexpr double kColumnsPerWidth = 5.0;  // of the usual bead
constexpr double kChosenColumns = 4e6;    // for a chosen pitch
constexpr double kChosenIntervals = 2e7;  // for a chosen pitch; every column of every bead may keep one
constexpr double kSamples = 2e6;          // in beads: 0.1% of the volume or better, also of a single layer
constexpr double kSampledColumns = 1e9;   // in the area of the print; few of them are used
constexpr double kPitchDigits = 1000.0;   // a chosen pitch is a multiple of 1 mm / this
constexpr double kCoarse = 0.5;           // pitch, of the usual bead width
constexpr int kMargin = 2;                // columns without material around the print
constexpr double kTouch = 1e-4;           // mm; and in ulps of the height:
constexpr double kTouchUlps = 4.0;

double choose_pitch(const PrintSurvey& survey, const PrintOptions& options) {
  if (options.resolution.mm() > 0.0) return options.resolution.mm();
  const Point3 size = survey.box.size();
  double pitch = std::max(kFinestPitch, survey.usual_width() / kColumnsPerWidth);
  pitch = std::max(pitch, std::sqrt(size.x * size.y / kChosenColumns));
  pitch = std::max(pitch, std::sqrt(survey.area / kChosenIntervals));
  return std::ceil(pitch * kPitchDigits) / kPitchDigits;
}

}  // namespace

void PrintSurvey::bead(const Bead& r) {
  const double reach = r.section.width / 2.0;
  for (const Point3 p : {r.from, r.to}) {
    box.add(p + Point3{-reach, -reach, -r.section.height});
    box.add(p + Point3{reach, reach, 0.0});
  }
  ++beads;
  length += r.length;
  area += r.length * r.section.width;
  if (levels.empty() || levels.back() != r.level) levels.push_back(r.level);
  if (levels.size() > 2 * sorted) sort_levels();
}

bool PrintSurvey::wants_more() {
  constexpr std::size_t kBetween = 4096;  // motions between two checks
  stopped = stopped || (++motions % kBetween == 0 && stop_requested(progress));
  return !stopped;
}

void PrintSurvey::sort_levels() {
  constexpr std::size_t kFew = 1024;  // levels; fewer are not sorted early
  std::sort(levels.begin(), levels.end());
  std::size_t kept = 0;
  for (const double z : levels)
    if (kept == 0 || z > levels[kept - 1] + kSameLevel) levels[kept++] = z;
  levels.resize(kept);
  sorted = std::max(kept, kFew);
}

std::uint32_t PrintSurvey::layer_of(double level) const {
  const auto it = std::upper_bound(levels.begin(), levels.end(), level);
  return static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(it - levels.begin() - 1, 0));
}

Frame make_sample_frame(const Frame& columns, const PrintSurvey& survey) {
  const double side_x = columns.nx * columns.pitch, side_y = columns.ny * columns.pitch;
  Frame frame = columns;
  frame.positions = ColumnPositions::spread;
  frame.pitch = std::max(std::sqrt(survey.area / kSamples), std::sqrt(side_x * side_y / kSampledColumns));
  frame.nx = static_cast<int>(std::ceil(side_x / frame.pitch)) + 2;
  frame.ny = static_cast<int>(std::ceil(side_y / frame.pitch)) + 2;
  return frame;
}

std::optional<Frame> make_frame(const PrintSurvey& survey, const PrintOptions& options,
                                Diagnostics& diagnostics) {
  const double wanted = options.resolution.mm();
  if (!(wanted >= 0.0) || !std::isfinite(wanted)) {
    diagnostics.error(codes::bad_resolution, {},
                      "the resolution must be a length above 0, or 0 to choose one");
    return std::nullopt;
  }
  const Point3 size = survey.box.size();
  const double high = survey.box.high.z - options.bed.mm();
  if (!(size.x < limits::kMaxStockSize && size.y < limits::kMaxStockSize &&
        std::abs(high) < limits::kMaxStockSize)) {
    diagnostics.error(codes::print_too_large, {},
                      fmt::format("the print measures {} x {} x {} mm, more than the limit",
                                  number_text(size.x, 0), number_text(size.y, 0), number_text(high, 0)));
    return std::nullopt;
  }
  const double pitch = choose_pitch(survey, options);
  const double nx = std::ceil(size.x / pitch) + 1 + 2 * kMargin,
               ny = std::ceil(size.y / pitch) + 1 + 2 * kMargin;
  if (nx * ny > static_cast<double>(options.max_columns)) {
    const double min_pitch = std::sqrt(size.x * size.y / static_cast<double>(options.max_columns));
    diagnostics
        .error(codes::print_too_large, {},
               fmt::format("a resolution of {} mm needs {:.0f} columns; at most {} are allowed",
                           number_text(pitch, 4), nx * ny, options.max_columns))
        .hint = fmt::format("use a resolution of {} mm or more", number_text(1.1 * min_pitch, 3));
    return std::nullopt;
  }
  if (pitch > kCoarse * survey.usual_width())
    diagnostics.warning(
        codes::print_coarse, {},
        fmt::format("a resolution of {} mm is coarse for beads {} mm wide; the figures are inaccurate",
                    number_text(pitch, 3), number_text(survey.usual_width(), 3)));
  Frame frame;
  frame.pitch = pitch;
  frame.nx = static_cast<int>(nx);
  frame.ny = static_cast<int>(ny);
  frame.x = (std::floor(survey.box.low.x / pitch) - kMargin + kShift) * pitch;
  frame.y = (std::floor(survey.box.low.y / pitch) - kMargin + kShift) * pitch;
  frame.bed = options.bed.mm();
  const auto height = static_cast<float>(std::max(high, 1.0));
  const float ulp = std::nextafter(height, std::numeric_limits<float>::max()) - height;
  frame.touch = static_cast<float>(std::max(kTouch, kTouchUlps * static_cast<double>(ulp)));
  return frame;
}

}  // namespace kerf::printing
