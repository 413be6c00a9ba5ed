// A value of what Kerf reports: null, a number, a text, a list or named members in their order. The command
// writes it as JSON, Python makes dicts of it, the page gets it as its model. The JSON library is included in
// value.cpp alone, because it is slow to compile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kerf {

class Record {
 public:
  Record() = default;  // null
  Record(std::nullptr_t) {}
  Record(bool value) : kind_(Kind::boolean), whole_(value ? 1 : 0) {}
  Record(double value) : kind_(Kind::number), number_(value) {}
  Record(std::string text) : kind_(Kind::text), text_(std::move(text)) {}
  Record(std::string_view text) : kind_(Kind::text), text_(text) {}
  Record(const char* text) : kind_(Kind::text), text_(text) {}
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  Record(Integer value) : kind_(Kind::whole), whole_(static_cast<std::int64_t>(value)) {}
  template <class Item>
  Record(const std::vector<Item>& items) : kind_(Kind::array), items_(items.begin(), items.end()) {}
  /// {{"key", value}, ...} is an object, {value, ...} an array.
  Record(std::initializer_list<Record> items);

  static Record array(std::initializer_list<Record> items = {});
  /// A list of fixed length such as a position: a tuple in Python, a list in JSON.
  static Record tuple(std::initializer_list<Record> items);
  static Record object();

  /// The member of an object, added with null where it is new; null becomes an object.
  Record& operator[](std::string_view key);
  /// An element of an array.
  Record& operator[](std::size_t index);
  /// Appends to an array; null becomes one.
  void push_back(Record item);
  /// Sets all members of another object.
  void update(const Record& other);

  /// On one line, or indented by two blanks. Bytes that are not UTF-8 become the replacement character.
  enum class Layout { line, indented };
  std::string text(Layout layout) const;

  // For writers of other forms.
  enum class Kind : std::uint8_t { null, boolean, whole, number, text, array, tuple, object };
  Kind kind() const { return kind_; }
  std::int64_t whole() const { return whole_; }  ///< of a whole number, 0 or 1 of a boolean
  double number() const { return number_; }
  const std::string& text() const { return text_; }
  const std::vector<std::string>& keys() const { return keys_; }  ///< of an object, one per item
  const std::vector<Record>& items() const { return items_; }

 private:
  bool is_member() const;  // an array of a string and a value
  void write(std::string& out, Layout layout, std::size_t depth) const;
  void write_list(std::string& out, Layout layout, std::size_t depth) const;

  Kind kind_ = Kind::null;
  std::int64_t whole_ = 0;
  double number_ = 0.0;
  std::string text_;
  std::vector<std::string> keys_;  // of an object, one per item, in the order in which they were set
  std::vector<Record> items_;
};

}  // namespace kerf
