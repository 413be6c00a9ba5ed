// Values of a gcmc program: 32 bytes each. A scalar carries its unit inline; a vector of up to three coordinates is
// held inline as well, so that points need no memory of their own. Longer vectors, lists and strings are counted
// blocks that are copied only when one of several owners writes (copy on write).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::gcmc {

enum class Unit : std::uint8_t { none, mm, inch, deg, rad };
constexpr bool is_distance(Unit u) { return u == Unit::mm || u == Unit::inch; }
constexpr bool is_angle(Unit u) { return u == Unit::deg || u == Unit::rad; }
/// "UNIT_MM", as the language's own messages name it.
std::string_view unit_name(Unit u);
/// "mm", "in", "deg", "rad" or nothing: the suffix a number is written with.
std::string_view unit_suffix(Unit u);

enum class Kind : std::uint8_t { undef, integer, real };

union Payload {
  double d;
  std::int32_t i;
  struct Block* block;
  class Value* target;
};
static_assert(sizeof(Payload) == 8);

/// Kind and unit of a scalar in one byte, so that equal tags are one comparison.
using Tag = std::uint8_t;
constexpr Tag make_tag(Kind kind, Unit unit) {
  return static_cast<Tag>(static_cast<unsigned>(kind) | static_cast<unsigned>(unit) << 2);
}
constexpr Kind kind_of(Tag tag) { return static_cast<Kind>(tag & 3); }
constexpr Unit unit_of(Tag tag) { return static_cast<Unit>(tag >> 2); }
constexpr Tag kUndefTag = make_tag(Kind::undef, Unit::none);

/// One number with its unit, or undef: a coordinate of a vector.
struct Scalar {
  Payload p{};
  Tag tag = kUndefTag;

  static Scalar integer(std::int32_t v, Unit unit = Unit::none) {
    Scalar s;
    s.p.i = v;
    s.tag = make_tag(Kind::integer, unit);
    return s;
  }
  static Scalar real(double v, Unit unit = Unit::none) {
    Scalar s;
    s.p.d = v;
    s.tag = make_tag(Kind::real, unit);
    return s;
  }
  Kind kind() const { return kind_of(tag); }
  Unit unit() const { return unit_of(tag); }
  bool defined() const { return kind() != Kind::undef; }
  double number() const { return kind() == Kind::integer ? p.i : kind() == Kind::real ? p.d : 0.0; }
  Scalar with_unit(Unit unit) const {
    Scalar s = *this;
    if (defined()) s.tag = make_tag(kind(), unit);
    return s;
  }
};

enum class Type : std::uint8_t {
  scalar,       // undef, integer or real
  vector,       // up to three coordinates, inline
  long_vector,  // more, in a block
  list,         // of vectors
  string,       // code points
  absent,       // a variable that does not exist, or a call that returned nothing
  reference,    // to a variable: never seen by a program
};

/// Counts what blocks hold, and refuses what goes beyond the limit (see Meter::grow).
struct Meter {
  std::size_t used = 0;
  std::size_t limit = std::size_t{1} << 31;
  /// Throws OutOfMemory where `bytes` more would pass the limit.
  void grow(std::size_t bytes);
  void shrink(std::size_t bytes) { used -= bytes; }
};
struct OutOfMemory {};

struct Block {
  std::uint32_t owners = 1;
  Type type;
  Meter* meter;
  std::size_t charged = 0;  // bytes that the meter counts for this block
  Block(Type t, Meter* m) : type(t), meter(m) {}
};
void release(Block* block);

class Value {
 public:
  Value() { set_head(Type::absent, kUndefTag); }
  Value(const Value& o) { copy_bytes(o), retain(); }
  Value(Value&& o) noexcept { copy_bytes(o), o.set_head(Type::absent, kUndefTag); }
  Value(Scalar s) { set_scalar(s.p, s.tag); }
  ~Value() {
    if (is_block()) release(c_[0].block);
  }
  /// Assignment keeps the flags: they belong to the variable, not to what it holds.
  Value& operator=(const Value& o) {
    if (o.is_block()) ++o.c_[0].block->owners;
    drop();
    copy_bytes(o);
    return *this;
  }
  Value& operator=(Value&& o) noexcept {
    if (this == &o) return *this;
    drop();
    copy_bytes(o);
    o.set_head(Type::absent, kUndefTag);
    return *this;
  }

  Type type() const { return type_; }
  bool is_scalar() const { return type_ == Type::scalar; }
  bool is_vector() const { return type_ == Type::vector || type_ == Type::long_vector; }
  bool is_list() const { return type_ == Type::list; }
  bool is_string() const { return type_ == Type::string; }
  bool is_undef() const { return is_scalar() && kind_of(tag_[0]) == Kind::undef; }
  bool is_absent() const { return type_ == Type::absent; }
  bool is_block() const {
    return type_ == Type::long_vector || type_ == Type::list || type_ == Type::string;
  }

  static Value undef() { return Value(Scalar{}); }
  static Value integer(std::int32_t v, Unit unit = Unit::none) { return Value(Scalar::integer(v, unit)); }
  static Value real(double v, Unit unit = Unit::none) { return Value(Scalar::real(v, unit)); }
  static Value boolean(bool v) { return integer(v ? 1 : 0); }
  static Value string(std::u32string text, Meter& meter);
  static Value vector(const Scalar* coordinates, std::size_t count, Meter& meter);
  static Value empty_vector();
  static Value list(std::vector<Value> vectors, Meter& meter);
  static Value reference(Value* target, std::int32_t name);

  // Scalars
  Tag tag() const { return tag_[0]; }
  Payload payload() const { return c_[0]; }
  Scalar scalar() const {
    Scalar s;
    s.p = c_[0];
    s.tag = tag_[0];
    return s;
  }
  /// Overwrites with a scalar; what was held is let go.
  void store(Payload p, Tag tag) {
    drop();
    set_scalar(p, tag);
  }
  void store_integer(std::int32_t v, Tag tag) {
    Payload p;
    p.i = v;
    store(p, tag);
  }
  void store_real(double v, Tag tag) {
    Payload p;
    p.d = v;
    store(p, tag);
  }

  // Vectors
  std::size_t vector_size() const { return type_ == Type::vector ? count_ : long_size(); }
  Scalar coordinate(std::size_t i) const {
    if (type_ == Type::long_vector) return long_coordinate(i);
    Scalar s;
    s.p = c_[i];
    s.tag = tag_[i];
    return s;
  }
  /// Coordinate `i`, undef beyond the end.
  Scalar coordinate_or_undef(std::size_t i) const { return i < vector_size() ? coordinate(i) : Scalar{}; }
  /// Sets coordinate `i`; what lies between it and the end becomes undef.
  void set_coordinate(std::size_t i, Scalar s, Meter& meter) {
    if (type_ == Type::vector && i < 3) {
      while (count_ <= i) tag_[count_++] = kUndefTag;
      put(i, s.p, s.tag);
    } else {
      set_long_coordinate(i, s, meter);
    }
  }
  std::vector<Scalar> coordinates() const;
  /// Begins an inline vector of `count` <= 3 coordinates, to be filled by put().
  void make_vector(std::size_t count) {
    drop();
    set_head(Type::vector, kUndefTag);
    count_ = static_cast<std::uint8_t>(count);
  }
  void put(std::size_t i, Payload p, Tag tag) {
    c_[i] = p;
    tag_[i] = tag;
  }

  // Lists and strings
  const std::vector<Value>& vectors() const;
  std::vector<Value>& own_vectors(Meter& meter);  // for writing; call settle() after a change of size
  const std::u32string& text() const;
  std::u32string& own_text(Meter& meter);
  /// Tells the meter of a block's changed size.
  void settle();

  // References
  Value* target() const { return c_[0].target; }
  std::int32_t reference_name() const { return c_[1].i; }

  bool constant() const { return flags_ != 0; }
  void set_constant(bool on) { flags_ = on ? 1 : 0; }
  /// Back to a variable that does not exist.
  void clear() {
    drop();
    set_head(Type::absent, kUndefTag);
    flags_ = 0;
  }

 private:
  void set_head(Type type, Tag tag) {
    type_ = type;
    tag_[0] = tag;
  }
  void set_scalar(Payload p, Tag tag) {
    c_[0] = p;
    set_head(Type::scalar, tag);
  }
  void copy_bytes(const Value& o) {
    for (int i = 0; i < 3; ++i) c_[i] = o.c_[i];
    type_ = o.type_;
    std::memcpy(tag_, o.tag_, sizeof tag_);
    count_ = o.count_;
  }
  void retain() {
    if (is_block()) ++c_[0].block->owners;
  }
  void drop() {
    if (is_block()) release(c_[0].block);
  }
  void make_own(Meter& meter);
  std::size_t long_size() const;
  Scalar long_coordinate(std::size_t i) const;
  void set_long_coordinate(std::size_t i, Scalar s, Meter& meter);

  Payload c_[3]{};
  Type type_;
  Tag tag_[3]{};
  std::uint8_t count_ = 0;
  std::uint8_t flags_ = 0;
};
static_assert(sizeof(Value) == 32, "a stored 3D vector is to take at most 64 bytes");

struct LongVector : Block {
  std::vector<Scalar> items;
  explicit LongVector(Meter* m) : Block(Type::long_vector, m) {}
};
struct List : Block {
  std::vector<Value> items;
  explicit List(Meter* m) : Block(Type::list, m) {}
};
struct Text : Block {
  std::u32string items;
  explicit Text(Meter* m) : Block(Type::string, m) {}
};

/// "VAL_INT" and so on, as the language's own messages name a value's type.
std::string_view type_name(const Value& v);
/// Appends the textual form that message() and string addition use; reals with `decimals` places.
void append_text(std::string& out, const Value& v, int decimals);
void append_text(std::string& out, Scalar s, int decimals);
std::string to_utf8(const std::u32string& text);
void append_utf8(std::string& out, char32_t c);
/// Code points of UTF-8; bytes that are not UTF-8 stand for themselves.
std::u32string from_utf8(std::string_view bytes);

}  // namespace kerf::gcmc
