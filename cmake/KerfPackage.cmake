# The Debian packages: `kerf`, the command with its documents, which fits Debian 12 and 13, and
# `python3-kerf`, the modules for one version of Python in a folder where `kerf run` and python3 find them.

# Debian's python3 reads this file at its start and adds the folder in it to its path.
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/package/kerf.pth" CONTENT "/usr/${KERF_PYTHON_DIR}\n")
install(FILES "${PROJECT_BINARY_DIR}/package/kerf.pth" DESTINATION lib/python3/dist-packages
  COMPONENT python_path EXCLUDE_FROM_ALL)

# Libraries whose packages have other names in each release of Debian come along, in a folder of the package.
if(KERF_PRIVATE_LIBRARIES)
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/package/lib")
  foreach(library IN LISTS KERF_PRIVATE_LIBRARIES)
    find_library(KERF_FOUND_${library} NAMES ${library} REQUIRED)
    file(REAL_PATH "${KERF_FOUND_${library}}" file)
    execute_process(COMMAND objdump -p "${file}" OUTPUT_VARIABLE header COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCH "SONAME +([^\n]+)" unused "${header}")
    file(COPY_FILE "${file}" "${PROJECT_BINARY_DIR}/package/lib/${CMAKE_MATCH_1}" ONLY_IF_DIFFERENT)
    install(FILES "${file}" DESTINATION lib/kerf RENAME "${CMAKE_MATCH_1}" COMPONENT private_libraries)
  endforeach()
endif()

# The changelog has the date of the commit, so that the same sources give the same package.
set(date "$ENV{SOURCE_DATE_EPOCH}")
if(date STREQUAL "" AND EXISTS "${PROJECT_SOURCE_DIR}/.git")
  execute_process(COMMAND git -C "${PROJECT_SOURCE_DIR}" log -1 --format=%ct OUTPUT_VARIABLE date
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(date STREQUAL "")
  file(TIMESTAMP "${PROJECT_SOURCE_DIR}/VERSION" date "%s" UTC)
endif()
execute_process(COMMAND date -u -R -d "@${date}" OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET)
set(KERF_PACKAGE_CONTACT "Kerf developers <kerf-cam@example.org>" CACHE STRING
  "The maintainer of the Debian packages")
find_program(KERF_GZIP gzip)
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/package/changelog" CONTENT
"kerf (${PROJECT_VERSION}) unstable; urgency=medium

  * The changes are in /usr/share/doc/kerf/CHANGELOG.md.

 -- ${KERF_PACKAGE_CONTACT}  ${date}
")
if(KERF_GZIP)
  execute_process(COMMAND "${KERF_GZIP}" -9nkf "${PROJECT_BINARY_DIR}/package/changelog")
  install(FILES "${PROJECT_BINARY_DIR}/package/changelog.gz" DESTINATION share/doc/kerf
    COMPONENT debian EXCLUDE_FROM_ALL)
endif()
set(linked_documents "\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/doc")
install(CODE "file(MAKE_DIRECTORY \"${linked_documents}\")
  file(CREATE_LINK kerf \"${linked_documents}/python3-kerf\" SYMBOLIC)"
  COMPONENT python_path EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kerf)
set(CPACK_PACKAGE_CONTACT "${KERF_PACKAGE_CONTACT}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL app private_libraries shell data doc debian)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME kerf)
set(CPACK_DEBIAN_COMMAND_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/package/lib")
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "python3-kerf")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "xdg-utils")
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "simulates, checks and writes G-code
Kerf shows what a G-code program cuts before a machine runs it: a picture, a
mesh, the machining time, and the line of every motion that would damage a
tool or the part. It compiles gcmc programs, path drawings (DXF), OpenSCAD
programs, Python scripts and cutting jobs to G-code for many controllers.")

include(CPackComponent)
cpack_add_component_group(command DESCRIPTION "${CPACK_COMPONENT_COMMAND_DESCRIPTION}")
foreach(component app private_libraries shell data doc debian)
  cpack_add_component(${component} GROUP command)
endforeach()
if(KERF_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python python_path)
  cpack_add_component_group(modules)
  cpack_add_component(python GROUP modules)
  cpack_add_component(python_path GROUP modules)
  set(CPACK_DEBIAN_MODULES_PACKAGE_NAME python3-kerf)
  set(CPACK_DEBIAN_MODULES_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_MODULES_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_MODULES_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_MODULES_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/cmake/package/postinst;${PROJECT_SOURCE_DIR}/cmake/package/prerm")
  set(CPACK_COMPONENT_MODULES_DESCRIPTION "Python modules of Kerf
Toolpaths, tools, operations and simulation from Python: the modules kerf,
gcodepreview and cnc25d_api, for scripts and for the command kerf run.")
  # The compiled modules fit one version of Python only.
  string(REGEX MATCH "^[0-9]+\\.([0-9]+)" version "${KERF_PYTHON_VERSION}")
  math(EXPR next_minor "${CMAKE_MATCH_1} + 1")
  set(CPACK_DEBIAN_MODULES_PACKAGE_DEPENDS
    "kerf (= ${PROJECT_VERSION}), python3 (>= ${version}), python3 (<< 3.${next_minor}), python3-numpy")
endif()
include(CPack)
