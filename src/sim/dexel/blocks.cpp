// Large blocks of memory.
#include "sim/dexel/blocks.h"

#include <new>

namespace kerf::sim {
namespace {

constexpr std::align_val_t kAlignment{kHugePage};

}  // namespace

void* new_block(std::size_t bytes) {
  bytes = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  void* block = ::operator new(bytes, kAlignment);
  use_huge_pages(block, bytes);
  return block;
}

void free_block(void* block) { ::operator delete(block, kAlignment); }

}  // namespace kerf::sim
