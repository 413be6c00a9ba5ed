// Large blocks of memory.
#include "sim/blocks.h"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace kerf::sim {
namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

}  // namespace

void* new_block(std::size_t bytes) {
  bytes = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  void* block = std::aligned_alloc(kHugePage, bytes);
  if (block == nullptr) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  (void)madvise(block, bytes, MADV_HUGEPAGE);  // refused: small pages do as well
#endif
  return block;
}

void free_block(void* block) { std::free(block); }

}  // namespace kerf::sim
