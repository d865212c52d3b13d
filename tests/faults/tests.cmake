# Faults through the command: each is a test of its own, with its exit status and message.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(faults ${CMAKE_CURRENT_LIST_DIR}/faults.py)
file(GLOB fault_scripts CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.py)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${fault_scripts})
execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1
                        ${Python3_EXECUTABLE} ${faults} list
                OUTPUT_VARIABLE fault_names OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)

# Loaded into the command, it ends the process or fails in the middle of a write.
add_library(turner_break_write MODULE ${CMAKE_CURRENT_LIST_DIR}/break_write.c)
target_compile_options(turner_break_write PRIVATE -Wall -Wextra)
target_compile_definitions(turner_break_write PRIVATE _DEFAULT_SOURCE)
set_target_properties(turner_break_write PROPERTIES C_VISIBILITY_PRESET default)

string(REPLACE "\n" ";" fault_names "${fault_names}")
foreach(fault IN LISTS fault_names)
    set(labels faults)
    if(fault MATCHES "^(.*):device$")
        set(fault ${CMAKE_MATCH_1})
        list(APPEND labels device)
    endif()
    add_test(NAME fault_${fault} COMMAND Python3::Interpreter ${faults} ${fault})
    set_tests_properties(fault_${fault} PROPERTIES SKIP_RETURN_CODE 77 LABELS "${labels}"
        TIMEOUT 300 ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TURNER_FAULT_LIBRARY=$<TARGET_FILE:turner_break_write>;TURNER_SANITIZED=${TURNER_SANITIZE};TURNER_VALIDATION=1;PYTHONDONTWRITEBYTECODE=1;MESA_SHADER_CACHE_DIR=${PROJECT_BINARY_DIR}/mesa-cache/fault_${fault}")
endforeach()
