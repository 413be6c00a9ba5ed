// Blocks of values, their comparison, and their text as echo prints it.
#include "front/scad/value/value.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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

VectorBlock::VectorBlock(std::vector<Value> list, Meter* meter)
    : items(std::move(list)), nesting(1), meter_(meter) {
  for (const Value& v : items) nesting = std::max(nesting, v.nesting() + 1);
  if (meter_ != nullptr) meter_->bytes += kBlockBytes + items.capacity() * sizeof(Value);
}
VectorBlock::~VectorBlock() {
  if (meter_ != nullptr) meter_->bytes -= kBlockBytes + items.capacity() * sizeof(Value);
}

double Range::count() const {
  if (!std::isfinite(begin) || !std::isfinite(end) || std::isnan(step)) return 0.0;
  if (step == 0.0) return begin == end ? 1.0 : HUGE_VAL;
  if (begin == end) return 1.0;
  if ((end < begin) != (step < 0.0)) return 0.0;
  return std::floor((end - begin) / step) + 1.0;
}

Value Value::string(std::string text, Meter* meter) {
  return of(Type::string, new StringBlock(std::move(text), meter));
}
Value Value::vector(std::vector<Value> items, Meter* meter) {
  return of(Type::vector, new VectorBlock(std::move(items), meter));
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

/// The shortest text of six significant digits, as C's %g, with exponents from 1e+6 up and 1e-6 down.
void append_number(std::string& out, double x) {
  if (std::isnan(x)) {
    out += "nan";
    return;
  }
  if (std::isinf(x)) {
    out += x < 0 ? "-inf" : "inf";
    return;
  }
  if (x == 0.0) {
    out += '0';
    return;
  }
  std::string text = fmt::format("{:.5e}", x);  // d.ddddde+dd
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1));
  std::string digits;
  for (const char c : text.substr(0, e))
    if (c >= '0' && c <= '9') digits += c;
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back();
  if (x < 0) out += '-';
  const int count = static_cast<int>(digits.size());
  if (exponent < -5 || exponent > 5) {
    out += digits[0];
    if (count > 1) out += '.' + digits.substr(1);
    out += fmt::format("e{}{}", exponent < 0 ? '-' : '+', std::abs(exponent));
  } else if (exponent < 0) {
    out += "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  } else if (count <= exponent + 1) {
    out += digits + std::string(static_cast<std::size_t>(exponent + 1 - count), '0');
  } else {
    out += digits.substr(0, static_cast<std::size_t>(exponent + 1)) + '.' +
           digits.substr(static_cast<std::size_t>(exponent + 1));
  }
}

enum class Quotes : unsigned char { none, around_strings };

void append(std::string& out, const Value& v, Quotes quotes) {
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
        append(out, item, Quotes::around_strings);
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

std::string to_string(const Value& value) {
  std::string out;
  append(out, value, Quotes::around_strings);
  return out;
}

std::string to_string(double number) {
  std::string out;
  append_number(out, number);
  return out;
}

std::string as_text(const Value& value) {
  std::string out;
  append(out, value, Quotes::none);
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
      return a.items().size() == b.items().size() &&
             std::equal(a.items().begin(), a.items().end(), b.items().begin(), equal);
    case Type::range:
      return a.range().begin == b.range().begin && a.range().step == b.range().step &&
             a.range().end == b.range().end;
    case Type::function:
    case Type::object: break;
  }
  return a.block() == b.block();
}

}  // namespace kerf::scad
