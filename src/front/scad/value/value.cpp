// Blocks of values, their comparison, and their text as echo prints it.
#include "front/scad/value/value.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace kerf::scad {
namespace {

/// Blocks wait here while another one is being deleted, so that a chain of a million is no recursion.
struct Dropping {
  std::vector<Block*> waiting;
  bool active = false;
};
thread_local Dropping dropping;

constexpr std::size_t kBlockBytes = 48;  // of a block without its content

}  // namespace

std::string_view name_of(Type type) {
  switch (type) {
    case Type::undef:
    case Type::unset: break;
    case Type::boolean: return "bool";
    case Type::number: return "number";
    case Type::string: return "string";
    case Type::vector: return "vector";
    case Type::range: return "range";
    case Type::function: return "function";
    case Type::object: return "object";
  }
  return "undefined";
}

void drop(Block* block) {
  if (dropping.active) {
    dropping.waiting.push_back(block);
    return;
  }
  dropping.active = true;
  delete block;
  while (!dropping.waiting.empty()) {
    Block* next = dropping.waiting.back();
    dropping.waiting.pop_back();
    delete next;
  }
  dropping.active = false;
}

StringBlock::StringBlock(std::string t, Meter* meter) : text(std::move(t)), meter_(meter) {
  if (meter_ != nullptr) meter_->bytes += kBlockBytes + text.size();
}
StringBlock::~StringBlock() {
  if (meter_ != nullptr) meter_->bytes -= kBlockBytes + text.size();
}

VectorBlock::VectorBlock(std::size_t count, std::uint32_t depth, Meter* meter)
    : nesting(depth), count_(count), meter_(meter) {
  if (meter_ != nullptr) meter_->bytes += sizeof(VectorBlock) + count * sizeof(Value);
}
VectorBlock::~VectorBlock() {
  if (meter_ != nullptr) meter_->bytes -= sizeof(VectorBlock) + count_ * sizeof(Value);
  for (std::size_t i = 0; i < count_; ++i) values()[i].~Value();
}

ItemList::~ItemList() {
  for (std::size_t i = 0; i < count_; ++i) values()[i].~Value();
  std::free(memory_);
}
/// Values are moved as bytes: nothing refers to a value by its address while a list grows.
void ItemList::grow(std::size_t capacity) {
  static_assert(sizeof(VectorBlock) % alignof(Value) == 0);
  auto* memory = static_cast<char*>(std::realloc(memory_, sizeof(VectorBlock) + capacity * sizeof(Value)));
  if (memory == nullptr) throw std::bad_alloc();
  memory_ = memory;
  capacity_ = capacity;
}
Value ItemList::finish(Meter* meter) {
  std::uint32_t depth = 1;
  for (const Value& v : items()) depth = std::max(depth, v.nesting() + 1);
  constexpr std::size_t kMuch = 64;  // values; long lists release unused room
  if (memory_ == nullptr || (count_ > kMuch && capacity_ > count_ + count_ / 4)) grow(count_);
  auto* block = new (memory_) VectorBlock(count_, depth, meter);
  memory_ = nullptr;
  count_ = capacity_ = 0;
  return Value::of(Type::vector, block);
}

double Range::count() const {
  if (std::isnan(begin) || std::isnan(end) || std::isnan(step)) return 0.0;
  if (step < 0.0 ? begin < end : begin > end) return 0.0;
  if (begin == end || std::isinf(step)) return step == 0.0 ? 0.0 : 1.0;
  if (std::isinf(begin) || std::isinf(end) || step == 0.0) return HUGE_VAL;
  // As OpenSCAD: the quotient counts as a whole number if it is one ulp below it, so that [0:0.1:0.3] ends at
  // 0.3.
  return std::floor(std::nextafter((end - begin) / step, HUGE_VAL)) + 1.0;
}

std::partial_ordering Range::operator<=>(const Range& other) const {
  const double own_count = count(), other_count = other.count();
  if (own_count == 0.0 || other_count == 0.0) return own_count <=> other_count;
  if (const auto c = begin <=> other.begin; c != 0) return c;
  if (const auto c = step <=> other.step; c != 0) return c;
  return own_count <=> other_count;
}

Value Value::string(std::string text, Meter* meter) {
  return of(Type::string, new StringBlock(std::move(text), meter));
}
Value Value::vector(std::vector<Value> items, Meter* meter) {
  return vector(items.data(), items.size(), meter);
}
Value Value::vector(Value* first, std::size_t count, Meter* meter) {
  ItemList items;
  items.reserve(count);
  for (std::size_t i = 0; i < count; ++i) items.push_back(std::move(first[i]));
  return items.finish(meter);
}
Value Value::range(double begin, double step, double end) {
  return of(Type::range, new RangeBlock({begin, step, end}));
}
Value Value::of(Type type, Block* block) {
  assert(type > Type::unset);
  Value v;
  v.type_ = type;
  v.block_ = block;
  ++block->references_;
  return v;
}

std::uint32_t Value::nesting() const {
  return type_ == Type::vector ? static_cast<const VectorBlock*>(block_)->nesting : 0;
}

bool Value::is_true() const {
  switch (type_) {
    case Type::undef:
    case Type::unset: return false;
    case Type::boolean: return bool_;
    case Type::number: return number_ != 0.0;
    case Type::string: return !text().empty();
    case Type::vector: return !items().empty();
    case Type::range:
    case Type::function:
    case Type::object: break;
  }
  return true;
}

namespace {

/// Six significant digits, a tie rounded away from zero, without trailing zeros; the power of ten of the
/// first digit into `exponent`.
std::string six_digits(double x, int& exponent) {
  constexpr std::size_t kDigits = 6;
  std::string text = fmt::format("{:.15e}", x);  // d.ddd...e+dd
  const auto tail = std::string_view(text).substr(kDigits + 1, text.find('e') - kDigits - 1);
  // Possibly a tie, or just below one: more digits show it. They take much longer.
  if (tail[0] == '5' && tail.find_first_not_of('0', 1) == std::string_view::npos)
    text = fmt::format("{:.19e}", x);
  const std::size_t e = text.find('e');
  exponent = std::stoi(text.substr(e + 1));
  std::string digits = text.substr(0, 1) + text.substr(2, kDigits - 1);
  if (text[kDigits + 1] >= '5') {
    std::size_t i = digits.size();
    while (i > 0 && digits[i - 1] == '9') digits[--i] = '0';
    if (i > 0) {
      ++digits[i - 1];
    } else {
      digits[0] = '1';
      ++exponent;
    }
  }
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back();
  return digits;
}

/// With exponents from 1e+6 up and from 1e-6 down.
void append_number(std::string& out, double x) {
  constexpr int kWhole = 5, kFraction = -5;  // largest and smallest power of ten without an exponent
  if (std::isnan(x)) {
    out += "nan";
    return;
  }
  if (x < 0.0) out += '-';
  if (std::isinf(x)) {
    out += "inf";
    return;
  }
  if (x == 0.0) {
    out += '0';
    return;
  }
  constexpr double kPlain = 1e6;  // whole numbers below it have at most six digits
  if (std::fabs(x) < kPlain && x == std::trunc(x)) {
    fmt::format_to(std::back_inserter(out), "{}", std::abs(static_cast<int>(x)));
    return;
  }
  int exponent = 0;
  const std::string digits = six_digits(std::fabs(x), exponent);
  const int count = static_cast<int>(digits.size());
  const auto whole = static_cast<std::size_t>(exponent + 1);
  if (exponent < kFraction || exponent > kWhole) {
    out += digits[0];
    if (count > 1) out += '.' + digits.substr(1);
    out += fmt::format("e{}{}", exponent < 0 ? '-' : '+', std::abs(exponent));
  } else if (exponent < 0) {
    out += "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  } else if (count <= exponent + 1) {
    out += digits + std::string(whole - digits.size(), '0');
  } else {
    out += digits.substr(0, whole) + '.' + digits.substr(whole);
  }
}

enum class Quotes : unsigned char { none, around_strings };

void append(std::string& out, const Value& v, Quotes quotes, std::size_t limit) {
  if (out.size() > limit) return;
  switch (v.type()) {
    case Type::undef:
    case Type::unset: out += "undef"; break;
    case Type::boolean: out += v.truth() ? "true" : "false"; break;
    case Type::number: append_number(out, v.number()); break;
    case Type::string:
      if (quotes == Quotes::around_strings) out += '"';
      out += v.text();
      if (quotes == Quotes::around_strings) out += '"';
      break;
    case Type::vector: {
      out += '[';
      bool first = true;
      for (const Value& item : v.items()) {
        if (!first) out += ", ";
        first = false;
        append(out, item, Quotes::around_strings, limit);
        if (out.size() > limit) return;
      }
      out += ']';
      break;
    }
    case Type::range:
      out += '[';
      append_number(out, v.range().begin);
      out += " : ";
      append_number(out, v.range().step);
      out += " : ";
      append_number(out, v.range().end);
      out += ']';
      break;
    case Type::function: out += static_cast<const FunctionBlock*>(v.block())->text(); break;
    case Type::object: out += static_cast<const Object*>(v.block())->text(); break;
  }
}

}  // namespace

std::string to_string(const Value& value, std::size_t limit) {
  std::string out;
  append(out, value, Quotes::around_strings, limit);
  return out;
}

std::string to_string(double number) {
  std::string out;
  append_number(out, number);
  return out;
}

std::string as_text(const Value& value, std::size_t limit) {
  std::string out;
  append(out, value, Quotes::none, limit);
  return out;
}

bool equal(const Value& a, const Value& b) {
  if (a.type() != b.type()) return false;
  switch (a.type()) {
    case Type::undef:
    case Type::unset: return true;
    case Type::boolean: return a.truth() == b.truth();
    case Type::number: return a.number() == b.number();
    case Type::string: return a.text() == b.text();
    case Type::vector:
      return std::equal(a.items().begin(), a.items().end(), b.items().begin(), b.items().end(), equal);
    case Type::range: return a.range() == b.range();
    case Type::function:
    case Type::object: break;
  }
  return a.block() == b.block();
}

}  // namespace kerf::scad
