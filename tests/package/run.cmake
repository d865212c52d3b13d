# Installs into an empty prefix, moves that elsewhere, and builds the consumer against it: with
# find_package, then with pkg-config. Everything in WORK.
# cmake -DBUILD= -DSOURCE= -DWORK= -DVERSION= -DLIBDIR= -DC_COMPILER= -DCXX_COMPILER= -DFLAGS= -P
file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first)
file(RENAME ${WORK}/first ${prefix})
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*)
if(NOT headers STREQUAL "turner.h")
    message(FATAL_ERROR "installed headers: '${headers}', expected turner.h alone")
endif()

# ---- find_package ----
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/cmake -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_C_FLAGS=${FLAGS} -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${WORK}/cmake)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/cmake --output-on-failure --no-tests=error)

# ---- pkg-config ----
set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
execute_process(COMMAND pkg-config --modversion turner OUTPUT_VARIABLE version
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(NOT version STREQUAL VERSION)
    message(FATAL_ERROR "pkg-config says version '${version}', expected '${VERSION}'")
endif()
execute_process(COMMAND pkg-config --cflags --libs turner OUTPUT_VARIABLE flags
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${FLAGS} ${flags}")
run(${C_COMPILER} -o ${WORK}/consumer ${SOURCE}/consumer.c ${flags} -Wl,-rpath,${prefix}/${LIBDIR})
run(${WORK}/consumer ${prefix}/share/turner/scenes/whitted1980.json)
run(${WORK}/consumer ${prefix}/share/turner/scenes/environment.json) # reads a picture

# ---- the command, from where it was installed ----
execute_process(COMMAND ${prefix}/bin/turner render
    ${prefix}/share/turner/scenes/whitted1980.json --device reference --size 16x12
    -o ${WORK}/picture.png COMMAND_ERROR_IS_FATAL ANY)
if(NOT EXISTS ${WORK}/picture.png)
    message(FATAL_ERROR "the installed turner made no picture")
endif()

# ---- its shaders count: the reference, which has none, says that one was changed ----
file(APPEND ${prefix}/share/turner/shaders/user/post.glsl "// changed\n")
execute_process(COMMAND ${prefix}/bin/turner render
    ${prefix}/share/turner/scenes/whitted1980.json --device reference --size 16x12
    -o ${WORK}/picture.png ERROR_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "knows nothing of .*share/turner/shaders/user/post.glsl")
    message(FATAL_ERROR "the installed shaders are not looked at: ${said}")
endif()

# ---- the module for other formats: found there, and what is said without it ----
file(GLOB modules ${prefix}/${LIBDIR}/turner/turner-oiio.*)
if(modules) # a static build has it linked in
    run(${prefix}/bin/turner compare ${WORK}/picture.png ${WORK}/picture.png)
    file(REMOVE ${modules})
    execute_process(COMMAND ${prefix}/bin/turner compare ${WORK}/picture.png ${WORK}/picture.png
                    RESULT_VARIABLE status ERROR_VARIABLE said)
    if(NOT status EQUAL 4 OR NOT said MATCHES "turner-oiio.*cannot be loaded.*install turner")
        message(FATAL_ERROR "without its module turner ends with ${status}: ${said}")
    endif()
endif()

# ---- the same of that for mesh files ----
file(GLOB modules ${prefix}/${LIBDIR}/turner/turner-assimp.*)
if(modules)
    run(${prefix}/bin/turner check ${prefix}/share/turner/scenes/mesh.json)
    file(REMOVE ${modules})
    execute_process(COMMAND ${prefix}/bin/turner check ${prefix}/share/turner/scenes/mesh.json
                    RESULT_VARIABLE status ERROR_VARIABLE said)
    if(NOT status EQUAL 4 OR NOT said MATCHES "turner-assimp.*cannot be loaded.*install turner")
        message(FATAL_ERROR "without its module turner ends with ${status}: ${said}")
    endif()
endif()
