# Script: writes OUTPUT from the template INPUT with HELIXNAV_VERSION and the git commit of SOURCE_DIR.
set(git git --no-optional-locks -C ${SOURCE_DIR})
set(HELIXNAV_COMMIT unknown)

# A release unpacked inside somebody else's repository must not take that repository's commit for its own.
execute_process(COMMAND ${git} rev-parse --show-prefix
  OUTPUT_VARIABLE prefix ERROR_QUIET RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT failed AND prefix STREQUAL "")
  execute_process(COMMAND ${git} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE head ERROR_QUIET RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed)
    execute_process(COMMAND ${git} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
    set(HELIXNAV_COMMIT ${head})
    if(changes)
      string(APPEND HELIXNAV_COMMIT "+changes")
    endif()
  endif()
endif()

configure_file(${INPUT} ${OUTPUT} @ONLY)
