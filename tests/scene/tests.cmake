# Scenes: the data model, the JSON reader and its schema, loading.
foreach(name scene_model scene_camera scene_validate scene_json scene_json_errors scene_load scene_methods)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image scene)
endforeach()

# The schema that editors use says the same as the reader.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_executable(scene_dump_tables ${CMAKE_CURRENT_LIST_DIR}/dump_tables.c)
target_link_libraries(scene_dump_tables PRIVATE turner_flags turner_base turner_image turner_scene
    ${turner_image_libraries} ${turner_scene_libraries})
add_test(NAME scene_schema COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/check_schema.py
    ${PROJECT_SOURCE_DIR} $<TARGET_FILE:scene_dump_tables>)
set_tests_properties(scene_schema PROPERTIES SKIP_RETURN_CODE 77)
