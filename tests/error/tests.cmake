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
set_tests_properties(adaptive PROPERTIES SKIP_RETURN_CODE 77 LABELS device
    ENVIRONMENT "TURNER_VALIDATION=1;MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/adaptive")
