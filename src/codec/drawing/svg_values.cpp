// Reads values of SVG attributes.
#if KERF_WITH_SVG
#include "codec/drawing/svg_values.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "base/names.h"
#include "base/number.h"

#include "kerf/base/units.h"

namespace kerf::svg {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPixelsPerInch = 96.0;  // CSS Values and Units, section 6.2

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
std::string lowered(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), lower);
  return out;
}

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

std::optional<std::vector<double>> read_numbers(std::string_view text) {
  Scanner scanner(text);
  std::vector<double> out;
  scanner.skip_blanks();
  while (!scanner.at_end()) {
    const auto value = scanner.number();
    if (!value) return std::nullopt;
    out.push_back(*value);
    scanner.skip_separator();
  }
  return out;
}

// -------------------------------------------------------------------------------------------------
// transforms

namespace {

std::optional<Affine> transform_of(std::string_view name, const std::vector<double>& v) {
  const std::size_t n = v.size();
  const auto turned = [](double degrees) {
    const double angle = degrees * kPi / 180.0;
    return Affine{std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), 0.0, 0.0};
  };
  if (name == "matrix" && n == 6) return Affine{v[0], v[1], v[2], v[3], v[4], v[5]};
  if (name == "translate" && (n == 1 || n == 2)) return Affine{1, 0, 0, 1, v[0], n == 2 ? v[1] : 0.0};
  if (name == "scale" && (n == 1 || n == 2)) return Affine{v[0], 0, 0, n == 2 ? v[1] : v[0], 0, 0};
  if (name == "rotate" && n == 1) return turned(v[0]);
  if (name == "rotate" && n == 3)
    return Affine{1, 0, 0, 1, v[1], v[2]} * turned(v[0]) * Affine{1, 0, 0, 1, -v[1], -v[2]};
  if (name == "skewX" && n == 1) return Affine{1, 0, std::tan(v[0] * kPi / 180.0), 1, 0, 0};
  if (name == "skewY" && n == 1) return Affine{1, std::tan(v[0] * kPi / 180.0), 0, 1, 0, 0};
  return std::nullopt;
}

}  // namespace

std::optional<Affine> read_transform(std::string_view text) {
  Affine out;
  text = trim(text);
  while (!text.empty()) {
    const std::size_t open = text.find('('), close = text.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
      return std::nullopt;
    const auto values = read_numbers(trim(text.substr(open + 1, close - open - 1)));
    const auto next = values ? transform_of(trim(text.substr(0, open)), *values) : std::nullopt;
    if (!next) return std::nullopt;
    out = out * *next;
    text.remove_prefix(close + 1);
    while (!text.empty() && (is_blank(text.front()) || text.front() == ',')) text.remove_prefix(1);
  }
  return out;
}

// ----------------------------------------------------------------------------------------------------
// colours

std::string colour_name(std::string_view text) {
  std::string name = lowered(trim(text));
  if (name.size() == 4 && name[0] == '#') return {'#', name[1], name[1], name[2], name[2], name[3], name[3]};
  if (name.rfind("rgb(", 0) == 0 && name.back() == ')') {
    const auto parts = read_numbers(std::string_view(name).substr(4, name.size() - 5));
    const auto is_byte = [](double v) { return v >= 0.0 && v <= 255.0; };
    if (parts && parts->size() == 3 && std::all_of(parts->begin(), parts->end(), is_byte))
      return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>((*parts)[0]), static_cast<int>((*parts)[1]),
                         static_cast<int>((*parts)[2]));
  }
  return name;
}

// -------------------------------------------------------------------------------------------------- path
// data

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
  return scanner_.number();
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
  scanner_.skip_separator();
  const auto is_large = scanner_.flag();
  scanner_.skip_separator();
  const auto is_sweep = is_large ? scanner_.flag() : std::nullopt;
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
  if (std::string_view("MLHVCSQTA").find(kind) == std::string_view::npos) return false;
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
    if (!is_letter(letter) || (is_first && letter != 'M' && letter != 'm')) {
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
