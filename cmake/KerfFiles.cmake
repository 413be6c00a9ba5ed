# What is installed next to the command and the modules: manual pages, completion scripts, desktop entry, file
# types, documents, machine profiles and posts to copy, editors' files. The command itself needs none of them.
set(doc_folder "${KERF_DATA_ROOT}/doc/kerf")
set(data_folder "${KERF_DATA_ROOT}/kerf")

# The folders are those of the sources, so that links from one document to another lead somewhere.
file(READ README.md readme)
string(REPLACE "](LICENSE)" "](copyright)" readme "${readme}")
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/package/README.md" CONTENT "@readme@" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/package/README.md" ARCHITECTURE.md CHANGELOG.md CONTRIBUTING.md NOTICE
  SECURITY.md
  cmake/package/copyright DESTINATION ${doc_folder} COMPONENT doc)
install(FILES docs/differences.md docs/index.md DESTINATION ${doc_folder}/docs COMPONENT doc)
install(DIRECTORY docs/tutorials docs/how-to docs/manual docs/decisions docs/benchlog
  DESTINATION ${doc_folder}/docs COMPONENT doc PATTERN "*.py" EXCLUDE)
install(FILES web/PROTOCOL.md DESTINATION ${doc_folder}/web COMPONENT doc)
install(DIRECTORY examples licences DESTINATION ${doc_folder} COMPONENT doc PATTERN "__pycache__" EXCLUDE)

install(DIRECTORY data/machines posts editors DESTINATION ${data_folder} COMPONENT data)

if(NOT TARGET kerf)
  return()
endif()
find_program(KERF_GZIP gzip)
set(help_folder "${PROJECT_BINARY_DIR}/help")
add_custom_command(OUTPUT "${help_folder}/made"
  COMMAND ${CMAKE_COMMAND} "-DKERF=$<TARGET_FILE:kerf>" "-DEMULATOR=${CMAKE_CROSSCOMPILING_EMULATOR}"
    "-DFOLDER=${help_folder}" "-DGZIP=${KERF_GZIP}"
    -P "${PROJECT_SOURCE_DIR}/cmake/help_files.cmake"
  DEPENDS kerf "${PROJECT_SOURCE_DIR}/cmake/help_files.cmake"
  COMMENT "Manual pages and completion scripts" VERBATIM)
add_custom_target(kerf_help_files ALL DEPENDS "${help_folder}/made")
set(root "${KERF_DATA_ROOT}")
install(DIRECTORY "${help_folder}/man/" DESTINATION "${root}/man/man1" COMPONENT shell)
install(FILES "${help_folder}/kerf.bash" DESTINATION "${root}/bash-completion/completions" RENAME kerf
  COMPONENT shell)
install(FILES "${help_folder}/kerf.zsh" DESTINATION "${root}/zsh/vendor-completions" RENAME _kerf
  COMPONENT shell)
install(FILES "${help_folder}/kerf.fish" DESTINATION "${root}/fish/vendor_completions.d" COMPONENT shell)
install(FILES cmake/package/kerf.desktop DESTINATION "${root}/applications" COMPONENT shell)
install(FILES cmake/package/kerf.svg DESTINATION "${root}/icons/hicolor/scalable/apps" COMPONENT shell)
install(FILES cmake/package/kerf-mime.xml DESTINATION "${root}/mime/packages" RENAME kerf.xml
  COMPONENT shell)
