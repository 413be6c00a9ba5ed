// Leads and a finishing pass for the closed paths of a finished toolpath.
//
//   Diagnostics diagnostics;
//   const auto made = add_leads(path, {.lead_in = {LeadKind::arc, mm(3)}, .finish = mm(0.3)}, diagnostics);
//
// A closed path is a chain that goes straight down and then once around on one level. The part is on one side
// of it; leads are on the other one, and are left out, with a warning, where they would cross a closed path.
// The rapids that lead to the path and up from it move along with its ends. With a finishing allowance the
// path is first cut at that distance from the part, and then, as one pass at the full depth, where it was.
// All steps keep their origins.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/limits.h"
#include "kerf/op/contour.h"
#include "kerf/tolerance.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

enum class PartSide : std::uint8_t {
  right,  ///< of the direction of travel: climb milling with a clockwise spindle
  left    ///< conventional milling
};
struct LeadOptions {
  double top = 0.0;  ///< Z of the surface of the material: only rapids at this Z and above are moved
  Lead lead_in{}, lead_out{};
  Length overlap{};  ///< how far the tool continues along the path beyond its start
  /// Left on the part by all passes but the last. The last one has an arc of twice this radius as its lead,
  /// unless one is given.
  Length finish{};
  PartSide part = PartSide::right;
  Tolerance tolerance{};
  std::size_t max_steps = limits::kMaxPathSteps;
};
struct Led {
  Toolpath path;
  /// First steps of finishing passes: of chains that are to be cut at the full depth (see
  /// StepDownOptions::whole).
  std::vector<std::size_t> whole;
};
/// Nothing, with an error (code pass_option), for options out of range. A program without a closed path, and
/// paths that keep their start, are warnings (pass_refused).
std::optional<Led> add_leads(const Toolpath& path, const LeadOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
