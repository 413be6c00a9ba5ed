// Slots hold the intervals of columns that have material above an undercut; their memory comes in pages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "sim/dexel/blocks.h"

namespace kerf::sim {

using Real = float;
inline constexpr int kLanes = 16;  // columns of a micro

struct alignas(64) Lanes {
  Real v[kLanes];
  Real& operator[](int i) { return v[i]; }
  Real operator[](int i) const { return v[i]; }
};

/// One interval in each column of a micro; low > high: none.
struct Slot {
  Lanes low, high;
  alignas(64) std::uint32_t low_step[kLanes];
  alignas(64) std::uint32_t high_step[kLanes];
};

/// Memory for slots, in pages that tiles return and reuse; all of it is kept until the last tile that uses it
/// is destroyed. Thread-safe.
class SlotPages {
 public:
  static constexpr std::size_t kSlots = 16;  // per page
  struct Page {
    Slot slot[kSlots];
    std::int32_t next[kSlots];  // next slot of the same chain or of the free list; -1 after the last
  };
  Page* take();
  void release(const std::vector<Page*>& pages);

 private:
  struct Free {
    void operator()(void* block) const { free_block(block); }
  };
  std::mutex mutex_;
  std::vector<std::unique_ptr<void, Free>> blocks_;
  std::vector<Page*> unused_;
};

/// Numbered slots. They never move, and none is copied as their number grows.
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
  /// An empty list that uses the same memory.
  Slots none() const { return Slots(memory_); }

  Slot& operator[](std::int32_t k) { return page(k).slot[index_in_page(k)]; }
  const Slot& operator[](std::int32_t k) const { return page(k).slot[index_in_page(k)]; }
  std::int32_t& next(std::int32_t k) { return page(k).next[index_in_page(k)]; }
  std::int32_t next(std::int32_t k) const { return page(k).next[index_in_page(k)]; }
  std::int32_t size() const { return size_; }
  /// Appends an uninitialised slot; Tile::add_slot clears it.
  void add() {
    if (index_in_page(size_++) == 0) pages_.push_back(memory_->take());
  }

 private:
  using Page = SlotPages::Page;
  static std::size_t index_in_page(std::int32_t k) { return static_cast<std::size_t>(k) % SlotPages::kSlots; }
  Page& page(std::int32_t k) const { return *pages_[static_cast<std::size_t>(k) / SlotPages::kSlots]; }
  void swap(Slots& other) {
    memory_.swap(other.memory_);
    pages_.swap(other.pages_);
    std::swap(size_, other.size_);
  }
  std::shared_ptr<SlotPages> memory_;
  std::vector<Page*> pages_;
  std::int32_t size_ = 0;
};

}  // namespace kerf::sim
