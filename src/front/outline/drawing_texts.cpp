// Chooses fonts for the texts of a drawing, lays the texts out, and makes their outlines.
#include "front/outline/drawing_texts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/outline.h"
#include "base/ending.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/utf8.h"
#include "geom/text/stroke_fonts.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

namespace kerf::outline_front {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPitch = 5.0 / 3.0;  // of lines of MTEXT, in heights
constexpr double kBelow = 1.0 / 3.0;  // of letters below the baseline, in heights

/// Whether the shape or position of a character depends on its neighbours, as in Arabic or Hindi.
bool needs_shaping(char32_t c) {
  const auto within = [c](char32_t low, char32_t high) { return c >= low && c <= high; };
  return within(0x0300, 0x036F) || within(0x0590, 0x08FF) || within(0x0900, 0x0DFF) ||
         within(0x0E00, 0x0EFF) || within(0x0F00, 0x109F) || within(0x1780, 0x18AF) ||
         within(0x1900, 0x1AFF) || within(0x1B00, 0x1C4F) || within(0x200C, 0x200F) ||
         within(0xFB1D, 0xFDFF) || within(0xFE70, 0xFEFF);
}

/// The built-in font instead of one of AutoCAD's single strokes.
std::string built_in_for(std::string_view file) {
  std::string name(file.substr(file.find_last_of("/\\") + 1));
  for (char& c : name) c = small_letter(c);
  name = name.substr(0, name.find('.'));
  if (name == "complex" || name == "romanc" || name == "romand") return "serif";
  if (name == "romant") return "serif-bold";
  if (name == "italic" || name == "italicc") return "serif-italic";
  if (name == "italict") return "serif-bold-italic";
  if (name == "scripts") return "script";
  return name == "scriptc" ? "script-2" : "sans";
}

bool is_file_name(std::string_view texts) { return texts.find('.') != std::string_view::npos; }

bool is_outline_font(std::string_view file) {
  return has_ending(file, ".ttf") || has_ending(file, ".otf") || has_ending(file, ".ttc");
}

dxf::Point cross_of(dxf::Point a, dxf::Point b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
dxf::Point unit_of(dxf::Point p) {
  const double size = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  return size > 0.0 ? dxf::Point{p.x / size, p.y / size, p.z / size} : dxf::Point{1.0, 0.0, 0.0};
}

}  // namespace

// ---------------------------------------------------------------------------------------------------- fonts

bool TextDrawer::Face::has(char32_t c) const {
  return is_area ? file.glyphs.contains(c) : strokes.glyphs.contains(c);
}

double TextDrawer::Face::advance(char32_t c) const {
  if (!is_area) {
    const auto glyph = strokes.glyphs.find(c);
    return glyph == strokes.glyphs.end() ? 0.0 : glyph->second.advance;
  }
  const auto glyph = file.glyphs.find(c);
  return glyph == file.glyphs.end() ? 0.0 : glyph->second.advance;
}

double TextDrawer::Face::kerning(char32_t a, char32_t b) const {
  const auto& pairs = is_area ? file.kerning : strokes.kerning;
  const auto found = pairs.find({a, b});
  return found == pairs.end() ? 0.0 : found->second;
}

void TextDrawer::collect_characters() {
  if (!characters_.empty()) return;
  const auto take = [&](const std::vector<dxf::Entity>& entities) {
    const dxf::StyledText* last = nullptr;
    for (const dxf::Entity& entity : entities) {
      if (const auto* text = std::get_if<dxf::Boxed<dxf::Text>>(&entity.shape))
        characters_ += from_utf8(dxf::plain(**text));
      const auto* part = std::get_if<dxf::TextPart>(&entity.shape);
      if (part == nullptr || part->text.get() == last) continue;
      last = part->text.get();
      for (const auto& c : last->characters) characters_ += c.code;
    }
  };
  take(drawing_.entities);
  for (const dxf::Block& block : drawing_.blocks) take(block.entities);
  characters_ += U' ';
}

TextDrawer::Face* TextDrawer::built_in(const std::string& name) {
  const auto [at, is_new] = faces_.try_emplace("built-in " + name);
  Face& face = at->second;
  if (!is_new) return face.is_readable ? &face : nullptr;
  auto strokes = stroke_text_font(name);
  face.is_readable = strokes.has_value();
  if (strokes) face.strokes = std::move(*strokes);
  face.name = fmt::format("the built-in font {}, single strokes", name);
  return face.is_readable ? &face : nullptr;
}

TextDrawer::Face* TextDrawer::load(const std::string& key, const FoundFont& font) {
  const auto [at, is_new] = faces_.try_emplace(key);
  Face& face = at->second;
  if (!is_new) return face.is_readable ? &face : nullptr;
  collect_characters();
  const auto input = InputFile::open(font.file, diagnostics_, limits::kMaxToolLibraryBytes);
  auto file =
      input ? read_font(input->bytes(), font.file, characters_, diagnostics_, font.face) : std::nullopt;
  face.is_readable = file.has_value();
  if (!file) return nullptr;
  face.file = std::move(*file);
  face.is_area = true;
  face.em = face.file.em;
  face.name = font.name.empty() ? font.file : fmt::format("{} ({})", font.name, font.file);
  if (font.is_other_style) face.comment = "weight or slant differ from the drawing's";
  return &face;
}

/// The font of the option, for all texts; null if the drawing's own are to be used, or it cannot be read.
TextDrawer::Face* TextDrawer::given_face() {
  if (is_file_name(options_.texts))
    return load("file " + options_.texts, {options_.texts, 0, "", false, false});
  if (stroke_text_font(options_.texts)) return built_in(options_.texts);
  const NamedFont named = find_named_font(options_.texts);
  return named.font ? load("name " + options_.texts, *named.font) : nullptr;
}

TextDrawer::Face* TextDrawer::face_for(const dxf::StyledText::Style& style) {
  if (options_.texts != "drawn") return given_face();
  const std::string wanted = joined(style.families, ", ");
  const std::string key = fmt::format("{} {} {}", style.weight, style.italic, wanted);
  if (const auto known = faces_.find(key); known != faces_.end())
    return known->second.is_readable ? &known->second : nullptr;
  const auto font = find_font({style.families, style.weight, style.italic});
  if (!font) {
    faces_[key].is_readable = false;
    return nullptr;
  }
  Face* face = load(key, *font);
  if (face != nullptr && font->is_stand_in)
    face->comment = fmt::format("instead of \"{}\"", clipped(wanted.empty() ? "serif" : wanted, 60));
  return face;
}

TextDrawer::Face* TextDrawer::face_for(const dxf::Text& text) {
  if (options_.texts != "drawn") return given_face();
  const std::string& file = drawing_.styles[text.style].font;
  const auto font = is_outline_font(file) ? find_font_file(file) : std::nullopt;
  if (font) return load("style " + file, *font);
  Face* face = built_in(built_in_for(file));
  if (face != nullptr && is_outline_font(file) && face->comment.empty())
    face->comment = fmt::format("instead of \"{}\", which is not installed", clipped(file, 60));
  return face;
}

void TextDrawer::used(Face& face, const Origin& where) {
  if (face.texts++ == 0) face.first = where;
}

/// Warns and returns false if there is no font, or the text cannot be laid out character by character.
bool TextDrawer::is_drawable(std::u32string_view text, const Face* face, const std::string& wanted,
                             const Origin& where, const std::string& name) {
  const auto fail = [&](const std::string& what) -> Diagnostic& {
    return diagnostics_.warning(codes::drawing_text, where, fmt::format("{} is not drawn: {}", name, what));
  };
  if (face == nullptr) {
    const std::string near = joined(near_families(wanted.substr(0, wanted.find(','))), ", ");
    fail(wanted.empty() ? "its font cannot be read"
                        : fmt::format("the font \"{}\" is not installed{}{}", clipped(wanted, 80),
                                      near.empty() ? "" : "; near: ", near))
        .hint =
        "convert it to paths, or choose a font for all texts: a built-in one, an installed one or a file "
        "(texts sans, texts \"DejaVu Sans:bold\", texts FILE.ttf)";
    return false;
  }
  const auto shaped = std::find_if(text.begin(), text.end(), needs_shaping);
  if (shaped != text.end()) {
    fail(fmt::format("U+{:04X} is of a script whose characters depend on their neighbours",
                     static_cast<std::uint32_t>(*shaped)))
        .hint = "convert it to paths";
    return false;
  }
  const auto missing = std::find_if(text.begin(), text.end(),
                                    [&](char32_t c) { return c > U' ' && c != U'\u00A0' && !face->has(c); });
  if (missing != text.end())
    diagnostics_.warning(codes::drawing_text, where,
                         fmt::format("{}: {} has no character U+{:04X}; it is left out", name, face->name,
                                     static_cast<std::uint32_t>(*missing)));
  return true;
}

bool TextDrawer::has_font(const std::string& texts, Diagnostics& diagnostics) {
  if (texts == "drawn" || texts == "none" || stroke_text_font(texts)) return true;
  if (is_file_name(texts)) {
    const auto input = InputFile::open(texts, diagnostics, limits::kMaxToolLibraryBytes);
    return input && read_font(input->bytes(), texts, U"H", diagnostics);
  }
  const NamedFont named = find_named_font(texts);
  if (named.font) return true;
  std::vector<std::string> names{"drawn", "none"};
  for (const std::string_view name : stroke_font_names()) names.emplace_back(name);
  diagnostics
      .error(codes::drawing_text, CallLocation{"", 0, "texts"}, named.fault + guess_at_end(texts, names))
      .hint = "one of: " + joined(names, ", ") + "; an installed family; or a font file (.ttf, .otf)";
  return false;
}

void TextDrawer::report() {
  for (const auto& [key, face] : faces_) {
    if (face.texts == 0) continue;
    const std::string message = fmt::format("{} text{} {} drawn in {}{}{}", face.texts,
                                            face.texts == 1 ? "" : "s", face.texts == 1 ? "is" : "are",
                                            face.name, face.comment.empty() ? "" : ", ", face.comment);
    if (face.comment.empty())
      diagnostics_.note(codes::drawing_text, face.first, message);
    else
      diagnostics_.warning(codes::drawing_text, face.first, message);
  }
}

// ----------------------------------------------------------------------------------------------- characters

/// Appends the outlines of one character; `frame` is in heights of capitals. False after an error.
bool TextDrawer::append(Face& face, char32_t c, const TextFrame& frame, const Origin& where,
                        TextOutlines& made) {
  const TextFrame turned{{}, frame.x, frame.y};
  const Key key{c, frame.x.x, frame.x.y, frame.y.x, frame.y.y};
  auto known = face.cache.find(key);
  if (known == face.cache.end()) {
    std::vector<Outline> shape;
    if (face.is_area) {
      const auto glyph = face.file.glyphs.find(c);
      if (glyph == face.file.glyphs.end()) return true;
      auto loops = glyph_loops(mapped_contours(glyph->second.contours, turned), options_.within,
                               {face.name, where}, diagnostics_);
      if (!loops) return false;
      shape = std::move(*loops);
    } else {
      const auto glyph = face.strokes.glyphs.find(c);
      if (glyph == face.strokes.glyphs.end()) return true;
      for (const Outline& stroke : glyph->second.paths) {
        Outline& path = shape.emplace_back();
        path.start = turned(stroke.start.x, stroke.start.y);
        for (const Segment& s : stroke.segments) path.segments.push_back({turned(s.to.x, s.to.y), {}});
      }
    }
    known = face.cache.emplace(key, std::move(shape)).first;
  }
  for (const Outline& outline : known->second) made.outlines.push_back(placed(outline, {.offset = frame.at}));
  return true;
}

// ------------------------------------------------------------------------------------------------ SVG

/// Positions of all characters, by SVG 2's layout of text: absolute positions start chunks, each aligned by
/// itself.
void TextDrawer::lay_out(const dxf::StyledText& text) {
  laid_out_ = &text;
  layout_ = {};
  layout_.pens.resize(text.characters.size());
  for (const auto& style : text.styles) layout_.faces.push_back(face_for(style));
  layout_.characters.resize(text.styles.size());
  for (std::size_t i = 0; i < text.characters.size(); ++i)
    layout_.characters[text.characters[i].style].push_back(i);
  Point2 pen{};
  std::size_t chunk = 0;
  const auto align = [&](std::size_t end) {
    if (chunk >= end) return;
    const auto anchor = text.styles[text.characters[chunk].style].anchor;
    if (anchor == dxf::StyledText::Anchor::start) return;
    const double width = pen.x - layout_.pens[chunk].x;
    const double shift = anchor == dxf::StyledText::Anchor::centre ? 0.5 * width : width;
    for (std::size_t i = chunk; i < end; ++i) layout_.pens[i].x -= shift;
  };
  for (std::size_t i = 0; i < text.characters.size(); ++i) {
    const auto& c = text.characters[i];
    if (c.x || c.y) {
      align(i);
      chunk = i;
      pen = {c.x.value_or(pen.x), c.y.value_or(pen.y)};
    }
    pen = pen + Point2{c.dx, c.dy};
    layout_.pens[i] = pen;
    const auto& style = text.styles[c.style];
    const Face* face = layout_.faces[c.style];
    if (face == nullptr) continue;
    double heights = face->advance(c.code);
    const bool has_next = i + 1 < text.characters.size();
    if (has_next && text.characters[i + 1].style == c.style)
      heights += face->kerning(c.code, text.characters[i + 1].code);
    pen.x += style.size / face->em * heights + style.letter_spacing;
    if (c.code == U' ' || c.code == U'\u00A0') pen.x += style.word_spacing;
  }
  align(text.characters.size());
}

std::optional<TextOutlines> TextDrawer::make(const dxf::Placed& placed, const dxf::TextPart& part,
                                             const Origin& where, const std::string& name) {
  const dxf::StyledText& text = *part.text;
  if (laid_out_ != &text) lay_out(text);
  Face* face = layout_.faces[part.style];
  const auto& style = text.styles[part.style];
  std::u32string own;
  for (const std::size_t i : layout_.characters[part.style]) own += text.characters[i].code;
  const std::string wanted = style.families.empty() ? "serif" : joined(style.families, ", ");
  if (!is_drawable(own, face, options_.texts == "drawn" ? wanted : "", where, name)) return std::nullopt;
  used(*face, where);
  const auto& m = text.matrix;
  const auto flat = [&](dxf::Point p) { return Point2{scale_ * p.x, scale_ * p.y}; };
  const auto at = [&](Point2 p) {
    return flat(placed.matrix *
                dxf::Point{m[0] * p.x + m[2] * p.y + m[4], m[1] * p.x + m[3] * p.y + m[5], 0});
  };
  const auto direction = [&](double x, double y) {
    return flat(placed.matrix.direction({m[0] * x + m[2] * y, m[1] * x + m[3] * y, 0.0}));
  };
  const double height = style.size / face->em;
  TextOutlines made{{}, face->is_area};
  for (const std::size_t i : layout_.characters[part.style]) {
    const auto& c = text.characters[i];
    const double turn = c.turn * kPi / 180.0, x = height * std::cos(turn), y = height * std::sin(turn);
    if (!append(*face, c.code, {at(layout_.pens[i]), direction(x, y), direction(y, -x)}, where, made))
      return std::nullopt;
  }
  return made;
}

// ------------------------------------------------------------------------------------------------ DXF

double TextDrawer::width_of(const Face& face, std::u32string_view text) const {
  double width = 0.0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    width += face.advance(text[i]);
    if (i + 1 < text.size()) width += face.kerning(text[i], text[i + 1]);
  }
  return width;
}

void TextDrawer::line(Face& face, std::u32string_view text, TextFrame frame, const Origin& where,
                      TextOutlines& made) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!append(face, text[i], frame, where, made)) return;
    const double closer = i + 1 < text.size() ? face.kerning(text[i], text[i + 1]) : 0.0;
    frame.at = frame(face.advance(text[i]) + closer, 0.0);
  }
}

/// The lines of a text, those longer than `width` (above 0) divided at blanks.
std::vector<std::u32string> TextDrawer::wrapped(const Face& face, const std::u32string& text,
                                                double width) const {
  std::vector<std::u32string> lines;
  std::u32string_view rest = text;
  while (true) {
    const std::size_t end = std::min(rest.find(U'\n'), rest.size());
    std::u32string_view paragraph = rest.substr(0, end);
    std::u32string one;
    while (!paragraph.empty()) {
      const std::size_t word =
          std::min(paragraph.find(U' ', paragraph.find_first_not_of(U' ')), paragraph.size());
      const std::u32string longer = one + std::u32string(paragraph.substr(0, word));
      if (width > 0.0 && !one.empty() && width_of(face, longer) > width) {
        lines.push_back(std::move(one));
        paragraph.remove_prefix(std::min(paragraph.find_first_not_of(U' '), paragraph.size()));
        one.clear();
        continue;
      }
      one = longer;
      paragraph.remove_prefix(word);
    }
    lines.push_back(std::move(one));
    if (end == rest.size()) return lines;
    rest.remove_prefix(end + 1);
  }
}

/// The frame of a text at its anchor, in drawing units along and across its line.
TextFrame TextDrawer::frame_of(const dxf::Placed& placed, const dxf::Text& text) const {
  const dxf::Point normal = unit_of(drawing_.extrusions[placed.entity.extrusion]);
  const dxf::Matrix object = dxf::object_axes(drawing_.extrusions[placed.entity.extrusion]);
  const bool is_mtext = text.kind == dxf::TextKind::mtext;
  const double turn = dxf::rotation(text) * kPi / 180.0;
  dxf::Point x = object.direction({std::cos(turn), std::sin(turn), 0.0});
  if (is_mtext && text.second) x = unit_of(*text.second);
  const dxf::Point y = cross_of(normal, x);
  const dxf::Point at = is_mtext ? text.at : object * dxf::anchor(text);
  const auto flat = [&](dxf::Point p) { return Point2{scale_ * p.x, scale_ * p.y}; };
  return {flat(placed.matrix * at), flat(placed.matrix.direction(x)), flat(placed.matrix.direction(y))};
}

std::optional<TextOutlines> TextDrawer::make(const dxf::Placed& placed, const dxf::Text& text,
                                             const Origin& where, const std::string& name) {
  const std::u32string plain = from_utf8(dxf::plain(text));
  Face* face = face_for(text);
  std::u32string visible = plain;
  std::erase(visible, U'\n');
  if (visible.find_first_not_of(U' ') == std::u32string::npos) return TextOutlines{};
  if (!is_drawable(visible, face, "", where, name)) return std::nullopt;
  if (!(text.height > 0.0)) {
    diagnostics_.warning(codes::drawing_text, where,
                         fmt::format("{} is not drawn: its height is {:g}", name, text.height));
    return std::nullopt;
  }
  used(*face, where);
  TextOutlines made{{}, face->is_area};
  const TextFrame drawn = frame_of(placed, text);
  double height = text.height;
  if (text.kind == dxf::TextKind::mtext) {
    const auto lines = wrapped(*face, plain, text.reference_width / height);
    const int attached = std::clamp(text.attachment, 1, 9) - 1;
    const double pitch = kPitch * text.line_spacing;
    const double block = 1.0 + pitch * static_cast<double>(lines.size() - 1);
    double baseline = attached < 3 ? -1.0 : attached < 6 ? 0.5 * block - 1.0 : block - 1.0;
    const TextFrame frame{drawn.at, height * drawn.x, height * drawn.y};
    for (const std::u32string& one : lines) {
      const double start = -0.5 * (attached % 3) * width_of(*face, one);
      line(*face, one, {frame(start, baseline), frame.x, frame.y}, where, made);
      baseline -= pitch;
    }
    return made;
  }
  double factor = text.width_factor > 0.0 ? text.width_factor : 1.0;
  double width = factor * width_of(*face, visible);
  TextFrame base = drawn;
  const bool is_fitted = (text.horizontal == 3 || text.horizontal == 5) && text.second && width > 0.0;
  if (is_fitted) {  // between two points: by its height, or by its width alone
    dxf::Text start = text;
    start.second.reset();
    base = frame_of(placed, start);
    const double dx = text.second->x - text.at.x, dy = text.second->y - text.at.y;
    const double length = std::hypot(dx, dy), turn = std::atan2(dy, dx) - text.rotation * kPi / 180.0;
    base.x = base.direction(std::cos(turn), std::sin(turn));
    base.y = TextFrame{{}, drawn.x, drawn.y}.direction(-std::sin(turn), std::cos(turn));
    (text.horizontal == 3 ? height : factor) *= length / (height * width);
  }
  const double along = is_fitted || text.horizontal == 0 ? 0.0 : text.horizontal == 2 ? -1.0 : -0.5;
  const double up = text.horizontal == 4 ? -0.5
                    : text.vertical == 1 ? kBelow
                    : text.vertical == 2 ? -0.5
                    : text.vertical == 3 ? -1.0
                                         : 0.0;
  const double lean = std::tan(std::clamp(text.oblique, -85.0, 85.0) * kPi / 180.0);
  const double right = text.backward ? -height : height, top = text.upside_down ? -height : height;
  const TextFrame frame{base.at, factor * right * base.x, top * (base.y + lean * base.x)};
  line(*face, visible, {frame(along * width / factor, up), frame.x, frame.y}, where, made);
  return made;
}

}  // namespace kerf::outline_front
