// Messages of path drawings: each is reported once.
#include "front/pathdxf/text/report.h"

#include <functional>

namespace kerf::pathdxf {

void Report::add(Severity severity, Code code, const Origin& where, std::string message) {
  latest_ = nullptr;
  if (!reported_.insert(std::hash<std::string>()(to_string(where) + '\n' + message)).second) return;
  latest_ = &diagnostics_.add({severity, code, where, std::move(message), {}, {}});
}

}  // namespace kerf::pathdxf
