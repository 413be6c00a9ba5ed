// The interface of a running program for operators and built-in functions: messages, memory, units.
#pragma once

#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "front/gcmc/value/value.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"

namespace kerf::gcmc {

/// Ends the program; thrown inside of this room only.
struct Stop {};

/// Numbers x with |x| < kEpsilon are zero, and numbers with |a - b| < kEpsilon are equal.
constexpr double kEpsilon = 1e-12;

class Runtime {
 public:
  virtual ~Runtime() = default;
  void warn(Code code, std::string text, std::string hint = {}) {
    report_warning(code, std::move(text), std::move(hint));
  }
  /// Reports an error and ends the program.
  [[noreturn]] void fail(Code code, std::string text, std::string hint = {}) {
    report_error(code, std::move(text), std::move(hint));
    throw Stop{};
  }

  Meter meter;
  Unit native = Unit::mm;  // of lengths
  int decimals = 8;

 protected:
  virtual void report_warning(Code code, std::string text, std::string hint) = 0;
  virtual void report_error(Code code, std::string text, std::string hint) = 0;
};

/// `value` in unit `to` instead of `from`; both lengths or both angles.
double convert(double value, Unit from, Unit to);
/// The scalar in `to`: integers stay integers unless a factor applies.
Scalar convert(Scalar s, Unit to);
/// A length in native units, an angle in degrees; without unit unchanged.
double native_number(const Runtime& rt, Scalar s);

}  // namespace kerf::gcmc
