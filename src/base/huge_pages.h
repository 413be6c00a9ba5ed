// Memory in huge pages, where the system offers them: touching a hundred megabytes for the first time in
// small ones takes longer than cutting a small job.
#pragma once

#include <cstddef>

namespace kerf {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Asks for huge pages, as far as there are whole ones, for memory that is not yet touched.
void use_huge_pages(void* memory, std::size_t bytes);

/// The same, and has the memory given at once, on several threads: to touch it on one would take longer than
/// what is then done on all.
void prepare_pages(void* memory, std::size_t bytes, unsigned threads);

}  // namespace kerf
