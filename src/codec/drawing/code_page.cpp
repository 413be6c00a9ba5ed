// Decoding: tables for Windows' single-byte pages, the system's converters for others.
#include "codec/drawing/code_page.h"

#include <algorithm>

#include "codec/drawing/page_converter.h"

namespace kerf::dxf {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

/// The value of four hexadecimal digits.
std::optional<char32_t> four_digits(std::string_view text) {
  if (text.size() < 4) return std::nullopt;
  char32_t value = 0;
  for (const char c : text.substr(0, 4)) {
    const char lower = static_cast<char>(c | 0x20);
    const int digit = c >= '0' && c <= '9' ? c - '0' : lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
    if (digit < 0) return std::nullopt;
    value = value << 4 | static_cast<char32_t>(digit);
  }
  return value;
}

bool is_surrogate(char32_t c, char32_t first) { return c >= first && c < first + 0x400; }

/// Length of the valid UTF-8 character at the start of `text`; 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // Overlong encodings, surrogates, code points above U+10FFFF.
  if ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F)) return 0;
  if ((first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F)) return 0;
  return length;
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

std::optional<int> code_page_number(std::string_view name) {
  std::string folded;
  for (const char c : name)
    if (c != '_' && c != '-' && c != ' ') folded += static_cast<char>(c >= 'a' && c <= 'z' ? c - 32 : c);
  static constexpr struct {
    std::string_view name;
    int page;
  } kNames[] = {{"ASCII", kWesternEurope},
                {"USASCII", kWesternEurope},
                {"UTF8", kUtf8},
                {"MACINTOSH", 10000},
                {"MACROMAN", 10000},
                {"BIG5", 950},
                {"KSC5601", 949},
                {"JOHAB", 1361},
                {"GB2312", 936}};
  for (const auto& known : kNames)
    if (folded == known.name) return known.page;
  std::string_view digits = folded;
  bool latin = false;
  for (const std::string_view prefix : {"ANSI", "DOS", "CP", "IBM", "WINDOWS", "ISO8859"}) {
    if (!digits.starts_with(prefix)) continue;
    digits.remove_prefix(prefix.size());
    latin = prefix == "ISO8859";
    break;
  }
  if (digits.empty() || digits.size() > 5) return std::nullopt;
  int page = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    page = 10 * page + (c - '0');
  }
  return latin ? page + 28590 : page;
}

// -------------------------------------------------------------------------------------------------- decoder

TextDecoder::TextDecoder() = default;
TextDecoder::~TextDecoder() = default;

bool TextDecoder::use(int code_page) {
  const std::uint16_t* const upper = upper_half(code_page);
  auto converter = upper == nullptr && code_page != kUtf8 && code_page != kUnstated
                       ? PageConverter::open(code_page)
                       : nullptr;
  if (upper == nullptr && converter == nullptr && code_page != kUtf8 && code_page != kUnstated) return false;
  page_ = code_page;
  upper_ = upper;
  converter_ = std::move(converter);
  return true;
}

void TextDecoder::append_page(std::string& out, std::string_view bytes) {
  if (converter_ != nullptr) {
    faulty_ = !converter_->append(out, bytes) || faulty_;
    return;
  }
  const std::uint16_t* const upper = upper_ != nullptr ? upper_ : upper_half(kWesternEurope);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    const char32_t character = byte < 0x80 ? byte : upper[byte - 0x80];
    faulty_ = faulty_ || character == kReplacement;
    append_utf8(out, character);
  }
}

void TextDecoder::append_bytes(std::string& out, std::string_view bytes) {
  const bool ascii = std::all_of(bytes.begin(), bytes.end(), [](char c) { return (c & 0x80) == 0; });
  if (ascii && converter_ == nullptr) {
    out += bytes;
  } else if (page_ == kUtf8) {
    while (!bytes.empty()) {
      const std::size_t length = utf8_length(bytes);
      faulty_ = faulty_ || length == 0;
      if (length == 0) append_utf8(out, kReplacement);
      out += bytes.substr(0, length);
      bytes.remove_prefix(std::max<std::size_t>(length, 1));
    }
  } else if (page_ == kUnstated && is_utf8(bytes)) {
    out += bytes;
  } else {
    append_page(out, bytes);
  }
}

PageConverter* TextDecoder::converter(int digit) {
  static constexpr int kPages[] = {0, 932, 950, 949, 1361, 936};
  if (digit < 1 || digit > 5) return nullptr;
  auto& found = escaped_[digit];
  if (found == nullptr) found = PageConverter::open(kPages[digit]);
  return found.get();
}

/// Replaces the escape sequence at the start of `text`; returns its number of bytes, 0 if there is none.
std::size_t TextDecoder::append_escape(std::string& out, std::string_view text) {
  constexpr std::size_t kLength = 7;  // \U+00E9
  if (text.size() < kLength || text[2] != '+') return 0;
  if (text[1] == 'U') {
    const auto first = four_digits(text.substr(3));
    if (!first) return 0;
    if (is_surrogate(*first, 0xD800) && text.substr(kLength, 3) == "\\U+") {
      const auto second = four_digits(text.substr(kLength + 3));
      if (second && is_surrogate(*second, 0xDC00)) {
        append_utf8(out, 0x10000 + ((*first - 0xD800) << 10) + (*second - 0xDC00));
        return 2 * kLength;
      }
    }
    append_utf8(out, *first);
    return kLength;
  }
  if (text[1] != 'M' || text.size() < kLength + 1) return 0;
  PageConverter* const page = converter(text[3] - '0');
  const auto code = four_digits(text.substr(4));
  if (page == nullptr || !code) return 0;
  const char bytes[] = {static_cast<char>(*code >> 8), static_cast<char>(*code & 0xFF)};
  faulty_ = !page->append(out, {bytes, 2}) || faulty_;
  return kLength + 1;
}

std::string TextDecoder::decode(std::string_view bytes) {
  std::string out;
  faulty_ = false;
  // The second byte of a character of East Asian pages may be a backslash: the page is decoded first.
  std::string decoded;
  append_bytes(decoded, bytes);
  if (decoded.find("\\U+") == std::string::npos && decoded.find("\\M+") == std::string::npos) {
    out = std::move(decoded);
  } else {
    const std::string_view text = decoded;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t taken = text[at] == '\\' ? append_escape(out, text.substr(at)) : 0;
      if (taken == 0) out += text[at];
      at += std::max<std::size_t>(taken, 1);
    }
  }
  if (faulty_) ++faulty_texts_;
  return out;
}

}  // namespace kerf::dxf
