// Values: blocks, copying on write, and the textual form.
#include "front/gcmc/value/value.h"

#include <cassert>

#include "base/number.h"

namespace kerf::gcmc {

std::string_view unit_name(Unit u) {
  static constexpr std::string_view kNames[] = {"UNIT_NONE", "UNIT_MM", "UNIT_IN", "UNIT_DEG", "UNIT_RAD"};
  return kNames[static_cast<std::size_t>(u)];
}

std::string_view unit_suffix(Unit u) {
  static constexpr std::string_view kNames[] = {"", "mm", "in", "deg", "rad"};
  return kNames[static_cast<std::size_t>(u)];
}

// ---- blocks

void Meter::grow(std::size_t bytes) {
  if (bytes > limit - used) throw OutOfMemory{};
  used += bytes;
}

namespace {

/// Sets the number of bytes that the meter counts for a block.
void charge(Block& block, std::size_t bytes) {
  if (bytes > block.charged) block.meter->grow(bytes - block.charged);
  if (bytes < block.charged) block.meter->shrink(block.charged - bytes);
  block.charged = bytes;
}

template <class Body>
void charge_items(Body& block) {
  charge(block, block.items.capacity() * sizeof(block.items[0]));
}

}  // namespace

Value Value::owner_of(Block* block) {
  Value v;
  v.c_[0].block = block;
  v.head_ = head_of(block->type);
  return v;
}

Value Value::string(std::u32string text, Meter& meter) {
  auto* block = new Text(&meter);
  block->items = std::move(text);
  Value v = owner_of(block);
  charge_items(*block);
  return v;
}

Value Value::empty_vector() {
  Value v;
  v.make_vector(0);
  return v;
}

Value Value::vector(const Scalar* coordinates, std::size_t count, Meter& meter) {
  if (count <= 3) {
    Value v;
    v.make_vector(count);
    for (std::size_t i = 0; i < count; ++i) v.put(i, coordinates[i]);
    return v;
  }
  auto* block = new LongVector(&meter);
  block->items.assign(coordinates, coordinates + count);
  Value v = owner_of(block);
  charge_items(*block);
  return v;
}

Value Value::list(std::vector<Value> vectors, Meter& meter) {
  auto* block = new List(&meter);
  block->items = std::move(vectors);
  Value v = owner_of(block);
  charge_items(*block);
  return v;
}

Value Value::reference(Value* target, std::int32_t name) {
  Value v;
  v.c_[0].target = target;
  v.c_[1].i = name;
  v.head_ = head_of(Type::reference);
  return v;
}

void Value::make_own(Meter& meter) {
  Block* shared = c_[0].block;
  if (shared->owners == 1) return;
  Value copy;
  switch (type()) {
    case Type::long_vector: {
      const auto& items = static_cast<LongVector*>(shared)->items;
      copy = vector(items.data(), items.size(), meter);
      break;
    }
    case Type::list: copy = list(static_cast<List*>(shared)->items, meter); break;
    case Type::string: copy = string(static_cast<Text*>(shared)->items, meter); break;
    default: return;
  }
  *this = std::move(copy);
}

void Value::settle() {
  switch (type()) {
    case Type::long_vector: charge_items(static_cast<LongVector&>(*c_[0].block)); break;
    case Type::list: charge_items(static_cast<List&>(*c_[0].block)); break;
    case Type::string: charge_items(static_cast<Text&>(*c_[0].block)); break;
    default: break;
  }
}

// ---- vectors

std::size_t Value::long_size() const { return static_cast<LongVector*>(c_[0].block)->items.size(); }

Scalar Value::long_coordinate(std::size_t i) const { return static_cast<LongVector*>(c_[0].block)->items[i]; }

std::vector<Scalar> Value::coordinates() const {
  std::vector<Scalar> all(vector_size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = coordinate(i);
  return all;
}

void Value::set_long_coordinate(std::size_t i, Scalar s, Meter& meter) {
  if (type() == Type::vector) {
    std::vector<Scalar> all = coordinates();
    all.resize(i + 1);
    all[i] = s;
    *this = vector(all.data(), all.size(), meter);
    return;
  }
  make_own(meter);
  auto* block = static_cast<LongVector*>(c_[0].block);
  if (i >= block->items.size()) block->items.resize(i + 1);
  block->items[i] = s;
  charge_items(*block);
}

// ---- lists and strings

const std::vector<Value>& Value::vectors() const { return static_cast<List*>(c_[0].block)->items; }

std::vector<Value>& Value::own_vectors(Meter& meter) {
  make_own(meter);
  return static_cast<List*>(c_[0].block)->items;
}

const std::u32string& Value::text() const { return static_cast<Text*>(c_[0].block)->items; }

std::u32string& Value::own_text(Meter& meter) {
  make_own(meter);
  return static_cast<Text*>(c_[0].block)->items;
}

// ---- text

std::string_view type_name(const Value& v) {
  switch (v.type()) {
    case Type::scalar: break;
    case Type::vector:
    case Type::long_vector: return "VAL_VECTOR";
    case Type::list: return "VAL_VECTORLIST";
    case Type::string: return "VAL_STRING";
    case Type::absent:
    case Type::reference: return "VAL_NONE";
  }
  switch (kind_of(v.tag())) {
    case Kind::integer: return "VAL_INT";
    case Kind::real: return "VAL_FLOAT";
    case Kind::undef: break;
  }
  return "VAL_UNDEF";
}

std::string text_of(Scalar s) {
  constexpr int kDecimals = 6;
  return number_text(s.number(), kDecimals) + std::string(unit_suffix(s.unit()));
}

void append_text(std::string& out, Scalar s, int decimals) {
  switch (s.kind()) {
    case Kind::undef: out += "<undef>"; return;
    case Kind::integer: out += std::to_string(s.whole()); break;
    case Kind::real: append_fixed(out, s.p.d, decimals, MinusZero::keep); break;
  }
  out += unit_suffix(s.unit());
}

namespace {

void append_vector(std::string& out, const Value& v, int decimals) {
  out += '[';
  for (std::size_t i = 0; i < v.vector_size(); ++i) {
    if (i > 0) out += ',';
    const Scalar s = v.coordinate(i);
    if (s.defined())
      append_text(out, s, decimals);
    else
      out += '-';
  }
  out += ']';
}

}  // namespace

void append_text(std::string& out, const Value& v, int decimals) {
  switch (v.type()) {
    case Type::scalar: append_text(out, v.scalar(), decimals); break;
    case Type::vector:
    case Type::long_vector: append_vector(out, v, decimals); break;
    case Type::list: {
      out += '{';
      const char* separator = "";
      for (const Value& item : v.vectors()) {
        out += separator;
        append_vector(out, item, decimals);
        separator = ",";
      }
      out += '}';
      break;
    }
    case Type::string:
      for (char32_t c : v.text()) append_utf8(out, c);
      break;
    case Type::absent:
    case Type::reference: break;
  }
}

void append_utf8(std::string& out, char32_t c) {
  auto put = [&out](char32_t bits) { out += static_cast<char>(bits); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0 | c >> 6), put(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    put(0xE0 | c >> 12), put(0x80 | (c >> 6 & 0x3F)), put(0x80 | (c & 0x3F));
  } else {
    put(0xF0 | (c >> 18 & 7)), put(0x80 | (c >> 12 & 0x3F)), put(0x80 | (c >> 6 & 0x3F)),
        put(0x80 | (c & 0x3F));
  }
}

std::string to_utf8(const std::u32string& text) {
  std::string out;
  out.reserve(text.size());
  for (char32_t c : text) append_utf8(out, c);
  return out;
}

}  // namespace kerf::gcmc
