// Large blocks of memory.
#include "sim/blocks.h"

#include <cstdint>
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
namespace {

/// Pages of zeros. Large ones begin and end where huge pages do, so that there are no others: those who add
/// up read a place before they write to it, and of each small page that costs two interruptions of all
/// threads.
void* map_zeros(std::size_t bytes) {
  const std::size_t spare = bytes % kHugePage == 0 ? kHugePage : 0;
  void* memory = mmap(nullptr, bytes + spare, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  if (spare == 0) return memory;
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(memory) % kHugePage) % kHugePage;
  char* begin = static_cast<char*>(memory) + before;
  if (before > 0) (void)munmap(memory, before);
  if (spare > before) (void)munmap(begin + bytes, spare - before);
  use_huge_pages(begin, bytes);
  return begin;
}

std::size_t zeros_bytes(std::size_t count) {
  const std::size_t bytes = (count + 1) * sizeof(double);
  return bytes < kHugePage ? bytes : (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

}  // namespace

Zeros::Zeros(std::size_t count) : size_(count), numbers_(nullptr, Free{zeros_bytes(count)}) {
  numbers_.reset(static_cast<double*>(map_zeros(numbers_.get_deleter().bytes)));
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
