// Scan lines of a laser: fills, pictures, test grids.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/hatch.h"
#include "op/base/inner_first.h"
#include "op/base/option_check.h"
#include "op/base/reach.h"
#include "op/laser/beam.h"

#include "kerf/base/limits.h"
#include "kerf/geom/text.h"
#include "kerf/op/laser.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr double kMaxPixels = 1e8;  // of a picture on the board
constexpr double kMinGamma = 0.1, kMaxGamma = 10.0;
constexpr std::size_t kMaxCells = 10'000;  // of a test grid
constexpr double kLabelGap = 0.5;          // between labels and cells, of the label's height
constexpr std::uint8_t kLightest = 255;    // white

void scan_region(Beam& beam, const Region& region, Angle angle, const ScanOptions& scan, double power,
                 std::size_t max_lines) {
  const Point2 along{std::cos(angle.rad()), std::sin(angle.rad())};
  const std::vector<HatchLine> lines = hatch(region, angle, scan.interval, max_lines);
  for (std::size_t i = 0; i < lines.size() && !beam.full();) {
    std::vector<ScanPart> parts;
    const Point2 origin = lines[i].from;
    const std::size_t row = lines[i].row;
    for (; i < lines.size() && lines[i].row == row; ++i)
      parts.push_back({dot(lines[i].from - origin, along), dot(lines[i].to - origin, along), power});
    scan_line(beam, origin, along, parts, !scan.one_way && row % 2 == 1, scan.overscan);
  }
}

/// A picture in the pixels of the board, row by row from the bottom.
class Pixels {
 public:
  Pixels(const GreyPicture& picture, const LaserPictureOptions& options, int columns, int rows)
      : picture_(picture),
        options_(options),
        columns_(columns),
        rows_(rows),
        sums_(count(picture.width) + 1),
        error_(count(columns) + 2),
        next_error_(count(columns) + 2) {}

  /// The powers of a row, 0 to 1 of the options' power; rows must be read in order.
  void read(int row, std::vector<double>& powers) {
    sum_up(row);
    powers.resize(count(columns_));
    const double step = static_cast<double>(picture_.width) / columns_;
    for (int c = 0; c < columns_; ++c)
      powers[count(c)] = darkness((up_to((c + 1) * step) - up_to(c * step)) / step);
    if (options_.tones == PictureTones::dither)
      dither(powers, row % 2 == 1);
    else
      for (double& power : powers) power = power > 0.0 ? lift(power) : 0.0;
  }

 private:
  static std::size_t count(int n) { return static_cast<std::size_t>(n); }

  /// The mean grey of the input's rows that the row covers, summed up along it.
  void sum_up(int row) {
    const double step = static_cast<double>(picture_.height) / rows_;
    const double top = (rows_ - 1 - row) * step, bottom = top + step;
    std::fill(sums_.begin(), sums_.end(), 0.0);
    const int last = std::min(picture_.height - 1, static_cast<int>(std::ceil(bottom)) - 1);
    for (int y = static_cast<int>(top); y <= last; ++y) {
      const double weight = (std::min(bottom, y + 1.0) - std::max(top, static_cast<double>(y))) / step;
      if (!(weight > 0.0)) continue;
      const std::uint8_t* grey = picture_.grey.data() + count(y) * count(picture_.width);
      for (int x = 0; x < picture_.width; ++x) sums_[count(x) + 1] += weight * grey[x];
    }
    for (std::size_t x = 1; x < sums_.size(); ++x) sums_[x] += sums_[x - 1];
  }
  double up_to(double x) const {
    const double whole = std::min(std::floor(x), static_cast<double>(picture_.width - 1));
    const auto i = static_cast<std::size_t>(whole);
    return sums_[i] + (x - whole) * (sums_[i + 1] - sums_[i]);
  }
  double darkness(double grey) const {
    double dark = std::clamp(1.0 - grey / kLightest, 0.0, 1.0);
    if (options_.negative) dark = 1.0 - dark;
    if (dark < 0.5 / kLightest) return 0.0;  // white but for rounding
    return options_.gamma == 1.0 ? dark : std::pow(dark, options_.gamma);
  }
  double lift(double dark) const {
    const double strongest = options_.laser.power;
    return strongest > 0.0 ? (options_.min_power + dark * (strongest - options_.min_power)) / strongest : 0.0;
  }

  /// Floyd's and Steinberg's error diffusion, alternately in both directions.
  void dither(std::vector<double>& powers, bool backwards) {
    std::fill(next_error_.begin(), next_error_.end(), 0.0);
    const int step = backwards ? -1 : 1;
    for (int i = 0; i < columns_; ++i) {
      const int c = backwards ? columns_ - 1 - i : i;
      const auto at = [&](std::vector<double>& errors, int column) -> double& {
        return errors[count(column + 1)];
      };
      double& power = powers[count(c)];
      const double wanted = power + at(error_, c);
      power = wanted >= 0.5 ? 1.0 : 0.0;
      const double error = wanted - power;
      at(error_, c + step) += 7.0 / 16.0 * error;
      at(next_error_, c - step) += 3.0 / 16.0 * error;
      at(next_error_, c) += 5.0 / 16.0 * error;
      at(next_error_, c + step) += 1.0 / 16.0 * error;
    }
    std::swap(error_, next_error_);
  }

  const GreyPicture& picture_;
  const LaserPictureOptions& options_;
  int columns_, rows_;
  std::vector<double> sums_, error_, next_error_;
};

bool valid(const GreyPicture& picture, const LaserPictureOptions& options, Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options.laser);
  if (!op_detail::valid(options.laser, diagnostics) ||
      !op_detail::valid(options.scan, options.laser, diagnostics))
    return false;
  const auto pixels = static_cast<std::size_t>(std::max(picture.width, 0)) *
                      static_cast<std::size_t>(std::max(picture.height, 0));
  if (pixels == 0 || picture.grey.size() != pixels)
    return fail(cut, codes::op_empty, "the picture has no pixels", diagnostics);
  OptionCheck check(cut, diagnostics);
  const double width = options.width.mm(), interval = options.scan.interval.mm();
  check.expect(width > 0.0 && width <= limits::kMaxCoordinate, "width of the picture", width, "above 0 mm");
  check.expect(options.min_power >= 0.0 && options.min_power <= options.laser.power, "minimum power",
               100.0 * options.min_power, "from 0 to the power");
  check.expect(options.gamma >= kMinGamma && options.gamma <= kMaxGamma, "gamma", options.gamma,
               fmt::format("from {:g} to {:g}", kMinGamma, kMaxGamma));
  check.expect(in_range(options.at), "position of the picture", options.at.x, "a coordinate");
  const double height = width * picture.height / picture.width;
  check.expect(!(width / interval * (height / interval) > kMaxPixels), "interval", interval,
               fmt::format("larger: the picture has more than {:g} pixels on the board", kMaxPixels));
  return check.valid();
}

/// The power of a pixel in whole S, so that equal neighbours become one part.
double whole_s(double fraction, const LaserOptions& options) {
  return std::round(fraction * options.power * options.full_s) / options.full_s;
}

bool valid(const LaserTestOptions& options, Diagnostics& diagnostics) {
  const LaserOptions& laser = options.laser;
  const CutOptions cut = cut_options(laser);
  if (!op_detail::valid(laser, diagnostics) || !op_detail::valid(options.scan, laser, diagnostics))
    return false;
  OptionCheck check(cut, diagnostics);
  const std::size_t columns = options.powers.size(), rows = options.feeds.size();
  check.expect(columns > 0 && rows > 0 && columns <= kMaxCells && rows <= kMaxCells / columns,
               "number of cells", static_cast<double>(columns) * static_cast<double>(rows),
               fmt::format("from 1 to {}", kMaxCells));
  for (const double power : options.powers)
    check.expect(power >= 0.0 && power <= 1.0, "power", 100.0 * power, "from 0 to 100 %");
  for (const Feed feed : options.feeds)
    check.expect(feed > Feed{} && feed.mm_per_min() <= limits::kMaxSpeed, "feed", feed.mm_per_min(),
                 "above 0 mm/min");
  const double width = options.cell_width.mm(), height = options.cell_height.mm(), gap = options.gap.mm();
  check.expect(width > 0.0 && width <= limits::kMaxToolSize, "width of the cells", width, "above 0 mm");
  check.expect(height >= 0.0 && height <= limits::kMaxToolSize, "height of the cells", height,
               "0 mm or more");
  check.expect(gap >= 0.0 && gap <= limits::kMaxToolSize, "gap", gap, "0 mm or more");
  check.expect(height + gap > 0.0, "distance of the rows", height + gap, "above 0 mm");
  const double label = options.label_height.mm();
  check.expect(label >= 0.0 && label <= limits::kMaxToolSize, "height of the labels", label, "0 mm or more");
  check.expect(in_range(options.at), "position of the test", options.at.x, "a coordinate");
  return check.valid();
}

class TestGrid {
 public:
  TestGrid(const LaserTestOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics), beam_(options.laser) {}

  std::optional<Operation> run() {
    for (std::size_t row = 0; row < options_.feeds.size(); ++row)
      for (std::size_t column = 0; column < options_.powers.size() && !beam_.full(); ++column)
        cell(row, column);
    if (options_.label_height > Length{} && !labels()) return std::nullopt;
    return beam_.finished(diagnostics_);
  }

 private:
  Point2 corner(std::size_t row, std::size_t column) const {
    const double gap = options_.gap.mm();
    const auto from_below = static_cast<double>(options_.feeds.size() - 1 - row);
    return options_.at + Point2{static_cast<double>(column) * (options_.cell_width.mm() + gap),
                                from_below * (options_.cell_height.mm() + gap)};
  }

  void cell(std::size_t row, std::size_t column) {
    const LaserOptions& laser = options_.laser;
    const double power = options_.powers[column], width = options_.cell_width.mm();
    const double height = options_.cell_height.mm();
    const Point2 low = corner(row, column);
    beam_.feed(options_.feeds[row]);
    for (int pass = 0; pass < laser.passes && !beam_.full(); ++pass) {
      if (!(height > 0.0)) {
        beam_.travel(low);
        beam_.power(power);
        beam_.line(low + Point2{width, 0.0});
        continue;
      }
      const Point2 high = low + Point2{width, height};
      const Region box{{{low, {{{high.x, low.y}}, {high}, {{low.x, high.y}}, {low}}}}};
      scan_region(beam_, box, Angle{}, options_.scan, power, laser.max_steps);
    }
  }

  bool label(const std::string& text, Point2 at, TextAlign align) {
    const auto font = stroke_text_font("sans");
    const TextOptions how{.height = options_.label_height,
                          .at = at,
                          .align = align,
                          .name = options_.laser.name,
                          .where = options_.laser.where};
    const auto strokes = set_text(text, *font, how, diagnostics_);
    if (!strokes) return false;
    for (const Loop& stroke : loops_of(*strokes, options_.laser.tolerance.weld)) {
      if (beam_.full()) break;
      beam_.travel(stroke.track.at(0.0));
      beam_.power(options_.laser.power);
      beam_.follow(stroke.track, 0.0, stroke.track.length());
    }
    return true;
  }

  /// Feeds left of the rows, powers in percent below the columns.
  bool labels() {
    const double height = options_.label_height.mm(), gap = kLabelGap * height;
    // Scan lines run on beyond the cells, with power 0.
    const double beside = gap + (options_.cell_height > Length{} ? options_.scan.overscan.mm() : 0.0);
    beam_.feed(options_.laser.feed);
    bool good = true;
    for (std::size_t row = 0; row < options_.feeds.size() && good; ++row) {
      const Point2 low = corner(row, 0);
      good = label(fmt::format("{:g}", options_.feeds[row].mm_per_min()),
                   low + Point2{-beside, 0.5 * (options_.cell_height.mm() - height)}, TextAlign::right);
    }
    const std::size_t last = options_.feeds.size() - 1;
    for (std::size_t column = 0; column < options_.powers.size() && good; ++column)
      good = label(fmt::format("{:g}", std::round(1000.0 * options_.powers[column]) / 10.0),
                   corner(last, column) + Point2{0.5 * options_.cell_width.mm(), -gap - height},
                   TextAlign::centre);
    return good;
  }

  const LaserTestOptions& options_;
  Diagnostics& diagnostics_;
  Beam beam_;
};

}  // namespace

std::optional<Operation> laser_fill(const Region& region, Angle angle, const ScanOptions& scan,
                                    const LaserOptions& options, Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options);
  if (!op_detail::valid(options, diagnostics) || !op_detail::valid(scan, options, diagnostics) ||
      !usable(region, cut, diagnostics))
    return std::nullopt;
  OptionCheck check(cut, diagnostics);
  check.expect(std::isfinite(angle.rad()), "angle", angle.deg(), "finite");
  const Box2 box = bounds(region);
  const double rows = distance(box.low, box.high) / scan.interval.mm();
  check.expect(rows <= static_cast<double>(options.max_steps), "interval", scan.interval.mm(),
               "larger: the fill has too many lines");
  if (!check.valid()) return std::nullopt;
  Beam beam(options);
  for (int pass = 0; pass < options.passes && !beam.full(); ++pass)
    scan_region(beam, region, angle, scan, options.power, options.max_steps);
  return beam.finished(diagnostics);
}

std::optional<Operation> laser_picture(const GreyPicture& picture, const LaserPictureOptions& options,
                                       Diagnostics& diagnostics) {
  const LaserOptions& laser = options.laser;
  if (!valid(picture, options, diagnostics)) return std::nullopt;
  const double width = options.width.mm(), height = width * picture.height / picture.width;
  const double interval = options.scan.interval.mm();
  const int columns = std::max(1, static_cast<int>(std::lround(width / interval)));
  const int rows = std::max(1, static_cast<int>(std::lround(height / interval)));
  Beam beam(laser);
  std::vector<double> powers;
  std::vector<ScanPart> parts;
  for (int pass = 0; pass < laser.passes && !beam.full(); ++pass) {
    Pixels pixels(picture, options, columns, rows);
    bool backwards = false;
    for (int row = 0; row < rows && !beam.full(); ++row) {
      pixels.read(row, powers);
      parts.clear();
      for (int c = 0; c < columns; ++c) {
        const double power = whole_s(powers[static_cast<std::size_t>(c)], laser);
        const double from = width * c / columns, to = width * (c + 1) / columns;
        if (!(power > 0.0)) continue;
        if (!parts.empty() && parts.back().power == power && parts.back().to == from)
          parts.back().to = to;
        else
          parts.push_back({from, to, power});
      }
      if (parts.empty()) continue;
      scan_line(beam, options.at + Point2{0.0, height * (row + 0.5) / rows}, {1.0, 0.0}, parts, backwards,
                options.scan.overscan);
      backwards = !backwards && !options.scan.one_way;
    }
  }
  return beam.finished(diagnostics);
}

std::optional<Operation> laser_test(const LaserTestOptions& options, Diagnostics& diagnostics) {
  if (!valid(options, diagnostics)) return std::nullopt;
  return TestGrid(options, diagnostics).run();
}

}  // namespace kerf
