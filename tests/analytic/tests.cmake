# Closed forms and published numbers. The checks are a library for any renderer; a main for each.
add_library(turner_analytic STATIC
    ${CMAKE_CURRENT_LIST_DIR}/analytic.c ${CMAKE_CURRENT_LIST_DIR}/build.c
    ${CMAKE_CURRENT_LIST_DIR}/checks.c ${CMAKE_CURRENT_LIST_DIR}/check_fresnel.c
    ${CMAKE_CURRENT_LIST_DIR}/check_refraction.c)
target_link_libraries(turner_analytic PUBLIC turner_flags)
target_include_directories(turner_analytic PUBLIC ${PROJECT_SOURCE_DIR}/tests)

add_executable(test_analytic_reference ${CMAKE_CURRENT_LIST_DIR}/main_reference.c)
target_link_libraries(test_analytic_reference PRIVATE turner_analytic turner_base turner_image
    turner_scene turner_reference ${turner_image_libraries} ${turner_scene_libraries})
set_target_properties(test_analytic_reference PROPERTIES LINKER_LANGUAGE CXX)
add_test(NAME analytic_reference COMMAND test_analytic_reference)
