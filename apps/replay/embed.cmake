# Writes a C++ header that contains the files of the page as string literals.
# Usage: cmake -DFOLDER=... -DOUTPUT=... -P embed.cmake
file(GLOB files ${FOLDER}/*)
set(text "// Made from apps/replay/page by apps/replay/embed.cmake.\n#pragma once\n\n")
foreach(file ${files})
    get_filename_component(name ${file} NAME)
    string(REGEX REPLACE "[^a-zA-Z0-9]" "_" name ${name})
    file(READ ${file} content)
    string(APPEND text "inline constexpr const char* kFile_${name} = R\"__page__(${content})__page__\";\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
