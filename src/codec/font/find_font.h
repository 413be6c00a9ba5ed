// The outline fonts that are installed, by their names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

struct FontWish {
  /// In the order of preference: names of families, or whole names ("DejaVu Sans Bold", "MyriadPro-Bold");
  /// serif, sans-serif, monospace and the like are the first usual font of that kind. None: a serif font.
  std::vector<std::string> families;
  int weight = 400;  ///< 100 to 900; 700: bold
  bool italic = false;
};
struct FoundFont {
  std::string file;
  int face = 0;              ///< in the file
  std::string name;          ///< "DejaVu Sans Bold"
  bool is_stand_in = false;  ///< another font with the same widths of characters, or a usual one of its kind
  bool is_other_style = false;  ///< its weight or slant is not the one that was asked for
};

/// The installed font for a wish; nothing if none of its families is installed. Searched are the folders of
/// the environment variable KERF_FONTS, separated by ':' (';' on Windows), else what Fontconfig lists, or the
/// folders of the system and the user; once, at the first call.
std::optional<FoundFont> find_font(const FontWish& wish);
/// The installed font of a family and, after a colon, a style: "DejaVu Sans", "DejaVu Sans:bold italic",
/// "DejaVu Sans:Condensed Oblique"; or of a whole name. Never another one.
struct NamedFont {
  std::optional<FoundFont> font;
  std::string fault;  ///< what is missing, with the nearest names; empty if the font is there
};
NamedFont find_named_font(const std::string& text);
/// The installed families that are most similar to `name`, the first the nearest; at most five.
std::vector<std::string> near_families(std::string_view name);
/// The installed font of a file's name, such as "arial.ttf", without regard to case.
std::optional<FoundFont> find_font_file(std::string_view name);

}  // namespace kerf
