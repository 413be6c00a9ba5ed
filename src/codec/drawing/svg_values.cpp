// Reads values of SVG attributes.
#if KERF_WITH_SVG
#include "codec/drawing/svg_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/formula.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/drawing/colour_names.h"

#include "kerf/base/units.h"

namespace kerf::svg {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPixelsPerInch = 96.0;  // CSS Values and Units, section 6.2

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

// ----------------------------------------------------------------------------------------------------
// numbers

Affine Affine::operator*(const Affine& first) const {
  return {a * first.a + c * first.b, b * first.a + d * first.b,     a * first.c + c * first.d,
          b * first.c + d * first.d, a * first.e + c * first.f + e, b * first.e + d * first.f + f};
}

void Scanner::skip_blanks() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}
void Scanner::skip_separator() {
  skip_blanks();
  if (peek() != ',') return;
  ++at_;
  skip_blanks();
}
bool Scanner::at_end() {
  skip_blanks();
  return at_ >= text_.size();
}

std::optional<double> Scanner::number() {
  std::size_t end = at_;
  const auto peek_at = [&](std::size_t i) { return i < text_.size() ? text_[i] : '\0'; };
  const auto digits = [&] {
    while (is_digit(peek_at(end))) ++end;
  };
  if (peek_at(end) == '+' || peek_at(end) == '-') ++end;
  digits();
  if (peek_at(end) == '.') {
    ++end;
    digits();
  }
  if (peek_at(end) == 'e' || peek_at(end) == 'E') {
    std::size_t digit = end + 1;
    if (peek_at(digit) == '+' || peek_at(digit) == '-') ++digit;
    if (is_digit(peek_at(digit))) {
      end = digit;
      digits();
    }
  }
  std::string_view text = text_.substr(at_, end - at_);
  if (!text.empty() && text.back() == '.') text.remove_suffix(1);
  const auto value = parse_number(text);
  if (value) at_ = end;
  return value;
}

std::optional<bool> Scanner::flag() {
  const char c = peek();
  if (c != '0' && c != '1') return std::nullopt;
  ++at_;
  return c == '1';
}

std::string_view Scanner::word() {
  const std::size_t first = at_;
  while (is_letter(peek())) ++at_;
  return text_.substr(first, at_ - first);
}

std::optional<UnitLength> read_length(std::string_view text) {
  Scanner scanner(trim(text));
  const auto value = scanner.number();
  if (!value) return std::nullopt;
  UnitLength out{*value, lowered(scanner.word())};
  if (out.unit.empty() && scanner.peek() == '%') {
    scanner.next();
    out.unit = "%";
  }
  if (!scanner.at_end()) return std::nullopt;
  return out;
}

std::optional<double> mm_per(std::string_view unit) {
  if (unit == "mm") return 1.0;
  if (unit == "cm") return 10.0;
  if (unit == "q") return 0.25;
  if (unit == "in") return kMmPerInch;
  if (unit == "pt") return kMmPerInch / 72.0;
  if (unit == "pc") return kMmPerInch / 6.0;
  return std::nullopt;
}

std::optional<double> pixels_per(std::string_view unit) {
  if (unit.empty() || unit == "px") return 1.0;
  const auto size = mm_per(unit);
  return size ? std::optional(*size * kPixelsPerInch / kMmPerInch) : std::nullopt;
}

bool depends_on_font(std::string_view unit) {
  return unit == "ex" || unit == "ch" || unit == "cap" || unit == "ic" || unit == "lh" || unit == "rlh";
}

std::optional<double> resolved(const UnitLength& length, const LengthBase& base, Axis axis) {
  const std::string& unit = length.unit;
  const auto relative = [&](double whole) -> std::optional<double> {
    return whole > 0.0 ? std::optional(0.01 * length.value * whole) : std::nullopt;
  };
  if (const auto scale = pixels_per(unit)) return length.value * *scale;
  if (unit == "em" || unit == "ic") return length.value * base.em;
  if (unit == "rem") return length.value * base.root_em;
  if (unit == "ex" || unit == "ch") return 0.5 * length.value * base.em;
  if (unit == "cap") return 0.7 * length.value * base.em;
  if (unit == "lh") return 1.2 * length.value * base.em;
  if (unit == "rlh") return 1.2 * length.value * base.root_em;
  if (unit == "vw" || unit == "vi") return relative(base.page_width);
  if (unit == "vh" || unit == "vb") return relative(base.page_height);
  if (unit == "vmin") return relative(std::min(base.page_width, base.page_height));
  if (unit == "vmax") return relative(std::max(base.page_width, base.page_height));
  if (unit != "%") return std::nullopt;
  if (axis == Axis::x) return relative(base.width);
  if (axis == Axis::y) return relative(base.height);
  return relative(std::sqrt(0.5 * (base.width * base.width + base.height * base.height)));
}

std::optional<double> css_value(std::string_view text, const UnitFactor& factor) {
  text = trim(text);
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos) {
    const auto plain = read_length(text);
    const auto scale = plain ? factor(plain->unit) : std::nullopt;
    if (scale) return plain->value * *scale;
    return plain && plain->value == 0.0 && plain->unit.empty() ? std::optional(0.0) : std::nullopt;
  }
  if (lowered(text.substr(0, open)) != "calc" || text.back() != ')') return std::nullopt;
  std::string formula = lowered(text.substr(open));
  for (std::size_t at; (at = formula.find("calc(")) != std::string::npos;) formula.erase(at, 4);
  FormulaWords words;
  words.unit = factor;
  FormulaFault fault;
  return evaluate_formula(formula, words, fault);
}

Numbers read_numbers(std::string_view text) {
  Scanner scanner(text);
  Numbers out;
  while (!scanner.at_end()) {
    const auto value = scanner.number();
    if (!value) {
      out.error_at = scanner.position();
      break;
    }
    out.values.push_back(*value);
    scanner.skip_separator();
  }
  return out;
}

Affine fitted(const std::vector<double>& box, double width, double height, std::string_view aspect) {
  double x = width / box[2], y = height / box[3];
  Scanner scanner(aspect);
  scanner.skip_blanks();
  std::string_view align = scanner.word();
  scanner.skip_blanks();
  const std::string_view fit = scanner.word();
  if (align == "none") return {x, 0, 0, y, -x * box[0], -y * box[1]};
  constexpr std::string_view kSides = "MinMidMax";
  const auto side = [&](std::size_t at, char axis) {
    if (align.size() != 8 || align[at] != axis) return std::string_view::npos;
    return kSides.find(align.substr(at + 1, 3));
  };
  std::size_t side_x = side(0, 'x'), side_y = side(4, 'Y');
  const bool is_valid =
      side_x % 3 == 0 && side_y % 3 == 0 && (fit.empty() || fit == "meet" || fit == "slice") &&
      side_x != std::string_view::npos && side_y != std::string_view::npos && scanner.at_end();
  if (!is_valid) side_x = side_y = 3;  // half of the free space
  x = y = is_valid && fit == "slice" ? std::max(x, y) : std::min(x, y);
  const auto before = [](std::size_t at, double free) { return static_cast<double>(at) / 6.0 * free; };
  return {x,
          0,
          0,
          y,
          before(side_x, width - x * box[2]) - x * box[0],
          before(side_y, height - y * box[3]) - y * box[1]};
}

// -----------------------------------------------------------------------------------------------------
// path data

namespace {

/// Reads path data (SVG 2, section 9.3).
class PathReader {
 public:
  explicit PathReader(std::string_view text) : scanner_(text) {}
  PathData read();

 private:
  bool command(char letter);
  bool arguments(char kind);
  bool arc();
  std::optional<double> value();
  std::optional<bool> flag();
  std::optional<Vec> point();
  void add(char kind, Vec a, Vec b = {}, Vec c = {});
  Vec reflected() const { return {2 * at_.x - control_.x, 2 * at_.y - control_.y}; }

  Scanner scanner_;
  PathData out_;
  bool is_relative_ = false;
  Vec at_, start_, control_;
  char previous_ = '\0';
};

std::optional<double> PathReader::value() {
  scanner_.skip_separator();
  out_.expected = "a number";
  return scanner_.number();
}

std::optional<bool> PathReader::flag() {
  scanner_.skip_separator();
  out_.expected = "a flag, 0 or 1,";
  return scanner_.flag();
}

std::optional<Vec> PathReader::point() {
  const auto x = value();
  const auto y = x ? value() : std::nullopt;
  if (!y) return std::nullopt;
  return is_relative_ ? Vec{at_.x + *x, at_.y + *y} : Vec{*x, *y};
}

/// Appends a command; the last of its points is the current one from here on.
void PathReader::add(char kind, Vec a, Vec b, Vec c) {
  PathCommand command;
  command.kind = kind;
  command.at = {a, b, c};
  out_.commands.push_back(command);
  at_ = kind == 'C' ? c : kind == 'Q' ? b : a;
  control_ = kind == 'C' ? b : kind == 'Q' ? a : at_;
}

bool PathReader::arc() {
  const auto rx = value();
  const auto ry = rx ? value() : std::nullopt;
  const auto turn = ry ? value() : std::nullopt;
  if (!turn) return false;
  const auto is_large = flag();
  const auto is_sweep = is_large ? flag() : std::nullopt;
  const auto end = is_sweep ? point() : std::nullopt;
  if (!end) return false;
  PathCommand command;
  command.kind = 'A';
  command.at = {Vec{std::abs(*rx), std::abs(*ry)}, *end, Vec{}};
  command.turn = *turn;
  command.is_large = *is_large;
  command.is_sweep = *is_sweep;
  out_.commands.push_back(command);
  at_ = control_ = *end;
  return true;
}

/// One set of arguments of a command, given by its capital letter.
bool PathReader::arguments(char kind) {
  const Vec base = is_relative_ ? at_ : Vec{};
  if (kind == 'A') return arc();
  if (kind == 'H' || kind == 'V') {
    const auto v = value();
    if (v) add('L', kind == 'H' ? Vec{base.x + *v, at_.y} : Vec{at_.x, base.y + *v});
    return v.has_value();
  }
  const bool is_smooth = kind == 'S' || kind == 'T';
  const bool continues = kind == 'S' ? previous_ == 'C' : previous_ == 'Q';
  const Vec mirrored = is_smooth && continues ? reflected() : at_;
  const auto a = point();
  const auto b = a && (kind == 'C' || kind == 'S' || kind == 'Q') ? point() : a;
  const auto c = b && kind == 'C' ? point() : b;
  if (!c) return false;
  if (kind == 'C') add('C', *a, *b, *c);
  if (kind == 'S') add('C', mirrored, *a, *b);
  if (kind == 'Q') add('Q', *a, *b);
  if (kind == 'T') add('Q', mirrored, *a);
  if (kind == 'M' || kind == 'L') add(kind, *a);
  if (kind == 'M') start_ = *a;
  return true;
}

bool PathReader::command(char letter) {
  const char kind = letter >= 'a' ? static_cast<char>(letter - 'a' + 'A') : letter;
  is_relative_ = letter >= 'a';
  if (kind == 'Z') {
    add('Z', start_);
    previous_ = 'Z';
    return true;
  }
  char repeated = kind;
  do {
    if (!arguments(repeated)) return false;
    previous_ = kind == 'S' ? 'C' : kind == 'T' ? 'Q' : kind;
    if (kind == 'M') repeated = 'L';  // further points of a moveto are lines
    scanner_.skip_separator();
  } while (!scanner_.at_end() && !is_letter(scanner_.peek()));
  return true;
}

PathData PathReader::read() {
  while (!scanner_.at_end()) {
    const char letter = scanner_.peek();
    const bool is_first = out_.commands.empty();
    out_.expected = is_first ? "the command M or m" : "a command";
    if (std::string_view("MmZzLlHhVvCcSsQqTtAa").find(letter) == std::string_view::npos ||
        (is_first && letter != 'M' && letter != 'm')) {
      out_.error_at = scanner_.position();
      break;
    }
    scanner_.next();
    if (!command(letter)) {
      out_.error_at = scanner_.position();
      break;
    }
  }
  return std::move(out_);
}

}  // namespace

PathData read_path(std::string_view text) { return PathReader(text).read(); }

}  // namespace kerf::svg
#endif
