// Large blocks of memory.
#include "sim/blocks.h"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace kerf::sim {

void* new_block(std::size_t bytes) {
  bytes = (bytes + kHugePage - 1) / kHugePage * kHugePage;
  void* block = std::aligned_alloc(kHugePage, bytes);
  if (block == nullptr) throw std::bad_alloc();
  use_huge_pages(block, bytes);
  return block;
}

void free_block(void* block) { std::free(block); }

#if defined(__linux__)
Zeros::Zeros(std::size_t count) : size_(count), numbers_(nullptr, Free{(count + 1) * sizeof(double)}) {
  const std::size_t bytes = numbers_.get_deleter().bytes;
  void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  use_huge_pages(memory, bytes);
  numbers_.reset(static_cast<double*>(memory));
}

void Zeros::Free::operator()(double* numbers) const { (void)munmap(numbers, bytes); }
#else
Zeros::Zeros(std::size_t count)
    : size_(count), numbers_(static_cast<double*>(std::calloc(count + 1, sizeof(double))), Free{}) {
  if (!numbers_) throw std::bad_alloc();
}

void Zeros::Free::operator()(double* numbers) const { std::free(numbers); }
#endif

}  // namespace kerf::sim
