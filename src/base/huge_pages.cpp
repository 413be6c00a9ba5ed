// Memory in huge pages.
#include "base/huge_pages.h"

#include <cstdint>

#include "base/parallel.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace kerf {
namespace {

/// The huge pages that lie completely within a range of memory.
struct Pages {
  Pages(void* memory, std::size_t bytes)
      : first((reinterpret_cast<std::uintptr_t>(memory) + kHugePage - 1) / kHugePage * kHugePage),
        end((reinterpret_cast<std::uintptr_t>(memory) + bytes) / kHugePage * kHugePage) {}
  std::size_t count() const { return first < end ? (end - first) / kHugePage : 0; }
  std::uintptr_t first, end;
};

}  // namespace

void use_huge_pages(void* memory, std::size_t bytes) {
  const Pages pages(memory, bytes);
  if (pages.count() == 0) return;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  (void)madvise(reinterpret_cast<void*>(pages.first), pages.end - pages.first,
                MADV_HUGEPAGE);  // if refused, small pages are used
#endif
}

void prepare_pages(void* memory, std::size_t bytes, unsigned threads) {
  use_huge_pages(memory, bytes);
#if defined(__linux__) && defined(MADV_POPULATE_WRITE)
  const Pages pages(memory, bytes);
  const auto give = [&](std::size_t n) {
    (void)madvise(reinterpret_cast<void*>(pages.first + n * kHugePage), kHugePage, MADV_POPULATE_WRITE);
  };
  if (pages.count() > 1) parallel_for(threads, pages.count(), give, [] { return false; });
#else
  (void)threads;
#endif
}

}  // namespace kerf
