# What comes into a scene from files other than JSON.
foreach(name polygon nff nff_faults nff_spd mesh_file texture)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image scene)
endforeach()

find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME generators COMMAND Python3::Interpreter -B
    ${CMAKE_CURRENT_LIST_DIR}/check_generators.py
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}/../shared)
