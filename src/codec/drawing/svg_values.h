// Values of SVG attributes: numbers, lengths, transforms, colours, path data.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::svg {

struct Vec {
  double x = 0.0, y = 0.0;
};
struct Box {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};
/// x' = a x + c y + e, y' = b x + d y + f.
struct Affine {
  double a = 1.0, b = 0.0, c = 0.0, d = 1.0, e = 0.0, f = 0.0;
  Vec operator*(Vec p) const { return {a * p.x + c * p.y + e, b * p.x + d * p.y + f}; }
  Vec direction(Vec p) const { return {a * p.x + c * p.y, b * p.x + d * p.y}; }
  Affine operator*(const Affine& first) const;
};

/// Reads numbers from a text in which separators may be missing ("1-2.5.5e1").
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}
  std::size_t position() const { return at_; }
  /// Skips blanks, and at most one comma between them.
  void skip_separator();
  void skip_blanks();
  bool at_end();
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void next() { ++at_; }
  std::optional<double> number();
  /// A single 0 or 1.
  std::optional<bool> flag();
  /// Letters.
  std::string_view word();

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// A length with its unit in lower case; the unit is empty for user units.
struct UnitLength {
  double value = 0.0;
  std::string unit;
};
std::optional<UnitLength> read_length(std::string_view text);
/// Pixels of 1/96 inch in a unit of length; nothing for %, em and others that depend on something else.
std::optional<double> pixels_per(std::string_view unit);
/// mm in a unit other than pixels.
std::optional<double> mm_per(std::string_view unit);

/// The direction of a length, which decides what 100% is.
enum class Axis : unsigned char { x, y, both };
/// What relative lengths of an element refer to, in user units.
struct LengthBase {
  double width = 0.0, height = 0.0;            // of the viewport; 0: unknown
  double page_width = 0.0, page_height = 0.0;  // of the page; 0: unknown
  double em = 16.0, root_em = 16.0;
};
/// User units of a length; nothing where the unit is unknown, or depends on something unknown.
std::optional<double> resolved(const UnitLength& length, const LengthBase& base, Axis axis);
/// Whether a unit depends on the shapes of a font; `resolved` takes usual proportions.
bool depends_on_font(std::string_view unit);

/// What a unit is multiplied by, "" and "%" among them; nothing: it is not allowed.
using UnitFactor = std::function<std::optional<double>(std::string_view unit)>;
/// A number with a unit, or calc(). 0 needs no unit.
std::optional<double> css_value(std::string_view text, const UnitFactor& factor);

/// Numbers up to the first character that is part of none.
struct Numbers {
  std::vector<double> values;
  std::optional<std::size_t> error_at;
};
Numbers read_numbers(std::string_view text);
/// The transform from the coordinates of a viewBox (x, y, width, height) to a viewport of this size by the
/// value of preserveAspectRatio.
Affine fitted(const std::vector<double>& box, double width, double height, std::string_view aspect);

/// A command of path data with absolute coordinates. H, V, S and T are replaced by L, C and Q.
struct PathCommand {
  char kind = 'M';          // M, L, C, Q, A, Z
  std::array<Vec, 3> at{};  // M, L: the end; C: controls and end; Q: control and end; A: radii, end
  double turn = 0.0;        // of A: rotation of the axes, degrees
  bool is_large = false, is_sweep = false;
};
struct PathData {
  std::vector<PathCommand> commands;
  std::optional<std::size_t> error_at;  // of the first invalid character; the commands are those before it
  std::string_view expected;            // there: "a number"
};
PathData read_path(std::string_view text);

}  // namespace kerf::svg
