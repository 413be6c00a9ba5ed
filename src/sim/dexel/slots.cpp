// Allocates pages of slots from large blocks.
#include "sim/dexel/slots.h"

#include <cstddef>
#include <new>

namespace kerf::sim {

SlotPages::Page* SlotPages::take() {
  constexpr std::size_t kBlock = std::size_t{1} << 21;
  const std::lock_guard lock(mutex_);
  if (unused_.empty()) {
    auto* memory = static_cast<std::byte*>(blocks_.emplace_back(new_block(kBlock)).get());
    for (std::size_t n = kBlock / sizeof(Page); n > 0; --n)
      unused_.push_back(new (memory + (n - 1) * sizeof(Page)) Page);  // not cleared
  }
  Page* page = unused_.back();
  unused_.pop_back();
  return page;
}

void SlotPages::release(const std::vector<Page*>& pages) {
  const std::lock_guard lock(mutex_);
  unused_.insert(unused_.end(), pages.rbegin(), pages.rend());
}

Slots::Slots(const Slots& other) : memory_(other.memory_) {
  while (size_ < other.size_) add();
  for (std::size_t n = 0; n < pages_.size(); ++n) *pages_[n] = *other.pages_[n];
}

Slots::~Slots() {
  if (!pages_.empty()) memory_->release(pages_);
}

}  // namespace kerf::sim
