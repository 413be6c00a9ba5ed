// Little-endian binary data, as web/PROTOCOL.md defines it.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::app::view {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are in memory");

class BinaryWriter {
 public:
  void mark(std::string_view four_letters) { bytes_.append(four_letters); }
  void number(std::uint32_t value) { append(&value, sizeof value); }
  template <class Number>
  void array(const std::vector<Number>& values) {
    static_assert(sizeof(Number) == 1 || sizeof(Number) == 2 || sizeof(Number) == 4);
    append(values.data(), values.size() * sizeof(Number));
    while (bytes_.size() % 4 != 0) bytes_.push_back('\0');
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  void raw(std::string_view bytes) { bytes_.append(bytes); }
  std::string take() { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t size) {
    if (size != 0) bytes_.append(static_cast<const char*>(from), size);
  }
  std::string bytes_;
};

}  // namespace kerf::app::view
