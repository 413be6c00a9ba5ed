// The map of a burn with its scale and the laser that it is of.
#include "app/shown/burn.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "app/shown/binary.h"

#include "kerf/path/report.h"

namespace kerf::app::view {
namespace {

constexpr std::uint32_t kVersion = 1;
constexpr double kMaxCells = 2000.0;      // along a side
constexpr double kCellsPerBeam = 5.0;     // as the map has by itself
constexpr std::size_t kHeader = 20 + 36;  // bytes

}  // namespace

std::string burn_body(const Toolpath& path, const BurnSettings& settings, std::uint32_t revision,
                      Diagnostics& diagnostics) {
  BurnOptions laser = settings.laser;
  const Box3 cut = report_on(path, {}).all.cut_bounds;
  if (!cut.empty()) {
    const Point3 size = cut.size();
    const double side = std::max(size.x, size.y) + 2.0 * laser.beam.mm();
    laser.cell = mm(std::max(laser.beam.mm() / kCellsPerBeam, side / kMaxCells));
  }
  const auto map = map_burn(path, laser, diagnostics);
  if (!map) return "";
  const auto f = [](double v) { return static_cast<float>(v); };
  BinaryWriter out;
  out.reserve(kHeader + 4 * map->joules_per_mm2.size());
  out.mark("KBRN");
  out.number(kVersion);
  out.number(revision);
  out.number(static_cast<std::uint32_t>(map->nx));
  out.number(static_cast<std::uint32_t>(map->ny));
  out.array(std::vector<float>{f(map->low.x), f(map->low.y), f(map->cell),
                               f(settings.black > 0.0 ? settings.black : map->usual_highest), f(map->highest),
                               f(map->joules), f(laser.beam.mm()), f(laser.full_power), f(laser.full_s)});
  out.array(map->joules_per_mm2);
  return out.take();
}

}  // namespace kerf::app::view
