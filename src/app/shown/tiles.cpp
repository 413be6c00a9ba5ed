// Tiles as bytes, and those that a page does not have yet.
#include "app/shown/tiles.h"

#include <algorithm>
#include <cstring>

#include "app/shown/binary.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kNumber = sizeof(std::uint32_t);
// Beyond these a page that is behind gets all tiles again.
constexpr std::size_t kMaxRenumberings = 200, kMaxShifts = 100'000;

std::uint32_t renumbered(std::uint32_t step, const std::vector<StepShift>& shifts) {
  if (step == kStockSurface) return step;
  const auto after =
      std::upper_bound(shifts.begin(), shifts.end(), step,
                       [](std::uint32_t s, const StepShift& shift) { return s < shift.first; });
  return after == shifts.begin() ? step : step + static_cast<std::uint32_t>((after - 1)->by);
}

std::string table_bytes(std::uint32_t revision, const std::vector<StepShift>& shifts) {
  BinaryWriter out;
  out.number(revision);
  out.number(static_cast<std::uint32_t>(shifts.size()));
  for (const StepShift& shift : shifts) {
    out.number(shift.first);
    out.number(static_cast<std::uint32_t>(shift.by));
  }
  return out.take();
}

}  // namespace

std::string tile_bytes(std::uint32_t id, std::uint32_t level, const Mesh& mesh) {
  BinaryWriter out;
  out.reserve(16 + 4 * (mesh.positions.size() + mesh.triangles.size() + mesh.step.size()));
  out.number(id);
  out.number(level);
  out.number(static_cast<std::uint32_t>(mesh.positions.size() / 3));
  out.number(static_cast<std::uint32_t>(mesh.step.size()));
  out.array(mesh.positions);
  out.array(mesh.triangles);
  out.array(mesh.step);
  return out.take();
}

std::string bytes_of(const MeshBody& body) {
  constexpr std::uint32_t kVersion = 1;
  BinaryWriter out;
  std::size_t size = 28;
  for (const std::string& table : body.renumberings) size += table.size();
  for (const std::string* tile : body.tiles) size += tile->size();
  out.reserve(size);
  out.mark("KMSH");
  out.number(kVersion);
  out.number(body.revision);
  out.number(body.forget_others ? 1 : 0);
  out.number(body.at_step);
  out.number(static_cast<std::uint32_t>(body.tiles.size()));
  out.number(static_cast<std::uint32_t>(body.renumberings.size()));
  for (const std::string& table : body.renumberings) out.raw(table);
  for (const std::string* tile : body.tiles) out.raw(*tile);
  return out.take();
}

void TileSet::reset(std::uint32_t revision) {
  tiles_.clear();
  renumberings_.clear();
  reset_at_ = revision;
}

void TileSet::renumber(const std::vector<StepShift>& shifts, std::uint32_t revision) {
  if (shifts.empty()) return;
  for (Tile& tile : tiles_) {
    auto bytes = std::make_shared<std::string>(*tile.bytes);
    char* const first = bytes->data() + bytes->size() - kNumber * tile.triangles;  // steps are last
    for (std::size_t t = 0; t < tile.triangles; ++t) {
      std::uint32_t step = 0;
      std::memcpy(&step, first + kNumber * t, kNumber);
      step = renumbered(step, shifts);
      std::memcpy(first + kNumber * t, &step, kNumber);
    }
    tile.bytes = std::move(bytes);
  }
  renumberings_.push_back({revision, shifts});
  std::size_t all = 0;
  for (const Renumbering& each : renumberings_) all += each.shifts.size();
  while (all > kMaxShifts || renumberings_.size() > kMaxRenumberings) {
    all -= renumberings_.front().shifts.size();
    reset_at_ = renumberings_.front().revision;
    renumberings_.erase(renumberings_.begin());
  }
}

std::size_t TileSet::replace(const std::vector<MeshTile>& tiles, std::uint32_t revision) {
  std::size_t changed = 0;
  for (const MeshTile& made : tiles) {
    auto bytes = std::make_shared<const std::string>(tile_bytes(made.number, 0, made.mesh));
    const auto at = std::lower_bound(tiles_.begin(), tiles_.end(), made.number,
                                     [](const Tile& tile, std::uint32_t id) { return tile.id < id; });
    const bool known = at != tiles_.end() && at->id == made.number;
    if (known && *at->bytes == *bytes) continue;
    const Tile tile{made.number, revision, made.mesh.step.size(), std::move(bytes)};
    if (known) {
      *at = tile;
    } else {
      tiles_.insert(at, tile);
    }
    ++changed;
  }
  return changed;
}

std::size_t TileSet::triangles() const {
  std::size_t count = 0;
  for (const Tile& tile : tiles_) count += tile.triangles;
  return count;
}

std::string TileSet::changed_since(std::uint32_t since, std::uint32_t revision) const {
  const bool forget = since < reset_at_;
  MeshBody body{.revision = revision, .forget_others = forget};
  for (const Renumbering& each : renumberings_)
    if (!forget && each.revision > since)
      body.renumberings.push_back(table_bytes(each.revision, each.shifts));
  for (const Tile& tile : tiles_)
    if (forget || tile.revision > since) body.tiles.push_back(tile.bytes.get());
  return bytes_of(body);
}

}  // namespace kerf::app::view
