# README.md's scene renders, and what it names exists.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME readme COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/check_readme.py
    ${PROJECT_SOURCE_DIR} $<TARGET_FILE:turner> ${PROJECT_BINARY_DIR}/tests/readme)
