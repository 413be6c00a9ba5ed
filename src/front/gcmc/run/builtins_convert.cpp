// Built-in functions for conversion, queries and messages.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/codes/gcmc.h"
#include "base/number.h"
#include "front/gcmc/code/operators.h"
#include "front/gcmc/run/builtins.h"

namespace kerf::gcmc {
namespace {

/// Applies `change` to a scalar, or to each coordinate of a vector or of the vectors of a list, except undef.
template <class Change>
Value change_scalars(const Call& call, Change change) {
  Value v = std::move(call[0]);
  const auto each = [&](Value& vector) {
    for (std::size_t i = 0; i < vector.vector_size(); ++i) {
      const Scalar s = vector.coordinate(i);
      if (s.defined()) vector.set_coordinate(i, change(s, true), call.vm.meter);
    }
  };
  if (v.is_scalar()) {
    if (!v.is_undef()) v = Value(change(v.scalar(), false));
  } else if (v.is_vector()) {
    each(v);
  } else if (v.is_list()) {
    for (Value& item : v.own_vectors(call.vm.meter)) each(item);
  } else {
    call.fail(codes::gcmc_type,
              fmt::format("{}() argument 1 must be scalar, vector or vectorlist", call.name));
  }
  return v;
}

template <Unit unit>
Value to_unit(const Call& call) {
  return change_scalars(call, [&](Scalar s, bool) {
    if (s.unit() != Unit::none && is_distance(s.unit()) != is_distance(unit)) {
      call.warn(codes::gcmc_unit, is_angle(s.unit())
                                      ? fmt::format("Angular units {} converted to distance units {}",
                                                    unit_name(s.unit()), unit_name(unit))
                                      : fmt::format("Distance units {} converted to angular units {}",
                                                    unit_name(s.unit()), unit_name(unit)));
    }
    return convert(s, unit);
  });
}

Value to_native(const Call& call) {
  return change_scalars(call, [&](Scalar s, bool) {
    if (is_distance(s.unit())) return convert(s, call.vm.native);
    return is_angle(s.unit()) ? convert(s, Unit::deg) : s;
  });
}

Value to_none(const Call& call) {
  return change_scalars(call, [](Scalar s, bool) { return s.with_unit(Unit::none); });
}

Value to_distance(const Call& call) {
  return change_scalars(call, [&](Scalar s, bool) {
    if (is_distance(s.unit())) return s;
    if (is_angle(s.unit())) {
      call.warn(codes::gcmc_unit, fmt::format("Angular units {} converted to distance units {}",
                                              unit_name(s.unit()), unit_name(call.vm.native)));
    }
    return s.with_unit(call.vm.native);
  });
}

// ---- numbers of strings

/// The unit named by `rest`; `mil` is set for mil, which also scales.
Unit unit_of_text(const Call& call, std::string_view rest, bool& mil) {
  mil = rest == "mil";
  if (mil) return Unit::inch;
  for (const Unit u : {Unit::none, Unit::mm, Unit::inch, Unit::deg, Unit::rad})
    if (rest == unit_suffix(u)) return u;
  call.warn(
      codes::gcmc_unit,
      fmt::format("{}(): String has a trailing context '{}' which does not translate into a recognized unit",
                  call.name, rest));
  return Unit::none;
}

Value integer_of_text(const Call& call, const std::string& text, int base) {
  char* end = nullptr;
  const long long value = std::strtoll(text.c_str(), &end, base);
  bool mil = false;
  const Unit unit = unit_of_text(call, end, mil);
  auto number = static_cast<std::int32_t>(std::clamp<long long>(value, INT32_MIN, INT32_MAX));
  if (mil) {
    const std::int32_t inches = number / 1000;
    if (inches * 1000 != number) {
      call.warn(codes::gcmc_unit,
                fmt::format("{}(): Unit mil in string to integer loses digits because of inch conversion "
                            "({}mil != {}in)",
                            call.name, number, inches));
    }
    number = inches;
  }
  return Value::integer(number, unit);
}

Value to_int(const Call& call) {
  int base = 0;
  if (call.count > 1) {
    base = call.integer(1);
    if (base != 0 && (base < 2 || base > 36)) {
      call.warn(
          codes::gcmc_range,
          fmt::format("{}(): Base argument must be zero or between [2..36], setting to zero", call.name));
      base = 0;
    }
  }
  if (call[0].is_string()) {
    const std::string text = to_utf8(call[0].text());
    return text == "<undef>" ? Value::undef() : integer_of_text(call, text, base);
  }
  return change_scalars(call, [](Scalar s, bool in_vector) {
    if (s.kind() == Kind::real && !in_vector)
      s.p.d = std::trunc(s.p.d);  // only coordinates have the tolerance of 1e-12
    return Scalar::integer(to_integer(s), s.unit());
  });
}

Value to_float(const Call& call) {
  if (!call[0].is_string())
    return change_scalars(call, [](Scalar s, bool) { return Scalar::real(s.number(), s.unit()); });
  const std::string text = to_utf8(call[0].text());
  if (text == "<undef>") return Value::undef();
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  bool mil = false;
  const Unit unit = unit_of_text(call, end, mil);
  if (std::isnan(value)) call.warn(codes::gcmc_range, fmt::format("{}(): Value evaluates to NaN", call.name));
  if (std::isinf(value))
    call.warn(codes::gcmc_range,
              fmt::format("{}(): Value evaluates to {}Inf", call.name, value > 0 ? '+' : '-'));
  if (mil) value /= 1000.0;
  return Value::real(value, unit);
}

Value to_text(const Call& call) { return Value::string(from_utf8(joined_text(call)), call.vm.meter); }

Value to_chr(const Call& call) {
  constexpr std::int32_t kLastCodePoint = 0x10FFFF;
  const std::int32_t code = call.integer(0);
  if (code < 0 || code > kLastCodePoint)
    call.fail(codes::gcmc_range, fmt::format("to_chr() argument 1 is no character ({})", code));
  return Value::string(code == 0 ? std::u32string() : std::u32string(1, static_cast<char32_t>(code)),
                       call.vm.meter);
}

Value to_val(const Call& call) {
  if (!call[0].is_string()) call.fail(codes::gcmc_type, "to_val() argument 1 must be string");
  const std::u32string& text = call[0].text();
  return Value::integer(text.empty() ? 0 : static_cast<std::int32_t>(text[0]));
}

// ---- queries

template <Kind kind>
Value is_kind(const Call& call) {
  return Value::boolean(call[0].is_scalar() && call[0].scalar().kind() == kind);
}
Value is_scalar(const Call& call) { return Value::boolean(call[0].is_scalar() && !call[0].is_undef()); }
Value is_string(const Call& call) { return Value::boolean(call[0].is_string()); }
Value is_vector(const Call& call) { return Value::boolean(call[0].is_vector()); }
Value is_vectorlist(const Call& call) { return Value::boolean(call[0].is_list()); }

template <Unit unit>
Value is_unit(const Call& call) {
  return Value::boolean(call.scalar(0).unit() == unit);
}
Value is_any_angle(const Call& call) { return Value::boolean(!is_distance(call.scalar(0).unit())); }
Value is_any_distance(const Call& call) { return Value::boolean(!is_angle(call.scalar(0).unit())); }

const Value* named_variable(const Call& call) {
  if (!call[0].is_string())
    call.fail(codes::gcmc_type, fmt::format("{}() argument 1 must be string", call.name));
  return call.vm.variable(to_utf8(call[0].text()));
}

Value is_defined(const Call& call) { return Value::boolean(named_variable(call) != nullptr); }
Value is_const(const Call& call) {
  const Value* v = named_variable(call);
  return v == nullptr ? Value::undef() : Value::boolean(call.vm.is_constant(*v));
}

Value is_mode_mm(const Call& call) { return Value::boolean(!call.vm.options().imperial); }
Value is_relative(const Call& call) { return Value::boolean(call.vm.options().relative); }
template <GcmcTarget target>
Value is_target(const Call& call) {
  return Value::boolean(call.vm.options().target == target);
}

Value undefined(const Call&) { return Value::undef(); }

// ---- messages

template <Severity severity>
Value message_function(const Call& call) {
  std::string text = joined_text(call);
  if (!text.empty() && text.back() == '\n') text.pop_back();  // a line end is added in any case
  call.vm.program_message(severity, codes::gcmc_script, std::move(text), {}, Vm::At::here);
  return Value::undef();
}

Value comment(const Call& call) {
  const std::string text = joined_text(call);
  call.vm.reset_quiet_steps();
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.comment(text); });
  return Value::undef();
}

Value literal(const Call& call) {
  const std::string text = joined_text(call);
  call.vm.reset_quiet_steps();
  call.vm.machine().for_each_sink([&](Sink& sink) { sink.literal(text); });
  return Value::undef();
}

}  // namespace

const std::vector<Builtin>& convert_builtins() {
  static const std::vector<Builtin> table = {
      {"to_mm", to_unit<Unit::mm>, 1, 1},
      {"to_in", to_unit<Unit::inch>, 1, 1},
      {"to_inch", to_unit<Unit::inch>, 1, 1},
      {"to_deg", to_unit<Unit::deg>, 1, 1},
      {"to_rad", to_unit<Unit::rad>, 1, 1},
      {"to_native", to_native, 1, 1},
      {"to_none", to_none, 1, 1},
      {"to_distance", to_distance, 1, 1},
      {"to_int", to_int, 1, 2},
      {"to_float", to_float, 1, 1},
      {"to_string", to_text, 0, kAnyCount},
      {"to_chr", to_chr, 1, 1},
      {"to_val", to_val, 1, 1},
      {"isint", is_kind<Kind::integer>, 1, 1},
      {"isfloat", is_kind<Kind::real>, 1, 1},
      {"isundef", is_kind<Kind::undef>, 1, 1},
      {"isscalar", is_scalar, 1, 1},
      {"isstring", is_string, 1, 1},
      {"isvector", is_vector, 1, 1},
      {"isvectorlist", is_vectorlist, 1, 1},
      {"isnone", is_unit<Unit::none>, 1, 1},
      {"isdeg", is_unit<Unit::deg>, 1, 1},
      {"israd", is_unit<Unit::rad>, 1, 1},
      {"ismm", is_unit<Unit::mm>, 1, 1},
      {"isinch", is_unit<Unit::inch>, 1, 1},
      {"isangle", is_any_angle, 1, 1},
      {"isdistance", is_any_distance, 1, 1},
      {"isdefined", is_defined, 1, 1},
      {"isconst", is_const, 1, 1},
      {"ismodemm", is_mode_mm, 0, 0},
      {"isrelative", is_relative, 0, 0},
      {"isgcode", is_target<GcmcTarget::gcode>, 0, 0},
      {"issvg", is_target<GcmcTarget::svg>, 0, 0},
      {"isdxf", is_target<GcmcTarget::dxf>, 0, 0},
      {"undef", undefined, 0, 0},
      {"message", message_function<Severity::note>, 0, kAnyCount},
      {"warning", message_function<Severity::warning>, 0, kAnyCount},
      {"error", message_function<Severity::error>, 0, kAnyCount},
      {"comment", comment, 0, kAnyCount},
      {"literal", literal, 0, kAnyCount},
  };
  return table;
}

}  // namespace kerf::gcmc
