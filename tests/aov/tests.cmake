# Layers of pictures: each scene's against the reference, what files hold of them, the command.
add_executable(test_aov ${CMAKE_CURRENT_LIST_DIR}/test_aov.c
    ${CMAKE_CURRENT_LIST_DIR}/../truth/explain.c)
target_link_libraries(test_aov PRIVATE turner_flags PkgConfig::CMOCKA ${turner_libraries})
foreach(layer IN ITEMS base image scene reference bvh gpu render)
    target_link_libraries(test_aov PRIVATE turner_${layer})
endforeach()
set_target_properties(test_aov PROPERTIES LINKER_LANGUAGE CXX)

# turner_aov_test(NAME COMMAND argument…): a device test.
function(turner_aov_test name command)
    add_test(NAME ${name} COMMAND ${command} ${ARGN})
    set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS device)
endfunction()

# All kinds of kernel share what differs between scenes: bvh for each, the other two for one.
set(scenes ${PROJECT_SOURCE_DIR}/scenes)
file(GLOB aov_scenes CONFIGURE_DEPENDS ${scenes}/*.json)
list(REMOVE_ITEM aov_scenes ${scenes}/schema.json)
foreach(scene IN LISTS aov_scenes)
    get_filename_component(name ${scene} NAME_WE)
    turner_aov_test(aov_${name} test_aov ${scene} bvh)
endforeach()
turner_aov_test(aov_mesh_ray_query test_aov ${scenes}/mesh.json ray_query plain)
turner_aov_test(aov_water_glass_f64 test_aov ${scenes}/water_glass.json f64 plain)

turner_unit_test(aov_planes ${CMAKE_CURRENT_LIST_DIR}/test_aov_planes.c
                 LAYERS base image scene reference)
target_sources(test_aov_planes PRIVATE ${PROJECT_SOURCE_DIR}/src/render/contrast.c
                                       ${PROJECT_SOURCE_DIR}/src/render/layers.c)

find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(what IN ITEMS files adaptive refusals nonfinite)
    turner_aov_test(aov_${what} Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/command_aov.py ${what})
    set_property(TEST aov_${what} APPEND PROPERTY ENVIRONMENT
        "TURNER=$<TARGET_FILE:turner>" "TOOLS=${PROJECT_SOURCE_DIR}/tools")
endforeach()
