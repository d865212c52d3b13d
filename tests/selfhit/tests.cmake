# Rays that leave a surface do not meet it again.
add_executable(test_self_hit ${CMAKE_CURRENT_LIST_DIR}/test_self_hit.c)
target_link_libraries(test_self_hit PRIVATE turner_flags ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_self_hit PRIVATE turner_${layer})
endforeach()
set_target_properties(test_self_hit PROPERTIES LINKER_LANGUAGE CXX)
add_test(NAME self_hit COMMAND test_self_hit)
set_tests_properties(self_hit PROPERTIES SKIP_RETURN_CODE 77 LABELS device)
