# The reference tracer's own properties, and the ray counts of the SPD scenes.
turner_unit_test(reference ${CMAKE_CURRENT_LIST_DIR}/test_reference.c
                 LAYERS base image scene reference)

add_executable(test_reference_spd ${CMAKE_CURRENT_LIST_DIR}/test_reference_spd.c)
target_link_libraries(test_reference_spd PRIVATE turner_flags turner_base turner_image turner_scene
    turner_reference ${turner_image_libraries} ${turner_scene_libraries})
target_compile_definitions(test_reference_spd PRIVATE
    TURNER_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared")
set_target_properties(test_reference_spd PROPERTIES LINKER_LANGUAGE CXX)
# The counts belong to full-size pictures, which take minutes under the sanitizers: there one scene
# stands for all.
set(spd_scenes mount)
if(NOT TURNER_SANITIZE)
    list(APPEND spd_scenes balls gears teapot)
endif()
foreach(scene IN LISTS spd_scenes)
    foreach(grid centres published)
        add_test(NAME reference_spd_${scene}_${grid} COMMAND test_reference_spd ${scene} ${grid})
        set_tests_properties(reference_spd_${scene}_${grid} PROPERTIES
            SKIP_RETURN_CODE 77 PROCESSORS 2 TIMEOUT 300)
    endforeach()
endforeach()
