// The six-digit tool numbers of gcodepreview: kind, two size codes, flute code. See docs/manual/tools.md.
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/tools.h"
#include "base/number.h"

#include "kerf/base/units.h"
#include "kerf/tool/tool.h"

namespace kerf {
namespace {

constexpr double kPrinted = 0.0065;  // mm: 1/32" is printed as 0.80 mm; 1.6 mm is not 1/16"
constexpr double kEightMm = 0.0625;  // mm: the scheme codes 8 mm bits as 5/16"
constexpr double kLongReach = 19.05;
constexpr int kOther = 9;  // size code: above an inch, or a size without a code

struct SizeCode {
  int code;
  double mm;
};
constexpr std::array kSizes{SizeCode{1, 0.79375}, SizeCode{2, 1.5875}, SizeCode{3, 3.175},
                            SizeCode{4, 6.35},    SizeCode{5, 7.9375}, SizeCode{6, 9.525},
                            SizeCode{7, 12.7},    SizeCode{8, 19.05}};
constexpr std::array kFlutes{SizeCode{2, 1.5875}, SizeCode{3, 3.175}, SizeCode{4, 6.35},
                             SizeCode{5, 7.9375}, SizeCode{6, 12.7},  SizeCode{7, 19.05}};
constexpr std::array kTips{SizeCode{1, 0.254},   SizeCode{2, 0.396875}, SizeCode{3, 0.7493},
                           SizeCode{4, 0.79375}, SizeCode{5, 0.8509},   SizeCode{6, 0.89916},
                           SizeCode{7, 1.5875},  SizeCode{8, 3.175},    SizeCode{9, 6.35}};

template <std::size_t N>
std::optional<int> code_of(const std::array<SizeCode, N>& table, double size) {
  for (const SizeCode& entry : table) {
    if (std::abs(entry.mm - size) <= kPrinted) return entry.code;
  }
  return std::nullopt;
}

template <std::size_t N>
std::optional<double> size_of(const std::array<SizeCode, N>& table, int code) {
  for (const SizeCode& entry : table) {
    if (entry.code == code) return entry.mm;
  }
  return std::nullopt;
}

/// Two digits of a length: an inch size, or tenths of a millimetre from 1.0 to 9.9, or "other".
int size_code(double size) {
  if (const auto code = code_of(kSizes, size)) return *code;
  if (std::abs(size - 8.0) <= kPrinted && std::abs(size - 7.9375) <= kEightMm + kPrinted) return 5;
  const double tenths = std::round(10.0 * size);
  return std::abs(0.1 * tenths - size) <= 1e-6 && tenths >= 10.0 && tenths <= 99.0 ? static_cast<int>(tenths)
                                                                                   : kOther;
}

/// Whole degrees of two digits.
std::optional<int> angle_code(Angle angle) {
  const double whole = std::round(angle.deg());
  if (std::abs(whole - angle.deg()) > 1e-6 || whole < 1.0 || whole > 99.0) return std::nullopt;
  return static_cast<int>(whole);
}

int flute_code(double flute, int otherwise) {
  if (const auto code = code_of(kFlutes, flute)) return *code;
  return flute > kLongReach ? 8 : otherwise;
}

int number_of(int kind, int shape, int size, int flute) {
  return 100000 * kind + 1000 * shape + 10 * size + flute;
}

struct Encoder {
  int number;  // the tool's own

  std::optional<int> operator()(const shape::Square& s) const {
    return number_of(1, 0, size_code(s.diameter.mm()), flute_code(s.flute.mm(), 0));
  }
  std::optional<int> operator()(const shape::Ball& s) const {
    const int size = size_code(s.diameter.mm());
    const bool from_radius = std::abs(s.flute.mm() - 0.5 * s.diameter.mm()) <= kPrinted;
    return number_of(2, size, size, flute_code(s.flute.mm(), from_radius ? 9 : 0));
  }
  std::optional<int> operator()(const shape::Vee& s) const {
    const auto angle = angle_code(s.included_angle);
    if (!angle || s.tip_diameter.mm() > 0.0 || s.tip_radius.mm() > 0.0) return std::nullopt;
    return number_of(3, *angle, size_code(s.diameter.mm()), flute_code(s.flute.mm(), 1));
  }
  /// Numbers of bowls contain the manufacturer's number, not dimensions.
  std::optional<int> operator()(const shape::Bowl&) const {
    if (number >= 400000 && number <= 499999) return number;
    return number >= 1000 && number <= 99999 ? std::optional(400000 + number) : std::nullopt;
  }
  std::optional<int> operator()(const shape::TaperedBall& s) const {
    const auto angle = angle_code(s.included_angle);
    const auto tip = code_of(kTips, s.tip_diameter.mm());
    const auto size = code_of(kSizes, s.diameter.mm());
    if (!angle || !tip || !size) return std::nullopt;
    return number_of(5, *angle, 10 * *tip + *size, flute_code(s.flute.mm(), 1));
  }
  /// Radius and diameter as in the catalogue: half of the body, and the body; the code of the tip in the last
  /// digit.
  std::optional<int> operator()(const shape::Roundover& s) const {
    const double body = (s.tip_diameter + 2.0 * s.radius).mm();
    auto tip = code_of(kTips, s.tip_diameter.mm());
    if (std::abs(s.tip_diameter.mm() - 0.508) <= kPrinted) tip = 2;
    if (!tip) return std::nullopt;
    return number_of(6, size_code(0.5 * body), size_code(body), *tip);
  }
  /// Dovetails always have flute code 1, whatever their flute.
  std::optional<int> operator()(const shape::Dovetail& s) const {
    const auto angle = angle_code(s.side_angle);
    if (!angle) return std::nullopt;
    return number_of(8, *angle, size_code(s.diameter.mm()), 1);
  }
  std::optional<int> operator()(const shape::Keyhole& s) const {
    return number_of(9, size_code(s.diameter.mm()), size_code(s.neck_diameter.mm()),
                     flute_code(s.head.mm(), 0));
  }
  template <class Other>
  std::optional<int> operator()(const Other&) const {
    return std::nullopt;
  }
};

/// Decodes the five digits after the kind.
class Decoder {
 public:
  explicit Decoder(int number)
      : kind_(number / 100000), shape_(number / 1000 % 100), size_(number / 10 % 100), flute_(number % 10) {}

  /// The shape, or nothing with `fault` set.
  std::optional<ToolShape> shape();
  std::string fault = "does not follow the scheme";

 private:
  std::optional<double> length(int code, std::string_view what);
  std::optional<double> flute(std::optional<double> from_shape, Length otherwise);
  std::nullopt_t no(std::string why) {
    fault = std::move(why);
    return std::nullopt;
  }
  std::optional<ToolShape> square();
  std::optional<ToolShape> ball();
  std::optional<ToolShape> vee();
  std::optional<ToolShape> tapered_ball();
  std::optional<ToolShape> roundover();
  std::optional<ToolShape> dovetail();
  std::optional<ToolShape> keyhole();

  int kind_, shape_, size_, flute_;
};

std::optional<double> Decoder::length(int code, std::string_view what) {
  if (code >= 10) return 0.1 * code;
  if (const auto size = size_of(kSizes, code)) return size;
  return no(code == kOther ? fmt::format("does not give the {}: code 9 is \"above an inch or other\"", what)
                           : fmt::format("has no {}: code 00", what));
}

/// Flute codes 1 and 9 take the height from the shape; 0 and 8 do not specify it.
std::optional<double> Decoder::flute(std::optional<double> from_shape, Length otherwise) {
  if (const auto coded = size_of(kFlutes, flute_)) return coded;
  if (flute_ == 1 || flute_ == 9) {
    if (from_shape) return from_shape;
    return no(fmt::format("has flute code {}, which a tool of this kind does not have", flute_));
  }
  constexpr double kLongFlute = kMmPerInch;
  return flute_ == 8 ? std::max(kLongFlute, otherwise.mm()) : otherwise.mm();
}

std::optional<ToolShape> Decoder::square() {
  if (shape_ != 0) return no("has a shape code, but a square mill has none");
  const auto diameter = length(size_, "diameter");
  if (!diameter) return std::nullopt;
  const auto height = flute(std::nullopt, usual_flute(mm(*diameter)));
  if (!height) return std::nullopt;
  return shape::Square{mm(*diameter), mm(*height)};
}

std::optional<ToolShape> Decoder::ball() {
  const auto diameter = length(size_, "diameter");
  if (!diameter) return std::nullopt;
  if (shape_ != size_) return no("has a ball whose two diameter codes differ");
  const auto height =
      flute(flute_ == 9 ? std::optional(0.5 * *diameter) : std::nullopt, usual_flute(mm(*diameter)));
  if (!height || *height < 0.5 * *diameter) return no("has a ball higher than its flute");
  return shape::Ball{mm(*diameter), mm(*height)};
}

std::optional<ToolShape> Decoder::vee() {
  const auto diameter = length(size_, "diameter");
  if (!diameter) return std::nullopt;
  if (shape_ == 0) return no("has no angle");
  const double cone = 0.5 * *diameter / std::tan(degrees(0.5 * shape_).rad());
  const auto height = flute(flute_ == 1 ? std::optional(cone) : std::nullopt, mm(cone));
  if (!height) return std::nullopt;
  return shape::Vee{mm(*diameter), mm(std::max(*height, cone)), degrees(shape_), Length(), Length()};
}

std::optional<ToolShape> Decoder::tapered_ball() {
  const auto tip = size_of(kTips, size_ / 10);
  const auto diameter = size_of(kSizes, size_ % 10);
  if (shape_ == 0 || !tip || !diameter || *tip >= *diameter)
    return no("lacks the angle, tip and diameter of a tapered ball");
  const auto height = flute(flute_ == 1 ? std::optional(0.0) : std::nullopt, Length());
  if (!height) return std::nullopt;
  return shape::TaperedBall{mm(*diameter), mm(*height), degrees(shape_), mm(*tip)};
}

std::optional<ToolShape> Decoder::roundover() {
  const auto body = length(size_, "diameter");
  const auto tip = size_of(kTips, flute_);
  if (!body) return std::nullopt;
  if (!tip || *tip >= *body) return no("lacks the tip of a roundover");
  const double radius = 0.5 * (*body - *tip);
  return shape::Roundover{mm(*tip), mm(radius), Length()};
}

/// The digits of a dovetail do not specify its flute: the diameter, or less if the sides would meet.
std::optional<ToolShape> Decoder::dovetail() {
  const auto diameter = length(size_, "diameter");
  if (!diameter) return std::nullopt;
  if (shape_ == 0 || shape_ > 89) return no("lacks the angle of a dovetail");
  const double meet = 0.5 * *diameter / std::tan(degrees(shape_).rad());
  const auto height = flute(std::min(*diameter, 0.75 * meet), mm(std::min(*diameter, 0.75 * meet)));
  if (!height) return std::nullopt;
  if (*height >= meet) return no("has a dovetail whose sides meet within its flute");
  return shape::Dovetail{mm(*diameter), mm(*height), degrees(shape_)};
}

std::optional<ToolShape> Decoder::keyhole() {
  const auto head = length(shape_, "head");
  const auto neck = length(size_, "neck");
  if (!head || !neck) return std::nullopt;
  if (*neck >= *head) return no("has a keyhole neck wider than its head");
  const auto height = size_of(kFlutes, flute_);
  return shape::Keyhole{mm(*head), mm(height ? *height : 0.375 * *head), mm(*neck), Length()};
}

std::optional<ToolShape> Decoder::shape() {
  switch (kind_) {
    case 1: return square();
    case 2: return ball();
    case 3: return vee();
    case 4: return no("contains the manufacturer's number of a bowl, which has no dimensions");
    case 5: return tapered_ball();
    case 6: return roundover();
    case 7: return no("is that of a thread mill, for which the scheme has no dimensions");
    case 8: return dovetail();
    case 9: return keyhole();
    default: return std::nullopt;
  }
}

}  // namespace

std::optional<int> encode_tool_number(const Tool& tool) {
  return std::visit(Encoder{tool.number}, tool.shape);
}

std::optional<ToolShape> decode_tool_number(int number, const Origin& where, Diagnostics& diagnostics) {
  Decoder decoder(number < 100000 || number > 999999 ? 0 : number);
  std::optional<ToolShape> shape = decoder.shape();
  Diagnostics ignored;  // each digit can be right and the shape impossible
  if (shape && !make_tool(number, *shape, {}, where, ignored)) {
    shape.reset();
    decoder.fault = "gives inconsistent dimensions";
  }
  if (!shape) {
    diagnostics.error(codes::tool_number_unclear, where,
                      fmt::format("tool number {} {}", number, decoder.fault));
  }
  return shape;
}

}  // namespace kerf
