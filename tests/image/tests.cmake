# Pictures: files, faults, comparison, the command and the CTest function.
foreach(name image_files image_faults image_compare)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image)
endforeach()
turner_unit_test(cmd_compare ${CMAKE_CURRENT_LIST_DIR}/test_cmd_compare.c LAYERS base image
                 LIBRARIES PkgConfig::CJSON)
target_sources(test_cmd_compare PRIVATE ${PROJECT_SOURCE_DIR}/src/app/cmd_compare.c
                                        ${PROJECT_SOURCE_DIR}/src/app/compare_flip.c ${PROJECT_SOURCE_DIR}/src/app/process.c
                                        ${PROJECT_SOURCE_DIR}/src/app/options.c)

# The CTest function, with a stand-in for "turner render".
if(TARGET turner)
    add_executable(image_test_pictures ${CMAKE_CURRENT_LIST_DIR}/image_test/pictures.c)
    target_link_libraries(image_test_pictures PRIVATE turner_flags turner_base turner_image
                                                      ${turner_image_libraries})
    add_test(NAME image_test_function COMMAND ${CMAKE_COMMAND}
        -DTURNER=$<TARGET_FILE:turner> -DMODULE=${PROJECT_SOURCE_DIR}/cmake/TurnerImageTest.cmake
        -DSOURCE=${CMAKE_CURRENT_LIST_DIR}/image_test
        -DWORK=${PROJECT_BINARY_DIR}/tests/image_test -DCTEST=${CMAKE_CTEST_COMMAND}
        -DPICTURES=$<TARGET_FILE:image_test_pictures>
        -P ${CMAKE_CURRENT_LIST_DIR}/image_test/run.cmake)
    set_tests_properties(image_test_function PROPERTIES LABELS once)
endif()
