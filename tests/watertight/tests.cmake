# No ray slips between triangles.
add_executable(test_watertight ${CMAKE_CURRENT_LIST_DIR}/test_watertight.c)
target_link_libraries(test_watertight PRIVATE turner_flags ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_watertight PRIVATE turner_${layer})
endforeach()
set_target_properties(test_watertight PROPERTIES LINKER_LANGUAGE CXX)
add_test(NAME watertight COMMAND test_watertight)
set_tests_properties(watertight PROPERTIES SKIP_RETURN_CODE 77 LABELS device)
