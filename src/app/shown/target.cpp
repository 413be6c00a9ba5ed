// The comparison as figures and as the depths of all columns.
#include "app/shown/target.h"

#include "app/shown/binary.h"

namespace kerf::app::view {
namespace {

constexpr std::uint32_t kVersion = 1;

Record region_record(const DifferenceRegion& region) {
  return {{"kind", to_string(region.kind)},
          {"depth_mm", record_of(region.depth.mm())},
          {"volume_mm3", record_of(region.volume.mm3())},
          {"at", record_of(region.at)}};
}

Record figures_record(const Comparison& comparison, const Target& target) {
  Record regions = Record::array();
  for (const DifferenceRegion& region : comparison.regions) regions.push_back(region_record(region));
  return {{"file", target.file},
          {"tolerance_mm", record_of(target.tolerance.mm())},
          {"left_mm3", record_of(comparison.rest_beyond.mm3())},
          {"gouged_mm3", record_of(comparison.gouge_beyond.mm3())},
          {"region_count", comparison.region_count},
          {"regions", std::move(regions)}};
}

std::string depths_body(const Comparison& comparison, const Workpiece& part, std::uint32_t revision) {
  BinaryWriter out;
  out.reserve(32 + 4 * comparison.map.size());
  out.mark("KDIF");
  out.number(kVersion);
  out.number(revision);
  out.number(static_cast<std::uint32_t>(comparison.nx));
  out.number(static_cast<std::uint32_t>(comparison.ny));
  out.array(std::vector<float>{static_cast<float>(part.bounds().low.x),
                               static_cast<float>(part.bounds().low.y),
                               static_cast<float>(part.pitch().mm())});
  out.array(comparison.map);
  return out.take();
}

}  // namespace

std::optional<TargetResult> compare_with_target(const LiveJob& live, const Target& target,
                                                std::uint32_t revision, Diagnostics& diagnostics,
                                                Progress* progress) {
  if (live.cut() == nullptr) return std::nullopt;
  const Workpiece& part = *live.cut()->workpiece();
  const auto comparison = compare(part, *target.body, {.tolerance = target.tolerance}, diagnostics, progress);
  if (!comparison) return std::nullopt;
  return TargetResult{figures_record(*comparison, target), depths_body(*comparison, part, revision)};
}

}  // namespace kerf::app::view
