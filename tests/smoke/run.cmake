# Renders SCENE with TURNER on the device, small, with both traversals, and compares the two.
# cmake -DTURNER= -DSCENE= -DWORK= -P
file(MAKE_DIRECTORY ${WORK})
execute_process(COMMAND ${TURNER} devices RESULT_VARIABLE status OUTPUT_VARIABLE devices)
if(status EQUAL 4)
    message(NOTICE "smoke test skipped: no device here")
    return()
endif()
set(traversals bvh)
if(devices MATCHES "ray_query +yes")
    list(APPEND traversals ray_query)
endif()
foreach(traversal IN LISTS traversals)
    file(REMOVE ${WORK}/${traversal}.exr)
    execute_process(COMMAND ${TURNER} render ${SCENE} --size 32x24 --traversal ${traversal} --quiet
                            -o ${WORK}/${traversal}.exr COMMAND_ERROR_IS_FATAL ANY)
endforeach()
list(POP_BACK traversals other)
execute_process(COMMAND ${TURNER} compare ${WORK}/bvh.exr ${WORK}/${other}.exr
                COMMAND_ERROR_IS_FATAL ANY)
