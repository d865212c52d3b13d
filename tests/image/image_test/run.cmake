# turner_add_image_test as a project uses it: passes, fails, is skipped, makes a reference, and tells
# the dashboard. cmake -DTURNER= -DMODULE= -DSOURCE= -DWORK= -DCTEST= -DPICTURES= -P
# PICTURES writes the pictures of one pixel that are needed: white.exr grey.exr nan.exr wide.exr
# white.png white.16.png.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/pictures)
execute_process(COMMAND ${PICTURES} ${WORK}/pictures COMMAND_ERROR_IS_FATAL ANY)
unset(ENV{TURNER_UPDATE_GOLDENS})
set(ENV{REAL_TURNER} ${TURNER})
set(ENV{FAKE_SCENE} ${SOURCE}/scene.json)

# check(CASE REFERENCE PICTURE EXPECTED [VARIABLE=value…]): one run in WORK/CASE; EXPECTED is
# Passed, Failed or Skipped. ${output} is what CTest said. Reads ${extra} for further ARGS.
macro(check case reference picture expected)
    file(MAKE_DIRECTORY ${WORK}/${case})
    if(EXISTS ${WORK}/pictures/${reference})
        file(COPY ${WORK}/pictures/${reference} DESTINATION ${WORK}/${case})
    endif()
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/${case} -G Ninja
        -DMODULE=${MODULE} -DTURNER_EXECUTABLE=${SOURCE}/fake_turner.sh
        -DREFERENCE=${WORK}/${case}/${reference} "-DEXTRA_ARGS=${extra}"
        OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env FAKE_PICTURE=${WORK}/pictures/${picture}
        ${ARGN} ${CTEST} -T Test --verbose
        WORKING_DIRECTORY ${WORK}/${case} OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT output MATCHES "Test +#1: picture [. *]+${expected}")
        message(FATAL_ERROR "${case}: not ${expected}:\n${output}")
    endif()
    set(results ${WORK}/${case}/image-tests/picture)
endmacro()

function(expect_files)
    foreach(file IN LISTS ARGN)
        if(NOT EXISTS ${results}/${file})
            message(FATAL_ERROR "${case}: no ${results}/${file}:\n${output}")
        endif()
    endforeach()
endfunction()

function(expect_output)
    foreach(text IN LISTS ARGN)
        if(NOT output MATCHES "${text}")
            message(FATAL_ERROR "no \"${text}\" in:\n${output}")
        endif()
    endforeach()
endfunction()

set(extra)
check(equal white.exr white.exr Passed)
expect_files(picture.exr reference.exr picture.png reference.png difference.png comparison.json)
expect_output("name=\"RMSE\">0<")

check(equal_png white.png white.png Passed)
expect_files(picture.png reference.png difference.png)
check(equal_16 white.16.png white.16.png Passed)
expect_files(picture.16.png reference.16.png difference.png)

check(different white.exr grey.exr Failed)
expect_files(picture.exr reference.exr picture.png reference.png difference.png comparison.json)
expect_output("TURNER_UPDATE_GOLDENS=1")
# what CTest keeps for the dashboard
file(GLOB xml ${WORK}/different/Testing/*/Test.xml)
file(READ ${xml} xml)
foreach(measurement TestImage ValidImage DifferenceImage2 RMSE LargestDifference PixelsOver)
    if(NOT xml MATCHES "NamedMeasurement[^>]*name=\"${measurement}\"")
        message(FATAL_ERROR "no measurement ${measurement} in:\n${xml}")
    endif()
endforeach()
if(NOT xml MATCHES "name=\"RMSE\"[^>]*>[ \t\r\n]*<Value>0.5<")
    message(FATAL_ERROR "not the RMSE expected:\n${xml}")
endif()

check(size white.exr wide.exr Failed)
expect_output("sizes differ")
check(nan white.exr nan.exr Failed)
check(no_reference missing.exr white.exr Failed)
expect_output("there is no reference")

# a device that fails is a failure; no device is not, unless none was asked for
check(device_fails white.exr white.exr Failed FAKE_STATUS=4)
check(no_device white.exr white.exr Skipped FAKE_STATUS=4 FAKE_DEVICES=4)
expect_output("no such luck")
check(wrong_scene white.exr white.exr Failed FAKE_STATUS=3 FAKE_DEVICES=4)
set(extra "--device;reference")
check(no_excuse white.exr white.exr Failed FAKE_STATUS=4 FAKE_DEVICES=4)
set(extra)

# the picture becomes the reference, but not when it is unfit
check(update white.exr grey.exr Passed TURNER_UPDATE_GOLDENS=1)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WORK}/pictures/grey.exr
                        ${WORK}/update/white.exr COMMAND_ERROR_IS_FATAL ANY)
check(update_new new.exr grey.exr Passed TURNER_UPDATE_GOLDENS=1)
check(update_nan white.exr nan.exr Failed TURNER_UPDATE_GOLDENS=1)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WORK}/pictures/white.exr
                        ${WORK}/update_nan/white.exr COMMAND_ERROR_IS_FATAL ANY)
