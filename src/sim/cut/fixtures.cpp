// Simulates the toolpath once per fixture, with the fixture as a no-go solid.
#include <algorithm>
#include <cmath>

#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

/// The wanted number of columns of a fixture, and the range of their pitch. The columns of a body find its
/// contacts. Those of a box only measure the volume touched and may be few, as every motion is applied to all
/// columns that it touches.
struct FixtureColumns {
  double count, finest, coarsest;  // mm
};
constexpr FixtureColumns kOfBodies{1e6, 0.02, 0.25}, kOfBoxes{4e4, 0.02, 1.0};

Length pitch_for(const Stock& solid, Length wanted) {
  const FixtureColumns& columns = solid.body ? kOfBodies : kOfBoxes;
  const Point3 size = solid.block.size();
  const double own = std::clamp(std::sqrt(size.x * size.y / columns.count), columns.finest, columns.coarsest);
  return mm(solid.body && wanted.mm() > 0.0 ? std::min(own, wanted.mm()) : own);
}

std::optional<ToolPart> part_of(HazardKind kind) {
  switch (kind) {
    case HazardKind::spindle_off: return ToolPart::cutting;
    case HazardKind::neck_contact: return ToolPart::neck;
    case HazardKind::shank_contact: return ToolPart::shank;
    case HazardKind::holder_contact: return ToolPart::holder;
    case HazardKind::rapid_in_stock:
    case HazardKind::over_flute:
    case HazardKind::below_floor: break;
  }
  return std::nullopt;
}

/// Cuts below its floor are no contacts of a no-go solid, and cuts above the flutes are contacts of the part
/// above them.
bool is_contact(HazardKind kind) { return kind == HazardKind::rapid_in_stock || part_of(kind).has_value(); }

/// Errors, and warnings about the mesh of a fixture (4000 to 4999); warnings about the toolpath come from the
/// simulation of the stock.
bool is_reported(const Diagnostic& d) {
  return d.severity == Severity::error ||
         (static_cast<int>(d.code) >= 4000 && static_cast<int>(d.code) < 5000);
}

}  // namespace

std::optional<std::vector<FixtureContact>> find_fixture_contacts(const Toolpath& path, const ToolTable& tools,
                                                                 std::span<const Fixture> fixtures,
                                                                 const SimulationOptions& options,
                                                                 Diagnostics& diagnostics,
                                                                 Progress* progress) {
  std::vector<FixtureContact> found;
  for (std::size_t n = 0; n < fixtures.size(); ++n) {
    SimulationOptions how = options;
    how.role = SolidRole::no_go;
    how.resolution = pitch_for(fixtures[n].solid, options.resolution);
    Diagnostics found_here;
    const auto result = simulate({borrowed(path), tools, fixtures[n].solid, how}, found_here, progress);
    for (const Diagnostic& d : found_here.list())
      if (is_reported(d)) diagnostics.add(d);
    if (!result || result->stopped) return std::nullopt;
    for (const Hazard& h : result->hazards)
      if (is_contact(h.kind)) found.push_back({n, h.step, part_of(h.kind), h.at, h.depth, h.removed});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const FixtureContact& a, const FixtureContact& b) { return a.step < b.step; });
  return found;
}

}  // namespace kerf
