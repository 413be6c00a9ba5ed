# The libraries of the Windows build: headers of this system, Debian's zlib for MinGW-w64, and the others
# compiled from the source packages expat, libpng1.6, freetype, minizip, highway and cpp-httplib of Debian.
set(KERF_LIBRARY_SOURCES "${PROJECT_BINARY_DIR}/sources" CACHE PATH "The libraries' unpacked source packages")
set(KERF_SOURCE_INCLUDE "${PROJECT_BINARY_DIR}/source-include")  # headers that their own builds make
file(MAKE_DIRECTORY "${KERF_SOURCE_INCLUDE}")
enable_language(C RC)
include(cmake/KerfHostHeaders.cmake)
kerf_host_headers(CLI)
kerf_header_library(CLI11::CLI11)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)

# kerf_source_library(ALIAS FOLDER FILE ...): a static library of these files, with the folder's headers.
function(kerf_source_library ALIAS FOLDER)
  string(REPLACE "::" "_" name "windows_${ALIAS}")
  list(TRANSFORM ARGN PREPEND "${FOLDER}/")
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} SYSTEM PUBLIC "${FOLDER}" "${KERF_SOURCE_INCLUDE}")
  target_link_libraries(${name} PUBLIC ZLIB::ZLIB)
  add_library(${ALIAS} ALIAS ${name})
endfunction()

# kerf_source_folder(VARIABLE PATTERN): the unpacked package.
function(kerf_source_folder VARIABLE PATTERN)
  file(GLOB found "${KERF_LIBRARY_SOURCES}/${PATTERN}")
  if(NOT found)
    message(FATAL_ERROR "${KERF_LIBRARY_SOURCES}/${PATTERN} is missing: unpack the source package there")
  endif()
  set(${VARIABLE} "${found}" PARENT_SCOPE)
endfunction()

kerf_source_folder(expat "expat-*/expat/lib")
kerf_source_library(EXPAT::EXPAT "${expat}" xmlparse.c xmlrole.c xmltok.c)
file(CONFIGURE OUTPUT "${KERF_SOURCE_INCLUDE}/expat_config.h" CONTENT "#define BYTEORDER 1234
#define XML_CONTEXT_BYTES 1024\n#define XML_DTD 1\n#define XML_GE 1\n#define XML_NS 1\n")
target_compile_definitions(windows_EXPAT_EXPAT PUBLIC XML_STATIC)

kerf_source_folder(minizip "minizip-*/unzip.c")
cmake_path(GET minizip PARENT_PATH minizip)
file(CREATE_LINK "${minizip}" "${KERF_SOURCE_INCLUDE}/minizip" SYMBOLIC)
kerf_source_library(PkgConfig::MINIZIP "${minizip}" ioapi.c iowin32.c unzip.c zip.c)

kerf_source_folder(png "libpng1.6-*")
configure_file("${png}/scripts/pnglibconf.h.prebuilt" "${KERF_SOURCE_INCLUDE}/pnglibconf.h" COPYONLY)
kerf_source_library(PNG::PNG "${png}" png.c pngerror.c pngget.c pngmem.c pngpread.c pngread.c pngrio.c
  pngrtran.c pngrutil.c pngset.c pngtrans.c pngwio.c pngwrite.c pngwtran.c pngwutil.c)

kerf_source_folder(highway "highway-*")
kerf_source_library(hwy::hwy "${highway}" hwy/aligned_allocator.cc hwy/per_target.cc hwy/targets.cc)
target_compile_definitions(windows_hwy_hwy PUBLIC HWY_STATIC_DEFINE)

kerf_source_folder(freetype "freetype-*")
foreach(part BZIP2 HARFBUZZ BROTLI PNG)
  set(FT_DISABLE_${part} ON CACHE BOOL "")
endforeach()
set(SKIP_INSTALL_ALL ON)
add_subdirectory("${freetype}" "${PROJECT_BINARY_DIR}/freetype" EXCLUDE_FROM_ALL)
add_library(Freetype::Freetype ALIAS freetype)

# Headers alone: the header of Debian's library has declarations only.
kerf_source_folder(httplib "cpp-httplib-*/httplib.h")
cmake_path(GET httplib PARENT_PATH httplib)
add_library(PkgConfig::HTTPLIB INTERFACE IMPORTED GLOBAL)
target_link_libraries(PkgConfig::HTTPLIB INTERFACE ws2_32 crypt32)
target_include_directories(PkgConfig::HTTPLIB INTERFACE "${httplib}")

add_compile_definitions(_WIN32_WINNT=0x0A00 UNICODE _UNICODE NOMINMAX)
# GCC bug 54412: on Windows the stack is aligned to 16 bytes, but vectors of AVX2 are moved as aligned ones.
add_compile_options($<$<COMPILE_LANGUAGE:C,CXX>:-Wa,-muse-unaligned-vector-move>)
add_link_options(-static)
