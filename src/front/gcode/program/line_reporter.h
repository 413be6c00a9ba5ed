// Diagnostics about the lines of a program.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "kerf/base/diagnostics.h"

namespace kerf::gcode {

/// Adds diagnostics that have the current file and line as their location.
class LineReporter {
 public:
  LineReporter(std::string file, bool strict, Diagnostics& diagnostics)
      : file_(std::move(file)), strict_(strict), diagnostics_(diagnostics) {}

  void at_line(std::uint32_t line) { line_ = line; }
  void in_file(std::string file) { file_ = std::move(file); }
  std::uint32_t line() const { return line_; }
  TextLocation location(std::uint32_t column) const { return {file_, line_, column}; }
  Diagnostics& diagnostics() { return diagnostics_; }

  void error(Code code, std::uint32_t column, std::string message, std::string_view hint = {});
  /// A warning; an error if reading is strict.
  void unusual(Code code, std::uint32_t column, std::string message, std::string_view hint = {});
  /// The same at an earlier location.
  void unusual_at(TextLocation where, Code code, std::string message, std::string_view hint);
  void note(Code code, std::uint32_t column, std::string message);

 private:
  void add(Severity severity, Code code, std::uint32_t column, std::string message, std::string_view hint);

  std::string file_;
  bool strict_;
  Diagnostics& diagnostics_;
  std::uint32_t line_ = 0;
};

}  // namespace kerf::gcode
