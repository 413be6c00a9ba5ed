// Chamfers along edges: contours by the flank of a cone.
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/option_check.h"
#include "op/mill/carving_edge.h"

#include "kerf/base/limits.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

constexpr int kFlankSamples = 16;

/// The part of the cutting edge that makes the chamfer, above the tip.
struct Flank {
  double foot = 0.0, foot_radius = 0.0;  // mm: at the lower edge of the chamfer
  double top = 0.0, top_radius = 0.0;
};

std::optional<Flank> flank_of(const CarvingEdge& edge, const ChamferOptions& options) {
  Flank flank;
  flank.foot = options.tip_offset.mm(), flank.foot_radius = edge.radius_at(flank.foot);
  const bool by_width = options.width > Length{};
  if (by_width) {
    flank.top_radius = flank.foot_radius + options.width.mm();
    flank.top = edge.height_of(flank.top_radius);
  } else {
    flank.top = flank.foot + options.cut.depth.mm();
    flank.top_radius = edge.radius_at(flank.top);
  }
  const double tolerance = options.cut.tolerance.chord.mm();
  const bool within =
      by_width ? flank.top_radius <= edge.widest() + tolerance : flank.top <= edge.height() + tolerance;
  if (!within || !(flank.top > flank.foot)) return std::nullopt;
  return flank;
}

/// Whether it is a cone.
bool is_straight(const CarvingEdge& edge, const Flank& flank, double tolerance) {
  for (int i = 1; i < kFlankSamples; ++i) {
    const double part = static_cast<double>(i) / kFlankSamples;
    const double radius = flank.foot_radius + part * (flank.top_radius - flank.foot_radius);
    if (std::abs(edge.radius_at(flank.foot + part * (flank.top - flank.foot)) - radius) > tolerance)
      return false;
  }
  return flank.top_radius - flank.foot_radius > tolerance;
}

bool valid(const ChamferOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  OptionCheck check(cut, diagnostics);
  check.expect(options.width >= Length{} && options.width.mm() <= limits::kMaxToolSize,
               "width of the chamfer", options.width.mm(), "0 mm or more");
  check.expect(options.tip_offset > Length{} && options.tip_offset.mm() <= limits::kMaxToolSize, "tip offset",
               options.tip_offset.mm(), "above 0 mm");
  check.expect(cut.depth >= Length{} && cut.depth.mm() <= limits::kMaxCoordinate, "depth of the chamfer",
               cut.depth.mm(), "0 mm or more");
  if (!check.valid()) return false;
  if ((options.width > Length{}) != (cut.depth > Length{})) return true;
  return fail(cut, codes::op_option, "a chamfer has either a width or a depth", diagnostics);
}

}  // namespace

std::optional<Operation> chamfer(const Region& region, const Tool& tool, const ChamferOptions& options,
                                 Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!valid(options, diagnostics)) return std::nullopt;
  const auto edge = CarvingEdge::of(tool);
  const auto refuse = [&](const std::string& message) {
    fail(cut, codes::op_option, message, diagnostics);
    return std::nullopt;
  };
  if (!edge) return refuse(fmt::format("tool {} has no cone; a chamfer needs a V tool", tool.number));
  const auto flank = flank_of(*edge, options);
  if (!flank)
    return refuse(fmt::format(
        "the chamfer is too large for tool {}: above the tip offset of {:g} mm its edge is {:.4g} mm high "
        "and "
        "{:.4g} mm wide",
        tool.number, options.tip_offset.mm(), std::max(edge->height() - options.tip_offset.mm(), 0.0),
        std::max(edge->widest() - edge->radius_at(options.tip_offset.mm()), 0.0)));
  if (!is_straight(*edge, *flank, cut.tolerance.chord.mm()))
    return refuse(
        fmt::format("the edge of tool {} is no cone where it cuts; a chamfer needs a V tool", tool.number));
  // At the foot of the chamfer the tool touches the edge, and the tip is below, outside of the material.
  const auto foot = make_tool(tool.number, shape::Square{mm(2.0 * flank->foot_radius), mm(flank->top)}, {},
                              cut.where, diagnostics);
  if (!foot) return std::nullopt;
  Tool at_foot = *foot;
  at_foot.plunges = tool.plunges;
  ContourOptions along{cut, options.side, options.lead_in, options.lead_out, options.overlap};
  along.cut.depth = mm(flank->top);
  along.cut.allowance = Length{};
  if (!cut.name.empty()) along.cut.name = cut.name + ", where the tool touches the edge";
  return contour(region, at_foot, along, diagnostics);
}

}  // namespace kerf
