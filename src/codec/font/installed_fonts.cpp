// The fonts that are installed: by Fontconfig where it is there, else by reading the names of all font files.
#include "codec/font/installed_fonts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <tuple>

#include "base/ending.h"
#include "base/file_names.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

#if defined(KERF_WITH_FREETYPE)
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_TRUETYPE_TABLES_H
#endif
#if defined(KERF_WITH_FONTCONFIG)
#include <fontconfig/fontconfig.h>
#endif

namespace kerf {

#if defined(KERF_WITH_FREETYPE)
namespace {

constexpr std::size_t kMaxFonts = 20'000;
constexpr int kRegular = 400, kBold = 700;
constexpr const char* kOwnFolders = "KERF_FONTS";

/// Folders of fonts of all systems; those that do not exist are skipped.
std::vector<std::string> folders() {
#if defined(_WIN32)
  constexpr char kBetween = ';';
#else
  constexpr char kBetween = ':';
#endif
  std::vector<std::string> out;
  if (const char* own = std::getenv(kOwnFolders)) {
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
void read_names(FT_Library library, const std::string& file, std::vector<InstalledFont>& fonts) {
  Diagnostics unused;
  const auto input = InputFile::open(file, unused, limits::kMaxToolLibraryBytes);
  if (!input) return;
  const auto* bytes = reinterpret_cast<const FT_Byte*>(input->bytes().data());
  const auto size = static_cast<FT_Long>(input->bytes().size());
  for (FT_Long count = 1, k = 0; k < count && fonts.size() < kMaxFonts; ++k) {
    FT_Face face = nullptr;
    if (FT_New_Memory_Face(library, bytes, size, k, &face) != 0) return;
    count = std::min<FT_Long>(face->num_faces, 64);
    InstalledFont made;
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

/// By the names in all font files.
std::vector<InstalledFont> read_all() {
  std::vector<InstalledFont> made;
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) return made;
  for (const std::string& file : font_files()) read_names(library, file, made);
  FT_Done_FreeType(library);
  return made;
}

#if defined(KERF_WITH_FONTCONFIG)

template <auto destroy>
struct Destroyer {
  template <class T>
  void operator()(T* object) const {
    destroy(object);
  }
};
using Config = std::unique_ptr<FcConfig, Destroyer<FcConfigDestroy>>;
using Pattern = std::unique_ptr<FcPattern, Destroyer<FcPatternDestroy>>;
using Objects = std::unique_ptr<FcObjectSet, Destroyer<FcObjectSetDestroy>>;
using Fonts = std::unique_ptr<FcFontSet, Destroyer<FcFontSetDestroy>>;

/// The system's configuration; null without one, of which Fontconfig would complain on standard error.
FcConfig* config() {
  static const Config of_system = [] {
    const Config empty(FcConfigCreate());
    FcChar8* const file = FcConfigGetFilename(empty.get(), nullptr);
    if (file == nullptr) return Config();
    FcStrFree(file);
    return Config(FcInitLoadConfigAndFonts());
  }();
  return std::getenv(kOwnFolders) == nullptr ? of_system.get() : nullptr;
}

std::string text_of(FcPattern* font, const char* object, int n = 0) {
  FcChar8* text = nullptr;
  if (FcPatternGetString(font, object, n, &text) != FcResultMatch) return {};
  return reinterpret_cast<const char*>(text);
}

double number_of(FcPattern* font, const char* object, double otherwise) {
  double value = otherwise;
  return FcPatternGetDouble(font, object, 0, &value) == FcResultMatch ? value : otherwise;
}

/// Appends a font under each of its names: "DejaVu Sans", "Condensed Bold" is "DejaVu Sans Condensed",
/// "Bold".
void append_names(FcPattern* font, std::vector<InstalledFont>& fonts) {
  constexpr int kMaxNames = 32;
  constexpr double kPercentOfClass = 12.5;  // of widths, from 100 for class 5
  FcBool is_variable = FcFalse;
  if (FcPatternGetBool(font, FC_VARIABLE, 0, &is_variable) == FcResultMatch && is_variable) return;
  InstalledFont made;
  made.file = text_of(font, FC_FILE);
  made.post_script = text_of(font, FC_POSTSCRIPT_NAME);
  FcPatternGetInteger(font, FC_INDEX, 0, &made.face);
  made.weight = static_cast<int>(FcWeightToOpenTypeDouble(number_of(font, FC_WEIGHT, FC_WEIGHT_REGULAR)));
  made.width = kNormalFontWidth +
               static_cast<int>(std::lround((number_of(font, FC_WIDTH, FC_WIDTH_NORMAL) - FC_WIDTH_NORMAL) /
                                            kPercentOfClass));
  made.italic = number_of(font, FC_SLANT, FC_SLANT_ROMAN) > FC_SLANT_ROMAN;
  std::string style;
  for (int n = 0; n < kMaxNames; ++n) {
    made.family = text_of(font, FC_FAMILY, n);
    if (made.family.empty()) break;
    if (const std::string own = text_of(font, FC_STYLE, n); !own.empty()) style = own;
    made.style = style;
    fonts.push_back(made);
  }
}

std::vector<InstalledFont> list_all() {
  std::vector<InstalledFont> made;
  const Pattern outlines(FcPatternCreate());
  FcPatternAddBool(outlines.get(), FC_SCALABLE, FcTrue);
  FcPatternAddBool(outlines.get(), FC_OUTLINE, FcTrue);
  const Objects objects(FcObjectSetBuild(FC_FILE, FC_INDEX, FC_FAMILY, FC_STYLE, FC_POSTSCRIPT_NAME,
                                         FC_WEIGHT, FC_WIDTH, FC_SLANT, FC_VARIABLE, nullptr));
  const Fonts all(FcFontList(config(), outlines.get(), objects.get()));
  for (int i = 0; all && i < all->nfont && made.size() < kMaxFonts; ++i) append_names(all->fonts[i], made);
  return made;
}

#endif

std::vector<InstalledFont> find_all() {
#if defined(KERF_WITH_FONTCONFIG)
  if (config() != nullptr) return list_all();
#endif
  return read_all();
}

}  // namespace

const std::vector<InstalledFont>& installed_fonts() {
  static const std::vector<InstalledFont> fonts = [] {
    std::vector<InstalledFont> made = find_all();
    std::sort(made.begin(), made.end(), [](const InstalledFont& a, const InstalledFont& b) {
      return std::tie(a.file, a.face, a.family) < std::tie(b.file, b.face, b.family);
    });
    return made;
  }();
  return fonts;
}

std::string usual_family([[maybe_unused]] const std::string& kind) {
#if defined(KERF_WITH_FONTCONFIG)
  if (config() == nullptr) return {};
  const Pattern wish(FcPatternCreate());
  FcPatternAddString(wish.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>(kind.c_str()));
  FcPatternAddBool(wish.get(), FC_OUTLINE, FcTrue);
  FcConfigSubstitute(config(), wish.get(), FcMatchPattern);
  FcDefaultSubstitute(wish.get());
  FcResult result = FcResultNoMatch;
  const Pattern font(FcFontMatch(config(), wish.get(), &result));
  return font ? text_of(font.get(), FC_FAMILY) : std::string();
#else
  return {};
#endif
}

#else

const std::vector<InstalledFont>& installed_fonts() {
  static const std::vector<InstalledFont> none;
  return none;
}
std::string usual_family(const std::string&) { return {}; }

#endif

}  // namespace kerf
