# What is installed can be used: by CMake, by pkg-config, and from a folder it was moved to. The
# release build has the shared library, the debug build the static one.
set(flags)
if(TURNER_SANITIZE)
    set(flags "-fsanitize=address,undefined")
endif()
add_test(NAME package COMMAND ${CMAKE_COMMAND}
    -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${CMAKE_CURRENT_LIST_DIR}
    -DWORK=${PROJECT_BINARY_DIR}/tests/package -DVERSION=${PROJECT_VERSION}
    -DLIBDIR=${CMAKE_INSTALL_LIBDIR} -DC_COMPILER=${CMAKE_C_COMPILER}
    -DCXX_COMPILER=${CMAKE_CXX_COMPILER} -DFLAGS=${flags}
    -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
