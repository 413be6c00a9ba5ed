// The internal functions by which tracepath_comp() reports what its motions cut into and do not reach.
#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/codes/gcmc.h"
#include "front/gcmc/run/builtins.h"

namespace kerf::gcmc {
namespace {

constexpr std::size_t kMaxGouges = 20;  // of one call that are named

std::optional<Point2> point_of(const Call& call, const Value& v) {
  if (!v.is_vector()) return std::nullopt;
  const Scalar x = v.coordinate_or_undef(0), y = v.coordinate_or_undef(1);
  if (!x.defined() || !y.defined()) return std::nullopt;
  return Point2{native_number(call.vm, x), native_number(call.vm, y)};
}

std::string length_text(const Call& call, double length) {
  return fmt::format("{:.4g}{}", length, call.vm.native == Unit::mm ? "mm" : "in");
}

std::string position_text(Point2 p) { return fmt::format("[{:.6g}, {:.6g}]", p.x + 0.0, p.y + 0.0); }

/// __tpc_follow(path, width, closed): the motions that follow are recorded.
Value follow(const Call& call) {
  if (!call.vm.options().own_warnings || !call[0].is_list()) return Value::undef();
  CompensatedTrace trace;
  for (const Value& v : call[0].vectors())
    if (const auto p = point_of(call, v)) trace.path.push_back(*p);
  trace.width = call.length(1);
  trace.closed = call.truth(2);
  call.vm.machine().trace = std::move(trace);
  return Value::undef();
}

/// A warning at the call in the user's program.
void warn(const Call& call, Code code, std::string text, std::string hint) {
  call.vm.program_message(Severity::warning, code, std::move(text), std::move(hint), Vm::At::program);
}

/// __tpc_report(): a warning for each gouge of the recorded motions.
Value report(const Call& call) {
  std::optional<CompensatedTrace>& recorded = call.vm.machine().trace;
  if (!recorded) return Value::undef();
  const CompensatedTrace trace = *std::exchange(recorded, std::nullopt);
  const std::vector<Gouge> gouges = find_gouges(trace);
  for (std::size_t i = 0; i < std::min(gouges.size(), kMaxGouges); ++i) {
    const Gouge& g = gouges[i];
    const Point2 corner = trace.path[g.corner];
    const bool ends_here = g.corner == 0 || (!trace.closed && g.corner + 1 == trace.path.size());
    std::string text = fmt::format("tracepath_comp() cuts {} into its path at {}", length_text(call, g.depth),
                                   position_text(g.at));
    if (distance(g.at, corner) > trace.width * 1e-6)
      text += fmt::format(", near the corner {}", position_text(corner));
    warn(call, codes::gcmc_gouge, text,
         ends_here ? "start at an outside corner, or within a straight side"
                   : "the passage is narrower than the tool: use a smaller width");
  }
  if (gouges.size() > kMaxGouges)
    warn(call, codes::gcmc_gouge,
         fmt::format("tracepath_comp() cuts into its path at {} further corners", gouges.size() - kMaxGouges),
         {});
  return Value::undef();
}

/// __tpc_left_out(corner, width): a warning that the corner is not cut as drawn.
Value left_out(const Call& call) {
  const auto corner = point_of(call, call[0]);
  if (call.vm.options().own_warnings && corner)
    warn(call, codes::gcmc_corner_left_out,
         fmt::format("tracepath_comp() does not reach the inside corner {} at the width {}: "
                     "material stays there",
                     position_text(*corner), length_text(call, call.length(1))),
         "use a smaller tool, or a second pass with one");
  return Value::undef();
}

}  // namespace

const std::vector<Builtin>& compensated_builtins() {
  static const std::vector<Builtin> table = {
      {"__tpc_follow", follow, 3, 3},
      {"__tpc_report", report, 0, 0},
      {"__tpc_left_out", left_out, 2, 2},
  };
  return table;
}

}  // namespace kerf::gcmc
