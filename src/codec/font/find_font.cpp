// Finds installed fonts: reads the names of all font files once.
#include "codec/font/find_font.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "base/ending.h"
#include "base/file_names.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

#if defined(KERF_WITH_FREETYPE)
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_TRUETYPE_TABLES_H
#endif

namespace kerf {

#if defined(KERF_WITH_FREETYPE)
namespace {

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = small_letter(c);
  return out;
}

constexpr std::size_t kMaxFonts = 20'000;
constexpr int kRegular = 400, kBold = 700, kNormalWidth = 5;

struct Installed {
  std::string file, family, style, post_script;
  int face = 0, weight = kRegular, width = kNormalWidth;
  bool italic = false;
};

/// Folders of fonts of all systems; those that do not exist are skipped.
std::vector<std::string> folders() {
#if defined(_WIN32)
  constexpr char kBetween = ';';
#else
  constexpr char kBetween = ':';
#endif
  std::vector<std::string> out;
  if (const char* own = std::getenv("KERF_FONTS")) {
    std::string_view rest = own;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(kBetween), rest.size());
      if (end > 0) out.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return out;
  }
  const auto below = [&](const char* variable, const char* folder) {
    if (const char* start = std::getenv(variable); start != nullptr && *start != '\0')
      out.push_back(path_in(start, folder));
  };
  below("XDG_DATA_HOME", "fonts");
  below("HOME", ".local/share/fonts");
  below("HOME", ".fonts");
  below("HOME", "Library/Fonts");
  below("LOCALAPPDATA", "Microsoft/Windows/Fonts");
  below("WINDIR", "Fonts");
  for (const char* folder :
       {"/usr/local/share/fonts", "/usr/share/fonts", "/Library/Fonts", "/System/Library/Fonts"})
    out.emplace_back(folder);
  return out;
}

/// Appends the font files in a folder and those below it.
void collect_files(const std::string& folder, int depth, std::vector<std::string>& out) {
  constexpr int kDeepest = 8;  // links may lead back
  const auto names = names_in(folder, kMaxFonts);
  if (!names) return;
  for (const std::string& name : *names) {
    if (out.size() >= kMaxFonts) return;
    const std::string path = path_in(folder, name), ending = ending_of(name);
    if (ending == ".ttf" || ending == ".otf" || ending == ".ttc" || ending == ".otc") {
      if (is_regular_file(path)) out.push_back(path);
    } else if (depth < kDeepest && is_folder(path)) {
      collect_files(path, depth + 1, out);
    }
  }
}

std::vector<std::string> font_files() {
  std::vector<std::string> out;
  for (const std::string& folder : folders()) collect_files(folder, 0, out);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Appends the faces of a font file.
void read_names(FT_Library library, const std::string& file, std::vector<Installed>& fonts) {
  Diagnostics unused;
  const auto input = InputFile::open(file, unused, limits::kMaxToolLibraryBytes);
  if (!input) return;
  const auto* bytes = reinterpret_cast<const FT_Byte*>(input->bytes().data());
  const auto size = static_cast<FT_Long>(input->bytes().size());
  for (FT_Long count = 1, k = 0; k < count && fonts.size() < kMaxFonts; ++k) {
    FT_Face face = nullptr;
    if (FT_New_Memory_Face(library, bytes, size, k, &face) != 0) return;
    count = std::min<FT_Long>(face->num_faces, 64);
    Installed made;
    made.file = file;
    made.face = static_cast<int>(k);
    made.family = face->family_name != nullptr ? face->family_name : "";
    made.style = face->style_name != nullptr ? face->style_name : "";
    if (const char* name = FT_Get_Postscript_Name(face)) made.post_script = name;
    made.italic = (face->style_flags & FT_STYLE_FLAG_ITALIC) != 0;
    made.weight = (face->style_flags & FT_STYLE_FLAG_BOLD) != 0 ? kBold : kRegular;
    if (const auto* os2 = static_cast<const TT_OS2*>(FT_Get_Sfnt_Table(face, FT_SFNT_OS2))) {
      made.weight = os2->usWeightClass > 0 ? os2->usWeightClass : made.weight;
      made.width = os2->usWidthClass > 0 ? os2->usWidthClass : made.width;
    }
    const bool is_outline = (face->face_flags & FT_FACE_FLAG_SCALABLE) != 0;
    FT_Done_Face(face);
    if (is_outline) fonts.push_back(std::move(made));
  }
}

const std::vector<Installed>& installed() {
  static const std::vector<Installed> fonts = [] {
    std::vector<Installed> made;
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library) != 0) return made;
    for (const std::string& file : font_files()) read_names(library, file, made);
    FT_Done_FreeType(library);
    return made;
  }();
  return fonts;
}

/// Fonts with the same widths of characters, and the usual ones of a kind, the first that is installed.
struct StandIn {
  std::string_view name;
  std::array<std::string_view, 7> fonts;
};
constexpr StandIn kStandIns[] = {
    {"sans-serif", {"Noto Sans", "DejaVu Sans", "Liberation Sans", "Arial", "Helvetica", "Roboto", ""}},
    {"sans", {"Noto Sans", "DejaVu Sans", "Liberation Sans", "Arial", "Helvetica", "Roboto", ""}},
    {"system-ui", {"Noto Sans", "DejaVu Sans", "Segoe UI", "Helvetica Neue", "Roboto", "Arial", ""}},
    {"serif", {"Noto Serif", "DejaVu Serif", "Liberation Serif", "Times New Roman", "Times", "", ""}},
    {"monospace", {"Noto Sans Mono", "DejaVu Sans Mono", "Liberation Mono", "Courier New", "Menlo", "", ""}},
    {"arial", {"Liberation Sans", "Arimo", "Helvetica", "Nimbus Sans", "", "", ""}},
    {"helvetica", {"Arial", "Liberation Sans", "Arimo", "Nimbus Sans", "", "", ""}},
    {"times new roman", {"Liberation Serif", "Tinos", "Times", "Nimbus Roman", "", "", ""}},
    {"times", {"Times New Roman", "Liberation Serif", "Tinos", "Nimbus Roman", "", "", ""}},
    {"courier new", {"Liberation Mono", "Cousine", "Courier", "Nimbus Mono PS", "", "", ""}},
    {"courier", {"Courier New", "Liberation Mono", "Cousine", "Nimbus Mono PS", "", "", ""}},
    {"calibri", {"Carlito", "", "", "", "", "", ""}},
    {"cambria", {"Caladea", "", "", "", "", "", ""}}};

/// The nearest face of a family: by width, slant and weight, in this order, as CSS chooses.
const Installed* of_family(std::string_view family, const FontWish& wish) {
  const std::string name = lowered(family);
  const Installed* best = nullptr;
  std::array<int, 3> least{};
  for (const Installed& font : installed()) {
    const bool is_whole =
        lowered(font.post_script) == name || lowered(font.family + " " + font.style) == name;
    if (lowered(font.family) != name && !is_whole) continue;
    // Between two weights that are equally far the bolder one is taken for bold wishes.
    const int off = font.weight - wish.weight, bolder = wish.weight > 500 ? off : -off;
    const std::array<int, 3> cost{is_whole ? -1 : std::abs(font.width - kNormalWidth),
                                  font.italic != wish.italic ? 1 : 0,
                                  2 * std::abs(off) - (bolder > 0 ? 1 : 0)};
    if (best == nullptr || cost < least) {
      best = &font;
      least = cost;
    }
  }
  return best;
}

FoundFont found(const Installed& font, const FontWish& wish, bool is_stand_in) {
  constexpr int kSameWeight = 100;
  const bool is_near = std::abs(font.weight - wish.weight) <= kSameWeight;
  return {font.file, font.face, font.family + " " + font.style, is_stand_in,
          font.italic != wish.italic || !is_near};
}

}  // namespace

std::optional<FoundFont> find_font(const FontWish& wish) {
  std::vector<std::string> families = wish.families;
  if (families.empty()) families.emplace_back("serif");
  for (const std::string& family : families) {
    if (const Installed* font = of_family(family, wish)) return found(*font, wish, false);
    for (const StandIn& other : kStandIns) {
      if (other.name != lowered(family)) continue;
      for (const std::string_view name : other.fonts)
        if (const Installed* font = name.empty() ? nullptr : of_family(name, wish))
          return found(*font, wish, true);
    }
  }
  return std::nullopt;
}

std::optional<FoundFont> find_font_file(std::string_view name) {
  const std::string wanted = lowered(name.substr(name.find_last_of("/\\") + 1));
  for (const Installed& font : installed())
    if (lowered(font.file.substr(font.file.find_last_of("/\\") + 1)) == wanted)
      return found(font, {{}, font.weight, font.italic}, false);
  return std::nullopt;
}

#else

std::optional<FoundFont> find_font(const FontWish&) { return std::nullopt; }
std::optional<FoundFont> find_font_file(std::string_view) { return std::nullopt; }

#endif

}  // namespace kerf
