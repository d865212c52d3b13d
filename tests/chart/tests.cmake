# turner chart: its arithmetic, its reference pictures, the command.
turner_unit_test(chart_patterns ${CMAKE_CURRENT_LIST_DIR}/test_patterns.c
    LAYERS base image scene reference)
turner_unit_test(chart ${CMAKE_CURRENT_LIST_DIR}/test_chart.c LAYERS base image scene)
target_sources(test_chart PRIVATE ${PROJECT_SOURCE_DIR}/src/app/chart_front.c
                                  ${PROJECT_SOURCE_DIR}/src/app/chart_grid.c)

find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(what IN ITEMS whole resume cache flip samples faults)
    add_test(NAME chart_${what} COMMAND Python3::Interpreter
        ${CMAKE_CURRENT_LIST_DIR}/command_chart.py ${what})
    set_tests_properties(chart_${what} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 ENVIRONMENT
        "TURNER=$<TARGET_FILE:turner>")
    if(NOT what STREQUAL "faults")
        set_property(TEST chart_${what} PROPERTY LABELS device)
    endif()
endforeach()
