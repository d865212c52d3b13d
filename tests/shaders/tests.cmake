# Shaders that users write: hooks, parameters, what watches them.
turner_unit_test(shader_param ${CMAKE_CURRENT_LIST_DIR}/test_param.c LAYERS base image gpu)
if(NOT TARGET turner)
    return()
endif()
function(turner_shader_test name script)
    add_test(NAME shaders_${name} COMMAND Python3::Interpreter
        ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${script} ${ARGN})
    set_tests_properties(shaders_${name} PROPERTIES LABELS device SKIP_RETURN_CODE 77 TIMEOUT 300
        ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TURNER_SOURCE=${PROJECT_SOURCE_DIR};PYTHONDONTWRITEBYTECODE=1;MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/shaders_${name}")
endfunction()
turner_shader_test(hooks hooks.py
    plain brdf surface background light post folders reference everything)
turner_shader_test(params params.py values constants metadata everywhere listed)
