// Reads CutViewer's tool comments in the variants of real programs: odd spacing, two decimals, fields left
// 0.
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/tools.h"
#include "base/names.h"
#include "base/number.h"
#include "tool/silhouette.h"

#include "kerf/tool/tool.h"

namespace kerf {
namespace {

constexpr double kPrinted = 0.01;           // mm: half of "3.17" is printed as "1.59"
constexpr double kMaxRoundedTip = 0.2;      // mm: programs write a pointed V as a ball of 0.10 mm on a cone
constexpr double kUsualVeeDiameter = 12.7;  // mm: if a V has neither height nor diameter
constexpr double kQuarter = 0.5 * std::numbers::pi;

/// The numbers of a comment after its word.
struct Fields {
  std::array<double, 6> values{};
  std::size_t count = 0;
};

class CommentReader {
 public:
  CommentReader(std::string_view comment, double scale, const Origin& where, Diagnostics& diagnostics)
      : comment_(comment), scale_(scale), where_(where), diagnostics_(diagnostics) {}

  std::optional<ToolShape> read();

 private:
  std::nullopt_t malformed(const std::string& why) {
    diagnostics_.error(codes::tool_comment_malformed, where_, fmt::format("tool comment: {}", why));
    return std::nullopt;
  }
  std::nullopt_t unusable(const std::string& why) {
    diagnostics_.warning(codes::tool_comment_unusable, where_, fmt::format("tool comment ignored: {}", why));
    return std::nullopt;
  }
  /// Reads `min_count` to `max_count` numbers; false after an error.
  bool numbers(std::string_view word, std::string_view list, std::size_t min_count, std::size_t max_count);
  double length(std::size_t i) const { return scale_ * fields_.values[i]; }
  double angle(std::size_t i) const { return fields_.values[i] * std::numbers::pi / 180.0; }

  std::optional<ToolShape> mill(std::string_view list);
  std::optional<ToolShape> tapered_mill(double diameter, double corner, double height, double taper);
  std::optional<ToolShape> corner_mill(std::string_view list);
  std::optional<ToolShape> chamfer(std::string_view list);
  std::optional<ToolShape> drill(std::string_view list);
  std::optional<ToolShape> centre_drill(std::string_view list);
  /// Whether an angle field is valid for a cone: above `low`, below `high` degrees.
  bool angle_fits(std::size_t i, double low, double high);

  std::string_view comment_;
  double scale_;
  const Origin& where_;
  Diagnostics& diagnostics_;
  Fields fields_;
};

/// Removes and returns the next field of a comma-separated list.
std::string_view next_field(std::string_view& list) {
  const std::size_t comma = list.find(',');
  const std::string_view field = trim(list.substr(0, comma));
  list = comma == std::string_view::npos ? std::string_view() : list.substr(comma + 1);
  return field;
}

bool CommentReader::numbers(std::string_view word, std::string_view list, std::size_t min_count,
                            std::size_t max_count) {
  fields_ = {};
  while (!trim(list).empty() && fields_.count < max_count) {
    const std::string_view field = next_field(list);
    if (fold_name(field) == "color" || fold_name(field) == "colour") break;
    const std::optional<double> value = parse_number(field);
    if (!value || std::abs(*value * scale_) > 1e6) {
      malformed(fmt::format("expected a number after TOOL/{}, found \"{}\"", word, field.substr(0, 40)));
      return false;
    }
    fields_.values[fields_.count++] = *value;
  }
  if (fields_.count >= min_count) return true;
  malformed(fmt::format("TOOL/{} needs {} numbers, found {}", word, min_count, fields_.count));
  return false;
}

bool CommentReader::angle_fits(std::size_t i, double low, double high) {
  const double value = fields_.values[i];
  if (value > low && value < high) return true;
  malformed(fmt::format("an angle of {} degrees; expected one between {} and {}", number_text(value, 4), low,
                        high));
  return false;
}

std::optional<ToolShape> CommentReader::mill(std::string_view list) {
  if (!numbers("MILL", list, 3, 4)) return std::nullopt;
  const double diameter = length(0);
  const double corner = length(1);
  const double height = length(2);
  const double taper = angle(3);  // 0 where not given
  if (diameter < 0.0 || height < 0.0) return malformed("a negative diameter or height");
  if (corner < 0.0) {
    return malformed(
        "a ball controlled at its centre (negative corner radius) is not supported; "
        "write the program for the tip with a positive radius");
  }
  if (corner > 0.5 * diameter + kPrinted) {
    return unusable(fmt::format("a corner radius of {} mm is more than half the diameter of {} mm",
                                number_text(corner, 4), number_text(diameter, 4)));
  }
  if (taper != 0.0) {
    if (!angle_fits(3, 0.0, 89.5)) return std::nullopt;
    return tapered_mill(diameter, corner, height, taper);
  }
  if (diameter == 0.0) return unusable("a diameter of 0 and no taper");
  if (corner == 0.0) return shape::Square{mm(diameter), mm(height)};
  if (corner >= 0.5 * diameter - std::min(kPrinted, 0.1 * diameter))
    return shape::Ball{mm(diameter), mm(height)};
  return shape::BullNose{mm(diameter), mm(height), mm(corner)};
}

/// The diameter is that of the tip. A corner radius is tangent to the flat of the tip and to the cone; at
/// half the diameter it is a ball.
std::optional<ToolShape> CommentReader::tapered_mill(double diameter, double corner, double height,
                                                     double taper) {
  const bool ball = corner > 0.0 && corner >= 0.5 * diameter - std::min(kPrinted, 0.1 * diameter);
  if (ball) corner = 0.5 * diameter;
  const double flat = 0.5 * diameter - corner;
  const double tangent_r = flat + corner * std::cos(taper);
  const double tangent_z = corner * (1.0 - std::sin(taper));
  if (height == 0.0)
    height = tangent_z + std::max(0.5 * kUsualVeeDiameter - tangent_r, tangent_r) / std::tan(taper);
  if (height <= tangent_z) return unusable("the height ends below the cone");
  const Length widest = mm(2.0 * (tangent_r + (height - tangent_z) * std::tan(taper)));
  const Angle included = radians(2.0 * taper);
  if (corner == 0.0) return shape::Vee{widest, mm(height), included, mm(diameter), Length()};
  if (ball && diameter <= kMaxRoundedTip)
    return shape::Vee{widest, mm(height), included, Length(), mm(corner)};
  if (ball) return shape::TaperedBall{widest, mm(height), included, mm(diameter)};
  detail::Outline outline(0.0, 0.0);
  outline.line_to(flat, 0.0)
      .arc_to(tangent_r, tangent_z, kQuarter - taper)
      .line_to(0.5 * widest.mm(), height);
  return shape::Drawn{outline.take()};
}

std::optional<ToolShape> CommentReader::corner_mill(std::string_view list) {
  if (!numbers("CRMILL", list, 4, 5)) return std::nullopt;
  for (std::size_t i = 0; i < fields_.count; ++i) {
    if (fields_.values[i] < 0.0) return malformed("a negative number in TOOL/CRMILL");
  }
  if (length(1) <= length(0) || length(2) == 0.0)
    return unusable("the second diameter is not larger than the first");
  return shape::CornerRounding{mm(length(0)), mm(length(1)), mm(length(2)), mm(length(3)), mm(length(4))};
}

std::optional<ToolShape> CommentReader::chamfer(std::string_view list) {
  if (!numbers("CHAMFER", list, 3, 4) || !angle_fits(1, 0.0, 179.0)) return std::nullopt;
  if (length(0) <= 0.0 || length(2) < 0.0 || length(3) < 0.0)
    return malformed("a diameter that is not above 0");
  const double tip = length(0) - 2.0 * length(3) * std::tan(0.5 * angle(1));
  if (length(3) > 0.0 && tip < 0.0) return unusable("the chamfer is longer than its cone");
  return shape::Chamfer{mm(length(0)), mm(length(2)), radians(angle(1)), mm(length(3) > 0.0 ? tip : 0.0)};
}

std::optional<ToolShape> CommentReader::drill(std::string_view list) {
  if (!numbers("DRILL", list, 3, 3) || !angle_fits(1, 0.0, 179.0)) return std::nullopt;
  if (length(0) <= 0.0 || length(2) < 0.0) return malformed("a diameter that is not above 0");
  return shape::Drill{mm(length(0)), mm(length(2)), radians(angle(1))};
}

std::optional<ToolShape> CommentReader::centre_drill(std::string_view list) {
  if (!numbers("CDRILL", list, 6, 6) || !angle_fits(1, 0.0, 179.0) || !angle_fits(4, 0.0, 179.0))
    return std::nullopt;
  if (length(0) <= 0.0 || length(2) <= 0.0 || length(3) <= 0.0 || length(5) < 0.0) {
    return malformed("a diameter or length that is not above 0");
  }
  return shape::CentreDrill{mm(length(0)), mm(length(2)), radians(angle(1)),
                            mm(length(3)), mm(length(5)), radians(angle(4))};
}

std::optional<ToolShape> CommentReader::read() {
  std::string_view text = comment_;
  while (!text.empty() &&
         (text.front() == '(' || text.front() == ';' || static_cast<unsigned char>(text.front()) <= ' ')) {
    text.remove_prefix(1);
  }
  while (!text.empty() && (text.back() == ')' || static_cast<unsigned char>(text.back()) <= ' '))
    text.remove_suffix(1);
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos || slash > 8 || fold_name(text.substr(0, slash)) != "tool")
    return std::nullopt;
  text.remove_prefix(slash + 1);
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || comma > 16) return std::nullopt;  // TOOL/ID=7, TOOL/Description=...
  const std::string word = fold_name(text.substr(0, comma));
  const std::string_view list = text.substr(comma + 1);
  if (word == "mill") return mill(list);
  if (word == "crmill") return corner_mill(list);
  if (word == "chamfer") return chamfer(list);
  if (word == "drill") return drill(list);
  if (word == "cdrill") return centre_drill(list);
  return std::nullopt;
}

}  // namespace

std::optional<ToolShape> read_tool_comment(std::string_view comment, double scale, const Origin& where,
                                           Diagnostics& diagnostics) {
  return CommentReader(comment, scale, where, diagnostics).read();
}

}  // namespace kerf
