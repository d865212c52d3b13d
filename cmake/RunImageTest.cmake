# One image test (see TurnerImageTest.cmake):
# cmake -DTURNER= -DSCENE= -DREFERENCE= -DRENDER_ARGS= -DTOLERANCE= -DFOLDER= -P RunImageTest.cmake
cmake_minimum_required(VERSION 3.25)

cmake_path(GET REFERENCE EXTENSION LAST_ONLY kind)
if(REFERENCE MATCHES "(\\.16\\.png)$") # 16 bit
    set(kind ${CMAKE_MATCH_1})
endif()
set(picture ${FOLDER}/picture${kind})
file(REMOVE_RECURSE ${FOLDER}) # nothing of an earlier run may be taken for this one's
file(MAKE_DIRECTORY ${FOLDER})

# ---- render ----
execute_process(COMMAND ${TURNER} render ${SCENE} -o ${picture} --quiet ${RENDER_ARGS}
                RESULT_VARIABLE status ERROR_VARIABLE reason ECHO_ERROR_VARIABLE)
if(status EQUAL 4 AND NOT "${RENDER_ARGS}" MATCHES "(^|[;=])reference(;|$)")
    # No device at all is no fault of the picture; anything else the device does wrong is.
    execute_process(COMMAND ${TURNER} devices RESULT_VARIABLE devices OUTPUT_QUIET ERROR_QUIET)
    if(devices EQUAL 4)
        message(NOTICE "image test skipped: no device here; ${reason}")
        return()
    endif()
endif()
if(NOT status EQUAL 0 OR NOT EXISTS ${picture})
    message(FATAL_ERROR "${SCENE} did not render (status ${status})")
endif()

# ---- or make it the reference ----
if("$ENV{TURNER_UPDATE_GOLDENS}" STREQUAL "1")
    execute_process(COMMAND ${TURNER} compare ${picture} ${picture} RESULT_VARIABLE status)
    if(NOT status EQUAL 0) # a NaN differs from itself
        message(FATAL_ERROR "${picture} is not fit to be a reference")
    endif()
    file(COPY_FILE ${picture} ${REFERENCE} ONLY_IF_DIFFERENT)
    message(NOTICE "${REFERENCE} is now this picture; look at it before you commit it")
endif()
if(NOT EXISTS ${REFERENCE})
    message(FATAL_ERROR "there is no reference ${REFERENCE}; look at ${picture} and, if it is "
                        "right, run the test again with TURNER_UPDATE_GOLDENS=1")
endif()
file(COPY_FILE ${REFERENCE} ${FOLDER}/reference${kind})

# ---- compare ----
set(preview)
if(NOT kind MATCHES "\\.(png|PNG)$") # browsers know no EXR
    set(preview --preview ${FOLDER})
endif()
execute_process(COMMAND ${TURNER} compare ${picture} ${REFERENCE} ${TOLERANCE} ${preview}
                        --heatmap ${FOLDER}/difference.png --json ${FOLDER}/comparison.json
                RESULT_VARIABLE status)

# ---- measurements, which CTest takes out of the output for dashboards ----
function(attach name file)
    if(EXISTS ${file})
        message(NOTICE "<CTestMeasurementFile type=\"image/png\" name=\"${name}\">${file}"
                       "</CTestMeasurementFile>")
    endif()
endfunction()

if(preview)
    set(kind .png)
endif()
attach(TestImage ${FOLDER}/picture${kind})
attach(ValidImage ${FOLDER}/reference${kind})
attach(DifferenceImage2 ${FOLDER}/difference.png)
if(EXISTS ${FOLDER}/comparison.json)
    file(READ ${FOLDER}/comparison.json figures)
    foreach(pair RMSE:rmse RelativeMSE:relative_mse LargestDifference:largest
                 PixelsOver:pixels_over)
        string(REGEX MATCH "(.*):(.*)" pair "${pair}")
        set(name ${CMAKE_MATCH_1})
        string(JSON value ERROR_VARIABLE missing GET "${figures}" ${CMAKE_MATCH_2})
        if(NOT missing) # pictures of unequal size have no figures
            message(NOTICE "<CTestMeasurement type=\"numeric/double\" name=\"${name}\">${value}"
                           "</CTestMeasurement>")
        endif()
    endforeach()
endif()
if(NOT status EQUAL 0)
    message(FATAL_ERROR "${picture} against ${REFERENCE}: turner compare says ${status} (1: they "
                        "differ); see the pictures in ${FOLDER}. If the new picture is the right "
                        "one, run the test again with TURNER_UPDATE_GOLDENS=1")
endif()
