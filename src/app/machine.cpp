// Reads GRBL's settings.
#include "app/machine.h"

#include <fmt/format.h>

#include "kerf/files.h"
#include "kerf/number.h"

namespace kerf::app {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;  // bytes; real ones have one or two thousand
constexpr double kFastest = 1e6;               // mm/min

/// The number behind "$110=" in a line, without what follows it.
std::string_view value_of(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos || line.find_first_not_of(" \t") != at) return {};
  line.remove_prefix(at + key.size());
  return line.substr(0, line.find_first_not_of("0123456789.+-eE"));
}

}  // namespace

std::optional<Machine> read_machine(const std::string& path, Diagnostics& diagnostics) {
  const auto file = InputFile::open(path, diagnostics, kLargestFile);
  if (!file) return std::nullopt;
  Machine machine;
  constexpr std::array<std::string_view, 3> kKeys{"$110=", "$111=", "$112="};
  std::array<bool, 3> seen{};
  std::string_view text = file->bytes();
  for (std::uint32_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view told = value_of(line, kKeys[axis]);
      if (told.empty()) continue;
      const auto value = parse_number(told);
      seen[axis] = value && *value > 0.0 && *value <= kFastest;
      if (seen[axis]) {
        machine.rapid[axis] = mm_per_min(*value);
        continue;
      }
      diagnostics.error(Code::machine_file, TextSpot{path, number, 1},
                        fmt::format("{} is no rate in mm/min above 0", told));
      return std::nullopt;
    }
  }
  if (seen[0] && seen[1] && seen[2]) return machine;
  diagnostics
      .error(Code::machine_file, TextSpot{path, 0, 0}, "expected GRBL's settings with $110=, $111= and $112=")
      .hint = "save what the controller answers to $$ (TOML profiles of machines are not read yet)";
  return std::nullopt;
}

}  // namespace kerf::app
