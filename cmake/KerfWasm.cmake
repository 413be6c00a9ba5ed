# The libraries of the WebAssembly build: headers of this system. Debian packages no libraries for emscripten.
# Modules leave out features that need libraries which do not exist there (zlib, minizip, threads).
include(cmake/KerfHostHeaders.cmake)
kerf_host_headers(hwy)
kerf_header_library(hwy::hwy)  # one instruction set, so there is no selection at run time
# Empty targets, so that a module's list of libraries is the same in every build.
foreach(name Threads::Threads ZLIB::ZLIB EXPAT::EXPAT Freetype::Freetype PkgConfig::MINIZIP)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
endforeach()

add_compile_options(-fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions -sALLOW_MEMORY_GROWTH=1)
