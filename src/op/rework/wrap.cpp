// A flat program around a bar: Y becomes turns of A. Positive A moves the tool from Z+ towards Y- of the bar
// (ISO 841), so A falls while Y grows.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/op.h"
#include "op/rework/moved_steps.h"
#include "path/arc_parts.h"

#include "kerf/base/limits.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr unsigned kY = 2, kAll = 7;
constexpr unsigned kOthers = 6;      // B and C, of MotionExtra
constexpr double kStill = 5e-4;      // mm: half of the last decimal of posts
constexpr int kMaxChords = 1 << 20;  // of one arc

class Wrapping {
 public:
  Wrapping(const Toolpath& path, const WrapOptions& options, Diagnostics& diagnostics)
      : path_(path),
        options_(options),
        degrees_(-360.0 / (std::numbers::pi * options.diameter.mm())),
        diagnostics_(diagnostics) {}

  std::optional<Toolpath> run() {
    out_.reserve(path_.size());
    MachineAxes machine(kY);
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      std::string_view why = fault_of_move(path_, i);
      if (why.empty()) why = machine.pass(s, before_.at);
      const unsigned unknown = before_.unknown | s.unknown_axes();
      if (why.empty() && s.is_cutting() && (unknown & kAll) != 0) why = "it cuts at an unknown position";
      if (why.empty() && s.kind() == StepKind::arc && !can_be_divided(s, before_))
        why = "it is an arc of unknown height";
      if (!why.empty()) {
        diagnostics_.error(codes::pass_refused, path_.origin_of(i),
                           fmt::format("not possible here: {}", why));
        return std::nullopt;
      }
      if (s.is_motion())
        motion(i);
      else
        out_.add_copy(path_, i);
      before_.pass(s);
      if (out_.size() > options_.max_steps) {
        diagnostics_.error(codes::pass_option, {}, fmt::format("more than {} steps", options_.max_steps));
        return std::nullopt;
      }
    }
    return std::move(out_);
  }

 private:
  void motion(std::size_t i) {
    const Step& s = path_[i];
    if (s.kind() == StepKind::arc) {
      Point3 from = before_.at;
      for (const Point3 to : chords_of(s, from, options_.chord, kMaxChords)) {
        cut(from, to, s.feed(), out_.copy_origin(path_, i));
        from = to;
      }
      return;
    }
    if (s.is_cutting()) return cut(before_.at, s.to(), s.feed(), out_.copy_origin(path_, i));
    const std::size_t added = out_.add_copy(path_, i);
    const bool known = (s.unknown_axes() & kY) == 0;
    if (known) out_.set_end(added, {s.to().x, 0.0, s.to().z});
    here_ = out_[added].to();
    if (known) turn_to(added, s.to().y);
  }

  /// A straight cut; its feed is that of X and Z, or of A where these rest.
  void cut(Point3 from, Point3 to, Feed feed, OriginId origin) {
    Point3 end{to.x, 0.0, to.z};
    const double around = to.y - from.y, flat = std::hypot(end.x - here_.x, end.z - here_.z);
    const double length = std::hypot(around, flat);
    Feed now = feed;
    if (around != 0.0 && flat <= kStill) {
      end = {here_.x, 0.0, here_.z};
      now = mm_per_min(feed.mm_per_min() * std::abs(degrees_ * around) / length);
    } else if (around != 0.0) {
      now = (flat / length) * feed;
    }
    const std::size_t added = out_.add(step::Cut{end, now}, origin);
    here_ = end;
    turn_to(added, to.y);
  }

  void turn_to(std::size_t added, double y) {
    MotionExtra extra;
    extra.abc = {degrees_ * y, 0.0, 0.0};
    extra.unknown_abc = kOthers;
    out_.set_extra(added, std::move(extra));
  }

  const Toolpath& path_;
  const WrapOptions& options_;
  double degrees_;  // of A per mm of Y
  Diagnostics& diagnostics_;
  Toolpath out_;
  PathPosition before_;  // in the flat program
  Point3 here_;          // in the wrapped one
};

}  // namespace

std::optional<Toolpath> wrapped(const Toolpath& path, const WrapOptions& options, Diagnostics& diagnostics) {
  const double diameter = options.diameter.mm();
  if (!(diameter > 0.0 && diameter <= limits::kMaxCoordinate) || !(options.chord > Length{})) {
    diagnostics.error(
        codes::pass_option, {},
        fmt::format("a bar of {:g} mm is not possible; the diameter must be above 0", diameter));
    return std::nullopt;
  }
  return Wrapping(path, options, diagnostics).run();
}

}  // namespace kerf
