// What requests to kerf view say about themselves, one per line: Host, Origin, token, a number, a file name.
// Only the exact token from the own host is accepted, numbers are those that their digits say, and names of
// downloads fit into a header and into a folder.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "app/shown/file_name.h"
#include "app/view/access.h"

namespace {

constexpr int kPort = 8123;
const std::string kToken = "a-token-of-24-characters";

void check_sender(const std::string& host, const std::string& origin, const std::string& token) {
  const bool own = host == "127.0.0.1:8123" || host == "localhost:8123";
  const bool from_here =
      origin.empty() || origin == "http://127.0.0.1:8123" || origin == "http://localhost:8123";
  const bool accepted = kerf::app::view::refusal({host, origin, token}, kPort, kToken).empty();
  if (accepted != (own && from_here && token == kToken)) std::abort();
  if (kerf::app::view::refusal({host, origin, token}, kPort, "").empty()) std::abort();
}

void check_number(std::string_view text) {
  const auto number = kerf::app::view::parse_number(text);
  if (!number) return;
  std::string_view digits = text;
  while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
  if (std::to_string(*number) != digits) std::abort();
}

void check_name(std::string_view text) {
  const std::string name = kerf::app::view::download_name(text);
  const bool safe = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-' || c == '_';
  });
  if (!safe || name.empty() || name.front() == '.' || name.size() > 101) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::array<std::string, 5> lines;
  for (std::string& line : lines) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  check_sender(lines[0], lines[1], lines[2]);
  check_number(lines[3]);
  check_name(lines[4]);
  return 0;
}
