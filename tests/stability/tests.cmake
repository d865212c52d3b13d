# Where methods fail (docs/stability.md): every default holds its bound, and each method that is
# known to fail does so where it is known to. A test a subject, at the values that decide.
foreach(subject IN ITEMS sphere leave triangle fresnel phong place recursion aa)
    set(rows ${subject})
    if(subject STREQUAL fresnel)
        set(rows fresnel schlick)
    elseif(subject STREQUAL recursion)
        set(rows mirrors tree furnace)
    endif()
    add_test(NAME stability_${subject} COMMAND turner stability --quick ${rows})
    set_tests_properties(stability_${subject} PROPERTIES LABELS "device;stability" TIMEOUT 600
        SKIP_REGULAR_EXPRESSION "no Vulkan driver found")
endforeach()

# The figures that others have published, and the files of a report.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME stability_report COMMAND Python3::Interpreter -B
    ${CMAKE_CURRENT_LIST_DIR}/check_report.py $<TARGET_FILE:turner>
    ${PROJECT_BINARY_DIR}/tests/stability/report)
set_tests_properties(stability_report PROPERTIES LABELS "device;stability" SKIP_RETURN_CODE 77
    TIMEOUT 600)

# The judge sees what it has to see. No device.
set(sources ${CMAKE_CURRENT_LIST_DIR}/test_stability_verdict.c
    ${PROJECT_SOURCE_DIR}/src/app/stability_result.c)
turner_unit_test(stability_verdict "${sources}" LAYERS base LIBRARIES Vulkan::Vulkan)
