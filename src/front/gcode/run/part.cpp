// What the parts of the interpreter have in common.
#include "front/gcode/run/part.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMinBytesPerStep = 2;  // a text of n bytes has at most n / 2 words

}  // namespace

StepWriter::StepWriter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
                       const LineWords& line, LineReporter& reporter)
    : path_(program.path),
      line_(line),
      reporter_(reporter),
      max_steps_(std::min(options.max_steps, text.size() / kMinBytesPerStep + options.max_made_steps)),
      file_(program.path.origins().file(options.file_name)) {}

bool StepWriter::room_for(double steps) {
  if (static_cast<double>(path_.size()) + steps <= static_cast<double>(max_steps_)) return true;
  if (!full_)
    reporter_.error(codes::too_many_steps, line_.column(),
                    fmt::format("the program has more than {} steps; the rest is not read", max_steps_));
  full_ = true;
  return false;
}

OriginId StepWriter::origin() {
  if (origin_line_ != reporter_.line()) start_origin(line_.column());
  return origin_;
}

void StepWriter::start_origin(std::uint32_t column) {
  origin_line_ = reporter_.line();
  origin_ = path_.origins().text(file_, origin_line_, column);
  if (!callers_.empty()) path_.origins().set_caller(origin_, callers_.back());
}

void StepWriter::note_depth(std::size_t depth) {
  origin_line_ = 0;
  if (depth <= callers_.size()) return callers_.resize(depth);
  const OriginId call = path_.origins().text(file_, reporter_.line(), 0);
  if (!callers_.empty()) path_.origins().set_caller(call, callers_.back());
  callers_.resize(depth, call);
}

bool Part::reachable(Point3 p) {
  if (within_limit(p)) return true;
  reporter_.error(codes::position_too_far, line_.column(),
                  fmt::format("a position is farther than {:g} mm from the work zero; the motion is skipped",
                              kMaxCoordinate));
  line_.use(kAllLetters);
  return false;
}

Point2 Part::in_plane(Point3 p) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  return {p[axes.u], p[axes.v]};
}

Point3 Part::with_plane_position(Point3 p, Point2 to) const {
  const PlaneAxes axes = axes_of(modes_.plane);
  p[axes.u] = to.x;
  p[axes.v] = to.y;
  return p;
}

void Part::report_unresolved(std::string_view what, std::uint32_t column) {
  reporter_.unusual(
      codes::value_unknown, column,
      fmt::format("{} depends on a value known only at run time, such as a probed position", what));
  add(step::Unresolved{std::string(what)});
}

}  // namespace kerf::gcode
