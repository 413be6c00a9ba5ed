// Texts of users inside XML and HTML.
#include "base/markup.h"

#include "base/utf8.h"

namespace kerf {
namespace {

/// XML 1.0, production 2, without the control characters above ASCII.
bool is_permitted(char32_t c) {
  const bool control = (c < 0x20 && c != '\n' && c != '\t') || (c >= 0x7F && c < 0xA0);
  return !control && c != 0xFFFE && c != 0xFFFF;
}

}  // namespace

std::string markup_text(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char32_t c : from_utf8(text)) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default:
        if (is_permitted(c)) append_utf8(out, c);
    }
  }
  return out;
}

}  // namespace kerf
