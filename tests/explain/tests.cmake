# turner explain: the reference's tree, two trees compared, the device's tree, the command.
turner_unit_test(explain_tree ${CMAKE_CURRENT_LIST_DIR}/test_explain_tree.c
                 LAYERS base image scene reference)
turner_unit_test(explain_compare ${CMAKE_CURRENT_LIST_DIR}/test_explain_compare.c
                 LAYERS base image scene reference)
target_sources(test_explain_compare PRIVATE ${PROJECT_SOURCE_DIR}/src/app/explain_compare.c)
turner_unit_test(explain_kernel ${CMAKE_CURRENT_LIST_DIR}/test_explain_kernel.c LAYERS base image gpu)

add_executable(test_explain_device ${CMAKE_CURRENT_LIST_DIR}/test_explain_device.c
    ${PROJECT_SOURCE_DIR}/src/app/explain_compare.c)
target_link_libraries(test_explain_device PRIVATE turner_flags PkgConfig::CMOCKA
    ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_explain_device PRIVATE turner_${layer})
endforeach()
target_compile_definitions(test_explain_device PRIVATE TURNER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(test_explain_device PROPERTIES LINKER_LANGUAGE CXX)
add_test(NAME explain_device COMMAND test_explain_device)
set_tests_properties(explain_device PROPERTIES SKIP_RETURN_CODE 77 LABELS device)

# The command. Only its last part needs a device.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(what IN ITEMS usage reference device)
    add_test(NAME explain_command_${what} COMMAND Python3::Interpreter
        ${CMAKE_CURRENT_LIST_DIR}/explain_command.py ${what})
    set_tests_properties(explain_command_${what} PROPERTIES SKIP_RETURN_CODE 77 ENVIRONMENT
        "TURNER=$<TARGET_FILE:turner>;TURNER_SOURCE=${PROJECT_SOURCE_DIR}")
endforeach()
set_property(TEST explain_command_device PROPERTY LABELS device)
