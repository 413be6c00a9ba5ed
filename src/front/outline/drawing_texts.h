// Texts of drawings as outlines: areas of outline fonts, or single strokes of the built-in ones.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "codec/font/find_font.h"
#include "codec/font/font_files.h"

#include "kerf/drawing/drawing_outlines.h"
#include "kerf/geom/text.h"

namespace kerf::outline_front {

/// From coordinates of a text (x along the line, y up) to mm of the drawing.
struct TextFrame {
  Point2 at, x{1.0, 0.0}, y{0.0, 1.0};
  Point2 operator()(double u, double v) const { return at + u * x + v * y; }
  Point2 direction(double u, double v) const { return u * x + v * y; }
};

struct TextOutlines {
  std::vector<Outline> outlines;
  bool is_area = false;  // else they are strokes
};

class TextDrawer {
 public:
  TextDrawer(const dxf::Drawing& drawing, double mm_per_unit, const DrawingOutlineOptions& options,
             Diagnostics& diagnostics)
      : drawing_(drawing), scale_(mm_per_unit), options_(options), diagnostics_(diagnostics) {}

  /// The outlines of a text; nothing, with a warning, if it is not drawn. `where` and `name` are for
  /// messages.
  std::optional<TextOutlines> make(const dxf::Placed& placed, const dxf::TextPart& part, const Origin& where,
                                   const std::string& name);
  std::optional<TextOutlines> make(const dxf::Placed& placed, const dxf::Text& text, const Origin& where,
                                   const std::string& name);
  /// Whether the font of the options exists; an error if it does not.
  static bool has_font(const std::string& texts, Diagnostics& diagnostics);
  /// Which fonts were used.
  void report();

 private:
  using Key = std::tuple<char32_t, double, double, double, double>;  // a character with the axes of its frame
  struct Face {
    std::string name;  // in messages
    bool is_readable = true;
    bool is_area = false;
    TextFont strokes;
    FontFile file;
    double em = 1.0 / 0.7;  // in heights of capitals, the unit of both
    std::size_t texts = 0;
    Origin first;
    std::string comment;  // why it is not the font that the drawing names
    std::map<Key, std::vector<Outline>> cache;

    bool has(char32_t c) const;
    double advance(char32_t c) const;
    double kerning(char32_t a, char32_t b) const;
  };
  struct Layout {
    std::vector<Point2> pens;
    std::vector<Face*> faces;                          // by style
    std::vector<std::vector<std::size_t>> characters;  // by style
  };

  Face* face_for(const dxf::StyledText::Style& style);
  Face* face_for(const dxf::Text& text);
  Face* given_face();
  Face* built_in(const std::string& name);
  Face* load(const std::string& key, const FoundFont& font);
  void collect_characters();
  bool is_drawable(std::u32string_view text, const Face* face, const std::string& wanted, const Origin& where,
                   const std::string& name);
  void lay_out(const dxf::StyledText& text);
  bool append(Face& face, char32_t c, const TextFrame& frame, const Origin& where, TextOutlines& made);
  void line(Face& face, std::u32string_view text, TextFrame frame, const Origin& where, TextOutlines& made);
  double width_of(const Face& face, std::u32string_view text) const;
  std::vector<std::u32string> wrapped(const Face& face, const std::u32string& text, double width) const;
  TextFrame frame_of(const dxf::Placed& placed, const dxf::Text& text) const;
  void used(Face& face, const Origin& where);

  const dxf::Drawing& drawing_;
  const double scale_;
  const DrawingOutlineOptions& options_;
  Diagnostics& diagnostics_;
  std::map<std::string, Face> faces_;
  std::u32string characters_;  // of all texts
  const dxf::StyledText* laid_out_ = nullptr;
  Layout layout_;
};

}  // namespace kerf::outline_front
