// Text as strokes, from the fonts of data/fonts.
#include "front/gcmc/run/typeset.h"

#include <charconv>
#include <map>
#include <unordered_map>
#include <vector>

#include "embedded_stroke_fonts.h"

namespace kerf::gcmc {
namespace {

constexpr double kCapitalHeight = 21.0;  // font units; a capital letter is 1.0 high in the result

struct FontPoint {
  std::int16_t x, y;
};
struct Glyph {
  int advance = 0;
  std::vector<std::vector<FontPoint>> strokes;
};
using Font = std::unordered_map<char32_t, Glyph>;

int number_at(std::string_view text, std::size_t& at, int base = 10) {
  int value = 0;
  const auto result = std::from_chars(text.data() + at, text.data() + text.size(), value, base);
  at = static_cast<std::size_t>(result.ptr - text.data());
  return value;
}

/// A line of strokes.txt: "41 18 9,21 1,0|9,21 17,0".
void read_glyph(std::string_view line, Font& font) {
  std::size_t at = 0;
  const auto code = static_cast<char32_t>(number_at(line, at, 16));
  Glyph& glyph = font[code];
  ++at;
  glyph.advance = number_at(line, at);
  if (at + 1 >= line.size()) return;
  glyph.strokes.emplace_back();
  while (at < line.size()) {
    if (line[at] == '|') glyph.strokes.emplace_back();
    ++at;
    FontPoint p{};
    p.x = static_cast<std::int16_t>(number_at(line, at));
    ++at;
    p.y = static_cast<std::int16_t>(number_at(line, at));
    glyph.strokes.back().push_back(p);
  }
}

std::map<std::int32_t, Font> read_fonts() {
  std::map<std::int32_t, Font> fonts;
  Font* font = nullptr;
  std::string_view text = embedded::stroke_fonts[0].bytes;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line[0] == '#') continue;
    if (line.substr(0, 5) == "font ") {
      std::size_t at = 5;
      font = &fonts[number_at(line, at)];
    } else if (font != nullptr) {
      read_glyph(line, *font);
    }
  }
  return fonts;
}

const Font* font_of(std::int32_t id) {
  static const std::map<std::int32_t, Font> fonts = read_fonts();
  const auto found = fonts.find(id);
  return found == fonts.end() ? nullptr : &found->second;
}

/// Builds the list: pen marks are vectors with Z only, points have X and Y.
class Typesetter {
 public:
  explicit Typesetter(Runtime& rt) : rt_(rt) {}
  void pen(bool up) {
    Value v;
    v.make_vector(3);
    v.put(2, Scalar::real(up ? 1.0 : 0.0));
    add(std::move(v));
  }
  void point(double x, double y) {
    Value v;
    v.make_vector(3);
    v.put(0, Scalar::real(x / kCapitalHeight));
    v.put(1, Scalar::real(y / kCapitalHeight));
    add(std::move(v));
  }
  void glyph(const Glyph& g) {
    for (const auto& stroke : g.strokes) {
      for (std::size_t i = 0; i < stroke.size(); ++i) {
        point(x_ + stroke[i].x, stroke[i].y);
        if (i == 0) pen(false);
      }
      pen(true);
      last_y_ = stroke.back().y;
    }
    x_ += g.advance;
    point(x_, last_y_);
  }
  Value finish() {
    point(x_, 0.0);
    return Value::list(std::move(list_), rt_.meter);
  }

 private:
  void add(Value v) {
    constexpr std::size_t kLook = 4096;
    list_.push_back(std::move(v));
    if (list_.size() % kLook == 0 && list_.size() * sizeof(Value) > rt_.meter.limit - rt_.meter.used)
      throw OutOfMemory{};
  }
  Runtime& rt_;
  std::vector<Value> list_;
  double x_ = 0.0, last_y_ = 0.0;
};

}  // namespace

Value typeset_text(Runtime& rt, const std::u32string& text, std::int32_t id) {
  const Font* font = font_of(id);
  if (font == nullptr) {
    rt.warn(Code::gcmc_glyph, fmt::format("Font id 0x{:08x} not found", static_cast<std::uint32_t>(id)));
    return Value::undef();
  }
  Typesetter setter(rt);
  setter.pen(true);
  setter.point(0.0, 0.0);
  for (const char32_t c : text) {
    auto found = font->find(c);
    if (found == font->end()) {
      rt.warn(Code::gcmc_glyph, fmt::format("Glyph for codepoint 0x{:08x} not available, replacing with ' '",
                                            static_cast<std::uint32_t>(c)));
      found = font->find(U' ');
    }
    setter.glyph(found->second);
  }
  return setter.finish();
}

}  // namespace kerf::gcmc
