# The one place that knows how tests are built and launched: mpiexec and its environment, thread
# counts, labels, time limits and the cores a test takes. `ctest -L unit`, `-L mpi`, `-L system` and
# `-L slurm` select by kind.

# More ranks than cores, as root in a container: a line of this file is a word and NAME=VALUE.
set(settings ${PROJECT_SOURCE_DIR}/job_scripts/mpi_settings.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${settings})
file(STRINGS ${settings} CARROM_TEST_ENVIRONMENT REGEX "^[a-z]+ [A-Z]")
list(TRANSFORM CARROM_TEST_ENVIRONMENT REPLACE "^[a-z]+ " "")
list(APPEND CARROM_TEST_ENVIRONMENT
     CARROM_PROGRAM=${CMAKE_BINARY_DIR}/carrom
     CARROM_MPIEXEC=${MPIEXEC_EXECUTABLE}
     CARROM_SOURCE_DIR=${PROJECT_SOURCE_DIR})
if(CARROM_SANITIZE MATCHES "address|leak")
  # MPI itself leaks
  list(APPEND CARROM_TEST_ENVIRONMENT ASAN_OPTIONS=detect_leaks=0 LSAN_OPTIONS=detect_leaks=0)
endif()
set(CARROM_GIVE_WAY OFF)
if("${MPI_C_LIBRARIES}" MATCHES "mpich" AND NOT CARROM_SANITIZE)
  set(CARROM_GIVE_WAY ON)
  # The library itself would sleep: many small messages then take twice as long.
  list(APPEND CARROM_TEST_ENVIRONMENT MPIR_CVAR_ENABLE_HEAVY_YIELD=0
       LD_PRELOAD=${CMAKE_BINARY_DIR}/tests/libgive_way.so)
endif()

# A test's time limit in arg_TIMEOUT, `default` if it says nothing: it is what a busy machine needs,
# sanitizers need more.
macro(carrom_time_limit default)
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT ${default})
  endif()
  if(CARROM_SANITIZE)
    math(EXPR arg_TIMEOUT "10 * ${arg_TIMEOUT}")
  endif()
endmacro()

# What every test executable shares. Tests may include their module's private headers and those of
# tests/support.
function(carrom_test_executable target module)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
  if(TARGET carrom::${module})
    target_link_libraries(${target} PRIVATE carrom::${module})
  endif()
  target_link_libraries(${target} PRIVATE carrom_warnings carrom_numerics Catch2::Catch2 ${ARGN})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
endfunction()

# carrom_unit_test(module SOURCES a_test.cpp ... [LINKS target ...] [TIMEOUT seconds])
# Builds <module>_unit_test without MPI; each Catch2 case is a ctest entry. Links carrom::<module>
# by itself.
function(carrom_unit_test module)
  cmake_parse_arguments(arg "" "TIMEOUT" "SOURCES;LINKS" ${ARGN})
  carrom_time_limit(120)
  # CTest takes the names as a list: behind a bracket left open, the names that follow are one long
  # name, and no test.
  foreach(source ${arg_SOURCES})
    file(STRINGS ${source} names REGEX "^TEST_CASE\\(\"[^\"]*[][;]")
    if(names)
      message(FATAL_ERROR "${source}: names of test cases must not hold brackets or semicolons")
    endif()
  endforeach()
  set(target ${module}_unit_test)
  add_executable(${target} ${arg_SOURCES})
  carrom_test_executable(${target} ${module} carrom_unit_main ${arg_LINKS})
  # Half the time to build; what is tested has its own options. g++ 12 warns of its own strings
  # then.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> -Wno-array-bounds)
  target_precompile_headers(${target} REUSE_FROM carrom_unit_main)
  catch_discover_tests(${target} TEST_PREFIX "${module}:"
                       PROPERTIES LABELS unit TIMEOUT ${arg_TIMEOUT}
                       ENVIRONMENT "OMP_NUM_THREADS=2")
endfunction()

# carrom_mpi_test(name SHAPES 1x2 3x1 ... [LONG_SHAPES 2x1 ...] SOURCES a_test.cpp ...
#                 [LINKS target ...] [TIMEOUT seconds] [LABELS label ...] [IN_PARTS])
# Builds <name>_mpi_test; one ctest entry for each shape, ranks x threads, runs all its Catch2 cases
# on every rank. Links carrom::<name>, if there is one, and carrom::parallel by itself. Shapes that
# hold what others hold are long: `ctest -C long -L long` runs them. IN_PARTS: $CARROM_TEST_PART
# says "k/n" to the k-th of n shapes, for tests that share their scenes out; the long run does
# everything on every shape, hidden Catch2 cases with the tag [long] included.
function(carrom_mpi_test name)
  cmake_parse_arguments(arg "IN_PARTS" "TIMEOUT" "SHAPES;LONG_SHAPES;SOURCES;LINKS;LABELS" ${ARGN})
  carrom_time_limit(120)
  if(NOT arg_LABELS)
    set(arg_LABELS mpi)
  endif()
  set(target ${name}_mpi_test)
  add_executable(${target} ${arg_SOURCES})
  carrom_test_executable(${target} ${name} carrom_mpi_main carrom::parallel ${arg_LINKS})
  target_precompile_headers(${target} REUSE_FROM carrom_mpi_main)
  list(LENGTH arg_SHAPES n_parts)
  set(part 0)
  foreach(shape ${arg_SHAPES})
    carrom_mpi_entry(${target} "${name}" ${shape} ${arg_TIMEOUT} "${arg_LABELS}")
    if(arg_IN_PARTS)
      set_property(TEST "${entry}" APPEND PROPERTY ENVIRONMENT CARROM_TEST_PART=${part}/${n_parts})
      carrom_mpi_entry(${target} "${name}, all of it" ${shape} 3600 "${arg_LABELS};long" "*")
    endif()
    math(EXPR part "${part} + 1")
  endforeach()
  foreach(shape ${arg_LONG_SHAPES})
    carrom_mpi_entry(${target} "${name}, all of it" ${shape} 3600 "${arg_LABELS};long")
  endforeach()
endfunction()

# carrom_mpi_entry(target name RANKSxTHREADS timeout labels [argument ...]): one entry, whose name
# is in `entry`.
function(carrom_mpi_entry target name shape timeout labels)
  string(REPLACE x ";" numbers ${shape})
  list(GET numbers 0 ranks)
  list(GET numbers 1 threads)
  # Threads of small scenes wait for each other asleep, most of the time. Ranks do not: beside other
  # tests each of their messages takes a slice of time.
  math(EXPR cores "2 * ${ranks} * ${threads}")
  if(ranks EQUAL 1)
    set(cores 1)
  endif()
  set(configurations)
  if(long IN_LIST labels)
    set(configurations CONFIGURATIONS long)
  endif()
  set(entry "${name}: ${ranks} ranks x ${threads} threads")
  set(entry "${entry}" PARENT_SCOPE)
  add_test(NAME ${entry} ${configurations}
           COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} ${MPIEXEC_PREFLAGS}
                   $<TARGET_FILE:${target}> ${ARGN} ${MPIEXEC_POSTFLAGS})
  set_tests_properties(${entry} PROPERTIES LABELS "${labels}" PROCESSORS ${cores}
                       TIMEOUT ${timeout})
  set_tests_properties(${entry} PROPERTIES ENVIRONMENT
    "${CARROM_TEST_ENVIRONMENT};OMP_NUM_THREADS=${threads};CARROM_TEST_SECONDS=${timeout}")
endfunction()

# carrom_system_test(name COMMAND program arg ... [LABELS label ...] [PROCESSORS n] [TIMEOUT
# seconds]) Runs a script or the real program in a folder of its own, so tests may run side by side.
# Scripts find the program in $CARROM_PROGRAM, mpiexec in $CARROM_MPIEXEC and the source tree in
# $CARROM_SOURCE_DIR. Tests with the label `long` are run by `ctest -C long -L long` only, those
# with the label `python` by `ctest -C python -L python`. One thread is the default, because two of
# a small scene wait for each other most of the time.
function(carrom_system_test name)
  cmake_parse_arguments(arg "" "TIMEOUT;PROCESSORS" "COMMAND;LABELS" ${ARGN})
  carrom_time_limit(300)
  if(NOT arg_PROCESSORS)
    set(arg_PROCESSORS 1)
  endif()
  if(NOT arg_LABELS)
    set(arg_LABELS system)
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/run/${name})
  file(MAKE_DIRECTORY ${folder})
  set(configurations)
  if(long IN_LIST arg_LABELS)
    set(configurations CONFIGURATIONS long)
  elseif(python IN_LIST arg_LABELS AND faults IN_LIST arg_LABELS)
    set(configurations CONFIGURATIONS python long) # `ctest -C long -L faults` has all attacks
  elseif(python IN_LIST arg_LABELS)
    set(configurations CONFIGURATIONS python)
  endif()
  add_test(NAME ${name} COMMAND ${arg_COMMAND} WORKING_DIRECTORY ${folder} ${configurations})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" PROCESSORS ${arg_PROCESSORS}
                       TIMEOUT ${arg_TIMEOUT})
  set_tests_properties(${name} PROPERTIES ENVIRONMENT
    "${CARROM_TEST_ENVIRONMENT};OMP_NUM_THREADS=1")
endfunction()
