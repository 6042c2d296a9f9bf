# Writes OUTPUT, a header that defines STOPLINE_VERSION_TEXT as "VERSION (REVISION)". The revision is the output of
# `git describe` in SOURCE_DIR, or "unknown". An unchanged file is not rewritten, so nothing is recompiled.
set(revision "unknown")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE_DIR}/.git)
    # Without optional locks, `git describe` does not disturb another git command that runs at the same time.
    execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0 ${GIT} describe --always --dirty
                    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE described RESULT_VARIABLE result
                    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(result EQUAL 0 AND described)
        set(revision ${described})
    endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define STOPLINE_VERSION_TEXT \"${VERSION} (${revision})\"\n")
