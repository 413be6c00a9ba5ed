# Writes the C++ of kerf_embed: run as a script with NAME, HEADER, SOURCE and FILES.
file(WRITE "${HEADER}" "// Made by the build: files that are part of the program.
#pragma once
#include <cstddef>
#include <string_view>
namespace kerf::embedded {
struct File {
  std::string_view name;
  std::string_view bytes;
};
extern const File ${NAME}[];
extern const std::size_t ${NAME}_count;
}  // namespace kerf::embedded
")
set(arrays "")
set(table "")
set(count 0)
foreach(path IN LISTS FILES)
  file(READ "${path}" hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  get_filename_component(name "${path}" NAME)
  string(APPEND arrays "constexpr char kBytes${count}[] = {${bytes}};\n")
  string(APPEND table "  {\"${name}\", {kBytes${count}, sizeof kBytes${count}}},\n")
  math(EXPR count "${count} + 1")
endforeach()
get_filename_component(header_name "${HEADER}" NAME)
file(WRITE "${SOURCE}" "// Made by the build.
#include \"${header_name}\"
namespace kerf::embedded {
namespace {
${arrays}}  // namespace
const File ${NAME}[] = {
${table}};
const std::size_t ${NAME}_count = ${count};
}  // namespace kerf::embedded
")
