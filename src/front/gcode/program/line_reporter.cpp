// Diagnostics about the lines of a program.
#include "front/gcode/program/line_reporter.h"

namespace kerf::gcode {

void LineReporter::error(Code code, std::uint32_t column, std::string message, std::string_view hint) {
  add(Severity::error, code, column, std::move(message), hint);
}

void LineReporter::unusual(Code code, std::uint32_t column, std::string message, std::string_view hint) {
  unusual_at(location(column), code, std::move(message), hint);
}

void LineReporter::unusual_at(TextLocation where, Code code, std::string message, std::string_view hint) {
  const Severity severity = strict_ ? Severity::error : Severity::warning;
  diagnostics_.add({severity, code, std::move(where), std::move(message), {}, std::string(hint)});
}

void LineReporter::note(Code code, std::uint32_t column, std::string message) {
  add(Severity::note, code, column, std::move(message), {});
}

void LineReporter::add(Severity severity, Code code, std::uint32_t column, std::string message,
                       std::string_view hint) {
  diagnostics_.add({severity, code, location(column), std::move(message), {}, std::string(hint)});
}

}  // namespace kerf::gcode
