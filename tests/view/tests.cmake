# turner built without a window says so.
if(TARGET turner AND NOT TARGET turner_view)
    add_test(NAME view_left_out COMMAND turner view scene.json)
    set_tests_properties(view_left_out PROPERTIES
        PASS_REGULAR_EXPRESSION "error: this turner was built without a window")
    add_test(NAME view_left_out_help COMMAND turner --help)
    set_tests_properties(view_left_out_help PROPERTIES
        PASS_REGULAR_EXPRESSION "view +\\(left out of this build\\)")
endif()

# The window as it is used: a display in memory, and xdotool at its mouse and keys.
if(TARGET turner_view)
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
    set(view_script ${CMAKE_CURRENT_LIST_DIR}/view.py)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${view_script})
    execute_process(COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 TURNER=
                            ${Python3_EXECUTABLE} ${view_script} list
                    OUTPUT_VARIABLE view_tests OUTPUT_STRIP_TRAILING_WHITESPACE
                    COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "\n" ";" view_tests "${view_tests}")

    # Loaded into the command, it loses the window's surface.
    add_library(turner_lose_surface MODULE ${CMAKE_CURRENT_LIST_DIR}/lose_surface.c)
    target_compile_options(turner_lose_surface PRIVATE -Wall -Wextra)
    target_compile_definitions(turner_lose_surface PRIVATE _GNU_SOURCE)
    target_link_libraries(turner_lose_surface PRIVATE Vulkan::Headers ${CMAKE_DL_LIBS})
    set_target_properties(turner_lose_surface PROPERTIES C_VISIBILITY_PRESET default)

    foreach(name IN LISTS view_tests)
        set(plain "")
        if(name MATCHES "^(camera|params|shown|soon|follows|rays|files|rebuilt|cameras)$")
            set(plain ";plain")
        endif()
        add_test(NAME view_${name} COMMAND Python3::Interpreter ${view_script} ${name})
        set_tests_properties(view_${name} PROPERTIES SKIP_RETURN_CODE 77 LABELS "device${plain}" TIMEOUT 600
            # one at a time, from the beginning, beside tests of other kinds: what they wait for comes
            COST 1000 RESOURCE_LOCK window
            ENVIRONMENT "TURNER=$<TARGET_FILE:turner>;TURNER_LOSE_LIBRARY=$<TARGET_FILE:turner_lose_surface>;TURNER_SANITIZED=${TURNER_SANITIZE};PYTHONDONTWRITEBYTECODE=1")
    endforeach()
endif()

# What needs no window.
if(TARGET turner_view)
    function(turner_view_test name)
        turner_unit_test(view_${name} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/test_view_${name}.c
                         LAYERS base)
        target_sources(test_view_${name} PRIVATE ${ARGN})
    endfunction()
    turner_view_test(pace ${PROJECT_SOURCE_DIR}/src/view/pace.c)
    turner_view_test(orbit ${PROJECT_SOURCE_DIR}/src/view/camera.c)
    turner_view_test(turn ${PROJECT_SOURCE_DIR}/src/view/turn.c)
endif()

# What a saved scene leaves to be built anew.
if(TARGET turner)
    turner_unit_test(view_move ${CMAKE_CURRENT_LIST_DIR}/test_view_move.c
        LAYERS base image scene reference bvh gpu render LIBRARIES ${turner_libraries})
    set_target_properties(test_view_move PROPERTIES LINKER_LANGUAGE CXX)
    set_tests_properties(view_move PROPERTIES LABELS device)
endif()
