# Shaders that users write: hooks, parameters, what watches them.
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
