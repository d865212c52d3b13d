# Closed forms and published numbers. The checks are a library for any renderer; a main for each.
file(GLOB checks CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/check_*.c)
add_library(turner_analytic STATIC ${CMAKE_CURRENT_LIST_DIR}/analytic.c
    ${CMAKE_CURRENT_LIST_DIR}/build.c ${CMAKE_CURRENT_LIST_DIR}/checks.c ${checks})
target_link_libraries(turner_analytic PUBLIC turner_flags)
target_include_directories(turner_analytic PUBLIC ${PROJECT_SOURCE_DIR}/tests)

add_executable(test_analytic_reference ${CMAKE_CURRENT_LIST_DIR}/main_reference.c)
target_link_libraries(test_analytic_reference PRIVATE turner_analytic turner_base turner_image
    turner_scene turner_reference ${turner_image_libraries} ${turner_scene_libraries})
set_target_properties(test_analytic_reference PROPERTIES LINKER_LANGUAGE CXX)
add_test(NAME analytic_reference COMMAND test_analytic_reference)

add_executable(test_analytic_device ${CMAKE_CURRENT_LIST_DIR}/main_device.c)
target_link_libraries(test_analytic_device PRIVATE turner_analytic turner_flags
    ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_analytic_device PRIVATE turner_${layer})
endforeach()
set_target_properties(test_analytic_device PROPERTIES LINKER_LANGUAGE CXX)
# bvh_lane draws the bytes of bvh_packet (tests/truth): a few checks stand for all.
foreach(traversal IN ITEMS bvh_packet bvh_lane ray_query)
    set(filter)
    if(traversal STREQUAL bvh_lane)
        set(filter furnace)
    endif()
    add_test(NAME analytic_${traversal} COMMAND test_analytic_device ${traversal} ${filter})
    set_tests_properties(analytic_${traversal} PROPERTIES SKIP_RETURN_CODE 77 LABELS device)
endforeach()
