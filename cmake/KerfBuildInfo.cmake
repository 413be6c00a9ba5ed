# kerf_build_info(TARGET): the compiler, the kind of build and the commit, as definitions of "build_info.h".
# They have no date, so that the same sources give the same bytes. The commit is looked up with each build,
# and the header is written only if it differs.
function(kerf_build_info TARGET)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/generated")
  add_custom_target(kerf_commit BYPRODUCTS "${folder}/build_info.h"
    COMMAND ${CMAKE_COMMAND} "-DSOURCE=${PROJECT_SOURCE_DIR}" "-DHEADER=${folder}/build_info.h"
      "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" "-DBUILD_TYPE=${CMAKE_BUILD_TYPE}"
      "-DSYSTEM=${CMAKE_SYSTEM_NAME} ${CMAKE_SYSTEM_PROCESSOR}" "-DSANITIZE=${KERF_SANITIZE}"
      -P "${PROJECT_SOURCE_DIR}/cmake/build_info.cmake"
    COMMENT "" VERBATIM)
  add_dependencies(${TARGET} kerf_commit)
  target_include_directories(${TARGET} PRIVATE "${folder}")
endfunction()
