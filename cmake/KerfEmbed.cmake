# kerf_embed(TARGET NAME FILE ...): embeds files into a module as bytes, for use without a file system.
# In C++: `extern const kerf::EmbeddedFile NAME[]; extern const std::size_t NAME_count;` of "embedded_NAME.h".

function(kerf_embed TARGET NAME)
  set(header "${CMAKE_CURRENT_BINARY_DIR}/embedded/embedded_${NAME}.h")
  set(source "${CMAKE_CURRENT_BINARY_DIR}/embedded/embedded_${NAME}.cpp")
  add_custom_command(OUTPUT "${header}" "${source}"
    COMMAND ${CMAKE_COMMAND} "-DNAME=${NAME}" "-DHEADER=${header}" "-DSOURCE=${source}" "-DFILES=${ARGN}"
            -P "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake"
    DEPENDS ${ARGN} "${PROJECT_SOURCE_DIR}/cmake/embed_files.cmake" VERBATIM)
  target_sources(${TARGET} PRIVATE "${header}" "${source}")
  target_include_directories(${TARGET} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/embedded")
endfunction()
