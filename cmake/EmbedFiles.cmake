# Puts copies of files into the program.
#
# Included by the root CMakeLists.txt: turner_embed_files(TARGET ARRAY ROOT pattern…) adds to TARGET a
# generated C file with the array of struct turner_embedded_file (src/base/embedded.h) called ARRAY,
# and its length ARRAY_count, of the files under ROOT that match. Run as a script, with -DROOT=
# -DLIST= -DOUTPUT= -DARRAY=, it writes that file.

if(CMAKE_SCRIPT_MODE_FILE)
    file(STRINGS ${LIST} names)
    set(arrays "")
    set(table "")
    set(count 0)
    foreach(name IN LISTS names)
        file(READ ${ROOT}/${name} hex HEX)
        string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
        string(REGEX REPLACE "(0x0a,)" "\\1\n" bytes "${bytes}") # a line a line
        string(APPEND arrays "static const unsigned char file_${count}[] = {\n${bytes}0};\n")
        string(APPEND table "    {\"${name}\", (const char *)file_${count}},\n")
        math(EXPR count "${count} + 1")
    endforeach()
    file(WRITE ${OUTPUT}
        "/* Made by cmake/EmbedFiles.cmake. */\n#include \"base/embedded.h\"\n\n${arrays}\n"
        "const struct turner_embedded_file ${ARRAY}[] = {\n${table}    {0, 0},\n};\n"
        "const size_t ${ARRAY}_count = ${count};\n")
    return()
endif()

function(turner_embed_files target array root)
    list(TRANSFORM ARGN PREPEND ${root}/ OUTPUT_VARIABLE patterns)
    file(GLOB files CONFIGURE_DEPENDS ${patterns})
    set(names)
    foreach(file IN LISTS files)
        file(RELATIVE_PATH name ${root} ${file})
        list(APPEND names ${name})
    endforeach()
    list(SORT names)
    list(JOIN names "\n" text)
    set(list ${PROJECT_BINARY_DIR}/${array}.txt)
    set(output ${PROJECT_BINARY_DIR}/${array}.c)
    file(CONFIGURE OUTPUT ${list} CONTENT "${text}\n" @ONLY) # untouched when nothing changed
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DROOT=${root} -DLIST=${list} -DOUTPUT=${output} -DARRAY=${array}
                -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
        DEPENDS ${files} ${list} ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
        COMMENT "Embedding ${array}" VERBATIM)
    target_sources(${target} PRIVATE ${output})
endfunction()
