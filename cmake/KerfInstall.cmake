# The library for other projects: archive, public headers, CMake package and pkg-config file.
#   cmake --install build --component library --prefix PREFIX
# kerfConfig.cmake finds the libraries of kerf_archive again, which a static library leaves to its users.
include(CMakePackageConfigHelpers)
set(KERF_OPTIONAL_LIBRARIES "")
set(KERF_OPTIONAL_MODULES "")
if(TARGET JPEG::JPEG)
  string(APPEND KERF_OPTIONAL_LIBRARIES " JPEG")
  string(APPEND KERF_OPTIONAL_MODULES " libjpeg")
endif()
if(TARGET Fontconfig::Fontconfig)
  string(APPEND KERF_OPTIONAL_LIBRARIES " Fontconfig")
  string(APPEND KERF_OPTIONAL_MODULES " fontconfig")
endif()
if(TARGET SQLite::SQLite3)
  string(APPEND KERF_OPTIONAL_LIBRARIES " SQLite3")
  string(APPEND KERF_OPTIONAL_MODULES " sqlite3")
endif()
set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/kerf")
install(DIRECTORY include/kerf DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT library EXCLUDE_FROM_ALL)
install(TARGETS kerf_archive EXPORT kerf ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library
  EXCLUDE_FROM_ALL)
install(EXPORT kerf NAMESPACE kerf:: FILE kerfTargets.cmake DESTINATION "${package_folder}" COMPONENT library
  EXCLUDE_FROM_ALL)
configure_package_config_file(cmake/kerfConfig.cmake.in "${PROJECT_BINARY_DIR}/kerfConfig.cmake"
  INSTALL_DESTINATION "${package_folder}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/kerfConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/kerfConfig.cmake" "${PROJECT_BINARY_DIR}/kerfConfigVersion.cmake"
  DESTINATION "${package_folder}" COMPONENT library EXCLUDE_FROM_ALL)
configure_file(cmake/kerf.pc.in "${PROJECT_BINARY_DIR}/kerf.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/kerf.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
  COMPONENT library EXCLUDE_FROM_ALL)
