# The GPU layer. Every process has a shader cache of its own: Mesa's is not safe to share between
# processes that start at once.
foreach(name gpu_include gpu_compiler gpu_device gpu_memory gpu_program)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base gpu)
    set_tests_properties(${name} PROPERTIES ENVIRONMENT
        "MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/tests/gpu/cache-${name};LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan.supp")
endforeach()
