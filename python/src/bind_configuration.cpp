// kerf.config(): what kerf.toml and the user's config.toml say.
#include "bindings.h"
#include "job/configuration.h"
#include "job/record/configuration.h"
#include "program_arguments.h"
#include "records.h"

namespace kerf::python {
namespace py = pybind11;

namespace {

py::object config_of(const py::object& folder) {
  Diagnostics diagnostics;
  const Configuration found = configuration_unless_off(to_file_name(folder), diagnostics);
  raise_or_warn(diagnostics);
  return to_python(record_of(found));
}

}  // namespace

void bind_configuration(py::module_& m) {
  m.def("config", &config_of, py::arg("folder") = "",
        R"(Read the values that the command takes from `kerf.toml` and the user's `config.toml`.

The calls of this module do not use them: a script is the same program on every machine unless it asks.

Parameters
----------
folder : str or path
    The folder of the work; by default the current one. The nearest `kerf.toml` there or above counts.

Returns
-------
dict
    `files` that were read, and `values`: for each key a dict of `value`, `file` and `line`, as
    `kerf config --json` prints them. Both are empty where the variable KERF_NO_CONFIG is set.

Raises
------
kerf.Error
    For an unknown key or a wrong value.

Examples
--------
>>> found = kerf.config()['values'].get('post')
>>> post = found['value'] if found else 'grbl')");
}

}  // namespace kerf::python
