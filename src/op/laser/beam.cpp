// Steps of a laser, and the options that all its operations have.
#include "op/laser/beam.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/op.h"
#include "op/base/option_check.h"

#include "kerf/base/limits.h"

namespace kerf::op_detail {
namespace {

constexpr int kMaxPasses = 1000;
constexpr double kMinInterval = 0.001;   // mm
constexpr double kMaxOverscan = 1000.0;  // mm
// Gaps of a scan line that are longer than this and twice the overscan are rapids.
constexpr double kLongGap = 10.0;  // mm

}  // namespace

CutOptions cut_options(const LaserOptions& options) {
  CutOptions cut;
  cut.feed = options.feed, cut.tolerance = options.tolerance, cut.max_steps = options.max_steps;
  cut.name = options.name, cut.where = options.where, cut.progress = options.progress;
  return cut;
}

bool valid(const LaserOptions& options, Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options);
  OptionCheck check(cut, diagnostics);
  const double feed = options.feed.mm_per_min();
  check.expect(options.power >= 0.0 && options.power <= 1.0, "power", 100.0 * options.power,
               "from 0 to 100 %");
  check.expect(options.full_s > 0.0 && options.full_s <= limits::kMaxSpeed, "S of full power", options.full_s,
               "above 0");
  check.expect(feed > 0.0 && feed <= limits::kMaxSpeed, "feed", feed, "above 0 mm/min");
  check.expect(options.passes >= 1 && options.passes <= kMaxPasses, "number of passes", options.passes,
               fmt::format("from 1 to {}", kMaxPasses));
  check.expect(options.mode != LaserMode::off, "mode of the beam", 0.0, "constant or dynamic");
  return check.valid();
}

bool valid(const ScanOptions& scan, const LaserOptions& options, Diagnostics& diagnostics) {
  const CutOptions cut = cut_options(options);
  OptionCheck check(cut, diagnostics);
  const double interval = scan.interval.mm(), overscan = scan.overscan.mm();
  check.expect(interval >= kMinInterval && interval <= limits::kMaxToolSize, "interval", interval,
               fmt::format("{:g} mm or more", kMinInterval));
  check.expect(overscan >= 0.0 && overscan <= kMaxOverscan, "overscan", overscan,
               fmt::format("from 0 to {:g} mm", kMaxOverscan));
  return check.valid();
}

Beam::Beam(const LaserOptions& options) : options_(options), feed_(options.feed) {
  origin_ = std::holds_alternative<std::monostate>(options.where) ? OriginId::none
                                                                  : path_.origins().add(options.where);
}

void Beam::set(double s) {
  if (s == s_) return;
  path_.add(step::LaserPower{options_.mode, s}, origin_);
  s_ = s;
}

void Beam::power(double fraction) { set(std::round(fraction * options_.full_s)); }

void Beam::travel(Point2 to) {
  if (at_ && distance(*at_, to) <= options_.tolerance.weld.mm()) return;
  set(0.0);
  add_motion(path_.add(step::Rapid{{to.x, to.y, 0.0}}, origin_));
  at_ = to;
}

void Beam::line(Point2 to) {
  if (distance(*at_, to) <= options_.tolerance.weld.mm()) return;
  add_motion(path_.add(step::Cut{{to.x, to.y, 0.0}, feed_}, origin_));
  at_ = to;
}

void Beam::arc(Point2 to, Point2 centre, Turn turn) {
  add_motion(
      path_.add(step::Arc{.to = {to.x, to.y, 0.0}, .centre = centre, .turn = turn, .feed = feed_}, origin_));
  at_ = to;
}

void Beam::follow(const Track& track, double from, double to) {
  const std::size_t first = path_.size();
  const Point3 end = add_along(path_, track, from, to, {at_->x, at_->y, 0.0}, 0.0, feed_, origin_,
                               options_.tolerance.weld.mm(), options_.max_steps);
  for (std::size_t i = first; i < path_.size(); ++i) add_motion(i);
  at_ = end.xy();
}

std::optional<Operation> Beam::finished(Diagnostics& diagnostics) {
  if (stop_requested(options_.progress)) return std::nullopt;
  if (full()) {
    fail(cut_options(options_), codes::op_limit, fmt::format("more than {} steps", options_.max_steps),
         diagnostics);
    return std::nullopt;
  }
  path_.add(step::LaserPower{}, origin_);
  Operation made;
  made.path = std::move(path_);
  return made;
}

void scan_line(Beam& beam, Point2 origin, Point2 along, const std::vector<ScanPart>& parts, bool backwards,
               Length overscan) {
  const double sign = backwards ? -1.0 : 1.0, beyond = overscan.mm();
  const double long_gap = std::max(kLongGap, 2.0 * beyond);
  const auto at = [&](double s) { return origin + s * along; };
  std::optional<double> end;  // of the part before, where it is not far away
  for (std::size_t i = 0; i < parts.size() && !beam.full(); ++i) {
    const ScanPart& part = backwards ? parts[parts.size() - 1 - i] : parts[i];
    const double first = backwards ? part.to : part.from, last = backwards ? part.from : part.to;
    if (end && std::abs(first - *end) > long_gap) {
      beam.power(0.0);
      beam.line(at(*end + sign * beyond));
      end.reset();
    }
    if (!end) beam.travel(at(first - sign * beyond));
    if (!end || *end != first) {
      beam.power(0.0);
      beam.line(at(first));
    }
    beam.power(part.power);
    beam.line(at(last));
    end = last;
  }
  if (!end) return;
  beam.power(0.0);
  beam.line(at(*end + sign * beyond));
}

}  // namespace kerf::op_detail
