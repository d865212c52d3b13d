# Golden pictures: every own scene, small, against what the reference tracer made of it. To make
# them anew, look at scenes/ first, then run tests/golden/make.sh and look at each picture.
#
# Tolerance. Magnitude: goldens have 8 bits, and a value next to a rounding boundary may fall on
# either side; at white, where the sRGB curve is flattest, that step is 2.28/255 = 0.0090 of linear
# radiance. Count: 4 pixels of 19,200, whose centre lies on an edge within rounding once it is seen
# through a row of mirrors; float and extended precision were seen to differ in 2 (the hall of
# mirrors) and in none elsewhere. The fine comparison, without 8 bits, is tests/truth.
set(golden_threshold 0.0091)
set(golden_pixels 4)

include(${PROJECT_SOURCE_DIR}/cmake/TurnerImageTest.cmake)
file(GLOB golden_scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.json
                                          ${PROJECT_SOURCE_DIR}/scenes/*.nff)
list(REMOVE_ITEM golden_scenes ${PROJECT_SOURCE_DIR}/scenes/schema.json)
foreach(scene IN LISTS golden_scenes)
    get_filename_component(name ${scene} NAME_WE)
    file(READ ${scene} text)
    string(JSON width GET "${text}" settings size 0)
    string(JSON height GET "${text}" settings size 1)
    math(EXPR height "160 * ${height} / ${width}") # as make.sh does
    turner_add_image_test(NAME golden_${name} SCENE ${scene}
        REFERENCE ${CMAKE_CURRENT_LIST_DIR}/${name}.png
        ARGS --size 160x${height} --spp 1
        THRESHOLD ${golden_threshold} PIXELS ${golden_pixels})
    set_tests_properties(golden_${name} PROPERTIES LABELS "image;golden;device")
endforeach()

# The comparison is worth something: it tells any two goldens apart.
add_executable(test_golden_pairs ${CMAKE_CURRENT_LIST_DIR}/test_golden_pairs.c
    ${PROJECT_SOURCE_DIR}/src/app/cmd_compare.c ${PROJECT_SOURCE_DIR}/src/app/compare_flip.c ${PROJECT_SOURCE_DIR}/src/app/process.c
    ${PROJECT_SOURCE_DIR}/src/app/options.c)
target_link_libraries(test_golden_pairs PRIVATE turner_flags PkgConfig::CMOCKA PkgConfig::CJSON
    turner_base turner_image ${turner_image_libraries})
add_test(NAME golden_pairs COMMAND test_golden_pairs ${CMAKE_CURRENT_LIST_DIR}
    ${golden_threshold} ${golden_pixels})
set_tests_properties(golden_pairs PROPERTIES LABELS "golden")
