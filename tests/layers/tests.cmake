# The rules of the layout, and that their check finds what it is there for.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME layers COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/check_layers.py
                             ${PROJECT_SOURCE_DIR})
add_test(NAME layers_check COMMAND Python3::Interpreter -B
                                   ${CMAKE_CURRENT_LIST_DIR}/test_check_layers.py)
set_tests_properties(layers layers_check PROPERTIES LABELS once)
