// A JSON value to be written. The JSON library is included in json_value.cpp alone, because it is slow to
// compile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kerf::app {

class Json {
 public:
  Json() = default;  // null
  Json(std::nullptr_t) {}
  Json(bool value) : kind_(Kind::boolean), whole_(value ? 1 : 0) {}
  Json(double value) : kind_(Kind::number), number_(value) {}
  Json(std::string text) : kind_(Kind::text), text_(std::move(text)) {}
  Json(std::string_view text) : kind_(Kind::text), text_(text) {}
  Json(const char* text) : kind_(Kind::text), text_(text) {}
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  Json(Integer value) : kind_(Kind::whole), whole_(static_cast<std::int64_t>(value)) {}
  template <class Item>
  Json(const std::vector<Item>& items) : kind_(Kind::array), items_(items.begin(), items.end()) {}
  /// {{"key", value}, ...} is an object, {value, ...} an array.
  Json(std::initializer_list<Json> items);

  static Json array(std::initializer_list<Json> items = {});
  static Json object();

  /// The member of an object, added with null where it is new; null becomes an object.
  Json& operator[](std::string_view key);
  /// An element of an array.
  Json& operator[](std::size_t index);
  /// Appends to an array; null becomes one.
  void push_back(Json item);
  /// Sets all members of another object.
  void update(const Json& other);

  /// On one line, or indented by two blanks. Bytes that are not UTF-8 become the replacement character.
  enum class Layout { line, indented };
  std::string text(Layout layout) const;

 private:
  enum class Kind : std::uint8_t { null, boolean, whole, number, text, array, object };

  bool is_member() const;  // an array of a string and a value
  void write(std::string& out, Layout layout, std::size_t depth) const;
  void write_list(std::string& out, Layout layout, std::size_t depth) const;

  Kind kind_ = Kind::null;
  std::int64_t whole_ = 0;
  double number_ = 0.0;
  std::string text_;
  std::vector<std::string> keys_;  // of an object, one per item, in the order in which they were set
  std::vector<Json> items_;
};

}  // namespace kerf::app
