// Large blocks of memory.
#include "sim/blocks.h"

#include <cstdint>
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
  use_huge_pages(block, bytes);
  return block;
}

void use_huge_pages(void* memory, std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + kHugePage - 1) / kHugePage * kHugePage;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / kHugePage * kHugePage;
  if (begin >= end) return;
  (void)madvise(reinterpret_cast<void*>(begin), end - begin,
                MADV_HUGEPAGE);  // refused: small ones do as well
#else
  (void)memory, (void)bytes;
#endif
}

void free_block(void* block) { std::free(block); }

Zeros::Zeros(std::size_t count)
    : size_(count), numbers_(static_cast<double*>(std::calloc(count + 1, sizeof(double)))) {
  if (!numbers_) throw std::bad_alloc();
  use_huge_pages(numbers_.get(), count * sizeof(double));
}

void Zeros::Free::operator()(double* numbers) const { std::free(numbers); }

}  // namespace kerf::sim
