// The functions of the language that are built in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "front/gcmc/run/vm.h"

namespace kerf::gcmc {

/// A call of a built-in: its name for messages, and its arguments, which it may use up.
struct Call {
  Vm& vm;
  std::string_view name;
  Value* arguments;
  int count;
  bool value_used = true;  // nobody asks for the value otherwise

  Value& operator[](int i) const { return arguments[i]; }
  /// Argument `i` as a scalar, an error else; messages count arguments from 1.
  Scalar scalar(int i) const;
  /// The same, defined, as a number of native length; an angle is warned about.
  double length(int i) const;
  double number(int i) const { return scalar(i).number(); }
  double unitless(int i) const;
  double angle(int i) const;  // radians; without unit it is taken as such
  std::int32_t integer(int i) const;
  bool truth(int i) const;
  [[noreturn]] void fail(Code code, std::string text) const;
  void warn(Code code, std::string text, std::string hint = {}) const;
};

using BuiltinFunction = Value (*)(const Call& call);
struct Builtin {
  std::string_view name;
  BuiltinFunction function;
  int least;
  int most;  // -1: any number
};

constexpr int kAnyCount = -1;

// The parts of the table, one a file.
const std::vector<Builtin>& math_builtins();
const std::vector<Builtin>& vector_builtins();
const std::vector<Builtin>& convert_builtins();
const std::vector<Builtin>& machine_builtins();

const std::vector<Builtin>& all_builtins();
int builtin_index(std::string_view name);
const std::vector<std::string>& builtin_names();

/// The constants of the language: name and value.
struct LanguageConstant {
  std::string_view name;
  Value value;
};
std::vector<LanguageConstant> language_constants(Meter& meter);

/// The textual forms of all arguments, one after the other.
std::string joined_text(const Call& call);

}  // namespace kerf::gcmc
