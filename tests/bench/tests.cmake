# turner bench: its scenes, its judge, the command. Nothing here fails on a time.
set(app ${PROJECT_SOURCE_DIR}/src/app)
set(sources ${CMAKE_CURRENT_LIST_DIR}/test_bench.c ${app}/bench_check.c ${app}/bench_growth.c
    ${app}/bench_scene.c ${app}/options.c)
turner_unit_test(bench "${sources}" LAYERS base image scene reference bvh gpu render)
target_compile_definitions(test_bench PRIVATE
    TURNER_WORK_DIR="${PROJECT_BINARY_DIR}/tests/bench")
set_target_properties(test_bench PROPERTIES LINKER_LANGUAGE CXX)

find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(what IN ITEMS files wrong growth stages interrupted refused)
    add_test(NAME bench_${what} COMMAND Python3::Interpreter
        ${CMAKE_CURRENT_LIST_DIR}/command_bench.py ${what})
    set_tests_properties(bench_${what} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS device
        ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TURNER_SHADERS=${PROJECT_SOURCE_DIR}/shaders")
endforeach()

# Whole programs, by tools/bench.
add_test(NAME bench_whole COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/whole_bench.py)
set_tests_properties(bench_whole PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS device
    ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TOOLS=${PROJECT_SOURCE_DIR}/tools")
