# Export to POV-Ray, and POV-Ray's pictures beside those of the reference.
turner_unit_test(pov ${CMAKE_CURRENT_LIST_DIR}/test_pov.c LAYERS base image scene)

find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(what IN ITEMS command runner terms scenes)
    add_test(NAME pov_${what}
        COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/pov.py ${what})
    set_tests_properties(pov_${what} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300
        ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;SCENES=${PROJECT_SOURCE_DIR}/scenes")
endforeach()
set_tests_properties(pov_terms pov_scenes PROPERTIES LABELS once)
