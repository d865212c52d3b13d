# What is kept from one run to the next: entries that cannot be taken for others nor used when broken
# (no device), and pictures that no state of the cache changes, nor what the driver is given.
turner_unit_test(cache ${CMAKE_CURRENT_LIST_DIR}/test_cache.c LAYERS base image gpu)
if(TARGET turner)
    foreach(what IN ITEMS reuse broken key pair off fastest prebuilt objects)
        add_test(NAME cache_${what} COMMAND Python3::Interpreter
            ${CMAKE_CURRENT_LIST_DIR}/command_cache.py ${what})
        set_tests_properties(cache_${what} PROPERTIES LABELS "device;plain" SKIP_RETURN_CODE 77 TIMEOUT 300
            ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TURNER_SOURCE=${PROJECT_SOURCE_DIR};PYTHONDONTWRITEBYTECODE=1;MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/cache_${what}")
    endforeach()
endif()
