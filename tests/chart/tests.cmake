# turner chart: its arithmetic, its reference pictures, the command.
turner_unit_test(chart_patterns ${CMAKE_CURRENT_LIST_DIR}/test_patterns.c
    LAYERS base image scene reference)
