# How many samples a pixel gets, and what is said of its error.
add_executable(test_adaptive ${CMAKE_CURRENT_LIST_DIR}/test_adaptive.c
    ${CMAKE_CURRENT_LIST_DIR}/../render/render_test.c ${CMAKE_CURRENT_LIST_DIR}/../truth/explain.c)
target_link_libraries(test_adaptive PRIVATE turner_flags PkgConfig::CMOCKA ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_adaptive PRIVATE turner_${layer})
endforeach()
target_compile_definitions(test_adaptive PRIVATE TURNER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(test_adaptive PROPERTIES LINKER_LANGUAGE CXX)
add_test(NAME adaptive COMMAND test_adaptive)
set_tests_properties(adaptive PROPERTIES SKIP_RETURN_CODE 77 LABELS device)

turner_unit_test(error_truth "${CMAKE_CURRENT_LIST_DIR}/test_truth.c;${CMAKE_CURRENT_LIST_DIR}/truth.c"
                 LAYERS base image scene reference)

add_executable(error_measure ${CMAKE_CURRENT_LIST_DIR}/measure.c ${CMAKE_CURRENT_LIST_DIR}/truth.c)
target_link_libraries(error_measure PRIVATE turner_flags ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(error_measure PRIVATE turner_${layer})
endforeach()
set_target_properties(error_measure PROPERTIES LINKER_LANGUAGE CXX)
add_dependencies(error_measure turner_modules) # reads the truths

# The estimate beside the truth: a bound on 99.9 % of the pixels, within a factor of 10 on the median
# one. docs/error.md has more scenes, and which miss it.
function(turner_error_test test scene share tight)
    add_test(NAME ${test} COMMAND error_measure ${PROJECT_SOURCE_DIR}/scenes/${scene}.json 64 48
        0.00392157 --truth ${PROJECT_SOURCE_DIR}/tests/error/truth/${scene}.exr --share ${share}
        --tight ${tight} ${ARGN})
    set_tests_properties(${test} PROPERTIES SKIP_RETURN_CODE 77 LABELS device)
endfunction()
foreach(name IN ITEMS metals mirrors fresnel phong_terms lights attenuation underwater mesh prism)
    turner_error_test(error_${name} ${name} 0.999 10)
endforeach()
turner_error_test(error_of_schlick fresnel 0.999 10 --method fresnel=schlick)

find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME error_command COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/command_error.py)
set_tests_properties(error_command PROPERTIES SKIP_RETURN_CODE 77 LABELS device
    ENVIRONMENT "TURNER=$<TARGET_FILE:turner>")
