// The body of /path.
#include "app/shown/path_blocks.h"

#include <unordered_set>

#include "app/shown/binary.h"

namespace kerf::app::view {
namespace {

constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeader = 32, kEntry = 28;

}  // namespace

std::size_t PathBlocks::motions() const {
  std::size_t sum = 0;
  for (const PlacedBlock& placed : blocks_) sum += placed.block.motions;
  return sum;
}

std::string PathBlocks::body(std::uint32_t since) const {
  if (revision_ == 0) return {};
  std::size_t points = 0, groups = 0, size = kHeader + kEntry * blocks_.size();
  std::vector<bool> is_sent(blocks_.size());
  std::unordered_set<std::uint32_t> sent;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const auto& [block, first_step, lines] = blocks_[k];
    points += block.points;
    groups += lines.size();
    is_sent[k] = block.revision > since && sent.insert(block.id).second;
    size += 4 * lines.size() + (is_sent[k] ? block.bytes->size() : 0);
  }
  BinaryWriter out;
  out.reserve(size);
  out.mark("KPTH");
  out.number(kVersion);
  out.number(revision_);
  for (const std::size_t count : {motions(), points, blocks_.size(), groups})
    out.number(static_cast<std::uint32_t>(count));
  out.number(0);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const auto& [block, first_step, lines] = blocks_[k];
    const std::size_t bytes = is_sent[k] ? block.bytes->size() : 0;
    for (const std::size_t number :
         {std::size_t{block.id}, std::size_t{block.motions}, std::size_t{block.points},
          std::size_t{block.origins}, lines.size(), std::size_t{first_step}, bytes})
      out.number(static_cast<std::uint32_t>(number));
  }
  for (const PlacedBlock& placed : blocks_) out.array(placed.lines);
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (is_sent[k]) out.raw(*blocks_[k].block.bytes);
  return out.take();
}

}  // namespace kerf::app::view
