// Allocates many objects of one size from large blocks of memory in huge pages.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/huge_pages.h"

namespace kerf::sim {

/// At least `bytes` of memory, aligned to whole huge pages; free_block returns it. Throws std::bad_alloc.
void* new_block(std::size_t bytes);
void free_block(void* block);
using kerf::use_huge_pages;

/// Makes objects of one type. Memory of destroyed objects is reused; all of it is kept until the store is
/// destroyed. Thread-safe.
template <class Object>
class BlockStore {
 public:
  struct Destroy {
    BlockStore* store = nullptr;
    void operator()(Object* object) const {
      object->~Object();
      const std::lock_guard lock(store->mutex_);
      store->unused_.push_back(object);
    }
  };
  using Pointer = std::unique_ptr<Object, Destroy>;

  template <class... Arguments>
  Pointer make(Arguments&&... arguments) {
    return Pointer(new (allocate()) Object(std::forward<Arguments>(arguments)...), Destroy{this});
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 21;
  static constexpr std::size_t kEach =
      (sizeof(Object) + alignof(Object) - 1) / alignof(Object) * alignof(Object);
  static_assert(kEach <= kBlock);
  struct Free {
    void operator()(void* block) const { free_block(block); }
  };

  void* allocate() {
    const std::lock_guard lock(mutex_);
    if (!unused_.empty()) {
      void* at = unused_.back();
      unused_.pop_back();
      return at;
    }
    if (blocks_.empty() || used_ + kEach > kBlock) {
      blocks_.emplace_back(new_block(kBlock));
      used_ = 0;
    }
    void* at = static_cast<char*>(blocks_.back().get()) + used_;
    used_ += kEach;
    return at;
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<void, Free>> blocks_;
  std::size_t used_ = 0;  // of the last block
  std::vector<void*> unused_;
};

}  // namespace kerf::sim
