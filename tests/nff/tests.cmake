# What comes into a scene from files other than JSON.
foreach(name polygon nff nff_faults nff_spd mesh_file)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image scene)
endforeach()
