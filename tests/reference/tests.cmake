# The reference tracer's own properties.
turner_unit_test(reference ${CMAKE_CURRENT_LIST_DIR}/test_reference.c
                 LAYERS base image scene reference)
