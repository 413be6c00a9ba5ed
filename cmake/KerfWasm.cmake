# The libraries of the WebAssembly build. Debian packages none for emscripten, but fmt, nlohmann-json, toml++
# and Boost.Polygon can be used as headers only. They are found through a folder of links, because
# /usr/include itself in the search path would add the headers of the host's C library. Modules leave out
# features that need libraries which do not exist there (zlib, minizip, threads).
set(KERF_WASM_INCLUDE "${PROJECT_BINARY_DIR}/host-include")
file(MAKE_DIRECTORY "${KERF_WASM_INCLUDE}")
foreach(library fmt nlohmann toml++ hwy boost)
  if(NOT EXISTS "/usr/include/${library}")
    message(FATAL_ERROR "the headers of ${library} are not in /usr/include; `./dev wasm` installs them")
  endif()
  file(CREATE_LINK "/usr/include/${library}" "${KERF_WASM_INCLUDE}/${library}" SYMBOLIC)
endforeach()

function(kerf_header_library NAME)
  add_library(${NAME} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${NAME} INTERFACE "${KERF_WASM_INCLUDE}")
  target_compile_definitions(${NAME} INTERFACE ${ARGN})
endfunction()
kerf_header_library(fmt::fmt FMT_HEADER_ONLY=1)
kerf_header_library(nlohmann_json::nlohmann_json)
kerf_header_library(tomlplusplus::tomlplusplus TOML_HEADER_ONLY=1 TOML_SHARED_LIB=0)
kerf_header_library(Boost::headers)
kerf_header_library(hwy::hwy)  # one instruction set, so there is no selection at run time
# Empty targets, so that a module's list of libraries is the same in every build.
foreach(name Threads::Threads ZLIB::ZLIB EXPAT::EXPAT Freetype::Freetype PkgConfig::MINIZIP)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
endforeach()

add_compile_options(-fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions -sALLOW_MEMORY_GROWTH=1)
