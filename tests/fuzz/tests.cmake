# Fuzzers. In a fuzz build (preset `fuzz`) each runs for a minute on a copy of its seeds; in other
# builds the same source replays its seeds once, so that they always pass.
set(turner_fuzz_folder ${CMAKE_CURRENT_LIST_DIR})
add_custom_target(fuzzers) # all that the build preset `fuzz` makes
if(TURNER_FUZZ)
    # asserts are part of what a fuzzer looks for, in optimised builds too
    target_compile_options(turner_flags INTERFACE -UNDEBUG)
endif()

# turner_fuzz_target(NAME SOURCE LAYERS layer… [CORPUS folder] [LIBRARIES …]): builds fuzz_NAME
# from SOURCE, which defines LLVMFuzzerTestOneInput, and adds the test fuzz_NAME. Layers are named
# lowest first. Seeds are the files in CORPUS (tests/fuzz/corpus/NAME if not given); words that
# help the fuzzer stand in a libFuzzer dictionary beside it, "<CORPUS>.dict", if there is one.
function(turner_fuzz_target name source)
    cmake_parse_arguments(PARSE_ARGV 2 FUZZ "" "CORPUS" "LAYERS;LIBRARIES")
    if(NOT FUZZ_CORPUS)
        set(FUZZ_CORPUS ${turner_fuzz_folder}/corpus/${name})
    endif()
    add_executable(fuzz_${name} ${source})
    add_dependencies(fuzzers fuzz_${name})
    target_link_libraries(fuzz_${name} PRIVATE turner_flags ${FUZZ_LIBRARIES})
    foreach(layer IN LISTS FUZZ_LAYERS)
        target_link_libraries(fuzz_${name} PRIVATE turner_${layer} ${turner_${layer}_libraries})
    endforeach()
    if(TURNER_FUZZ)
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
        add_test(NAME fuzz_${name} COMMAND ${CMAKE_COMMAND}
            -DFUZZER=$<TARGET_FILE:fuzz_${name}> -DCORPUS=${FUZZ_CORPUS}
            -DWORK=${PROJECT_BINARY_DIR}/tests/fuzz/${name}
            -P ${turner_fuzz_folder}/run.cmake)
        set_tests_properties(fuzz_${name} PROPERTIES TIMEOUT 180)
    else()
        target_sources(fuzz_${name} PRIVATE ${turner_fuzz_folder}/replay.c)
        add_test(NAME fuzz_${name} COMMAND fuzz_${name} ${FUZZ_CORPUS})
    endif()
endfunction()

# JSON scenes; files that a scene names are not opened, see fuzz_json.c.
turner_fuzz_target(json ${turner_fuzz_folder}/fuzz_json.c LAYERS base image scene)
target_link_options(fuzz_json PRIVATE
    -Wl,--wrap=turner_mesh_read_file -Wl,--wrap=turner_scene_texture)

# Shader sources that include each other, held in memory.
turner_fuzz_target(include ${turner_fuzz_folder}/fuzz_include.c LAYERS base image gpu)
target_link_options(fuzz_include PRIVATE
    -Wl,--wrap=turner_embedded_shaders -Wl,--wrap=turner_embedded_shaders_count)

# NFF scenes.
turner_fuzz_target(nff ${turner_fuzz_folder}/fuzz_nff.c LAYERS base image scene)
