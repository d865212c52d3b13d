# The whole command on the device, small, under the sanitizers too (label `smoke`): each scene with
# both traversals, which agree.
file(GLOB smoke_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.json)
list(FILTER smoke_scenes EXCLUDE REGEX "/schema.json$")
foreach(scene IN LISTS smoke_scenes)
    get_filename_component(name ${scene} NAME_WE)
    add_test(NAME smoke_${name} COMMAND ${CMAKE_COMMAND} -DTURNER=$<TARGET_FILE:turner>
        -DSCENE=${scene} -DWORK=${PROJECT_BINARY_DIR}/tests/smoke/${name}
        -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
    set_tests_properties(smoke_${name} PROPERTIES
        LABELS "device;smoke" SKIP_REGULAR_EXPRESSION "smoke test skipped: " TIMEOUT 300
        ENVIRONMENT "TURNER_VALIDATION=1;LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan.supp;MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/smoke_${name}")
endforeach()
