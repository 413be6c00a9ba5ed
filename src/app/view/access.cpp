// The check of requests.
#include "app/view/access.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/system.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kTokenBytes = 18;  // 144 bits
constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// In a time that does not depend on where the texts differ.
bool equal_in_constant_time(std::string_view a, std::string_view b) {
  unsigned different = a.size() == b.size() ? 0u : 1u;
  for (std::size_t k = 0; k < a.size(); ++k)
    different |=
        static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[b.empty() ? 0 : k % b.size()]);
  return different == 0;
}

bool is_own_host(std::string_view host, int port) {
  return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
}

}  // namespace

std::string random_token() {
  unsigned char bytes[kTokenBytes];
  if (!fill_with_random_bytes(bytes)) return "";
  std::string text;  // six bits per letter
  for (std::size_t k = 0; k < kTokenBytes; k += 3) {
    const unsigned all = static_cast<unsigned>(bytes[k] << 16 | bytes[k + 1] << 8 | bytes[k + 2]);
    for (int shift = 18; shift >= 0; shift -= 6) text += kLetters[all >> shift & 63u];
  }
  return text;
}

std::string refusal(const Sender& sender, int port, const std::string& token) {
  if (!is_own_host(sender.host, port)) return "the request is for another host";
  constexpr std::string_view kScheme = "http://";
  if (!sender.origin.empty() && (sender.origin.substr(0, kScheme.size()) != kScheme ||
                                 !is_own_host(std::string_view(sender.origin).substr(kScheme.size()), port)))
    return "the request is from another page";
  if (token.empty() || !equal_in_constant_time(sender.token, token))
    return "the token is missing or wrong; open the address that kerf view has printed";
  return "";
}

bool is_page_origin(std::string_view text) {
  constexpr std::size_t kLongest = 255, kPortDigits = 5;
  const auto is_small = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() > kLongest) return false;
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (!text.starts_with(scheme)) continue;
    const std::string_view rest = text.substr(scheme.size()), host = rest.substr(0, rest.find(':'));
    if (host.empty() || !is_small(host.front()) || !is_small(host.back())) return false;
    if (!std::all_of(host.begin(), host.end(), [&](char c) { return is_small(c) || c == '.' || c == '-'; }))
      return false;
    if (host.size() == rest.size()) return true;
    const std::string_view port = rest.substr(host.size() + 1);
    return !port.empty() && port.size() <= kPortDigits && std::all_of(port.begin(), port.end(), is_digit);
  }
  return false;
}

std::optional<std::uint32_t> parse_number(std::string_view text) {
  constexpr std::size_t kMaxDigits = 10;
  if (text.empty() || text.size() > kMaxDigits) return std::nullopt;
  std::uint64_t value = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + static_cast<std::uint64_t>(c - '0');
  }
  if (value > 0xffffffffu) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

}  // namespace kerf::app::view
