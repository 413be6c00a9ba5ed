// Memory in huge pages.
#include "base/huge_pages.h"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace kerf {

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

}  // namespace kerf
