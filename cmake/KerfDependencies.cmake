# The libraries Kerf builds on, all from Debian (docs/decisions/0002-libraries.md says why each).
if(EMSCRIPTEN)
  include(cmake/KerfWasm.cmake)
  return()
endif()
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(Threads REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers of Boost.Polygon
find_package(hwy REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
find_package(EXPAT REQUIRED)
find_package(Freetype REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(MINIZIP REQUIRED QUIET IMPORTED_TARGET minizip)
if(KERF_APP)
  find_package(CLI11 REQUIRED)
  pkg_check_modules(HTTPLIB REQUIRED QUIET IMPORTED_TARGET cpp-httplib)
endif()

# Python: the virtual environment that ./dev creates, otherwise Debian's. Another Python earlier in PATH
# would lack pybind11 and the headers.
if(KERF_PYTHON OR KERF_TESTS)
  foreach(candidate "${CMAKE_BINARY_DIR}/venv/bin/python" /usr/bin/python3)
    if(NOT Python_EXECUTABLE AND EXISTS "${candidate}")
      set(Python_EXECUTABLE "${candidate}" CACHE FILEPATH
        "The Python that the modules are for and the tests run with")
    endif()
  endforeach()
  find_package(Python 3.9 REQUIRED COMPONENTS Interpreter OPTIONAL_COMPONENTS Development.Module)
endif()
if(KERF_PYTHON)
  set(PYBIND11_FINDPYTHON ON)
endif()

# Every target sees fmt's definitions, so that all modules can use one precompiled header.
target_compile_definitions(kerf_flags INTERFACE $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
