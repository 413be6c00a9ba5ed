// Any text as a number: a number that is read is finite, and its exact text reads back as the same number.
#include "base/number.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto value = kerf::parse_number(text);
  if (!value) return 0;
  if (!std::isfinite(*value)) std::abort();
  if (kerf::parse_number(kerf::exact_text(*value)) != *value) std::abort();
  if (kerf::fixed_text(*value, 3).empty()) std::abort();
  return 0;
}
