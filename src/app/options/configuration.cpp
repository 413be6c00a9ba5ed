// The configuration of this run of the command.
#include "app/options/configuration.h"

namespace kerf::app {

Configuration& configuration() {
  static Configuration of_process;
  return of_process;
}

std::string configured_file(std::string_view key, const std::string& name) {
  return configuration().file_named(key, name).value_or(name);
}

}  // namespace kerf::app
