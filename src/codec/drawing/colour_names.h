// Colours of CSS, in all their forms.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::svg {

struct Colour {
  std::array<std::uint8_t, 3> rgb{};
  double alpha = 1.0;
};
/// "red", "#f00", "#ff0000ff", "rgb(100%, 0, 0)", "hsl(0 100% 50% / 1)", "transparent"; nothing for others.
std::optional<Colour> read_colour(std::string_view text);
/// With ASCII letters in lower case.
std::string lowered(std::string_view text);
/// "#ff0000"
std::string name_of(const Colour& colour);

}  // namespace kerf::svg
