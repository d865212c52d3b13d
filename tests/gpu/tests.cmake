# The GPU layer.
foreach(name gpu_include gpu_compiler gpu_layout gpu_device gpu_memory gpu_program
             gpu_shader_object gpu_accel gpu_faults)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image gpu)
endforeach()
target_link_options(test_gpu_faults PRIVATE
    -Wl,--wrap=vkWaitForFences -Wl,--wrap=vkAllocateMemory -Wl,--wrap=vkQueueSubmit
    -Wl,--wrap=vkCreateComputePipelines)

# What the layout test expects, from the header itself.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(members ${CMAKE_CURRENT_BINARY_DIR}/gpu/shared_members.h)
add_custom_command(OUTPUT ${members}
    COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/list_members.py
            ${PROJECT_SOURCE_DIR}/shaders/shared.h ${members}
    DEPENDS ${PROJECT_SOURCE_DIR}/shaders/shared.h ${CMAKE_CURRENT_LIST_DIR}/list_members.py
    VERBATIM)
target_sources(test_gpu_layout PRIVATE ${members})
target_include_directories(test_gpu_layout PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/gpu)

if(TARGET turner)
    add_test(NAME gpu_absent_drivers COMMAND Python3::Interpreter
        ${CMAKE_CURRENT_LIST_DIR}/absent_drivers.py)
    set_tests_properties(gpu_absent_drivers PROPERTIES LABELS "device;plain" SKIP_RETURN_CODE 77
        TIMEOUT 120 ENVIRONMENT "TURNER=$<TARGET_FILE:turner>")
endif()
