// Memory in huge pages, if the system provides them: the first touch of a hundred megabytes in small pages
// takes longer than cutting a small job.
#pragma once

#include <cstddef>

namespace kerf {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Requests huge pages for memory that has not been touched, where whole ones fit.
void use_huge_pages(void* memory, std::size_t bytes);

/// The same, and touches the memory on several threads: on one thread this would take longer than the work
/// that all of them then do.
void prepare_pages(void* memory, std::size_t bytes, unsigned threads);

}  // namespace kerf
