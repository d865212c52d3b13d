# A million triangles, a million instances.
foreach(kind triangles instances)
    add_test(NAME large_${kind} COMMAND Python3::Interpreter -B
        ${CMAKE_CURRENT_LIST_DIR}/large_scenes.py ${kind})
    set_tests_properties(large_${kind} PROPERTIES LABELS "device;once" SKIP_RETURN_CODE 77
        TIMEOUT 300 ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TOOLS=${PROJECT_SOURCE_DIR}/tools")
endforeach()
