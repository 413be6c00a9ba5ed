// Which requests are answered: those of pages that this server has given out, on this machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::app::view {

/// Whether a text is the origin of a page, such as "https://shop.example" or "http://localhost:3000": small
/// letters and no path.
bool is_page_origin(std::string_view text);

/// Random letters and digits from the system's random numbers; empty if it has none.
std::string random_token();

/// What a request says about where it comes from.
struct Sender {
  std::string host;    // header Host
  std::string origin;  // header Origin; empty: none
  std::string token;   // query parameter t, else header X-Kerf-Token
};
/// The reason for refusing it; empty: it is accepted. A name that leads to this machine's address from
/// outside (DNS rebinding) has another Host, a foreign page another Origin.
std::string refusal(const Sender& sender, int port, const std::string& token);

/// A step or revision of a query: digits alone, at most 2^32 - 1.
std::optional<std::uint32_t> parse_number(std::string_view text);

}  // namespace kerf::app::view
