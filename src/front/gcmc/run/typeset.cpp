// Text as strokes of the built-in fonts, as the vectors that gcmc makes of them.
#include "front/gcmc/run/typeset.h"

#include <vector>

#include "base/codes/gcmc.h"
#include "geom/text/stroke_fonts.h"

namespace kerf::gcmc {
namespace {

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
    v.put(0, Scalar::real(x / kStrokeCapital));
    v.put(1, Scalar::real(y / kStrokeCapital));
    add(std::move(v));
  }
  void glyph(const StrokeGlyph& g) {
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
  const StrokeFont* font = stroke_font(id);
  if (font == nullptr) {
    rt.warn(codes::gcmc_glyph, fmt::format("Font id 0x{:08x} not found", static_cast<std::uint32_t>(id)));
    return Value::undef();
  }
  Typesetter setter(rt);
  setter.pen(true);
  setter.point(0.0, 0.0);
  for (const char32_t c : text) {
    auto found = font->find(c);
    if (found == font->end()) {
      rt.warn(codes::gcmc_glyph, fmt::format("Glyph for codepoint 0x{:08x} not available, replacing with ' '",
                                             static_cast<std::uint32_t>(c)));
      found = font->find(U' ');
    }
    setter.glyph(found->second);
  }
  return setter.finish();
}

}  // namespace kerf::gcmc
