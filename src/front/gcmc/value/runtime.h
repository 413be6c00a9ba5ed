// What operators and built-in functions need of the running program: messages, memory, units.
#pragma once

#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "front/gcmc/value/value.h"

#include "kerf/diagnostics.h"
#include "kerf/units.h"

namespace kerf::gcmc {

/// Ends the program; thrown inside the module only.
struct Stop {};

/// Below this, the language takes a number for zero and two numbers for equal.
constexpr double kEpsilon = 1e-12;

class Runtime {
 public:
  virtual ~Runtime() = default;
  void warn(Code code, std::string text, std::string hint = {}) {
    say_warning(code, std::move(text), std::move(hint));
  }
  /// Says what is wrong and ends the program.
  [[noreturn]] void fail(Code code, std::string text, std::string hint = {}) {
    say_error(code, std::move(text), std::move(hint));
    throw Stop{};
  }

  Meter meter;
  Unit native = Unit::mm;  // of lengths
  int decimals = 8;

 protected:
  virtual void say_warning(Code code, std::string text, std::string hint) = 0;
  virtual void say_error(Code code, std::string text, std::string hint) = 0;
};

/// `value` in unit `to` instead of `from`; both lengths or both angles.
double convert(double value, Unit from, Unit to);
/// The scalar in `to`: integers stay integers unless a factor applies.
Scalar convert(Scalar s, Unit to);
/// A length in native units, an angle in degrees; without unit unchanged.
double native_number(const Runtime& rt, Scalar s);

}  // namespace kerf::gcmc
