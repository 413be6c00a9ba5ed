// Built-in functions on numbers.
#include <cmath>
#include <limits>
#include <numbers>

#include "base/codes/gcmc.h"
#include "front/gcmc/code/operators.h"
#include "front/gcmc/run/builtins.h"

namespace kerf::gcmc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_range(const Call& call, double v, double low, double high) {
  if (v >= low && v <= high) return;
  call.warn(codes::gcmc_range,
            fmt::format("{}() argument 1 out of range [{:f},{:f}]", call.name, low == 0.0 ? 0.0 : low, high));
}

Value absolute(const Call& call) {
  const Scalar s = call.scalar(0);
  if (s.kind() == Kind::integer)
    return Value::integer(s.whole() < 0 ? wrap_sub(0, s.whole()) : s.whole(), s.unit());
  return Value::real(std::fabs(s.p.d), s.unit());
}

Value sign(const Call& call) { return Value::real(call.number(0) >= 0.0 ? 1.0 : -1.0); }

template <double (*f)(double)>
Value rounded(const Call& call) {
  const Scalar s = call.scalar(0);
  return Value::real(f(s.number()), s.unit());
}
double round_half_away(double v) { return std::round(v); }
double round_up(double v) { return std::ceil(v); }
double round_down(double v) { return std::floor(v); }

Value square_root(const Call& call) {
  const double v = call.number(0);
  check_range(call, v, 0.0, kInfinity);
  return Value::real(std::sqrt(v));
}

Value power(const Call& call) {
  const double base = call.number(0);
  return Value::real(std::pow(base, call.unitless(1)));
}

Value exponential(const Call& call) { return Value::real(std::exp(call.number(0))); }

template <double (*f)(double)>
Value logarithm(const Call& call) {
  const double v = call.number(0);
  if (!(v >= kEpsilon)) {
    call.warn(codes::gcmc_range, fmt::format("{}() argument 1 out of range [0.000000,inf]", call.name));
  }
  return Value::real(f(v));
}
double log_e(double v) { return std::log(v); }
double log_10(double v) { return std::log10(v); }
double log_2(double v) { return std::log2(v); }

Value sine(const Call& call) { return Value::real(std::sin(call.angle(0))); }
Value cosine(const Call& call) { return Value::real(std::cos(call.angle(0))); }
Value tangent(const Call& call) { return Value::real(std::tan(call.angle(0))); }

template <double (*f)(double)>
Value inverse(const Call& call) {
  const double v = call.unitless(0);
  check_range(call, v, -1.0, 1.0);
  return Value::real(f(v), Unit::rad);
}
double arc_sine(double v) { return std::asin(v); }
double arc_cosine(double v) { return std::acos(v); }

/// The arc tangent of numbers in one unit; `x` is converted if its unit differs but is compatible.
double arc_tangent_of(const Call& call, Scalar y, Scalar x) {
  if (y.unit() != x.unit()) {
    if (y.unit() != Unit::none && x.unit() != Unit::none && is_distance(y.unit()) == is_distance(x.unit())) {
      y = convert(y, x.unit());
    } else {
      call.warn(codes::gcmc_unit, fmt::format("{}() arguments have different units ({} and {})", call.name,
                                              unit_name(y.unit()), unit_name(x.unit())));
    }
  }
  return std::atan2(y.number(), x.number());
}

Value arc_tangent(const Call& call) {
  const Scalar y = call.scalar(0);
  return Value::real(arc_tangent_of(call, y, call.scalar(1)), Unit::rad);
}

template <int across, int up>
Value arc_tangent_of_vector(const Call& call) {
  static constexpr char kNames[] = "XYZ";
  if (!call[0].is_vector())
    call.fail(codes::gcmc_type, fmt::format("{}() argument 1 must be vector", call.name));
  const Scalar x = call[0].coordinate_or_undef(across), y = call[0].coordinate_or_undef(up);
  if (!x.defined() || !y.defined()) {
    call.fail(codes::gcmc_arguments, fmt::format("{}(): Both {} and {} coordinates must be present",
                                                 call.name, kNames[across], kNames[up]));
  }
  if (is_angle(x.unit()) || is_angle(y.unit())) {
    call.fail(codes::gcmc_unit, fmt::format("{}(): Both {} and {} coordinates must be distance", call.name,
                                            kNames[across], kNames[up]));
  }
  return Value::real(arc_tangent_of(call, y, x), Unit::rad);
}

Value circle_constant(const Call&) { return Value::real(std::numbers::pi); }

}  // namespace

const std::vector<Builtin>& math_builtins() {
  static const std::vector<Builtin> table = {
      {"pi", circle_constant, 0, 0},
      {"abs", absolute, 1, 1},
      {"sign", sign, 1, 1},
      {"round", rounded<round_half_away>, 1, 1},
      {"ceil", rounded<round_up>, 1, 1},
      {"floor", rounded<round_down>, 1, 1},
      {"sqrt", square_root, 1, 1},
      {"pow", power, 2, 2},
      {"exp", exponential, 1, 1},
      {"loge", logarithm<log_e>, 1, 1},
      {"log10", logarithm<log_10>, 1, 1},
      {"log2", logarithm<log_2>, 1, 1},
      {"sin", sine, 1, 1},
      {"cos", cosine, 1, 1},
      {"tan", tangent, 1, 1},
      {"asin", inverse<arc_sine>, 1, 1},
      {"acos", inverse<arc_cosine>, 1, 1},
      {"atan", arc_tangent, 2, 2},
      {"atan_xy", arc_tangent_of_vector<0, 1>, 1, 1},
      {"atan_xz", arc_tangent_of_vector<0, 2>, 1, 1},
      {"atan_yz", arc_tangent_of_vector<1, 2>, 1, 1},
  };
  return table;
}

}  // namespace kerf::gcmc
