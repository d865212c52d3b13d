# Pictures: files, faults, comparison, the command and the CTest function.
foreach(name image_files image_faults image_compare)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image)
endforeach()
