# turner_add_image_test(NAME <name> SCENE <file> REFERENCE <png or exr>
#                       [ARGS <argument of turner render>…]
#                       [THRESHOLD <x>] [RELATIVE <r>] [PIXELS <n or p%>])
#
# A CTest that renders SCENE and compares the picture with REFERENCE as `turner compare` does:
# THRESHOLD, RELATIVE and PIXELS are its options of these names and defaults. Relative paths start
# at the current source folder. The picture is of REFERENCE's kind and size comes from the scene
# unless ARGS say otherwise (--size, --device, …).
#
# <project's build folder>/image-tests/<name>/ then holds picture, reference, difference.png (heat
# map) and comparison.json; dashboards get the three pictures and the figures as measurements.
# Without a Vulkan device the test is skipped, unless ARGS ask for the device "reference".
# With TURNER_UPDATE_GOLDENS=1 in the environment the picture replaces REFERENCE instead.
#
# The program is the variable TURNER_EXECUTABLE, else the target turner::turner, else turner.
function(turner_add_image_test)
    cmake_parse_arguments(PARSE_ARGV 0 TEST "" "NAME;SCENE;REFERENCE;THRESHOLD;RELATIVE;PIXELS"
                          "ARGS")
    if(TEST_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "turner_add_image_test: unknown words: ${TEST_UNPARSED_ARGUMENTS}")
    endif()
    foreach(word NAME SCENE REFERENCE)
        if(NOT TEST_${word})
            message(FATAL_ERROR "turner_add_image_test: ${word} is missing")
        endif()
    endforeach()
    if(TURNER_EXECUTABLE)
        set(program ${TURNER_EXECUTABLE})
    elseif(TARGET turner::turner)
        set(program $<TARGET_FILE:turner::turner>)
    elseif(TARGET turner)
        set(program $<TARGET_FILE:turner>)
    else()
        message(FATAL_ERROR "turner_add_image_test: no target turner::turner; call "
                            "find_package(turner) first or set TURNER_EXECUTABLE")
    endif()
    cmake_path(ABSOLUTE_PATH TEST_SCENE NORMALIZE)
    cmake_path(ABSOLUTE_PATH TEST_REFERENCE NORMALIZE)
    set(tolerance)
    foreach(word THRESHOLD RELATIVE PIXELS)
        if(DEFINED TEST_${word})
            string(TOLOWER ${word} option)
            list(APPEND tolerance --${option}=${TEST_${word}})
        endif()
    endforeach()
    add_test(NAME ${TEST_NAME} COMMAND ${CMAKE_COMMAND}
        "-DTURNER=${program}" "-DSCENE=${TEST_SCENE}" "-DREFERENCE=${TEST_REFERENCE}"
        "-DRENDER_ARGS=${TEST_ARGS}" "-DTOLERANCE=${tolerance}"
        "-DFOLDER=${PROJECT_BINARY_DIR}/image-tests/${TEST_NAME}"
        -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/RunImageTest.cmake)
    set_tests_properties(${TEST_NAME} PROPERTIES
        LABELS image SKIP_REGULAR_EXPRESSION "image test skipped: ")
endfunction()
