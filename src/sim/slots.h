// The intervals of the columns of a micro that is no height field: slots, and the memory they live in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "sim/blocks.h"

namespace kerf::sim {

using Real = float;
inline constexpr int kLanes = 16;  // columns of a micro

struct alignas(64) Lanes {
  Real v[kLanes];
  Real& operator[](int i) { return v[i]; }
  Real operator[](int i) const { return v[i]; }
};

/// One interval in each column of a micro; low above high where there is none.
struct Slot {
  Lanes low, high;
  alignas(64) std::uint32_t low_step[kLanes];
  alignas(64) std::uint32_t high_step[kLanes];
  std::int32_t next = -1;  // slot of the same chain, or of those that are free
};

/// Memory for slots, in pages that go from one tile to the next; all of it is kept until the last tile that
/// uses it ends. Safe to use from several threads.
class SlotPages {
 public:
  static constexpr std::size_t kSlots = 64;  // of a page
  Slot* take();
  void give_back(Slot* page);

 private:
  struct Free {
    void operator()(void* block) const { free_block(block); }
  };
  std::mutex mutex_;
  std::vector<std::unique_ptr<void, Free>> blocks_;
  std::vector<Slot*> unused_;
};

/// Slots by number. They never move, and no slot is copied as their number grows.
class Slots {
 public:
  explicit Slots(std::shared_ptr<SlotPages> memory) : memory_(std::move(memory)) {}
  Slots(const Slots& other);
  Slots(Slots&& other) noexcept { swap(other); }
  Slots& operator=(Slots other) {
    swap(other);
    return *this;
  }
  ~Slots();

  Slot& operator[](std::size_t k) { return pages_[k / kPage][k % kPage]; }
  const Slot& operator[](std::size_t k) const { return pages_[k / kPage][k % kPage]; }
  std::size_t size() const { return size_; }
  Slot& add() {
    if (size_ % kPage == 0) pages_.push_back(memory_->take());
    const std::size_t k = size_++;
    return *new (&pages_[k / kPage][k % kPage]) Slot;  // not cleared: Tile::add_slot does that
  }

 private:
  static constexpr std::size_t kPage = SlotPages::kSlots;
  void swap(Slots& other) {
    memory_.swap(other.memory_);
    pages_.swap(other.pages_);
    std::swap(size_, other.size_);
  }
  std::shared_ptr<SlotPages> memory_;
  std::vector<Slot*> pages_;
  std::size_t size_ = 0;
};

}  // namespace kerf::sim
