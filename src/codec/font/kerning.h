// The kerning of an OpenType font by its table GPOS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The feature "kern" for Latin text, of pairs of glyphs. Reads beyond the table give 0.
class PairKerning {
 public:
  explicit PairKerning(std::string table);
  /// Whether the font has that feature: its older table "kern" is then not used.
  bool exists() const { return !lookups_.empty(); }
  /// Added to the advance of the first glyph, in units of the font.
  double between(std::uint16_t first, std::uint16_t second) const;

 private:
  std::uint16_t u16(std::size_t at) const;
  std::uint32_t u32(std::size_t at) const { return std::uint32_t{u16(at)} << 16 | u16(at + 2); }
  bool is_tag(std::size_t at, std::string_view tag) const { return table_.compare(at, 4, tag) == 0; }
  std::size_t latin() const;
  std::optional<std::size_t> covered(std::size_t coverage, std::uint16_t glyph) const;
  std::uint16_t class_of(std::size_t classes, std::uint16_t glyph) const;
  std::optional<double> of_subtable(std::size_t at, std::uint16_t first, std::uint16_t second) const;
  double advance(std::size_t value, std::uint16_t format) const;

  std::string table_;
  std::vector<std::vector<std::size_t>> lookups_;  // the subtables of each
};

}  // namespace kerf
