# What a scene needs and why, how deep and how exact it can be, and what asks for too much.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(name IN ITEMS useful_depth advice)
    turner_unit_test(needs_${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c
        LAYERS base image scene reference bvh gpu render)
    set_target_properties(test_needs_${name} PROPERTIES LINKER_LANGUAGE CXX)
endforeach()

foreach(what IN ITEMS lists warnings precision measure)
    add_test(NAME needs_${what}
        COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/check_needs.py ${what})
    set_tests_properties(needs_${what} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 ENVIRONMENT
        "TURNER=$<TARGET_FILE:turner>;TURNER_SCENES=${PROJECT_SOURCE_DIR}/scenes")
endforeach()
set_tests_properties(needs_lists PROPERTIES LABELS once)
set_tests_properties(needs_measure needs_precision PROPERTIES LABELS device)
