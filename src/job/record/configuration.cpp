// A configuration as a record.
#include "job/record/configuration.h"

#include "base/names.h"

namespace kerf {

Record record_of(const Configuration& configuration) {
  Record values = Record::object();
  for (const ConfigValue& value : configuration.values())
    values[std::string(value.key)] =
        Record{{"value", joined(value.texts, ", ")}, {"file", value.file}, {"line", value.line}};
  return Record{{"files", configuration.files()}, {"values", values}};
}

}  // namespace kerf
