// Numbers to text and back: independent of the locale, never "-0", fixed rounding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// Appends `value` with at most `decimals` decimals, trailing zeros dropped ("12.5", "3", "-0.25", never
/// "-0").
void append_number(std::string& out, double value, int decimals);
/// Whether a negative number that rounds to zero keeps its sign ("-0.00", as C's printf writes it).
enum class MinusZero : std::uint8_t { drop, keep };
/// Appends `value` with exactly `decimals` decimals ("12.500"), rounded from the exact binary value.
void append_fixed(std::string& out, double value, int decimals, MinusZero zero = MinusZero::drop);
/// Buffer size for write_fixed, bytes.
inline constexpr std::size_t kFixedRoom = 40;
/// Writes what append_fixed(MinusZero::keep) appends to `out`, which has kFixedRoom bytes, and returns the
/// end; nullptr, with nothing written, for the rare numbers that this fast algorithm cannot round reliably.
char* write_fixed(char* out, double value, int decimals);
std::string number_text(double value, int decimals);
std::string fixed_text(double value, int decimals);
/// Shortest text that reads back as the same double.
std::string exact_text(double value);

/// Reads all of `text` as a decimal number ("1", "-.5", "+2.50", "1e-3"). Nothing if it is not one or not
/// finite. Works without floating from_chars, which WebAssembly's library lacks.
std::optional<double> parse_number(std::string_view text);

/// Reads a decimal number or a fraction: "0.5", "3/4", "1-1/2", "-3/4".
std::optional<double> parse_fraction(std::string_view text);

/// mm in a unit of length: "mm", or "in", "inch", "inches" or a double quote, in any case; nothing for other
/// words.
std::optional<double> mm_per_unit(std::string_view unit);
/// Reads "6.35", "0.25in", "1/4 inch", "1-1/2in" as mm; `scale`: mm per unit if the text has no unit.
std::optional<double> parse_length(std::string_view text, double scale);

/// The closest of `known` to `word` if it is close enough to be a typing error ("did you mean ...").
std::optional<std::string> did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace kerf
