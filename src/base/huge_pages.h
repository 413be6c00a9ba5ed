// Memory in huge pages, if the system provides them: page faults of a hundred megabytes of small pages take
// longer than the simulation of a small job.
#pragma once

#include <cstddef>

namespace kerf {

inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

/// Requests huge pages for the part of untouched memory that contains whole ones.
void use_huge_pages(void* memory, std::size_t bytes);

/// The same, and touches the memory on several threads, because that takes too long on one.
void prepare_pages(void* memory, std::size_t bytes, unsigned threads);

}  // namespace kerf
