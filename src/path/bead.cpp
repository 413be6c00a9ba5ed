// The volume of a bead.
#include "path/bead.h"

#include <numbers>

#include "base/number.h"

namespace kerf {
namespace {

constexpr std::string_view kFilamentNote = "filament_diameter = ";
constexpr int kDecimals = 6;

}  // namespace

Volume bead_volume(Length length, Length width, Length height) {
  const double w = width.mm(), h = height.mm();
  return mm3(length.mm() * ((w - h) * h + std::numbers::pi / 4.0 * h * h));
}

std::string filament_note(Length diameter) {
  return std::string(kFilamentNote) + number_text(diameter.mm(), kDecimals);
}

std::optional<Length> read_filament_note(std::string_view text) {
  if (text.substr(0, kFilamentNote.size()) != kFilamentNote) return std::nullopt;
  const auto value = parse_number(text.substr(kFilamentNote.size()));
  return value && *value > 0.0 ? std::optional(mm(*value)) : std::nullopt;
}

Length filament_of_path(const Toolpath& path) {
  if (!path.has(StepKind::note)) return {};
  for (std::size_t i = 0; i < path.size(); ++i)
    if (path[i].kind() == StepKind::note)
      if (const auto diameter = read_filament_note(path.text(i))) return *diameter;
  return {};
}

}  // namespace kerf
