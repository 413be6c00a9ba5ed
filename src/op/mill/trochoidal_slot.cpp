// Slots wider than their tool: adaptive pockets of all that is within half the width of the outlines.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/option_check.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace op_detail;

bool usable(const std::vector<Outline>& outlines, const TrochoidalSlotOptions& options, const Tool& tool,
            Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  const bool good = valid(cut, tool, diagnostics);
  OptionCheck check(cut, diagnostics);
  check.expect(options.width > Length{} && options.width.mm() <= limits::kMaxToolSize, "width of the slot",
               options.width.mm(), fmt::format("above 0 mm and at most {:g}", limits::kMaxToolSize));
  if (!good || !check.valid()) return false;
  if (outlines.empty()) return fail(cut, codes::op_empty, "no outline; nothing to cut", diagnostics);
  for (const Outline& outline : outlines)
    if (!(length(outline).mm() > cut.tolerance.weld.mm()))
      return fail(cut, codes::op_option, "an outline has no length", diagnostics);
  return within_limits(outlines, cut, diagnostics);
}

}  // namespace

std::optional<Operation> trochoidal_slot(const std::vector<Outline>& outlines, const Tool& tool,
                                         const TrochoidalSlotOptions& options, Diagnostics& diagnostics) {
  const CutOptions& cut = options.cut;
  if (!usable(outlines, options, tool, diagnostics)) return std::nullopt;
  const RegionOptions regions = region_options(cut);
  Region all;
  for (const Outline& outline : outlines) {
    const auto one = buffer(outline, 0.5 * options.width, PathEnds::round, regions, diagnostics);
    const auto both = one ? combine(all, *one, Boolean::unite, regions, diagnostics) : std::nullopt;
    if (!both) return std::nullopt;
    all = both->region;
  }
  PocketOptions pocketed{cut, options.stepover, PocketPattern::adaptive};
  pocketed.engagement = options.engagement;
  return pocket(all, tool, pocketed, diagnostics);
}

}  // namespace kerf
