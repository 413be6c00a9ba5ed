// Lines and columns of a text, and addresses of files.
#include "app/lsp/text_positions.h"

#include <algorithm>
#include <fmt/format.h>

namespace kerf::app::lsp {
namespace {

constexpr std::string_view kFile = "file://";

/// Bytes of the character that starts so, in UTF-8.
std::size_t length_of(char first) {
  const auto byte = static_cast<unsigned char>(first);
  return byte < 0xC0 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
}

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char small = static_cast<char>(c | 0x20);
  return small >= 'a' && small <= 'f' ? small - 'a' + 10 : -1;
}

bool is_drive(std::string_view path) { return path.size() > 2 && path[0] == '/' && path[2] == ':'; }

}  // namespace

TextLines::TextLines(std::string_view text) : text_(text), starts_{0} {
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
    starts_.push_back(at + 1);
}

std::string_view TextLines::line(std::size_t number) const {
  if (number >= starts_.size()) return {};
  const std::size_t end = number + 1 < starts_.size() ? starts_[number + 1] - 1 : text_.size();
  std::string_view line = text_.substr(starts_[number], end - starts_[number]);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::size_t units_before(std::string_view line, std::size_t byte) {
  std::size_t units = 0;
  for (std::size_t at = 0; at < std::min(byte, line.size()); at += length_of(line[at]))
    units += length_of(line[at]) == 4 ? 2 : 1;
  return units;
}

std::size_t byte_of(std::string_view line, std::size_t units) {
  std::size_t at = 0;
  for (std::size_t passed = 0; passed < units && at < line.size(); at += length_of(line[at]))
    passed += length_of(line[at]) == 4 ? 2 : 1;
  return std::min(at, line.size());
}

std::string path_of_address(std::string_view address) {
  if (address.substr(0, kFile.size()) != kFile) return std::string(address);
  const std::string_view rest = address.substr(kFile.size());
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool coded =
        rest[i] == '%' && i + 2 < rest.size() && digit_of(rest[i + 1]) >= 0 && digit_of(rest[i + 2]) >= 0;
    path += coded ? static_cast<char>(16 * digit_of(rest[i + 1]) + digit_of(rest[i + 2])) : rest[i];
    if (coded) i += 2;
  }
  return is_drive(path) ? path.substr(1) : path;
}

std::string address_of_path(std::string_view path) {
  constexpr std::string_view kPlain = "-._~/:";
  std::string address(kFile);
  if (path.size() > 1 && path[1] == ':') address += '/';
  for (const char c : path) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       kPlain.find(c) != std::string_view::npos;
    address += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return address;
}

}  // namespace kerf::app::lsp
