// Values of an OpenSCAD program: 16 bytes each. Undef, truth values and numbers are stored inline; strings,
// vectors, ranges, functions and objects are blocks with a count of references, and never change.
#pragma once

#include <cassert>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::scad {

/// `unset` is a variable whose assignment has not run yet; no expression has it as its value.
enum class Type : std::uint8_t { undef, boolean, number, unset, string, vector, range, function, object };
/// "undefined", "bool", "number", "string", "vector", "range", "function", "object": for messages.
std::string_view name_of(Type type);

/// Counts the bytes of the blocks of a run.
struct Meter {
  std::size_t bytes = 0;
};

/// What a value that is not stored inline refers to.
class Block {
 public:
  Block() = default;
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  virtual ~Block() = default;

 private:
  friend class Value;
  friend void drop(Block*);
  std::uint32_t references_ = 0;
};
/// Deletes a block that nothing refers to; blocks that it refers to follow without recursion.
void drop(Block* block);

class Value {
 public:
  Value() : number_(0.0), type_(Type::undef) {}
  Value(double number) : number_(number), type_(Type::number) {}  // NOLINT: numbers are values
  Value(const Value& other) : number_(other.number_), type_(other.type_) {
    if (counted()) {
      block_ = other.block_;
      ++block_->references_;
    }
  }
  Value(Value&& other) noexcept : type_(other.type_) {
    take(other);
    other.type_ = Type::undef;
  }
  Value& operator=(const Value& other) {
    Value copy(other);
    swap(copy);
    return *this;
  }
  Value& operator=(Value&& other) noexcept {
    if (this == &other) return *this;
    release();
    type_ = other.type_;
    take(other);
    other.type_ = Type::undef;
    return *this;
  }
  ~Value() { release(); }

  static Value truth(bool b) {
    Value v;
    v.bool_ = b;
    v.type_ = Type::boolean;
    return v;
  }
  static Value unset() {
    Value v;
    v.type_ = Type::unset;
    return v;
  }
  /// A string, UTF-8.
  static Value string(std::string text, Meter* meter = nullptr);
  static Value vector(std::vector<Value> items, Meter* meter = nullptr);
  /// Of `count` values, which are moved from `first` on.
  static Value vector(Value* first, std::size_t count, Meter* meter);
  static Value range(double begin, double step, double end);
  /// A value whose type is that of the block: a function or an object.
  static Value of(Type type, Block* block);

  Type type() const { return type_; }
  bool is(Type type) const { return type_ == type; }
  bool is_number() const { return type_ == Type::number; }
  bool is_undef() const { return type_ == Type::undef; }

  // Each asserts the type.
  double number() const {
    assert(type_ == Type::number);
    return number_;
  }
  bool truth() const {
    assert(type_ == Type::boolean);
    return bool_;
  }
  const std::string& text() const;
  std::span<const Value> items() const;
  /// 1 for a flat vector, 1 more for each level; 0 for what is no vector.
  std::uint32_t nesting() const;
  const struct Range& range() const;
  Block* block() const {
    assert(counted());
    return block_;
  }

  /// As a condition: false, 0, "", [], and undef are false.
  bool is_true() const;
  void swap(Value& other) noexcept {
    Value kept(std::move(other));
    other.type_ = type_;
    other.take(*this);
    type_ = kept.type_;
    take(kept);
    kept.type_ = Type::undef;
  }

 private:
  bool counted() const { return type_ > Type::unset; }
  /// Copies whatever the other one holds; where pointers have 32 bits, block_ is not all of it.
  void take(const Value& other) {
    static_assert(sizeof number_ >= sizeof block_);
    std::memcpy(&number_, &other.number_, sizeof number_);
  }
  void release() {
    if (counted() && --block_->references_ == 0) drop(block_);
  }
  union {
    double number_;
    bool bool_;
    Block* block_;
  };
  Type type_;
};

class StringBlock final : public Block {
 public:
  StringBlock(std::string text, Meter* meter);
  ~StringBlock() override;
  const std::string text;

 private:
  Meter* meter_;
};

/// Its values follow it in memory. Made by ItemList.
class alignas(Value) VectorBlock final : public Block {
 public:
  ~VectorBlock() override;
  static void operator delete(void* memory) { std::free(memory); }
  std::span<const Value> items() const { return {values(), count_}; }
  const std::uint32_t nesting;

 private:
  friend class ItemList;
  VectorBlock(std::size_t count, std::uint32_t depth, Meter* meter);
  static void* operator new(std::size_t, void* memory) { return memory; }
  static void operator delete(void*, void*) {}
  Value* values() { return reinterpret_cast<Value*>(this + 1); }
  const Value* values() const { return reinterpret_cast<const Value*>(this + 1); }

  std::size_t count_;
  Meter* meter_;
};

/// The values of a vector that is being made, where the vector will have them: finishing copies nothing.
class ItemList {
 public:
  ItemList() = default;
  ItemList(ItemList&& other) noexcept
      : memory_(std::exchange(other.memory_, nullptr)),
        count_(std::exchange(other.count_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  ItemList& operator=(ItemList&&) = delete;
  ~ItemList();

  std::size_t size() const { return count_; }
  std::span<const Value> items() const { return {values(), count_}; }
  void reserve(std::size_t count) {
    if (count > capacity_) grow(count);
  }
  void push_back(Value value) {
    if (count_ == capacity_) grow(capacity_ < kFirst ? kFirst : 2 * capacity_);
    new (values() + count_++) Value(std::move(value));
  }
  /// The vector; the list is empty then.
  Value finish(Meter* meter);

 private:
  static constexpr std::size_t kFirst = 4;  // values of the first block of memory
  void grow(std::size_t capacity);
  Value* values() const { return reinterpret_cast<Value*>(memory_ + sizeof(VectorBlock)); }

  char* memory_ = nullptr;  // room for the block, then the values
  std::size_t count_ = 0, capacity_ = 0;
};

/// [begin : step : end]
struct Range {
  double begin = 0.0, step = 1.0, end = 0.0;
  /// The number of its values: 0 if the step is 0 at the end, or leads away from it; infinite for a step of 0
  /// that reaches nothing, and for limits that are not finite.
  double count() const;
  /// As lists of values: an empty one is before all others; then by the first value, step and number.
  std::partial_ordering operator<=>(const Range& other) const;
  bool operator==(const Range& other) const { return (*this <=> other) == 0; }
  double at(std::size_t i) const { return i == 0 ? begin : begin + static_cast<double>(i) * step; }
};
class RangeBlock final : public Block {
 public:
  explicit RangeBlock(Range r) : range(r) {}
  const Range range;
};

/// A function literal; the interpreter derives from it.
class FunctionBlock : public Block {
 public:
  /// As echo prints it: "function(x) (x + 1)".
  virtual std::string text() const = 0;
};

/// An object of commands, such as that of gcodepreview(); `value.name(...)` calls the command `name`.
/// Commands derive from it.
class Object : public Block {
 public:
  /// As echo prints it.
  virtual std::string text() const = 0;
};

inline const std::string& Value::text() const {
  assert(type_ == Type::string);
  return static_cast<const StringBlock*>(block_)->text;
}
inline std::span<const Value> Value::items() const {
  assert(type_ == Type::vector);
  return static_cast<const VectorBlock*>(block_)->items();
}
inline const Range& Value::range() const {
  assert(type_ == Type::range);
  return static_cast<const RangeBlock*>(block_)->range;
}

/// Length at which the text of a value is cut off: a small value can hold itself many times.
inline constexpr std::size_t kMaxText = std::size_t{16} << 20;
/// As echo prints it: six significant digits, strings in vectors with quotation marks. Values that would make
/// it longer than `limit` are left out beyond it.
std::string to_string(const Value& value, std::size_t limit = kMaxText);
/// A number with six significant digits: 0.1, 1e+6, inf.
std::string to_string(double number);
/// As str() does: as echo, but a string is itself.
std::string as_text(const Value& value, std::size_t limit = kMaxText);

/// Whether two values are equal, as == compares them; values of different types are not.
bool equal(const Value& a, const Value& b);

}  // namespace kerf::scad
