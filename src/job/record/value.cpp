// Building records, and writing them as JSON.
#include "job/record/value.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace kerf {
namespace {

constexpr std::size_t kIndent = 2;
constexpr double kMaxExact = 1e15;  // whole numbers below it are written without an exponent

/// A string or a number as the library writes it.
template <class Value>
void write_by_library(const Value& value, std::string& out) {
  out += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool is_plain(char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; }

void write_string(const std::string& text, std::string& out) {
  if (!std::all_of(text.begin(), text.end(), is_plain)) return write_by_library(text, out);
  out += '"';
  out += text;
  out += '"';
}

void write_number(double value, std::string& out) {
  if (!(std::fabs(value) < kMaxExact) || value != std::floor(value) || std::signbit(value) != (value < 0.0))
    return write_by_library(value, out);
  out += std::to_string(static_cast<std::int64_t>(value));
  out += ".0";
}

void break_line(std::string& out, Record::Layout layout, std::size_t depth) {
  if (layout == Record::Layout::line) return;
  out += '\n';
  out.append(kIndent * depth, ' ');
}

}  // namespace

Record::Record(std::initializer_list<Record> items) : kind_(Kind::array), items_(items) {
  if (!std::all_of(items_.begin(), items_.end(), [](const Record& item) { return item.is_member(); })) return;
  kind_ = Kind::object;
  for (Record& item : items_) {
    keys_.push_back(std::move(item.items_[0].text_));
    item = Record(std::move(item.items_[1]));
  }
}

Record Record::array(std::initializer_list<Record> items) {
  Record out;
  out.kind_ = Kind::array;
  out.items_ = items;
  return out;
}

Record Record::tuple(std::initializer_list<Record> items) {
  Record out = array(items);
  out.kind_ = Kind::tuple;
  return out;
}

Record Record::object() {
  Record out;
  out.kind_ = Kind::object;
  return out;
}

bool Record::is_member() const {
  return kind_ == Kind::array && items_.size() == 2 && items_[0].kind_ == Kind::text;
}

Record& Record::operator[](std::string_view key) {
  if (kind_ == Kind::null) kind_ = Kind::object;
  assert(kind_ == Kind::object);
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  if (found != keys_.end()) return items_[static_cast<std::size_t>(found - keys_.begin())];
  keys_.emplace_back(key);
  return items_.emplace_back();
}

Record& Record::operator[](std::size_t index) {
  assert(kind_ == Kind::array && index < items_.size());
  return items_[index];
}

void Record::push_back(Record item) {
  if (kind_ == Kind::null) kind_ = Kind::array;
  assert(kind_ == Kind::array);
  items_.push_back(std::move(item));
}

void Record::update(const Record& other) {
  assert(other.kind_ == Kind::object);
  for (std::size_t i = 0; i < other.keys_.size(); ++i) (*this)[other.keys_[i]] = other.items_[i];
}

void Record::write_list(std::string& out, Layout layout, std::size_t depth) const {
  const bool is_object = kind_ == Kind::object;
  out += is_object ? '{' : '[';
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (i > 0) out += ',';
    break_line(out, layout, depth + 1);
    if (is_object) {
      write_string(keys_[i], out);
      out += layout == Layout::line ? ":" : ": ";
    }
    items_[i].write(out, layout, depth + 1);
  }
  if (!items_.empty()) break_line(out, layout, depth);
  out += is_object ? '}' : ']';
}

void Record::write(std::string& out, Layout layout, std::size_t depth) const {
  switch (kind_) {
    case Kind::null: out += "null"; break;
    case Kind::boolean: out += whole_ != 0 ? "true" : "false"; break;
    case Kind::whole: out += std::to_string(whole_); break;
    case Kind::number: write_number(number_, out); break;
    case Kind::text: write_string(text_, out); break;
    case Kind::array:
    case Kind::tuple:
    case Kind::object: write_list(out, layout, depth); break;
  }
}

std::string Record::text(Layout layout) const {
  std::string out;
  write(out, layout, 0);
  return out;
}

}  // namespace kerf
