// The mesh of the shown part in tiles, each with the revision in which it last changed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kerf/sim/live.h"
#include "kerf/sim/mesh.h"

namespace kerf::app::view {

/// One tile as bytes, from its id to the steps of its triangles.
struct Tile {
  std::uint32_t id = 0;
  std::uint32_t revision = 0;
  std::size_t triangles = 0;
  std::shared_ptr<const std::string> bytes;
};
/// The bytes of a tile; `level` 0 is final.
std::string tile_bytes(std::uint32_t id, std::uint32_t level, const Mesh& mesh);

/// The tiles of a part. A value: copies share the bytes.
class TileSet {
 public:
  /// Starts over: pages have to forget all tiles of earlier revisions.
  void reset(std::uint32_t revision);
  /// Gives the steps of all tiles new numbers. Pages that have earlier tiles have to do the same.
  void renumber(const std::vector<StepShift>& shifts, std::uint32_t revision);
  /// Replaces tiles. A tile with the same bytes as before keeps its revision. Returns the number of changed
  /// ones.
  std::size_t replace(const std::vector<MeshTile>& tiles, std::uint32_t revision);

  const std::vector<Tile>& tiles() const { return tiles_; }
  std::size_t triangles() const;
  /// The body of /mesh: the tiles that changed after `since`.
  std::string changed_since(std::uint32_t since, std::uint32_t revision) const;

 private:
  struct Renumbering {
    std::uint32_t revision;
    std::vector<StepShift> shifts;
  };
  std::vector<Tile> tiles_;                // in order of their ids
  std::vector<Renumbering> renumberings_;  // since reset_at_
  std::uint32_t reset_at_ = 0;             // pages with older tiles get all again
};

inline constexpr std::uint32_t kWholeJob = 0xffffffffu;  // the part after all steps

/// A body of /mesh or /at.
struct MeshBody {
  std::uint32_t revision = 0;
  bool forget_others = false;
  std::uint32_t at_step = kWholeJob;
  std::vector<std::string> renumberings = {};  // as bytes
  std::vector<const std::string*> tiles = {};
};
std::string bytes_of(const MeshBody& body);

}  // namespace kerf::app::view
