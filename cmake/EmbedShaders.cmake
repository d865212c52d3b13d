# Puts copies of the shaders into the program.
#
# Included by the root CMakeLists.txt: turner_embed_shaders(TARGET) adds a generated C file with
# turner_embedded_files (src/gpu/include.h) to TARGET. Run as a script, with -DROOT= -DLIST= -DOUTPUT=,
# it writes that file.

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
        "/* Made by cmake/EmbedShaders.cmake from shaders/. */\n#include \"gpu/include.h\"\n\n${arrays}\n"
        "const struct turner_embedded_file turner_embedded_files[] = {\n${table}    {0, 0},\n};\n"
        "const size_t turner_embedded_file_count = ${count};\n")
    return()
endif()

function(turner_embed_shaders target)
    set(root ${PROJECT_SOURCE_DIR}/shaders)
    file(GLOB files CONFIGURE_DEPENDS ${root}/*.glsl ${root}/*.comp ${root}/*.h
                                      ${root}/user/*.glsl)
    set(names)
    foreach(file IN LISTS files)
        file(RELATIVE_PATH name ${root} ${file})
        list(APPEND names ${name})
    endforeach()
    list(SORT names)
    list(JOIN names "\n" text)
    set(list ${PROJECT_BINARY_DIR}/shaders.txt)
    set(output ${PROJECT_BINARY_DIR}/embedded_shaders.c)
    file(CONFIGURE OUTPUT ${list} CONTENT "${text}\n" @ONLY) # untouched when nothing changed
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -DROOT=${root} -DLIST=${list} -DOUTPUT=${output}
                -P ${PROJECT_SOURCE_DIR}/cmake/EmbedShaders.cmake
        DEPENDS ${files} ${list} ${PROJECT_SOURCE_DIR}/cmake/EmbedShaders.cmake
        COMMENT "Embedding shaders" VERBATIM)
    target_sources(${target} PRIVATE ${output})
endfunction()
