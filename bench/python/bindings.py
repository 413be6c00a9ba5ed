"""pybind11 and nanobind on the same small class: calls per second, time of import, size, time to compile.

    python3 bench/python/bindings.py      in an environment with pybind11 and nanobind

The class is Toolpath.cut reduced to its binding: a tuple of three numbers and a number, appended to a vector,
with the errors of wrong arguments. Compiles in a temporary folder with c++ -O2.
"""

import pathlib
import subprocess
import sys
import sysconfig
import tempfile
import time

import nanobind
import pybind11

COMMON = """
#include <vector>
#include <stdexcept>
struct Step { double x, y, z, feed; };
struct Path { std::vector<Step> steps; };
static double number(PyObject* item) {
  const double v = PyFloat_AsDouble(item);
  if (v == -1.0 && PyErr_Occurred()) { PyErr_Clear(); throw std::invalid_argument("to must be numbers"); }
  return v;
}
static void cut(Path& path, PyObject* to, double feed) {
  if (!PyTuple_Check(to) || PyTuple_GET_SIZE(to) != 3) 
    throw std::invalid_argument("to must be three numbers");
  if (!(feed > 0)) throw std::invalid_argument("feed must be above 0");
  path.steps.push_back({number(PyTuple_GET_ITEM(to, 0)), number(PyTuple_GET_ITEM(to, 1)),
                        number(PyTuple_GET_ITEM(to, 2)), feed});
}
"""
SOURCES = {
    "pybind11": "#include <pybind11/pybind11.h>\n" + COMMON + """
namespace py = pybind11;
PYBIND11_MODULE(with_pybind11, m) {
  py::class_<Path>(m, "Path").def(py::init<>())
      .def("cut", [](Path& p, py::handle to, double feed) { cut(p, to.ptr(), feed); },
           py::arg("to"), py::arg("feed"))
      .def("__len__", [](const Path& p) { return p.steps.size(); });
}
""",
    "nanobind": "#include <nanobind/nanobind.h>\n" + COMMON + """
namespace nb = nanobind;
NB_MODULE(with_nanobind, m) {
  nb::class_<Path>(m, "Path").def(nb::init<>())
      .def("cut", [](Path& p, nb::handle to, double feed) { cut(p, to.ptr(), feed); },
           nb::arg("to"), nb::arg("feed"))
      .def("__len__", [](const Path& p) { return p.steps.size(); });
}
""",
}
SCRIPT = """
import time
start = time.perf_counter()
from with_{name} import Path
loaded = time.perf_counter() - start
best = 1e9
for _ in range(5):
    path = Path()
    start = time.process_time()
    for i in range(300000):
        path.cut((i * 0.5, 2.0, -1.0), {feed})
    best = min(best, time.process_time() - start)
assert len(path) == 300000
print(f"{{300000 / best:,.0f}} calls/s, import {{loaded * 1e3:.2f}} ms")
"""


def compile_with(name, folder):
    source, suffix = folder / f"{name}.cpp", sysconfig.get_config_var("EXT_SUFFIX")
    source.write_text(SOURCES[name])
    words = ["c++", "-std=c++20", "-O2", "-DNDEBUG", "-fPIC", "-shared", "-fvisibility=hidden", "-s"]
    words += [f"-I{sysconfig.get_path('include')}", str(source)]
    if name == "pybind11":
        words.append(f"-I{pybind11.get_include()}")
    else:
        root = pathlib.Path(nanobind.__file__).parent
        words += [f"-I{root / 'include'}", f"-I{root / 'ext' / 'robin_map' / 'include'}"]
        words.append(str(root / "src" / "nb_combined.cpp"))
    target = folder / f"with_{name}{suffix}"
    start = time.perf_counter()
    subprocess.run([*words, "-o", str(target)], check=True)
    return time.perf_counter() - start, target.stat().st_size


def main():
    with tempfile.TemporaryDirectory() as text:
        folder = pathlib.Path(text)
        for name, version in (("pybind11", pybind11.__version__), ("nanobind", nanobind.__version__)):
            seconds, size = compile_with(name, folder)
            print(f"{name} {version}: {size / 1e3:.0f} kB, compiled in {seconds:.1f} s")
            for how, feed in (("by position", "800.0"), ("feed by name", "feed=800.0")):
                done = subprocess.run([sys.executable, "-c", SCRIPT.format(name=name, feed=feed)], cwd=folder,
                                      capture_output=True, text=True, check=True)
                print(f"  {how}: {done.stdout.strip()}")


if __name__ == "__main__":
    main()
