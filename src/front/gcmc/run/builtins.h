// The built-in functions of the language.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "front/gcmc/run/vm.h"

namespace kerf::gcmc {

/// A call of a built-in function: its name for messages, and its arguments, which it may move from.
struct Call {
  Vm& vm;
  std::string_view name;
  Value* arguments;
  int count;
  bool value_used = true;

  Value& operator[](int i) const { return arguments[i]; }
  /// Argument `i`, which must be a scalar; messages count arguments from 1.
  Scalar scalar(int i) const;
  /// The same, which must be defined, in the native unit of length; a warning for an angle.
  double length(int i) const;
  double number(int i) const { return scalar(i).number(); }
  double unitless(int i) const;
  double angle(int i) const;  // radians, also without unit
  std::int32_t integer(int i) const;
  bool truth(int i) const;
  [[noreturn]] void fail(Code code, std::string text) const;
  void warn(Code code, std::string text, std::string hint = {}) const;
};

using BuiltinFunction = Value (*)(const Call& call);
struct Builtin {
  std::string_view name;
  BuiltinFunction function;
  int min_arguments;
  int max_arguments;  // -1: any number
};

constexpr int kAnyCount = -1;

// The parts of the table, one per file.
const std::vector<Builtin>& math_builtins();
const std::vector<Builtin>& vector_builtins();
const std::vector<Builtin>& convert_builtins();
const std::vector<Builtin>& machine_builtins();
const std::vector<Builtin>& compensated_builtins();

const std::vector<Builtin>& all_builtins();
int builtin_index(std::string_view name);
const std::vector<std::string>& builtin_names();

/// The constants of the language: name and value.
struct LanguageConstant {
  std::string_view name;
  Value value;
};
std::vector<LanguageConstant> language_constants(Meter& meter, GcmcVersion version);

/// The concatenated textual forms of all arguments.
std::string joined_text(const Call& call);

}  // namespace kerf::gcmc
