// Records as Python values.
#include "records.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

py::dict to_dict(const Record& record) {
  py::dict out;
  for (std::size_t i = 0; i < record.items().size(); ++i)
    out[to_str(record.keys()[i])] = to_python(record.items()[i]);
  return out;
}

template <class Sequence>
Sequence to_sequence(const Record& record) {
  Sequence out(record.items().size());
  for (std::size_t i = 0; i < record.items().size(); ++i) out[i] = to_python(record.items()[i]);
  return out;
}

}  // namespace

py::object to_python(const Record& record) {
  switch (record.kind()) {
    case Record::Kind::null: return py::none();
    case Record::Kind::boolean: return py::bool_(record.whole() != 0);
    case Record::Kind::whole: return py::int_(record.whole());
    case Record::Kind::number: return py::float_(record.number());
    case Record::Kind::text: return to_str(record.text());
    case Record::Kind::array: return to_sequence<py::list>(record);
    case Record::Kind::tuple: return to_sequence<py::tuple>(record);
    case Record::Kind::object: break;
  }
  return to_dict(record);
}

}  // namespace kerf::python
