// Reads pairs of glyphs from GPOS, by the OpenType specification.
#include "codec/font/kerning.h"

#include <algorithm>
#include <bit>

namespace kerf {

std::uint16_t PairKerning::u16(std::size_t at) const {
  if (at + 2 > table_.size()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(table_[i]); };
  return static_cast<std::uint16_t>(byte(at) << 8 | byte(at + 1));
}

/// The default language of the script "latn", else "DFLT"; 0 if there is none.
std::size_t PairKerning::latin() const {
  const std::size_t scripts = u16(4);
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < u16(scripts); ++i) {
    const std::size_t record = scripts + 2 + 6 * i;
    if (record + 6 > table_.size()) break;
    if (is_tag(record, "latn") || (chosen == 0 && is_tag(record, "DFLT"))) chosen = scripts + u16(record + 4);
  }
  return chosen == 0 || u16(chosen) == 0 ? 0 : chosen + u16(chosen);
}

PairKerning::PairKerning(std::string table) : table_(std::move(table)) {
  constexpr std::uint16_t kPairs = 2, kExtension = 9;
  std::size_t left = 10'000;  // subtables of all lookups; fonts have some dozens
  const std::size_t language = table_.size() < 10 ? 0 : latin(), features = u16(6), all = u16(8);
  if (language == 0) return;
  for (std::size_t i = 0; i < u16(language + 4); ++i) {
    const std::size_t record = features + 2 + 6 * std::size_t{u16(language + 6 + 2 * i)};
    if (record + 6 > table_.size() || !is_tag(record, "kern")) continue;
    const std::size_t feature = features + u16(record + 4);
    for (std::size_t k = 0; k < u16(feature + 2) && left > 0; ++k) {
      --left;
      const std::size_t lookup = all + u16(all + 2 + 2 * std::size_t{u16(feature + 4 + 2 * k)});
      std::vector<std::size_t> subtables;
      for (std::size_t s = 0; s < u16(lookup + 4) && left > 0; ++s) {
        --left;
        std::size_t at = lookup + u16(lookup + 6 + 2 * s);
        std::uint16_t type = u16(lookup);
        if (type == kExtension) {
          type = u16(at + 2);
          at += u32(at + 4);
        }
        if (type == kPairs) subtables.push_back(at);
      }
      if (!subtables.empty()) lookups_.push_back(std::move(subtables));
    }
  }
}

/// The number of a glyph in a coverage table.
std::optional<std::size_t> PairKerning::covered(std::size_t coverage, std::uint16_t glyph) const {
  const bool is_list = u16(coverage) == 1;
  const std::size_t width = is_list ? 2 : 6;
  std::size_t low = 0, high = u16(coverage + 2);
  while (low < high) {
    const std::size_t mid = (low + high) / 2, at = coverage + 4 + width * mid;
    const std::uint16_t first = u16(at), last = is_list ? first : u16(at + 2);
    if (glyph < first)
      high = mid;
    else if (glyph > last)
      low = mid + 1;
    else
      return is_list ? mid : std::size_t{u16(at + 4)} + (glyph - first);
  }
  return std::nullopt;
}

std::uint16_t PairKerning::class_of(std::size_t classes, std::uint16_t glyph) const {
  if (u16(classes) == 1) {
    const std::uint16_t first = u16(classes + 2);
    return glyph >= first && glyph - first < u16(classes + 4)
               ? u16(classes + 6 + 2 * static_cast<std::size_t>(glyph - first))
               : std::uint16_t{0};
  }
  std::size_t low = 0, high = u16(classes + 2);
  while (low < high) {
    const std::size_t mid = (low + high) / 2, at = classes + 4 + 6 * mid;
    if (glyph < u16(at))
      high = mid;
    else if (glyph > u16(at + 2))
      low = mid + 1;
    else
      return u16(at + 4);
  }
  return 0;
}

/// The change of the advance in a value record.
double PairKerning::advance(std::size_t value, std::uint16_t format) const {
  constexpr std::uint16_t kPlacement = 3, kAdvance = 4;
  if ((format & kAdvance) == 0) return 0.0;
  const auto before = static_cast<std::size_t>(std::popcount(static_cast<unsigned>(format & kPlacement)));
  return static_cast<std::int16_t>(u16(value + 2 * before));
}

/// Nothing if the subtable says nothing of the pair.
std::optional<double> PairKerning::of_subtable(std::size_t at, std::uint16_t first,
                                               std::uint16_t second) const {
  const auto index = covered(at + u16(at + 2), first);
  if (!index) return std::nullopt;
  const std::uint16_t one = u16(at + 4), two = u16(at + 6);
  const auto size = [](std::uint16_t format) {
    return 2 * static_cast<std::size_t>(std::popcount(static_cast<unsigned>(format)));
  };
  const std::size_t values = size(one) + size(two);
  if (u16(at) == 2) {
    const std::size_t a = class_of(at + u16(at + 8), first), b = class_of(at + u16(at + 10), second);
    if (a >= u16(at + 12) || b >= u16(at + 14)) return std::nullopt;
    return advance(at + 16 + values * (a * u16(at + 14) + b), one);
  }
  if (u16(at) != 1 || *index >= u16(at + 8)) return std::nullopt;
  const std::size_t set = at + u16(at + 10 + 2 * *index), width = 2 + values;
  std::size_t low = 0, high = u16(set);
  while (low < high) {
    const std::size_t mid = (low + high) / 2, record = set + 2 + width * mid;
    if (second < u16(record))
      high = mid;
    else if (second > u16(record))
      low = mid + 1;
    else
      return advance(record + 2, one);
  }
  return std::nullopt;
}

double PairKerning::between(std::uint16_t first, std::uint16_t second) const {
  double sum = 0.0;
  for (const std::vector<std::size_t>& subtables : lookups_) {
    for (const std::size_t at : subtables) {
      if (const auto value = of_subtable(at, first, second)) {
        sum += *value;
        break;
      }
    }
  }
  return sum;
}

}  // namespace kerf
