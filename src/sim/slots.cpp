// Pages of slots out of large blocks.
#include "sim/slots.h"

#include <algorithm>

namespace kerf::sim {

Slot* SlotPages::take() {
  constexpr std::size_t kBlock = std::size_t{1} << 21;
  constexpr std::size_t kPageBytes = kSlots * sizeof(Slot);
  const std::lock_guard lock(mutex_);
  if (unused_.empty()) {
    auto* memory = static_cast<std::byte*>(blocks_.emplace_back(new_block(kBlock)).get());
    for (std::size_t at = kBlock / kPageBytes * kPageBytes; at > 0; at -= kPageBytes)
      unused_.push_back(reinterpret_cast<Slot*>(memory + at - kPageBytes));
  }
  Slot* page = unused_.back();
  unused_.pop_back();
  return page;
}

void SlotPages::give_back(Slot* page) {
  const std::lock_guard lock(mutex_);
  unused_.push_back(page);
}

Slots::Slots(const Slots& other) : memory_(other.memory_) {
  for (std::size_t k = 0; k < other.size(); ++k) add() = other[k];
}

Slots::~Slots() {
  for (Slot* page : pages_) memory_->give_back(page);
}

}  // namespace kerf::sim
