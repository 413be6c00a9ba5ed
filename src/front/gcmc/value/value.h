// Values of a gcmc program: 32 bytes each. Scalars with their unit and vectors of up to three coordinates are
// stored inline. Longer vectors, lists and strings are reference-counted blocks (copy on write).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/utf8.h"

namespace kerf::gcmc {

enum class Unit : std::uint8_t { none, mm, inch, deg, rad };
constexpr bool is_distance(Unit u) { return u == Unit::mm || u == Unit::inch; }
constexpr bool is_angle(Unit u) { return u == Unit::deg || u == Unit::rad; }
/// "UNIT_MM": the name in gcmc's messages.
std::string_view unit_name(Unit u);
/// "mm", "in", "deg", "rad" or nothing: the suffix of a number.
std::string_view unit_suffix(Unit u);

enum class Kind : std::uint8_t { undef, integer, real };

union Payload {
  double d;
  std::int64_t
      i;  // integers have 32 bits; all of a payload is always written, so that it can be read at once
  struct Block* block;
  class Value* target;
};
static_assert(sizeof(Payload) == 8);

/// Kind and unit of a scalar, in the lowest byte, so that two scalars need one comparison. A whole word,
/// because compilers access a single byte in different widths, which prevents store forwarding.
using Tag = std::uint64_t;
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

  /// The number of an integer.
  std::int32_t whole() const { return static_cast<std::int32_t>(p.i); }
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
  double number() const { return kind() == Kind::integer ? whole() : kind() == Kind::real ? p.d : 0.0; }
  Scalar with_unit(Unit unit) const {
    Scalar s = *this;
    if (defined()) s.tag = make_tag(kind(), unit);
    return s;
  }
};

enum class Type : std::uint8_t {
  scalar,       // undef, integer or real
  vector,       // up to three coordinates, inline
  absent,       // a variable that does not exist, or a call that returned nothing
  reference,    // to a variable; internal
  long_vector,  // more coordinates; from here on in a block
  list,         // of vectors
  string,       // code points
};

/// Counts the bytes of all blocks against a limit.
struct Meter {
  std::size_t used = 0;
  std::size_t limit = std::size_t{1} << 31;
  /// Adds `bytes`; throws OutOfMemory if they exceed the limit.
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
  Value() : head_(head_of(Type::absent)) {}
  Value(const Value& o) {
    copy_bytes(o);
    if (is_block()) ++c_[0].block->owners;
  }
  Value(Value&& o) noexcept {
    copy_bytes(o);
    o.head_ = head_of(Type::absent);
  }
  Value(Scalar s) { set_scalar(s.p, s.tag); }
  ~Value() { drop(); }
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
    o.head_ = head_of(Type::absent);
    return *this;
  }

  Type type() const { return static_cast<Type>(head_ & 0xFF); }
  bool is_scalar() const { return type() == Type::scalar; }
  static bool are_scalars(const Value& a, const Value& b) {
    static_assert(static_cast<int>(Type::scalar) == 0);
    return ((a.head_ | b.head_) & 0xFF) == 0;
  }
  bool is_vector() const { return type() == Type::vector || type() == Type::long_vector; }
  bool is_short_vector() const { return type() == Type::vector; }
  bool is_list() const { return type() == Type::list; }
  bool is_string() const { return type() == Type::string; }
  bool is_undef() const { return is_scalar() && kind_of(tag()) == Kind::undef; }
  bool is_absent() const { return type() == Type::absent; }
  bool is_block() const { return type() >= Type::long_vector; }

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
  Tag tag() const { return head_ >> 8 & 0xFF; }
  Payload payload() const { return c_[0]; }
  Scalar scalar() const {
    Scalar s;
    s.p = c_[0];
    s.tag = tag();
    return s;
  }
  /// True for an integer without unit.
  bool is_whole() const { return head_ == kWholeHead; }
  std::int32_t whole() const { return static_cast<std::int32_t>(c_[0].i); }
  void store_whole(std::int32_t v) {
    drop();
    c_[0].i = v;
    head_ = kWholeHead;
  }
  /// Overwrites with a scalar; a block is released.
  void store(Scalar s) {
    drop();
    set_scalar(s.p, s.tag);
  }

  // Vectors
  std::size_t vector_size() const { return type() == Type::vector ? short_size() : long_size(); }
  std::size_t short_size() const { return head_ >> 32; }
  Scalar short_coordinate(std::size_t i) const {
    Scalar s;
    s.p = c_[i];
    s.tag = head_ >> (8 + 8 * i) & 0xFF;
    return s;
  }
  Scalar coordinate(std::size_t i) const {
    return type() == Type::long_vector ? long_coordinate(i) : short_coordinate(i);
  }
  /// Coordinate `i`, undef beyond the end.
  Scalar coordinate_or_undef(std::size_t i) const { return i < vector_size() ? coordinate(i) : Scalar{}; }
  /// Sets coordinate `i`; coordinates between the end and `i` become undef.
  void set_coordinate(std::size_t i, Scalar s, Meter& meter) {
    if (type() == Type::vector && i < 3) {
      while (short_size() <= i) head_ += std::uint64_t{1} << 32;  // tags beyond the end are those of undef
      put(i, s);
    } else {
      set_long_coordinate(i, s, meter);
    }
  }
  std::vector<Scalar> coordinates() const;
  /// Becomes an inline vector of `count` <= 3 undef coordinates, to be set by put().
  void make_vector(std::size_t count) {
    drop();
    head_ = head_of(Type::vector) | std::uint64_t{count} << 32;
  }
  void put(std::size_t i, Scalar s) {
    const std::size_t shift = 8 + 8 * i;
    c_[i] = s.p;
    head_ = (head_ & ~(std::uint64_t{0xFF} << shift)) | s.tag << shift;
  }

  /// True for a short vector all of whose coordinates are real numbers; kinds and units then are the head's.
  bool is_real_vector() const {
    constexpr std::uint64_t kKinds[] = {0, 0x0300, 0x030300, 0x03030300};
    constexpr std::uint64_t kReals[] = {0, 0x0200, 0x020200, 0x02020200};
    return type() == Type::vector && (head_ & kKinds[short_size()]) == kReals[short_size()];
  }
  /// True if both have the same type, size, kinds and units.
  bool same_shape(const Value& o) const { return head_ == o.head_; }
  double real_coordinate(std::size_t i) const { return c_[i].d; }
  /// Becomes a vector of real numbers with the size and units of `shape`, which may be this.
  void store_reals(const Value& shape, const double (&numbers)[3]) {
    const std::uint64_t head = shape.head_;
    drop();
    for (std::size_t i = 0; i < head >> 32; ++i) c_[i].d = numbers[i];
    head_ = head;
  }

  // Lists and strings
  const std::vector<Value>& vectors() const;
  std::vector<Value>& own_vectors(Meter& meter);  // for writing; call settle() after a change of size
  const std::u32string& text() const;
  std::u32string& own_text(Meter& meter);
  /// Updates the meter after a block has changed its size.
  void settle();

  // References
  Value* target() const { return c_[0].target; }
  std::int32_t reference_name() const { return static_cast<std::int32_t>(c_[1].i); }

  /// Becomes absent.
  void clear() {
    drop();
    head_ = head_of(Type::absent);
  }

 private:
  // The last 8 bytes: type, tags of three coordinates, number of coordinates. Always written as a whole: a
  // read wider than the preceding write cannot be forwarded from the store buffer.
  static constexpr std::uint64_t head_of(Type type) { return static_cast<std::uint64_t>(type); }
  static constexpr std::uint64_t kWholeHead = std::uint64_t{make_tag(Kind::integer, Unit::none)} << 8;
  void set_scalar(Payload p, Tag tag) {
    c_[0] = p;
    head_ = head_of(Type::scalar) | tag << 8;
  }
  void copy_bytes(const Value& o) {
    c_[0] = o.c_[0];
    head_ = o.head_;
    if (o.is_scalar()) return;
    c_[1] = o.c_[1];
    c_[2] = o.c_[2];
  }
  void drop() {
    if (is_block()) release(c_[0].block);
  }
  static Value owner_of(Block* block);
  void make_own(Meter& meter);
  std::size_t long_size() const;
  Scalar long_coordinate(std::size_t i) const;
  void set_long_coordinate(std::size_t i, Scalar s, Meter& meter);

  Payload c_[3]{};
  std::uint64_t head_;
};
static_assert(static_cast<int>(kUndefTag) == 0, "coordinates that are not set are undef");
static_assert(sizeof(Value) == 32, "a stored 3D vector has at most 64 bytes");

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

/// "VAL_INT" etc.: the name of a type in gcmc's messages.
std::string_view type_name(const Value& v);
/// Appends the textual form for message() and string addition; reals with `decimals` decimals.
void append_text(std::string& out, const Value& v, int decimals);
void append_text(std::string& out, Scalar s, int decimals);
/// A number for hints: "2.5mm".
std::string text_of(Scalar s);
std::string to_utf8(const std::u32string& text);
void append_utf8(std::string& out, char32_t c);

}  // namespace kerf::gcmc
