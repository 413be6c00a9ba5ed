// Conversion between the units of values.
#include <numbers>

#include "front/gcmc/value/runtime.h"

namespace kerf::gcmc {

double convert(double value, Unit from, Unit to) {
  if (from == to) return value;
  if (from == Unit::mm && to == Unit::inch) return value / kMmPerInch;
  if (from == Unit::inch && to == Unit::mm) return value * kMmPerInch;
  if (from == Unit::deg && to == Unit::rad) return value * std::numbers::pi / 180.0;
  if (from == Unit::rad && to == Unit::deg) return value * 180.0 / std::numbers::pi;
  return value;
}

Scalar convert(Scalar s, Unit to) {
  const Unit from = s.unit();
  const bool factor =
      from != to && ((is_distance(from) && is_distance(to)) || (is_angle(from) && is_angle(to)));
  return factor ? Scalar::real(convert(s.number(), from, to), to) : s.with_unit(to);
}

double native_number(const Runtime& rt, Scalar s) {
  if (is_distance(s.unit())) return convert(s.number(), s.unit(), rt.native);
  if (is_angle(s.unit())) return convert(s.number(), s.unit(), Unit::deg);
  return s.number();
}

}  // namespace kerf::gcmc
