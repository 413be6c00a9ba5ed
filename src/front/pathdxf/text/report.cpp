// Messages of path drawings: each is reported once.
#include "front/pathdxf/text/report.h"

#include <functional>

namespace kerf::pathdxf {

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

void Report::add(Severity severity, Code code, const Origin& where, std::string message) {
  latest_ = nullptr;
  if (!reported_.insert(std::hash<std::string>()(to_string(where) + '\n' + message)).second) return;
  latest_ = &diagnostics_.add({severity, code, where, std::move(message), {}, {}});
}

}  // namespace kerf::pathdxf
