# Whole pictures: what is compiled in, that nothing but the scene decides them, counts, edge cases.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

# turner_render_test(NAME): a program with all layers.
function(turner_render_test name)
    add_executable(test_${name} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/test_${name}.c
        ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/render_test.c
        ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../truth/explain.c)
    target_link_libraries(test_${name} PRIVATE turner_flags PkgConfig::CMOCKA ${turner_libraries})
    foreach(layer IN ITEMS base image scene reference bvh gpu render)
        target_link_libraries(test_${name} PRIVATE turner_${layer})
    endforeach()
    target_compile_definitions(test_${name} PRIVATE TURNER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    set_target_properties(test_${name} PROPERTIES LINKER_LANGUAGE CXX)
endfunction()

# turner_device_test(TEST PROGRAM argument…)
function(turner_device_test test program)
    add_test(NAME ${test} COMMAND ${program} ${ARGN})
    set_tests_properties(${test} PROPERTIES SKIP_RETURN_CODE 77 LABELS device TIMEOUT 600)
endfunction()

turner_render_test(needs)
add_test(NAME needs COMMAND test_needs)

turner_render_test(switches)
file(GLOB switch_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.json)
list(FILTER switch_scenes EXCLUDE REGEX "/schema\\.json$")
foreach(scene IN LISTS switch_scenes)
    get_filename_component(name ${scene} NAME_WE)
    turner_device_test(switches_${name} test_switches ${scene})
endforeach()

turner_render_test(repeat)
turner_device_test(repeat test_repeat)

turner_render_test(soak)
turner_device_test(soak test_soak)

turner_render_test(counts)
turner_device_test(counts test_counts)

turner_render_test(edges)
turner_device_test(edges test_edges)

foreach(what IN ITEMS files stats nonfinite)
    turner_device_test(output_${what} Python3::Interpreter
        ${CMAKE_CURRENT_LIST_DIR}/command_output.py ${what})
    set_property(TEST output_${what} APPEND PROPERTY ENVIRONMENT "TURNER=$<TARGET_FILE:turner>")
endforeach()

turner_device_test(methods Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/methods.py
    $<TARGET_FILE:turner> ${PROJECT_SOURCE_DIR})

turner_device_test(beams Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/beams.py
    $<TARGET_FILE:turner>)

turner_device_test(work Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/work.py
    $<TARGET_FILE:turner> ${PROJECT_SOURCE_DIR})
