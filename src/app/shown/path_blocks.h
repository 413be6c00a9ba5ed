// The motions of a toolpath in blocks: what an edit does not change stays the same bytes, so that a page that
// has them gets only the others. Where a block is in the program is stated outside of it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace kerf::app::view {

/// The bytes of some motions, without the numbers of their first step and lines.
struct PathBlock {
  std::uint32_t id = 0;        // the same id: the same bytes
  std::uint32_t revision = 0;  // in which it first was part of the path
  std::uint32_t motions = 0, points = 0, origins = 0;
  std::shared_ptr<const std::string> bytes;
};

/// A block and where it is in the program.
struct PlacedBlock {
  PathBlock block;
  std::uint32_t first_step = 0;
  std::vector<std::uint32_t> lines;  // the first one of each group of origins
};

/// A path of one revision. A value: copies share the bytes.
class PathBlocks {
 public:
  /// The body of /path: blocks made after revision `since` with their bytes, others by their ids.
  std::string body(std::uint32_t since) const;
  std::size_t motions() const;
  std::uint32_t revision() const { return revision_; }
  const std::vector<PlacedBlock>& blocks() const { return blocks_; }

 private:
  friend class BlockMaker;
  std::uint32_t revision_ = 0;  // 0: no path
  std::uint32_t ids_ = 0;       // that have been given
  std::vector<PlacedBlock> blocks_;
};

}  // namespace kerf::app::view
