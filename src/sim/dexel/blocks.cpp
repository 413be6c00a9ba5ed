// Large blocks of memory.
#include "sim/dexel/blocks.h"

#include <cstdlib>
#include <new>

namespace kerf::sim {

void* new_block(std::size_t bytes) {
  bytes = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  void* block = std::aligned_alloc(kHugePage, bytes);
  if (block == nullptr) throw std::bad_alloc();
  use_huge_pages(block, bytes);
  return block;
}

void free_block(void* block) { std::free(block); }

}  // namespace kerf::sim
