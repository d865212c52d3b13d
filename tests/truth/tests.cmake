# Every scene against the reference, pixel by pixel (test_truth.c says how).
#
# Own scenes: 99.9 % of the pixels within 1e-3 relative or 1e-4 absolute. SPD scenes: a float tracer
# cannot do better than what is allowed here, since mirrors on mirrors amplify its rounding.
add_executable(test_truth ${CMAKE_CURRENT_LIST_DIR}/test_truth.c
    ${CMAKE_CURRENT_LIST_DIR}/explain.c)
target_link_libraries(test_truth PRIVATE turner_flags ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_truth PRIVATE turner_${layer})
endforeach()
set_target_properties(test_truth PROPERTIES LINKER_LANGUAGE CXX)

function(turner_truth_test scene share absolute relative)
    get_filename_component(name ${scene} NAME_WE)
    add_test(NAME truth_${name} COMMAND test_truth ${scene} ${share} ${absolute} ${relative})
    set_tests_properties(truth_${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS "device;truth")
endfunction()

file(GLOB own_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.json
                                       ${PROJECT_SOURCE_DIR}/scenes/*.nff)
list(REMOVE_ITEM own_scenes ${PROJECT_SOURCE_DIR}/scenes/schema.json)
foreach(scene IN LISTS own_scenes)
    turner_truth_test(${scene} 0.001 1e-4 1e-3)
endforeach()
set(spd ${PROJECT_SOURCE_DIR}/../shared/scenes/nff)
turner_truth_test(${spd}/balls.nff 0.006 1e-2 0)
foreach(name IN ITEMS gears mount teapot)
    turner_truth_test(${spd}/${name}.nff 0.0015 1e-2 0)
endforeach()
