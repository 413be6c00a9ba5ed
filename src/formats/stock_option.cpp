// Reads a stock from text: first into words and lengths, then by the two forms listed in workshop_files.h.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/codes/stock.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/base/limits.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

constexpr std::string_view kExpected =
    "expected \"100x60x12 [at lower-left top]\" or \"0,0,-12 to 100,60,0\", in mm or with \"in\" after each "
    "length or the last one";

/// A length as given; its unit may follow a later one.
struct Number {
  double value = 0.0;
  double scale = 0.0;  // mm per unit; 0: no unit
  bool has_unit() const { return scale != 0.0; }
  bool is_bare() const { return !has_unit() && value != 0.0; }  // 0 needs no unit
};
using Token = std::variant<Number, std::string>;

bool starts_number(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '+' || c == '.';
}

/// "12", "12mm", "0.5in", "0.5\"".
std::optional<Number> number_of(std::string_view text) {
  Number number;
  const std::size_t end = text.find_last_of("0123456789.") + 1;
  if (end < text.size()) {
    const auto unit = mm_per_unit(text.substr(end));
    if (!unit) return std::nullopt;
    number.scale = *unit;
  }
  const std::optional<double> value = parse_fraction(text.substr(0, end));
  if (!value) return std::nullopt;
  number.value = *value;
  return number;
}

/// The x of "100 x 60 x 12": alone, or before a number.
bool is_times_sign(std::string_view text, std::size_t i) {
  return text[i] == 'x' && (i + 1 == text.size() || text[i + 1] == ' ' || starts_number(text[i + 1]));
}

/// Splits at blanks and commas, and at the x between two lengths. Nothing if a word that starts like a number
/// is not one.
std::optional<std::vector<Token>> tokens_of(std::string_view text) {
  std::vector<Token> tokens;
  std::size_t i = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (c == ' ' || c == '\t' || c == ',' || is_times_sign(text, i)) {
      ++i;
      continue;
    }
    const bool number = starts_number(c);
    std::size_t end = i;
    while (end < text.size() && text[end] != ' ' && text[end] != '\t' && text[end] != ',' &&
           !(number && text[end] == 'x'))
      ++end;
    const std::string_view word = text.substr(i, end - i);
    i = end;
    if (!number) {
      auto* before = tokens.empty() ? nullptr : std::get_if<Number>(&tokens.back());
      const auto unit = mm_per_unit(word);
      if (unit && before != nullptr && !before->has_unit()) {
        before->scale = *unit;
      } else {
        tokens.emplace_back(std::string(word));
      }
      continue;
    }
    if (i < text.size() && text[i] == 'x') ++i;
    const std::optional<Number> length = number_of(word);
    if (!length) return std::nullopt;
    tokens.emplace_back(*length);
  }
  return tokens;
}

using Triple = std::array<Number, 3>;

bool has_unit(std::span<const Number> numbers) {
  return std::any_of(numbers.begin(), numbers.end(), [](const Number& n) { return n.has_unit(); });
}
bool has_bare(std::span<const Number> numbers) {
  return std::any_of(numbers.begin(), numbers.end(), [](const Number& n) { return n.is_bare(); });
}

/// Sets the unit of lengths without one: that of the last length if only that has one ("40x30x10in"), mm if
/// none has one. False if only some have one, which is ambiguous.
bool assign_units(std::span<Number> numbers) {
  const bool unit_before_last = has_unit(numbers.first(numbers.size() - 1));
  const double last = numbers.back().scale;
  if (has_bare(numbers) && unit_before_last) return false;
  for (Number& number : numbers)
    if (!number.has_unit()) number.scale = last != 0.0 ? last : 1.0;
  return true;
}

Point3 point_of(const Triple& triple) {
  return {triple[0].value * triple[0].scale, triple[1].value * triple[1].scale,
          triple[2].value * triple[2].scale};
}

constexpr std::string_view kMixedUnits =
    "some of its lengths have no unit; a single unit after the last length applies to all";

/// Reads the tokens in order; each `take` consumes tokens only if they match.
class TokenReader {
 public:
  explicit TokenReader(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

  bool at_end() const { return next_ == tokens_.size(); }
  bool take_word(std::string_view word) {
    const auto* given = at_end() ? nullptr : std::get_if<std::string>(&tokens_[next_]);
    if (given == nullptr || *given != word) return false;
    ++next_;
    return true;
  }
  std::optional<Triple> take_triple() {
    Triple triple;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto* number =
          next_ + axis < tokens_.size() ? std::get_if<Number>(&tokens_[next_ + axis]) : nullptr;
      if (number == nullptr) return std::nullopt;
      triple[axis] = *number;
    }
    next_ += 3;
    return triple;
  }
  /// The name of a corner, of one word or two ("centre left").
  std::optional<ZeroCorner> take_corner() {
    for (const std::size_t words : {std::size_t{2}, std::size_t{1}}) {
      std::string name;
      for (std::size_t k = 0; k < words && next_ + k < tokens_.size(); ++k)
        if (const auto* word = std::get_if<std::string>(&tokens_[next_ + k]))
          name += (k > 0 ? " " : "") + *word;
      const std::optional<ZeroCorner> corner = parse_zero_corner(name);
      if (!corner || next_ + words > tokens_.size()) continue;
      next_ += words;
      return corner;
    }
    return std::nullopt;
  }
  std::optional<ZeroHeight> take_height() {
    const auto* word = at_end() ? nullptr : std::get_if<std::string>(&tokens_[next_]);
    const std::optional<ZeroHeight> height = word != nullptr ? parse_zero_height(*word) : std::nullopt;
    if (height) ++next_;
    return height;
  }

 private:
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
};

/// A stock, or an error message.
using Answer = std::variant<Stock, std::string>;

std::string too_far() {
  return fmt::format("a length is beyond {} mm", number_text(limits::kMaxStockSize, 0));
}

bool within_reach(Point3 p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= limits::kMaxStockSize;
}

Answer read_corners(TokenReader& reader, const Triple& first) {
  const std::optional<Triple> second = reader.take_triple();
  if (!second || !reader.at_end())
    return std::string("the upper corner x,y,z is missing, or followed by other text");
  std::array<Number, 6> all;
  std::copy(second->begin(), second->end(), std::copy(first.begin(), first.end(), all.begin()));
  const std::span<Number> low(all.data(), 3), high(all.data() + 3, 3);
  // A unit in each corner, or one after the second for both.
  const bool fine = has_unit(low)
                        ? (has_unit(high) || !has_bare(high)) && assign_units(low) && assign_units(high)
                        : assign_units(all);
  if (!fine) return std::string(kMixedUnits);
  Stock stock;
  stock.block.low = point_of({all[0], all[1], all[2]});
  stock.block.high = point_of({all[3], all[4], all[5]});
  if (!within_reach(stock.block.low) || !within_reach(stock.block.high)) return too_far();
  const Point3 size = stock.block.size();
  if (size.x > 0.0 && size.y > 0.0 && size.z > 0.0) return stock;
  return std::string("its upper corner must lie above its lower corner in X, Y and Z");
}

std::string known_positions() {
  return fmt::format("known: {}, each with {} or {}", list_text(zero_corner_names()), zero_height_names()[0],
                     zero_height_names()[1]);
}

Answer read_size(TokenReader& reader, Triple lengths) {
  if (!assign_units(lengths)) return std::string(kMixedUnits);
  const Point3 size = point_of(lengths);
  if (!within_reach(size)) return too_far();
  if (!(size.x > 0.0 && size.y > 0.0 && size.z > 0.0)) return std::string("each edge must be longer than 0");
  const bool named = reader.take_word("at") || reader.take_word("zero");
  const std::optional<ZeroCorner> corner = reader.take_corner();
  const std::optional<ZeroHeight> height = reader.take_height();
  if (named && !corner && !height)
    return "the position of work zero is missing or unknown; " + known_positions();
  if (!reader.at_end()) return "the text after it is not a position of work zero; " + known_positions();
  return make_block(size, corner.value_or(ZeroCorner::lower_left), height.value_or(ZeroHeight::top));
}

Answer read(std::string_view text) {
  if (text.size() > limits::kMaxStockOptionBytes) return std::string("it is too long");
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::optional<std::vector<Token>> tokens = tokens_of(lower);
  if (!tokens) return std::string("a length is not a number, or its unit is neither mm nor in");
  TokenReader reader(std::move(*tokens));
  const bool corners = reader.take_word("min");
  if (!corners) reader.take_word("block");
  const std::optional<Triple> first = reader.take_triple();
  if (!first) return std::string("it does not start with three lengths");
  if (reader.take_word("to") || reader.take_word("max")) return read_corners(reader, *first);
  if (corners) return std::string("\"max\" and the upper corner are missing");
  return read_size(reader, *first);
}

}  // namespace

std::optional<Stock> read_stock_option(std::string_view text, const Origin& where, Diagnostics& diagnostics) {
  Answer answer = read(text);
  if (auto* stock = std::get_if<Stock>(&answer)) return *stock;
  diagnostics
      .error(codes::stock_option, where,
             fmt::format("invalid stock \"{}\": {}", text.substr(0, limits::kMaxStockOptionBytes),
                         std::get<std::string>(answer)))
      .hint = kExpected;
  return std::nullopt;
}

}  // namespace kerf
