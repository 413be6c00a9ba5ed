// The outline fonts that are installed, with their names.
#pragma once

#include <string>
#include <vector>

namespace kerf {

inline constexpr int kNormalFontWidth = 5;

/// A font under one of its names.
struct InstalledFont {
  std::string file, family, style, post_script;
  int face = 0;
  int weight = 400;              ///< 100 to 900; 700: bold
  int width = kNormalFontWidth;  ///< 1 to 9, from condensed to expanded
  bool italic = false;
};

/// In the order of their files. Listed once, at the first call: by Fontconfig, or those in the folders of the
/// environment variable KERF_FONTS.
const std::vector<InstalledFont>& installed_fonts();

/// The family that the system's settings have for a kind: "sans-serif", "serif", "monospace". Empty if they
/// are not known.
std::string usual_family(const std::string& kind);

}  // namespace kerf
