# Runs FUZZER for a minute on a copy of CORPUS in WORK; inputs that break it stay in WORK.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
file(COPY ${CORPUS}/ DESTINATION ${WORK}/corpus)
set(dictionary)
if(EXISTS ${CORPUS}.dict)
    set(dictionary -dict=${CORPUS}.dict)
endif()
# to the sanitizer, what --wrap of lld puts in the place of a variable is that one once more
set(ENV{ASAN_OPTIONS} "$ENV{ASAN_OPTIONS}:detect_odr_violation=0")
execute_process(
    COMMAND ${FUZZER} -max_total_time=60 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1
            -verbosity=1 -artifact_prefix=${WORK}/ ${dictionary} ${WORK}/corpus
    ERROR_VARIABLE log RESULT_VARIABLE status)
string(LENGTH "${log}" length)
if(length GREATER 8000) # the end says what happened
    math(EXPR begin "${length} - 8000")
    string(SUBSTRING "${log}" ${begin} -1 log)
endif()
message("${log}")
if(NOT status EQUAL 0)
    message(FATAL_ERROR "the fuzzer found something (${status}); the input lies in ${WORK}")
endif()
