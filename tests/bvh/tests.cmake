set(bvh_folder ${CMAKE_CURRENT_LIST_DIR})
foreach(name bounds build tree wide walk flatten)
    turner_unit_test(bvh_${name} "${bvh_folder}/test_${name}.c;${bvh_folder}/scenes.c"
        LAYERS base image scene bvh)
endforeach()
