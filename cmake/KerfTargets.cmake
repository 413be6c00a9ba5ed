# kerf_module(NAME [COLD] DEPENDS ... LIBRARIES ...): a static library kerf_NAME of every .cpp in the current
# folder, linked privately. COLD: code that runs once per command, with -O1 in two thirds of the time.

add_library(kerf_flags INTERFACE)
target_include_directories(kerf_flags INTERFACE "${PROJECT_SOURCE_DIR}/include")
target_compile_options(kerf_flags INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Wnon-virtual-dtor -ffp-contract=off)
if(KERF_WERROR)
  target_compile_options(kerf_flags INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC bug 105651: false alarms in the + of std::string, more of them with a precompiled header
  target_compile_options(kerf_flags INTERFACE
    -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
endif()
if(KERF_SANITIZE)
  target_compile_options(kerf_flags INTERFACE -fsanitize=${KERF_SANITIZE} -fno-omit-frame-pointer -g)
  target_link_options(kerf_flags INTERFACE -fsanitize=${KERF_SANITIZE})
  if(KERF_SANITIZE MATCHES "undefined")
    target_compile_options(kerf_flags INTERFACE -fno-sanitize-recover=undefined)
  endif()
endif()
if(KERF_FUZZ)
  target_compile_options(kerf_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
# Assertions are active in every build.
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")

# Precompiled headers save a third of the time of a build (docs/benchlog/build.md). They hold headers of the
# standard library and of other projects only: a file includes what it uses, and the arrows stay in force.
# With GCC only: WebAssembly and the fuzz targets (Clang) are compiled without, which shows a missing include.
# `cmake -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON` shows it as well.
set(KERF_PRECOMPILE OFF)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(KERF_PRECOMPILE ON)
endif()

# kerf_precompiled(NAME HEADERS ... LIBRARIES ...): the target kerf_NAME holds a precompiled header.
function(kerf_precompiled NAME)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  if(NOT KERF_PRECOMPILE)
    return()
  endif()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/kerf_${NAME}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "// Compiled for its precompiled header.\n")
  add_library(kerf_${NAME} OBJECT "${source}")
  target_link_libraries(kerf_${NAME} PRIVATE kerf_flags ${ARG_LIBRARIES})
  target_precompile_headers(kerf_${NAME} PRIVATE ${ARG_HEADERS})
endfunction()

# kerf_use_precompiled(TARGET NAME): TARGET uses the precompiled header of kerf_NAME, if there is one.
function(kerf_use_precompiled TARGET NAME)
  if(TARGET kerf_${NAME})
    target_precompile_headers(${TARGET} REUSE_FROM kerf_${NAME})
    target_compile_options(${TARGET} PRIVATE -fpch-preprocess)  # for the compiler cache
  endif()
endfunction()

function(kerf_module NAME)
  cmake_parse_arguments(ARG "COLD" "" "DEPENDS;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  if(NOT sources)
    message(STATUS "module ${NAME} has no source yet")
    add_library(kerf_${NAME} INTERFACE)
    return()
  endif()
  add_library(kerf_${NAME} STATIC ${sources})
  set_property(GLOBAL APPEND PROPERTY KERF_MODULES kerf_${NAME})
  set(links "")
  foreach(dependency IN LISTS ARG_DEPENDS)
    list(APPEND links kerf_${dependency})
  endforeach()
  target_include_directories(kerf_${NAME} PRIVATE "${PROJECT_SOURCE_DIR}/src")
  target_link_libraries(kerf_${NAME} PRIVATE kerf_flags ${links} ${ARG_LIBRARIES})
  kerf_use_precompiled(kerf_${NAME} headers)
  if(ARG_COLD)
    kerf_cold(kerf_${NAME})
  endif()
endfunction()

# kerf_cold(TARGET): release builds compile TARGET with -O1.
function(kerf_cold TARGET)
  target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()
