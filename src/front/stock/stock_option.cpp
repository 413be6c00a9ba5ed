// Reads a stock told in words: first into words and lengths, then by the two forms that stock_files.h lists.
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <variant>
#include <vector>

#include "kerf/number.h"
#include "kerf/stock_files.h"

namespace kerf {
namespace {

constexpr std::size_t kLongest = 200;   // bytes; a stock takes far less
constexpr double kLargest = 100'000.0;  // mm; beyond any machine, and safe to compute with
constexpr std::string_view kExpected =
    "expected \"100x60x12 [at lower-left top]\" or \"0,0,-12 to 100,60,0\", lengths in mm or with \"in\"";

using Token = std::variant<double, std::string>;

bool begins_number(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '+' || c == '.';
}

/// "12", "12mm", "0.5in", "0.5\"" in mm.
std::optional<double> length_of(std::string_view text) {
  double scale = 1.0;
  const auto drop = [&text](std::string_view unit) {
    if (text.size() <= unit.size() || text.substr(text.size() - unit.size()) != unit) return false;
    text.remove_suffix(unit.size());
    return true;
  };
  if (drop("in") || drop("\"")) {
    scale = 25.4;
  } else {
    drop("mm");
  }
  const std::optional<double> value = parse_number(text);
  if (!value || std::abs(*value * scale) > kLargest) return std::nullopt;
  return *value * scale;
}

/// The x of "100 x 60 x 12": alone, or before a number.
bool stands_between(std::string_view text, std::size_t i) {
  return text[i] == 'x' && (i + 1 == text.size() || text[i + 1] == ' ' || begins_number(text[i + 1]));
}

/// Cuts at blanks and commas, and at the x between two lengths. Nothing where something that begins as a
/// number is none.
std::optional<std::vector<Token>> tokens_of(std::string_view text) {
  std::vector<Token> tokens;
  std::size_t i = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (c == ' ' || c == '\t' || c == ',' || stands_between(text, i)) {
      ++i;
      continue;
    }
    const bool number = begins_number(c);
    std::size_t end = i;
    while (end < text.size() && text[end] != ' ' && text[end] != '\t' && text[end] != ',' &&
           !(number && text[end] == 'x'))
      ++end;
    const std::string_view word = text.substr(i, end - i);
    i = end;
    if (!number) {
      tokens.emplace_back(std::string(word));
      continue;
    }
    if (i < text.size() && text[i] == 'x') ++i;
    const std::optional<double> length = length_of(word);
    if (!length) return std::nullopt;
    tokens.emplace_back(*length);
  }
  return tokens;
}

/// Walks the tokens; each `take` moves on only if it fits.
class Reader {
 public:
  explicit Reader(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

  bool at_end() const { return next_ == tokens_.size(); }
  bool take_word(std::string_view word) {
    const auto* told = at_end() ? nullptr : std::get_if<std::string>(&tokens_[next_]);
    if (told == nullptr || *told != word) return false;
    ++next_;
    return true;
  }
  std::optional<Point3> take_point() {
    Point3 point;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t i = next_ + static_cast<std::size_t>(axis);
      const auto* value = i < tokens_.size() ? std::get_if<double>(&tokens_[i]) : nullptr;
      if (value == nullptr) return std::nullopt;
      point[axis] = *value;
    }
    next_ += 3;
    return point;
  }
  /// A corner's name of one word or two ("centre left").
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

/// A stock, or why there is none.
using Answer = std::variant<Stock, std::string>;

Answer read_corners(Reader& reader, Point3 low) {
  const std::optional<Point3> high = reader.take_point();
  if (!high || !reader.at_end())
    return std::string("the highest corner x,y,z is missing or followed by more");
  Stock stock;
  stock.block.low = low;
  stock.block.high = *high;
  const Point3 size = stock.block.size();
  if (size.x > 0.0 && size.y > 0.0 && size.z > 0.0) return stock;
  return std::string("its highest corner must lie above its lowest in X, Y and Z");
}

Answer read_size(Reader& reader, Point3 size) {
  if (!(size.x > 0.0 && size.y > 0.0 && size.z > 0.0)) return std::string("each edge must be longer than 0");
  const bool told = reader.take_word("at") || reader.take_word("zero");
  const std::optional<ZeroCorner> corner = reader.take_corner();
  const std::optional<ZeroHeight> height = reader.take_height();
  if (told && !corner && !height) return std::string("the place of program zero is missing or not known");
  if (!reader.at_end()) return std::string("there is something behind it that is no place of program zero");
  return make_block(size, corner.value_or(ZeroCorner::lower_left), height.value_or(ZeroHeight::top));
}

Answer read(std::string_view text) {
  if (text.size() > kLongest) return std::string("it is too long");
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::optional<std::vector<Token>> tokens = tokens_of(lower);
  if (!tokens) return fmt::format("a length is not a number, or beyond {} mm", number_text(kLargest, 0));
  Reader reader(std::move(*tokens));
  const bool corners = reader.take_word("min");
  if (!corners) reader.take_word("block");
  const std::optional<Point3> first = reader.take_point();
  if (!first) return std::string("it does not begin with three lengths");
  if (reader.take_word("to") || reader.take_word("max")) return read_corners(reader, *first);
  if (corners) return std::string("\"max\" and the highest corner are missing");
  return read_size(reader, *first);
}

}  // namespace

std::optional<Stock> read_stock_option(std::string_view text, const Origin& where, Diagnostics& diagnostics) {
  Answer answer = read(text);
  if (auto* stock = std::get_if<Stock>(&answer)) return *stock;
  diagnostics
      .error(Code::stock_option, where,
             fmt::format("cannot understand the stock \"{}\": {}", text.substr(0, kLongest),
                         std::get<std::string>(answer)))
      .hint = kExpected;
  return std::nullopt;
}

}  // namespace kerf
