// Text set in lines.
#include "kerf/geom/text.h"

#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/utf8.h"
#include "geom/text/stroke_fonts.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

class Setter {
 public:
  Setter(const TextFont& font, const TextOptions& options, Diagnostics& diagnostics)
      : font_(font), options_(options), diagnostics_(diagnostics) {}

  bool line(std::u32string_view text, double baseline) {
    double width = 0.0;
    std::vector<std::pair<const TextGlyph*, double>> row;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const auto glyph = font_.glyphs.find(text[i]);
      if (glyph == font_.glyphs.end())
        return fail(fmt::format("the font has no character U+{:04X}, number {} of the text",
                                static_cast<std::uint32_t>(text[i]), i + 1));
      row.push_back({&glyph->second, width});
      if (i + 1 == text.size()) {
        width += glyph->second.advance * height();
        break;
      }
      const auto kern = font_.kerning.find({text[i], text[i + 1]});
      const double closer = kern == font_.kerning.end() ? 0.0 : kern->second;
      width += (glyph->second.advance + closer) * height() + options_.spacing.mm();
    }
    const double start = options_.align == TextAlign::left     ? 0.0
                         : options_.align == TextAlign::centre ? -0.5 * width
                                                               : -width;
    for (const auto& [glyph, x] : row)
      for (const Outline& path : glyph->paths) add(path, {start + x, baseline});
    return true;
  }

  bool fail(const std::string& message) {
    diagnostics_.error(codes::cut_job_key, options_.where,
                       (options_.name.empty() ? "text: " : options_.name + ": ") + message);
    return false;
  }

  std::vector<Outline> paths;

 private:
  double height() const { return options_.height.mm(); }
  void add(const Outline& path, Point2 offset) {
    const Outline moved = placed(path, {.offset = offset, .factor = {height(), height()}});
    const Outline turned = options_.angle == Angle{} ? moved : rotated(moved, {}, options_.angle);
    paths.push_back(placed(turned, {.offset = options_.at}));
  }
  const TextFont& font_;
  const TextOptions& options_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::optional<TextFont> stroke_text_font(std::string_view name) {
  const StrokeFont* strokes = stroke_font(name);
  if (strokes == nullptr) return std::nullopt;
  TextFont font;
  for (const auto& [code, glyph] : *strokes) {
    TextGlyph& made = font.glyphs[code];
    made.advance = glyph.advance / kStrokeCapital;
    for (const std::vector<StrokePoint>& stroke : glyph.strokes) {
      const auto point = [&](std::size_t i) {
        return Point2{stroke[i].x / kStrokeCapital, stroke[i].y / kStrokeCapital};
      };
      if (stroke.size() < 2) continue;
      Outline path{point(0), {}};
      for (std::size_t i = 1; i < stroke.size(); ++i) path.segments.push_back({point(i), {}});
      made.paths.push_back(std::move(path));
    }
  }
  return font;
}

std::optional<std::vector<Outline>> set_text(std::string_view text, const TextFont& font,
                                             const TextOptions& options, Diagnostics& diagnostics) {
  Setter setter(font, options, diagnostics);
  const double height = options.height.mm(), spacing = options.spacing.mm();
  const bool sized = height > 0.0 && height <= limits::kMaxCoordinate;
  if (!sized || !(std::abs(spacing) <= limits::kMaxCoordinate) || !std::isfinite(options.angle.rad()) ||
      !(std::abs(options.line_pitch) <= limits::kMaxToolSize)) {
    setter.fail(sized ? "the spacing or the angle is out of range"
                      : fmt::format("the height is {:g}; it must be above 0 mm", height));
    return std::nullopt;
  }
  std::u32string all = from_utf8(text);
  std::erase(all, U'\r');
  std::u32string_view rest = all;
  for (double baseline = 0.0;; baseline -= options.line_pitch * height) {
    const std::size_t end = std::min(rest.find(U'\n'), rest.size());
    if (!setter.line(rest.substr(0, end), baseline)) return std::nullopt;
    if (end == rest.size()) break;
    rest.remove_prefix(end + 1);
  }
  if (setter.paths.empty()) {
    setter.fail("it has no visible character");
    return std::nullopt;
  }
  return std::move(setter.paths);
}

}  // namespace kerf
