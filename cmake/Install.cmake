# What `cmake --install` lays down: the command, the library with its header, shaders and scenes to
# start from, the CMake package and the pkg-config file. Everything is found relative to where it
# lies, so the prefix may be moved.
# Expects the targets libturner (its libraries linked PRIVATE) and turner (the command).
include(CMakePackageConfigHelpers)

target_include_directories(libturner INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(libturner PROPERTIES
    OUTPUT_NAME turner
    EXPORT_NAME libturner
    PUBLIC_HEADER ${PROJECT_SOURCE_DIR}/src/turner.h
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
if(BUILD_SHARED_LIBS)
    # Only turner.h is public: not what comes in with the static archives of glslang.
    target_link_options(libturner PRIVATE LINKER:--exclude-libs,ALL)
endif()

install(TARGETS libturner turner EXPORT turnerTargets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TURNER_MODULES) # beside the library, found from wherever both lie
    set(turner_module_dir ${CMAKE_INSTALL_LIBDIR}/turner)
    install(TARGETS ${turner_module_targets} LIBRARY DESTINATION ${turner_module_dir})
    file(RELATIVE_PATH turner_from_bin /${CMAKE_INSTALL_BINDIR} /${turner_module_dir})
    set_property(TARGET turner PROPERTY INSTALL_RPATH $ORIGIN/${turner_from_bin})
    set_property(TARGET libturner PROPERTY INSTALL_RPATH $ORIGIN/turner)
endif()
install(DIRECTORY shaders scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/turner)

# ---- CMake package: turner::libturner, turner::turner, turner_add_image_test ----
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/turner)
install(EXPORT turnerTargets NAMESPACE turner:: DESTINATION ${package})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/turnerConfig.cmake.in
    ${PROJECT_BINARY_DIR}/turnerConfig.cmake INSTALL_DESTINATION ${package}
    NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/turnerConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/turnerConfig.cmake
              ${PROJECT_BINARY_DIR}/turnerConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/TurnerImageTest.cmake
              ${PROJECT_SOURCE_DIR}/cmake/RunImageTest.cmake
        DESTINATION ${package})

# ---- pkg-config: a static library passes on what it needs itself ----
if(BUILD_SHARED_LIBS)
    set(turner_pc_requires)
    set(turner_pc_libs)
else()
    set(turner_pc_requires "libcjson libpng OpenEXR OpenImageIO assimp vulkan spirv-cross-c-shared")
    # glslang's own .pc names other libraries in every version, and not always all.
    set(glslang_libs -lglslang-default-resource-limits -lSPIRV -lglslang -lMachineIndependent
                     -lGenericCodeGen -lOSDependent)
    if(TARGET glslang::OGLCompiler)
        list(APPEND glslang_libs -lOGLCompiler)
    endif()
    list(JOIN glslang_libs " " glslang_libs)
    set(turner_pc_libs
        "-Wl,--start-group ${glslang_libs} -Wl,--end-group -lSPIRV-Tools-opt -lSPIRV-Tools -lstdc++ -pthread -lm")
endif()
file(RELATIVE_PATH turner_pc_prefix
     /${CMAKE_INSTALL_LIBDIR}/pkgconfig /) # from the .pc file up to the prefix
configure_file(${PROJECT_SOURCE_DIR}/cmake/turner.pc.in ${PROJECT_BINARY_DIR}/turner.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/turner.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
