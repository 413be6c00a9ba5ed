# Libraries of which this system's headers are used for another system: fmt, nlohmann-json, toml++ and
# Boost.Polygon need no more. They are found through a folder of links, because /usr/include itself in the
# search path would add the headers of the host's C library.
set(KERF_HOST_INCLUDE "${PROJECT_BINARY_DIR}/host-include")

# kerf_host_headers(FILE_OR_FOLDER ...): links to them.
function(kerf_host_headers)
  file(MAKE_DIRECTORY "${KERF_HOST_INCLUDE}")
  foreach(library IN LISTS ARGN)
    if(NOT EXISTS "/usr/include/${library}")
      message(FATAL_ERROR "the headers of ${library} are not in /usr/include; ./dev installs them")
    endif()
    file(CREATE_LINK "/usr/include/${library}" "${KERF_HOST_INCLUDE}/${library}" SYMBOLIC)
  endforeach()
endfunction()

# kerf_header_library(NAME DEFINITION ...): a target for it.
function(kerf_header_library NAME)
  add_library(${NAME} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${NAME} INTERFACE "${KERF_HOST_INCLUDE}")
  target_compile_definitions(${NAME} INTERFACE ${ARGN})
endfunction()

kerf_host_headers(fmt nlohmann toml++ boost)
kerf_header_library(fmt::fmt FMT_HEADER_ONLY=1)
kerf_header_library(nlohmann_json::nlohmann_json)
kerf_header_library(tomlplusplus::tomlplusplus TOML_HEADER_ONLY=1 TOML_SHARED_LIB=0)
kerf_header_library(Boost::headers)
