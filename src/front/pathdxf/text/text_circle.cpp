// The overlap circles of texts.
#include "front/pathdxf/text/text_circle.h"

#include <algorithm>
#include <cmath>

namespace kerf::pathdxf {
namespace {

constexpr double kLetterWidth = 0.6;                 // of the height
constexpr double kMtextRadius = 0.7;                 // the largest radius, of the height of all lines
constexpr double kMaxRotation = 1.0;                 // degrees, of an MTEXT that counts as not rotated
constexpr double kTextRotation = 1e-6;               // the same of TEXT
constexpr int kAligned = 3, kCentred = 4, kFit = 5;  // horizontal alignments of TEXT

void append_code_point(std::string& out, unsigned code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0u | code >> 6);
    out += static_cast<char>(0x80u | (code & 0x3Fu));
  } else {
    out += static_cast<char>(0xE0u | code >> 12);
    out += static_cast<char>(0x80u | (code >> 6 & 0x3Fu));
    out += static_cast<char>(0x80u | (code & 0x3Fu));
  }
}

/// Takes a code that starts with a backslash and returns its length.
std::size_t take_code(std::string& out, std::string_view text) {
  if (text.size() < 2) return 1;
  const char code = text[1];
  if (code == '\\' || code == '{' || code == '}') {
    out += code;
    return 2;
  }
  if (code == 'P' || code == 'X') {
    out += '\n';
    return 2;
  }
  if (code == '~') {
    out += ' ';
    return 2;
  }
  if (std::string_view("LlOoKk").find(code) != std::string_view::npos) return 2;
  if (code == 'U' && text.size() >= 7 && text[2] == '+') {
    unsigned value = 0;
    for (const char c : text.substr(3, 4)) {
      const std::size_t digit = std::string_view("0123456789ABCDEF")
                                    .find(static_cast<char>(c >= 'a' && c <= 'f' ? c - 'a' + 'A' : c));
      if (digit == std::string_view::npos) return 2;
      value = value * 16 + static_cast<unsigned>(digit);
    }
    append_code_point(out, value);
    return 7;
  }
  const std::size_t end = text.find(';');
  if (end == std::string_view::npos) return 2;
  if (code == 'S') out += text.substr(2, end - 2);
  return end + 1;
}

std::string mtext_without_codes(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t taken = 1;
    if (text[0] == '\\') {
      taken = take_code(out, text);
    } else if (text.substr(0, 2) == "^I" || text.substr(0, 2) == "^J") {
      out += text[1] == 'I' ? '\t' : '\n';
      taken = 2;
    } else if (text[0] != '{' && text[0] != '}') {
      out += text[0];
    }
    text.remove_prefix(taken);
  }
  return out;
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

/// Width and height of a text, mm, as estimated.
Point2 size_of(const dxf::Text& text) {
  const std::string plain = unformatted(text);
  if (text.kind != dxf::TextKind::mtext)
    return {kLetterWidth * text.height * static_cast<double>(characters(plain)), text.height};
  std::size_t lines = 0, longest = 0;
  for (std::size_t i = 0; i <= plain.size(); ++lines) {
    const std::size_t end = std::min(plain.find('\n', i), plain.size());
    // The end of a line counts as a character (it is CR LF to the original).
    const std::size_t length =
        characters(std::string_view(plain).substr(i, end - i)) + (end < plain.size() ? 1 : 0);
    longest = std::max(longest, length);
    i = end + 1;
  }
  return {kLetterWidth * text.height * static_cast<double>(longest),
          text.height * static_cast<double>(lines)};
}

/// From the anchor to the centre, in widths and heights; nothing for an unknown alignment.
std::optional<Point2> centre_in_sizes(const dxf::Text& text) {
  if (text.kind == dxf::TextKind::mtext) {
    if (text.attachment < 1 || text.attachment > 9) return std::nullopt;
    const int column = (text.attachment - 1) % 3, row = (text.attachment - 1) / 3;
    return Point2{0.5 - 0.5 * column, -0.5 + 0.5 * row};
  }
  switch (text.horizontal) {
    case kCentred: return Point2{};
    case kAligned:
    case kFit: return Point2{0.0, 0.5};
    default: break;
  }
  if (text.horizontal < 0 || text.horizontal > 2 || text.vertical < 0 || text.vertical > 3)
    return std::nullopt;
  const double up = text.vertical < 2 ? 0.5 : text.vertical == 2 ? 0.0 : -0.5;
  return Point2{0.5 - 0.5 * text.horizontal, up};
}

}  // namespace

std::string unformatted(const dxf::Text& text) {
  return text.kind == dxf::TextKind::mtext ? mtext_without_codes(text.text) : text.text;
}

std::string without_special_characters(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code = text.substr(i, 2) == "%%" && i + 2 < text.size();
    const int code = is_code ? text[i + 2] | 0x20 : 0;
    if (code != 'c' && code != 'd' && code != 'p') {
      out += text[i];
      continue;
    }
    out += code == 'c' ? "_D" : code == 'd' ? "_G" : "_+";
    i += 2;
  }
  return out;
}

std::optional<TextCircle> circle_of(const dxf::Text& text) {
  if (text.backward || text.upside_down) return std::nullopt;
  const auto offset = centre_in_sizes(text);
  if (!offset) return std::nullopt;
  const bool is_mtext = text.kind == dxf::TextKind::mtext;
  const bool is_centred = offset->x == 0.0 && offset->y == 0.0;
  const double rotation = std::remainder(dxf::rotation(text), 360.0);
  if (!is_centred && std::abs(rotation) > (is_mtext ? kMaxRotation : kTextRotation)) return std::nullopt;
  dxf::Point anchor = dxf::anchor(text);
  if (!is_mtext && (text.horizontal == kAligned || text.horizontal == kFit) && text.second)
    anchor = {(text.at.x + text.second->x) / 2.0, (text.at.y + text.second->y) / 2.0, anchor.z};
  const Point2 size = size_of(text);
  double radius = std::hypot(size.x, size.y) / 2.0;
  if (is_mtext) radius = std::min(radius, kMtextRadius * size.y);
  return TextCircle{{anchor.x + offset->x * size.x, anchor.y + offset->y * size.y}, radius};
}

}  // namespace kerf::pathdxf
