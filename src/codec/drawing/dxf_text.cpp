// Texts of DXF entities without their control codes.
#include <cmath>
#include <numbers>

#include "codec/drawing/code_page.h"

#include "kerf/drawing/dxf.h"

namespace kerf::dxf {
namespace {

constexpr std::string_view kDegree = "\xC2\xB0", kDiameter = "\xC3\x98", kPlusMinus = "\xC2\xB1";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads a code of TEXT that starts with %% and returns its length; 0 if it is not one.
std::size_t take_percent(std::string& out, std::string_view text) {
  if (text.size() < 3 || text[1] != '%') return 0;
  switch (text[2] | 0x20) {
    case 'd': out += kDegree; return 3;
    case 'c': out += kDiameter; return 3;
    case 'p': out += kPlusMinus; return 3;
    case 'u':
    case 'o':
    case 'k': return 3;
    default: break;
  }
  if (text[2] == '%') {
    out += '%';
    return 3;
  }
  if (text.size() < 5 || !is_digit(text[2]) || !is_digit(text[3]) || !is_digit(text[4])) return 0;
  const int code = 100 * (text[2] - '0') + 10 * (text[3] - '0') + (text[4] - '0');
  if (code < ' ' || code > 255) return 0;
  append_utf8(out, static_cast<char32_t>(code));
  return 5;
}

/// Reads a control character written as ^I and returns its length; 0 if it is not one.
std::size_t take_caret(std::string& out, std::string_view text) {
  if (text.size() < 2) return 0;
  const char c = text[1];
  if (c == ' ') out += '^';
  if (c == 'I') out += '\t';
  if (c == 'J') out += '\n';
  return c == ' ' || (c >= '@' && c <= '_') ? 2 : 0;
}

class MtextReader {
 public:
  explicit MtextReader(std::string_view text) : text_(text) {}
  std::string read();

 private:
  std::size_t take_code();
  void stack(std::string_view parts);
  std::string_view text_;  // not yet read
  std::string out_;
};

std::string MtextReader::read() {
  while (!text_.empty()) {
    std::size_t taken = 0;
    switch (text_[0]) {
      case '\\': taken = take_code(); break;
      case '{':
      case '}': taken = 1; break;
      case '%': taken = take_percent(out_, text_); break;
      case '^': taken = take_caret(out_, text_); break;
      default: break;
    }
    if (taken == 0) out_ += text_[taken++];
    text_.remove_prefix(taken);
  }
  return std::move(out_);
}

/// Reads a code that starts with a backslash and returns its length; 0 if it is not one.
std::size_t MtextReader::take_code() {
  if (text_.size() < 2) return 1;
  const char code = text_[1];
  switch (code) {
    case '\\':
    case '{':
    case '}': out_ += code; return 2;
    case 'P':
    case 'X':
    case 'N': out_ += '\n'; return 2;
    case '~': out_ += ' '; return 2;
    case 'L':
    case 'l':
    case 'O':
    case 'o':
    case 'K':
    case 'k': return 2;
    default: break;
  }
  // Codes with an argument: font, height, colour, ...
  constexpr std::size_t kLongest = 256;
  const std::size_t end = text_.substr(0, kLongest).find(';');
  if (end == std::string_view::npos) return 0;
  if (code == 'S') stack(text_.substr(2, end - 2));
  return end + 1;
}

/// A fraction or a pair of tolerances, separated by '/', '#' or '^'.
void MtextReader::stack(std::string_view parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const char c = parts[i];
    if (c == '\\' && i + 1 < parts.size()) {
      out_ += parts[++i];
    } else if (c == '^') {
      out_ += ' ';
      if (i + 1 < parts.size() && parts[i + 1] == ' ') ++i;
    } else {
      out_ += c == '#' ? '/' : c;
    }
  }
}

}  // namespace

std::string plain_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    std::size_t taken = text[0] == '%' ? take_percent(out, text) : text[0] == '^' ? take_caret(out, text) : 0;
    if (taken == 0) out += text[taken++];
    text.remove_prefix(taken);
  }
  return out;
}

std::string plain_mtext(std::string_view text) { return MtextReader(text).read(); }

std::string plain(const Text& text) {
  return text.kind == TextKind::mtext ? plain_mtext(text.text) : plain_text(text.text);
}

Point anchor(const Text& text) {
  const bool aligned = text.kind != TextKind::mtext && (text.horizontal != 0 || text.vertical != 0);
  return aligned && text.second ? *text.second : text.at;
}

double rotation(const Text& text) {
  if (text.kind != TextKind::mtext || !text.second) return text.rotation;
  return std::atan2(text.second->y, text.second->x) * 180.0 / std::numbers::pi;
}

}  // namespace kerf::dxf
