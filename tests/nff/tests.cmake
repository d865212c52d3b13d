# What comes into a scene from files other than JSON.
foreach(name polygon)
    turner_unit_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LAYERS base image scene)
endforeach()
