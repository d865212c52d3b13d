# Shaders that users write: hooks, parameters, what watches them.
turner_unit_test(watch ${CMAKE_CURRENT_LIST_DIR}/test_watch.c LAYERS base)
turner_unit_test(shader_param ${CMAKE_CURRENT_LIST_DIR}/test_param.c LAYERS base image gpu)
if(NOT TARGET turner)
    return()
endif()
function(turner_shader_test name script)
    add_test(NAME shaders_${name} COMMAND Python3::Interpreter
        ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${script} ${ARGN})
    set_tests_properties(shaders_${name} PROPERTIES LABELS device SKIP_RETURN_CODE 77 TIMEOUT 300
        ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TURNER_SOURCE=${PROJECT_SOURCE_DIR};PYTHONDONTWRITEBYTECODE=1")
endfunction()
turner_shader_test(hooks hooks.py
    plain brdf surface background light post folders reference everything free)
turner_shader_test(check check.py errors recursion scenes)
set_tests_properties(shaders_check PROPERTIES LABELS "")
turner_shader_test(templates check.py templates examples)
set_tests_properties(shaders_templates PROPERTIES LABELS once)
turner_shader_test(params params.py values constants metadata everywhere listed)

foreach(program IN ITEMS test_reload test_preview reload_seconds)
    add_executable(${program} ${CMAKE_CURRENT_LIST_DIR}/${program}.c
        ${CMAKE_CURRENT_LIST_DIR}/reload_bench.c)
    target_link_libraries(${program} PRIVATE turner_flags PkgConfig::CMOCKA ${turner_libraries})
    foreach(layer IN ITEMS base image scene reference bvh gpu render)
        target_link_libraries(${program} PRIVATE turner_${layer})
    endforeach()
    target_compile_definitions(${program} PRIVATE TURNER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    set_target_properties(${program} PROPERTIES LINKER_LANGUAGE CXX)
endforeach()
add_test(NAME shaders_reload COMMAND test_reload)
set_tests_properties(shaders_reload PROPERTIES LABELS device SKIP_RETURN_CODE 77 TIMEOUT 300)
add_test(NAME shaders_preview COMMAND test_preview)
set_tests_properties(shaders_preview PROPERTIES LABELS device SKIP_RETURN_CODE 77 TIMEOUT 300
    ENVIRONMENT "MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/shaders_preview")
turner_shader_test(watch watch.py shaders scene hard)
turner_shader_test(compare compare.py differences errors)
turner_shader_test(examples examples.py marble blinn toon listed)
turner_shader_test(tutorial tutorial.py steps)
