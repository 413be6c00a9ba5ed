// The values that a loop or each runs over.
#pragma once

#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/interpreter.h"

namespace kerf::scad {

/// Calls body(value) for each value of a range, vector or string; once for another value; never for undef.
template <class Body>
void for_each_value(Interpreter& run, const Value& values, Position at, Body body) {
  switch (values.type()) {
    case Type::undef:
    case Type::unset: return;
    case Type::range: {
      const Range range = values.range();
      const double count = range.count();
      if (count > static_cast<double>(run.limits().max_range)) {
        const std::string number = std::isinf(count) ? "the range never ends" : fmt::format("{:.0f}", count);
        run.error(
            codes::scad_limit, at,
            fmt::format("bad range parameter in for statement: too many elements ({}); {} is the maximum",
                        number, run.limits().max_range));
        return;
      }
      const auto n = static_cast<std::size_t>(count);
      for (std::size_t i = 0; i < n; ++i) body(Value(range.at(i)));
      return;
    }
    case Type::vector: {
      const Value held = values;
      for (const Value& item : held.items()) body(item);
      return;
    }
    case Type::string: {
      const Value held = values;
      for (const std::string_view c : characters(held.text())) body(Value::string(std::string(c)));
      return;
    }
    default: body(values);
  }
}

}  // namespace kerf::scad
