// The reader of SVG files: its state while it visits the elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/pace.h"
#include "codec/drawing/colour_names.h"
#include "codec/drawing/svg_entities.h"
#include "codec/drawing/svg_style.h"
#include "codec/drawing/svg_tree.h"
#include "codec/drawing/svg_values.h"

#include "kerf/drawing/svg.h"

namespace kerf::svg {

struct PaintValue {
  std::string name = "none";   // "#ff0000", "none", "currentcolor" or "url"
  std::string link, fallback;  // of "url"
  double alpha = 1.0;
};

/// The properties that are used; all but the last two are inherited.
struct Style {
  PaintValue stroke, fill{"#000000", {}, {}, 1.0};
  Colour colour;
  double fill_opacity = 1.0, stroke_opacity = 1.0;
  bool is_hidden = false;  // visibility
  bool is_even_odd = false, is_clip_even_odd = false;
  double stroke_width = 1.0, mitre_limit = 4.0;
  std::vector<double> dashes;  // and gaps in turn, an even number
  double dash_offset = 0.0;
  dxf::StrokeEnds ends = dxf::StrokeEnds::butt;
  dxf::StrokeCorners corners = dxf::StrokeCorners::mitre;
  dxf::StyledText::Style font;
  bool keeps_blanks = false;  // of texts
  bool is_shown = true;       // display
  double opacity = 1.0;       // the product of all around
};

/// What an element inherits.
struct Context {
  Affine matrix;  // to the drawing
  Style style;
  std::string layer;  // of Inkscape
  std::uint32_t clip = 0;
  bool is_in_clip = false;  // its fill is the area of a clipPath
  LengthBase base;
  std::shared_ptr<const Variables> variables;  // custom properties
};

/// An element that is visited, with its properties, and the context inside of it.
struct Drawn {
  const Element& element;
  const Properties& properties;
  const Context& context;
};

/// Whether an element is drawn in English (systemLanguage), by a program without extensions.
bool passes_conditions(const Element& element);

class SvgReader {
 public:
  SvgReader(const std::string& file, const SvgOptions& options, Pace& pace, Diagnostics& diagnostics)
      : options_(options), pace_(pace), diagnostics_(diagnostics), writer_(drawing_, chains_) {
    drawing_.file = file;
  }
  /// `sheets` are the style sheets in other files.
  std::optional<dxf::Drawing> read(const Element& root, const std::vector<Element>& sheets);

 private:
  enum class Range : std::uint8_t { any, positive };
  struct Ignored {
    std::size_t count = 0;
    const Element* first = nullptr;
    std::string consequence{};
    bool is_applied = false;  // a clip that is
  };

  // The page and its elements
  void index(const Element& element);
  void read_page(const Element& root, Context& context);
  std::optional<std::vector<double>> view_box_of(const Element& element);
  Context in_viewport(const Element& element, Context context, double width, double height);
  std::optional<Context> entered(const Element& element, const Properties& properties, Context context);
  void visit(const Element& element, const Context& outside, std::size_t depth);
  void draw_content(const Drawn& drawn, std::size_t depth);
  void children(const Element& element, const Context& context, std::size_t depth);
  const Element* target_of(const Element& use);
  void visit_use(const Drawn& drawn, std::size_t depth);
  void nested(const Drawn& drawn, std::optional<double> width, std::optional<double> height,
              std::size_t depth);

  // Clips
  void apply_clip(const Drawn& drawn, Context& context);
  std::uint32_t clip_to_viewport(const Context& frame, double width, double height);
  std::optional<std::uint32_t> clip_to_path(const Element& path, const Drawn& drawn);
  Box box_of(const Drawn& drawn);

  // Styles
  void apply_style(const Drawn& drawn, Context& context);
  void apply_paint(const Drawn& drawn, std::string_view key, PaintValue& paint);
  void apply_font_size(const Drawn& drawn, Context& context);
  void apply_stroke(const Drawn& drawn, Style& style);
  void apply_dashes(const Drawn& drawn, Style& style);
  void apply_font(const Drawn& drawn, Context& context);
  std::string painted(const PaintValue& paint, double opacity, const Style& style) const;
  bool is_painting(const Element& server) const;
  void note_pattern(const Drawn& drawn, std::string_view key, const PaintValue& paint);
  Box reference_box(const Drawn& drawn);
  Affine transform_of(const Drawn& drawn);
  std::optional<double> length_of(const Drawn& drawn, std::string_view key, Axis axis,
                                  Range range = Range::any);
  std::uint32_t layer_index(std::string_view name);
  EntityWriter::Setting setting_of(const Drawn& drawn);

  // Shapes
  bool draw(const Drawn& drawn);
  void draw_path(const Drawn& drawn);
  void draw_rectangle(const Drawn& drawn);
  void draw_ellipse(const Drawn& drawn);
  void draw_points(const Element& element, bool is_closed);
  void count_other(const Drawn& drawn, const EntityWriter::Setting& setting);

  // Texts
  struct TextBuilder;
  void draw_text(const Drawn& drawn, std::size_t depth);
  void collect_text(const Drawn& drawn, TextBuilder& text, std::size_t depth);
  std::vector<double> lengths_of(const Drawn& drawn, std::string_view key, Axis axis);

  // Messages
  Origin location(const Element& e) const {
    return TextLocation{drawing_.file, static_cast<std::uint32_t>(e.line),
                        static_cast<std::uint32_t>(e.column)};
  }
  void warn(const Element& element, std::string_view key, std::string_view value, std::string_view what);
  void note_tilted(const Element& element);
  void note_ignored(const Element& element, std::string_view what,
                    std::string_view consequence = "has no effect on outlines");
  void report_ignored();
  bool within_limits(const Element& element, std::size_t depth);

  const SvgOptions& options_;
  Pace& pace_;
  Diagnostics& diagnostics_;
  dxf::Drawing drawing_;
  std::uint32_t chains_ = 0;
  EntityWriter writer_;
  StyleSheet sheet_;
  std::vector<const Element*> unknown_rules_;  // the style element of each of StyleSheet::unknown
  std::map<std::string, const Element*, std::less<>> by_id_;
  std::map<std::string, Ignored> ignored_;
  std::map<std::string, std::uint32_t> clips_;  // by element and transform
  std::vector<const Element*> open_clips_;      // that are being read
  std::vector<const Element*> open_uses_;       // what the `use` around the current element refer to
  std::size_t depth_ = 0;                       // of the element that is entered
  double pixel_ = 1.0;                          // of the page, in units of the drawing
  std::size_t elements_ = 0, elements_in_file_ = 0, segments_ = 0;
  std::map<std::string, Box> boxes_;  // by element and what relative lengths refer to
  bool is_over_limit_ = false, has_tilted_ = false;
};

}  // namespace kerf::svg
