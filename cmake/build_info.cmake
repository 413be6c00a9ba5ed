# Writes build_info.h of kerf_build_info(): run as a script with SOURCE, HEADER, COMPILER, BUILD_TYPE, SYSTEM
# and SANITIZE. Sources outside of a checkout have no commit: an sdist may lie inside another project's one.
cmake_minimum_required(VERSION 3.25)
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS "${SOURCE}/.git")
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" describe --always --dirty --abbrev=12 "--exclude=*"
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
string(REPLACE "GNU " "GCC " COMPILER "${COMPILER}")
file(CONFIGURE OUTPUT "${HEADER}" CONTENT "// Made by the build.
#define KERF_BUILD_COMPILER \"@COMPILER@\"
#define KERF_BUILD_TYPE \"@BUILD_TYPE@\"
#define KERF_BUILD_SYSTEM \"@SYSTEM@\"
#define KERF_BUILD_SANITIZE \"@SANITIZE@\"
#define KERF_BUILD_COMMIT \"@commit@\"
" @ONLY)
