// The bytes of values, little-endian: a sink that writes them and a source that reads them.
//
// Both have the same calls, so that one list of fields (fields.h) serves both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace kerf::stored {

/// What a list of fields is applied to: const where it is written.
template <class A, class T>
using Like = std::conditional_t<A::kReads, T, const T>;

class Sink {
 public:
  static constexpr bool kReads = false;

  void byte(std::uint8_t v) { bytes_ += static_cast<char>(v); }
  void number(double v) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);  // libc++ 13 has no std::bit_cast
    for (int shift = 0; shift < 64; shift += 8) byte(static_cast<std::uint8_t>(bits >> shift));
  }
  /// 7 bits per byte, the lowest first; the eighth bit means that more follow.
  void whole(std::uint64_t v) {
    for (; v > 0x7f; v >>= 7) byte(static_cast<std::uint8_t>(v | 0x80));
    byte(static_cast<std::uint8_t>(v));
  }
  /// Small absolute values are short.
  void signed_whole(std::int64_t v) {
    whole(static_cast<std::uint64_t>(v) << 1 ^ static_cast<std::uint64_t>(v >> 63));
  }
  void text(std::string_view v) {
    whole(v.size());
    bytes_ += v;
  }
  std::size_t size() const { return bytes_.size(); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a sink has written. After the first fault all values are 0; the caller asks failed() where it
/// matters, at the end at the latest.
class Source {
 public:
  static constexpr bool kReads = true;
  /// `version`: of the format, see container.h.
  Source(std::string_view bytes, std::uint64_t version) : rest_(bytes), version_(version) {}

  std::uint64_t version() const { return version_; }

  std::uint8_t byte() {
    const std::string_view taken = take(1);
    return taken.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(taken[0]);
  }
  double number() {
    std::uint64_t bits = 0;
    const std::string_view taken = take(8);
    for (std::size_t k = 0; k < taken.size(); ++k)
      bits |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(taken[k])) << (8 * k);
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::uint64_t whole() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t next = byte();
      value |= static_cast<std::uint64_t>(next & 0x7f) << shift;
      if ((next & 0x80) == 0) return value;
    }
    refuse("an integer has more than 64 bits");
    return 0;
  }
  std::int64_t signed_whole() {
    const std::uint64_t v = whole();
    return static_cast<std::int64_t>(v >> 1 ^ (~(v & 1) + 1));
  }
  std::string_view text() { return take(whole()); }
  /// The number of entries that follow, of at least `least` bytes each: no more than there are bytes for.
  std::size_t entries(std::size_t least) {
    const std::uint64_t count = whole();
    if (count <= rest_.size() / least) return static_cast<std::size_t>(count);
    refuse("a list is longer than its bytes");
    return 0;
  }

  void refuse(std::string_view fault) {
    if (fault_.empty()) fault_ = fault;
    rest_ = {};
  }
  bool failed() const { return !fault_.empty(); }
  const std::string& fault() const { return fault_; }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) {
      refuse("it ends within a value");
      return {};
    }
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view rest_;
  std::uint64_t version_;
  std::string fault_;
};

}  // namespace kerf::stored
