# Pictures: files, faults, comparison, the command and the CTest function.
foreach(name image_files image_faults image_compare)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image)
endforeach()
turner_unit_test(cmd_compare ${CMAKE_CURRENT_LIST_DIR}/test_cmd_compare.c LAYERS base image
                 LIBRARIES PkgConfig::CJSON)
target_sources(test_cmd_compare PRIVATE ${PROJECT_SOURCE_DIR}/src/app/cmd_compare.c
                                        ${PROJECT_SOURCE_DIR}/src/app/compare_flip.c
                                        ${PROJECT_SOURCE_DIR}/src/app/options.c)
