# Makes the manual pages and completion scripts: run as a script with KERF, the command, EMULATOR, which
# runs it if it is for another processor, FOLDER, and GZIP, which compresses the pages.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}/man")
execute_process(COMMAND ${EMULATOR} "${KERF}" man "${FOLDER}/man" COMMAND_ERROR_IS_FATAL ANY)
foreach(shell bash zsh fish)
  execute_process(COMMAND ${EMULATOR} "${KERF}" completion ${shell} OUTPUT_FILE "${FOLDER}/kerf.${shell}"
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(GZIP)
  file(GLOB pages "${FOLDER}/man/*.1")
  execute_process(COMMAND "${GZIP}" -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
file(TOUCH "${FOLDER}/made")
