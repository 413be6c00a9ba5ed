# What is installed, and the Debian package: the command, the Python modules in a folder of their own where
# `kerf run` and Debian's python3 find them, the manual, the examples.
set(doc_folder share/doc/kerf)
install(FILES README.md CHANGELOG.md NOTICE DESTINATION ${doc_folder} COMPONENT doc)
install(FILES LICENSE DESTINATION ${doc_folder} RENAME copyright COMPONENT doc)
install(FILES docs/differences.md DESTINATION ${doc_folder}/docs COMPONENT doc)
install(DIRECTORY docs/manual DESTINATION ${doc_folder}/docs COMPONENT doc PATTERN "*.py" EXCLUDE)
install(DIRECTORY examples DESTINATION ${doc_folder} COMPONENT doc)

# Debian's python3 reads this file at its start and adds the folder in it to its path.
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/kerf.pth" CONTENT "/usr/${KERF_PYTHON_DIR}\n")
install(FILES "${PROJECT_BINARY_DIR}/kerf.pth" DESTINATION lib/python3/dist-packages
  COMPONENT python_path EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kerf)
set(CPACK_PACKAGE_CONTACT "Kerf developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulates, checks and writes G-code")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Kerf shows what a G-code program cuts before a machine runs it: a picture, a mesh, the
machining time, and the line of every motion that would damage a tool or the part. It
compiles gcmc programs, path drawings (DXF), Python scripts and cutting jobs to G-code.")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENTS_ALL app python python_path doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
if(KERF_PYTHON)
  # The compiled modules fit one version of Python only.
  string(REGEX MATCH "^[0-9]+\\.([0-9]+)" version "${KERF_PYTHON_VERSION}")
  math(EXPR next_minor "${CMAKE_MATCH_1} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= ${version}), python3 (<< 3.${next_minor}), python3-numpy")
endif()
include(CPack)
