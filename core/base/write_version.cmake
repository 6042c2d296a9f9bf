# Writes OUTPUT, a header that defines STOPLINE_VERSION_TEXT as "VERSION (what git calls SOURCE_DIR, or unknown)".
# Leaves the file alone when the text is the same, so that nothing is recompiled.
set(revision "unknown")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE_DIR}/.git)
    # The lock is optional: describe must not disturb a git command that runs meanwhile.
    execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0 ${GIT} describe --always --dirty
                    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE described RESULT_VARIABLE result
                    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(result EQUAL 0 AND described)
        set(revision ${described})
    endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define STOPLINE_VERSION_TEXT \"${VERSION} (${revision})\"\n")
