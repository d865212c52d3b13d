# Ray counts of the SPD scenes, by the reference and by both traversals.
add_executable(test_spd ${CMAKE_CURRENT_LIST_DIR}/test_spd.c)
target_link_libraries(test_spd PRIVATE turner_flags ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_spd PRIVATE turner_${layer})
endforeach()
target_compile_definitions(test_spd PRIVATE TURNER_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared")
set_target_properties(test_spd PROPERTIES LINKER_LANGUAGE CXX)
# The counts belong to full-size pictures, which take minutes under the sanitizers: there one scene
# and the reference stand for all.
set(spd_scenes mount)
set(spd_ways reference)
if(NOT TURNER_SANITIZE)
    list(APPEND spd_scenes balls gears teapot)
    list(APPEND spd_ways bvh ray_query f64)
endif()
foreach(scene IN LISTS spd_scenes)
    foreach(grid IN ITEMS centres published)
        foreach(way IN LISTS spd_ways)
            if(grid STREQUAL published AND way MATCHES "ray_query|f64")
                continue() # the same hits as bvh, or finer ones: centres show it
            endif()
            set(name spd_${scene}_${grid}_${way})
            add_test(NAME ${name} COMMAND test_spd ${scene} ${grid} ${way})
            set_tests_properties(${name} PROPERTIES
                SKIP_RETURN_CODE 77 PROCESSORS 2 TIMEOUT 300)
            if(NOT way STREQUAL reference)
                set_tests_properties(${name} PROPERTIES LABELS device ENVIRONMENT
                    "MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/${name}")
            endif()
        endforeach()
    endforeach()
endforeach()
