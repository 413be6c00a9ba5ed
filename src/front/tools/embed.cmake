# Writes the text of INPUT as a C++ source OUTPUT that defines kerf::detail::FUNCTION().
file(READ "${INPUT}" text)
get_filename_component(name "${INPUT}" NAME)
file(WRITE "${OUTPUT}" "// Made from data/${name} by embed.cmake.
#include \"front/tools/built_in_text.h\"

namespace kerf::detail {

std::string_view ${FUNCTION}() {
  return R\"KERF(${text})KERF\";
}

}  // namespace kerf::detail
")
