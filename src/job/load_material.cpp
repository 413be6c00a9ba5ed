// Materials by name or from files.
#include "job/load_material.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "base/guess.h"
#include "base/names.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {

std::optional<std::size_t> end_of_material_file(const std::string& text) {
  constexpr std::string_view kEnding = ".toml";
  const std::size_t at = text.find(kEnding);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t end = at + kEnding.size();
  return end == text.size() || text[end] == ':' ? std::optional(end) : std::nullopt;
}

std::optional<Material> load_material(const std::string& text, Diagnostics& diagnostics) {
  const auto end = end_of_material_file(text);
  if (!end) return material_named(text, diagnostics);
  const std::string file = text.substr(0, *end), name = text.substr(std::min(*end + 1, text.size()));
  const auto input = InputFile::open(file, diagnostics, limits::kMaxProfileBytes);
  if (!input) return std::nullopt;
  const std::size_t errors = diagnostics.errors();
  const std::vector<Material> materials = read_material_file(input->bytes(), file, diagnostics);
  if (diagnostics.errors() > errors) return std::nullopt;
  std::vector<std::string> known;
  for (const Material& material : materials) {
    known.push_back(material.name);
    const auto is_asked = [&](const std::string& n) { return fold_name(n) == fold_name(name); };
    if (name.empty() || is_asked(material.name) ||
        std::any_of(material.other_names.begin(), material.other_names.end(), is_asked))
      return material;
  }
  diagnostics
      .error(codes::material_unknown, TextLocation{file, 0, 0},
             known.empty() ? "the file has no material"
                           : fmt::format("the file has no material \"{}\"", clipped(name, 40)))
      .hint = known.empty() ? "[[material]], as in docs/manual/machine.md"
                            : guess(name, known, "known: " + list_text(known));
  return std::nullopt;
}

}  // namespace kerf
