// Frames: the variables of a file, a block or a call while they exist.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#include "front/scad/text/syntax.h"
#include "front/scad/value/value.h"

namespace kerf::scad {

struct Frame {
  Frame* parent = nullptr;
  Value* slots = nullptr;
  std::uint32_t count = 0;
  bool on_heap = false;
};

struct HeapFrame;

/// A counted reference to a heap frame; to another frame it counts nothing.
class FrameRef {
 public:
  FrameRef() = default;
  explicit FrameRef(Frame* f) : frame_(f) { add(); }
  FrameRef(const FrameRef& o) : frame_(o.frame_) { add(); }
  FrameRef(FrameRef&& o) noexcept : frame_(std::exchange(o.frame_, nullptr)) {}
  FrameRef& operator=(FrameRef o) noexcept {
    std::swap(frame_, o.frame_);
    return *this;
  }
  ~FrameRef() {
    if (frame_ != nullptr && frame_->on_heap) count_down();
  }
  Frame* get() const { return frame_; }

 private:
  void add() {
    if (frame_ != nullptr && frame_->on_heap) count_up();
  }
  void count_up();
  void count_down();
  Frame* frame_ = nullptr;
};

/// A frame that function literals may keep beyond its block; all that exist are in a list, so that rings of
/// frames and literals can be split at the end of the run.
struct HeapFrame final : Frame {
  explicit HeapFrame(Meter& m) : meter(m) {}
  HeapFrame(const HeapFrame&) = delete;
  HeapFrame& operator=(const HeapFrame&) = delete;
  ~HeapFrame() {
    if (before != nullptr) meter.bytes -= bytes();
  }
  std::size_t bytes() const { return sizeof(HeapFrame) + values.size() * sizeof(Value); }
  Meter& meter;
  FrameRef outer;
  std::vector<Value> values;
  std::uint32_t references = 0;
  HeapFrame *before = nullptr, *after = nullptr;
};
inline void FrameRef::count_up() { ++static_cast<HeapFrame*>(frame_)->references; }

/// The values of frames that end with their block, one after the other.
class ValueStack {
 public:
  explicit ValueStack(std::size_t capacity)
      : base_(static_cast<Value*>(std::calloc(capacity, sizeof(Value)))),
        top_(base_),
        end_(base_ == nullptr ? nullptr : base_ + capacity) {}
  ~ValueStack() {
    shrink(base_);
    std::free(base_);
  }
  ValueStack(const ValueStack&) = delete;
  ValueStack& operator=(const ValueStack&) = delete;

  bool has_room(std::size_t count) const { return static_cast<std::size_t>(end_ - top_) >= count; }
  /// `count` values, undef. There must be room.
  Value* grow(std::size_t count) {
    Value* first = top_;
    for (Value* end = top_ + count; top_ != end; ++top_) new (top_) Value();
    return first;
  }
  Value* top() const { return top_; }
  void shrink(Value* to) {
    while (top_ != to) (--top_)->~Value();
  }

 private:
  Value *base_, *top_, *end_;
};

/// A function literal with the frame that it was made in.
class Closure final : public FunctionBlock {
 public:
  Closure(const Function* f, Frame* frame) : function(f), frame_(frame) {}
  std::string text() const override { return text_of(*function); }
  Frame* frame() const { return frame_.get(); }
  const Function* const function;

 private:
  FrameRef frame_;
};

}  // namespace kerf::scad
