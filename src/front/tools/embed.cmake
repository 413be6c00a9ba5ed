# Writes the text of INPUT as a C++ source OUTPUT that defines kerf::detail::built_in_tool_text().
file(READ "${INPUT}" text)
file(WRITE "${OUTPUT}" "// Made from data/tools.toml by embed.cmake.
#include \"front/tools/built_in_text.h\"

namespace kerf::detail {

std::string_view built_in_tool_text() {
  return R\"KERF(${text})KERF\";
}

}  // namespace kerf::detail
")
