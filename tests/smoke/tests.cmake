# The whole command on the device, small, under the sanitizers too (label `smoke`): scenes with both
# traversals, which agree. A few, since compiling a kernel under ASan takes seconds; the tests of
# truth have them all. Half of them run as users do, the others under the validation layers.
foreach(name IN ITEMS whitted1980 water_glass instances environment)
    add_test(NAME smoke_${name} COMMAND ${CMAKE_COMMAND} -DTURNER=$<TARGET_FILE:turner>
        -DSCENE=${PROJECT_SOURCE_DIR}/scenes/${name}.json -DWORK=${PROJECT_BINARY_DIR}/tests/smoke/${name}
        -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
    set(plain "")
    if(name MATCHES "instances|environment")
        set(plain ";plain")
    endif()
    set_tests_properties(smoke_${name} PROPERTIES
        LABELS "device;smoke${plain}" SKIP_REGULAR_EXPRESSION "smoke test skipped: " TIMEOUT 300)
endforeach()
