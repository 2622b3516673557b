# The rules of the house: who may use whom, and the functions that declare targets by these rules.
#
#   tenon_library(NAME [EXCEPT FOLDER...] [PUBLIC DEP...] [PRIVATE DEP...])
#   tenon_main(NAME SOURCE [DEP...])
#   tenon_lcm_types(NAME)
#   tenon_test(AREA [SERIAL|UNLISTED] [SHORT] [PLANS] [EXECUTABLES MAIN...] [FULL_EXECUTABLES MAIN...]
#              [FULL FILTER...])
#   tenon_area_runs(AREA [PROGRAMS TARGET...] [FILES FILE...])
#   tenon_test_program(NAME [DEP...])     for benchmarks and fuzzers
#   tenon_plan(NAME TASK [START NAME] [CELL FILE] [FULL])
#   tenon_check_house()
#
# A dependency that is not in the table below stops the configure step, whether it is declared with
# these functions or slipped in with target_link_libraries().

# ---------------------------------------------------------------------------------------------
# Who may use whom. One row per target: everything that it may link, and therefore include.
# ---------------------------------------------------------------------------------------------
set(TENON_LIBRARIES shared shared_canopen shared_mit shared_system shared_drawing shared_eds shared_config lcmtypes lcmtypes_received
    planner planner_belief planner_search planner_judge planner_check planner_report planner_cell_fit planner_new_task
    executor executor_faults executor_states executor_record executor_motion executor_sensing executor_dry_run
    executor_loop executor_identification executor_telemetry executor_monitor executor_recorded
    executor_export hw_can hw_canopen hw_cia402 hw_sensors hw_arm hw_mit hw_robot_arm hw_load hw_check
    sim_physics sim_cell sim_listener sim_view sim_evaluation sim_evaluation_chain)

set(TENON_MAY_USE_shared        Eigen3::Eigen)
set(TENON_MAY_USE_shared_canopen shared)
set(TENON_MAY_USE_shared_mit    shared)
set(TENON_MAY_USE_shared_system shared Threads::Threads)
set(TENON_MAY_USE_shared_drawing shared)
set(TENON_MAY_USE_shared_eds    shared)
set(TENON_MAY_USE_shared_config shared shared_canopen shared_mit shared_system yaml-cpp urdfdom::urdfdom_model
                                console_bridge::console_bridge nlohmann_json::nlohmann_json CLI11::CLI11)
set(TENON_MAY_USE_lcmtypes      LCM::headers)
set(TENON_MAY_USE_lcmtypes_received shared lcmtypes)
set(TENON_MAY_USE_planner       shared planner_cell_fit planner_belief planner_search planner_judge)
set(TENON_MAY_USE_planner_cell_fit shared)
set(TENON_MAY_USE_planner_belief shared shared_system)
set(TENON_MAY_USE_planner_search shared planner_belief)
set(TENON_MAY_USE_planner_judge  shared planner_belief planner_cell_fit)
set(TENON_MAY_USE_planner_check  shared planner_belief planner_search)
set(TENON_MAY_USE_planner_new_task shared)
set(TENON_MAY_USE_planner_report shared shared_drawing planner planner_belief planner_judge planner_check
                                 nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_executor                shared executor_motion)
set(TENON_MAY_USE_executor_faults         shared)
set(TENON_MAY_USE_executor_states         shared executor_faults)
set(TENON_MAY_USE_executor_record         shared shared_system executor_states)
set(TENON_MAY_USE_executor_motion         shared executor_states)
set(TENON_MAY_USE_executor_sensing        shared executor_faults executor_states)
set(TENON_MAY_USE_executor_dry_run        shared executor_motion nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_executor_loop           shared shared_system executor_faults executor_states
                                          executor_record executor_motion executor_sensing executor_dry_run)
set(TENON_MAY_USE_executor_identification shared executor_states executor_record executor_motion
                                          executor_sensing executor_loop)
# Message types and LCM are telemetry's, and those who listen to it.
set(TENON_MAY_USE_executor_telemetry      shared shared_system executor_states executor_record
                                          executor_motion executor_loop executor_identification
                                          lcmtypes lcmtypes_received LCM::lcm Threads::Threads
                                          nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_executor_monitor        shared shared_system executor_faults executor_states executor_telemetry
                                          lcmtypes lcmtypes_received)
# Reads what telemetry wrote, and needs no LCM for it.
set(TENON_MAY_USE_executor_recorded       shared shared_system executor_faults executor_states executor_record
                                          lcmtypes lcmtypes_received nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_executor_export         shared shared_system executor_faults executor_states executor_record
                                          executor_recorded lcmtypes lcmtypes_received
                                          nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_hw_can        shared shared_system)
set(TENON_MAY_USE_hw_canopen    shared shared_canopen)
set(TENON_MAY_USE_hw_cia402     shared shared_canopen)
set(TENON_MAY_USE_hw_sensors    shared)
set(TENON_MAY_USE_hw_arm        shared shared_canopen hw_canopen hw_cia402 hw_sensors)
set(TENON_MAY_USE_hw_mit        shared shared_mit hw_arm)
set(TENON_MAY_USE_hw_robot_arm  shared shared_mit hw_arm hw_mit)
set(TENON_MAY_USE_hw_load       shared shared_mit hw_arm hw_mit)
set(TENON_MAY_USE_hw_check      shared shared_eds shared_mit hw_canopen hw_arm hw_mit hw_load)
set(TENON_MAY_USE_sim_physics    shared ODE::ODE)
# The arm's links and joints are bodies of the same engine.
set(TENON_MAY_USE_sim_cell       shared shared_canopen shared_mit shared_eds sim_physics ODE::ODE nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_sim_listener   shared shared_system lcmtypes lcmtypes_received LCM::lcm)
# The one server of web pages.
set(TENON_MAY_USE_sim_view       shared shared_system shared_drawing sim_cell Threads::Threads
                                 MicroHttpd::microhttpd nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_sim_evaluation shared shared_system shared_drawing sim_cell
                                 nlohmann_json::nlohmann_json)
# The evaluation runs executor and virtual arm in lockstep inside one process.
set(TENON_MAY_USE_sim_evaluation_chain shared shared_system sim_evaluation sim_cell
                                       executor_dry_run executor_loop executor_telemetry hw_robot_arm)

# The mains compose. What is common to all of them:
set(TENON_MAY_USE_any_main      shared shared_system Threads::Threads CLI11::CLI11
                                nlohmann_json::nlohmann_json)
# What an arm can do is told to the planner, behind its port, by the dry run and the kinematics under it.
set(TENON_MAY_USE_tenon-plan     planner planner_check planner_report planner_cell_fit planner_new_task executor_dry_run sim_physics
                                 shared_config)
set(TENON_MAY_USE_tenon-inspect  planner planner_report planner_cell_fit executor_recorded sim_physics shared_config)
set(TENON_MAY_USE_tenon-exec     executor executor_dry_run executor_identification
                                 executor_loop executor_telemetry hw_can hw_robot_arm hw_load shared_config)
set(TENON_MAY_USE_tenon-monitor  executor_monitor executor_export executor_telemetry shared_config LCM::lcm Ncurses::ncursesw)
set(TENON_MAY_USE_tenon-sim      sim_cell sim_listener sim_view hw_can shared_eds shared_config)
set(TENON_MAY_USE_tenon-evaluate sim_evaluation_chain sim_evaluation sim_cell hw_load shared_config)
set(TENON_MAY_USE_tenon-can      hw_can hw_canopen hw_cia402 hw_mit hw_check shared_eds shared_config)

# Everything under tests/ may use any library, and never a main.
set(TENON_MAY_USE_tests ${TENON_LIBRARIES} test_support Eigen3::Eigen yaml-cpp ODE::ODE LCM::lcm
    Threads::Threads nlohmann_json::nlohmann_json GTest::gtest GTest::gmock GTest::gtest_main
    GTest::gmock_main orocos-kdl fcl benchmark::benchmark benchmark::benchmark_main)

# Stops unless the row of the table allows `target` to use each of the given dependencies.
function(tenon_check_dependencies target)
  get_target_property(row ${target} TENON_ROW)
  if(NOT row)
    message(FATAL_ERROR "Tenon: target '${target}' was not declared with the functions of "
                        ".cmake/Tenon.cmake, so no row of the table of dependencies covers it.")
  endif()
  set(allowed ${TENON_MAY_USE_${row}})
  if(row MATCHES "^tenon-")
    list(APPEND allowed ${TENON_MAY_USE_any_main})
  endif()
  foreach(dependency IN LISTS ARGN)
    if(NOT dependency IN_LIST allowed)
      list(JOIN allowed ", " allowed_text)
      message(FATAL_ERROR "Tenon: forbidden dependency: '${target}' may not use '${dependency}'. "
                          "Allowed: ${allowed_text}. (The table stands in .cmake/Tenon.cmake.)")
    endif()
  endforeach()
endfunction()

# ---------------------------------------------------------------------------------------------
# Include roots. Includes are repository paths ("shared/motion/guarded_move.h"), but nobody gets
# the repository itself as an include directory: each library exports a directory of links that
# shows its own folder and nothing else.
# ---------------------------------------------------------------------------------------------
set(TENON_INSTALLED_ROOT include/tenon)

function(tenon_include_root target folder)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "EXCEPT")
  set(root ${PROJECT_BINARY_DIR}/roots/${target})
  file(REMOVE_RECURSE ${root})
  if(arg_EXCEPT)
    # Link each entry by itself, so that an excepted sub-folder stays out of reach.
    file(MAKE_DIRECTORY ${root}/${folder})
    file(GLOB entries CONFIGURE_DEPENDS LIST_DIRECTORIES true
         RELATIVE ${PROJECT_SOURCE_DIR}/${folder} ${PROJECT_SOURCE_DIR}/${folder}/*)
    list(REMOVE_ITEM entries ${arg_EXCEPT} CMakeLists.txt README.md)
    foreach(entry IN LISTS entries)
      file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder}/${entry} ${root}/${folder}/${entry} SYMBOLIC)
    endforeach()
  else()
    get_filename_component(parent ${root}/${folder} DIRECTORY)
    file(MAKE_DIRECTORY ${parent})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  endif()
endfunction()

# ---------------------------------------------------------------------------------------------
# Targets
# ---------------------------------------------------------------------------------------------

# The library of a folder: every .cpp below it, except the mains and the folders after EXCEPT.
# FOLDER defaults to NAME.
# INNERMOST: every simulated move spends its time here, a tenth less of it where GCC inlines more.
function(tenon_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "INNERMOST" "FOLDER" "EXCEPT;PUBLIC;PRIVATE")
  if(NOT arg_FOLDER)
    set(arg_FOLDER ${name})
  endif()
  set(folder ${PROJECT_SOURCE_DIR}/${arg_FOLDER})

  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main_[a-z_]+\\.cpp$")
  foreach(except IN LISTS arg_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "^${folder}/${except}/")
  endforeach()

  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES TENON_ROW ${name})

  tenon_check_dependencies(${name} ${arg_PUBLIC} ${arg_PRIVATE})
  tenon_include_root(${name} ${arg_FOLDER} EXCEPT ${arg_EXCEPT})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/roots/${name}>
                                            $<INSTALL_INTERFACE:${TENON_INSTALLED_ROOT}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  if(arg_INNERMOST)
    target_compile_options(${name} PRIVATE $<$<NOT:$<CONFIG:Sanitize>>:-O3>)
  endif()
endfunction()

# An executable out of one thin main that composes libraries. SOURCE may be a pattern for a main and its
# parts (main_NAME.cpp, main_NAME_PART.cpp). Does nothing while it is missing.
function(tenon_main name source)
  file(GLOB found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source})
  if(NOT found)
    return()
  endif()
  add_executable(${name} ${found})
  set_target_properties(${name} PROPERTIES TENON_ROW ${name})
  tenon_check_dependencies(${name} ${ARGN})
  # Its parts have headers beside them, which are reached like all others, and by this main alone.
  string(REGEX REPLACE "\\.cpp$" ".h" pattern ${source})
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
       ${CMAKE_CURRENT_SOURCE_DIR}/${pattern})
  set(root ${PROJECT_BINARY_DIR}/roots/${name})
  file(REMOVE_RECURSE ${root})
  foreach(header IN LISTS headers)
    get_filename_component(folder ${header} DIRECTORY)
    file(MAKE_DIRECTORY ${root}/${folder})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${header} ${root}/${header} SYMBOLIC)
  endforeach()
  if(headers)
    target_include_directories(${name} PRIVATE ${root})
  endif()
  target_compile_definitions(${name} PRIVATE TENON_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${name} PRIVATE ${ARGN} CLI11::CLI11 nlohmann_json::nlohmann_json)
  set_property(GLOBAL APPEND PROPERTY TENON_MAINS ${name})
endfunction()

# The C++ types of every .lcm file of the current folder. The message `status_t` of package `tenon`
# is included as "lcmtypes/tenon/status_t.hpp".
function(tenon_lcm_types name)
  set(root ${PROJECT_BINARY_DIR}/roots/${name})
  file(GLOB inputs CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.lcm)
  set(outputs)
  foreach(input IN LISTS inputs)
    # The header's names follow from the file's text, so read it again whenever it changes.
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${input})
    file(STRINGS ${input} package_line REGEX "^[ \t]*package[ \t]+[a-z_]+[ \t]*;")
    file(STRINGS ${input} struct_lines REGEX "^[ \t]*struct[ \t]+[A-Za-z0-9_]+")
    string(REGEX REPLACE "^[ \t]*package[ \t]+([a-z_]+).*" "\\1" package "${package_line}")
    list(TRANSFORM struct_lines REPLACE "^[ \t]*struct[ \t]+([A-Za-z0-9_]+).*" "\\1")
    list(TRANSFORM struct_lines PREPEND ${root}/lcmtypes/${package}/)
    list(TRANSFORM struct_lines APPEND .hpp)
    add_custom_command(
      OUTPUT ${struct_lines}
      COMMAND ${LCM_GEN} --cpp --cpp-std c++11 --cpp-hpath ${root}/lcmtypes --cpp-include lcmtypes
              ${input}
      DEPENDS ${input}
      COMMENT "Generating the message types of ${input}"
      VERBATIM)
    list(APPEND outputs ${struct_lines})
  endforeach()

  file(MAKE_DIRECTORY ${root}/lcmtypes)
  add_custom_target(${name}_headers DEPENDS ${outputs})
  add_library(${name} INTERFACE)
  add_dependencies(${name} ${name}_headers)
  set_target_properties(${name} PROPERTIES TENON_ROW ${name})
  target_include_directories(${name} SYSTEM INTERFACE $<BUILD_INTERFACE:${root}>
                                                      $<INSTALL_INTERFACE:${TENON_INSTALLED_ROOT}>)
  target_link_libraries(${name} INTERFACE LCM::headers)
endfunction()

# What every program under tests/ gets: all libraries, and its own folder as an include root. Where
# things are on this machine, tests ask tests/support/places.h.
function(tenon_test_program name)
  set_target_properties(${name} PROPERTIES TENON_ROW tests)
  tenon_check_dependencies(${name} ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_BINARY_DIR}/roots/tests)
  target_link_libraries(${name} PRIVATE ${TENON_LIBRARIES} ${ARGN})
  if(TARGET test_support AND NOT name STREQUAL test_support AND "${ARGN}" MATCHES "GTest")
    target_precompile_headers(${name} REUSE_FROM test_support)
  endif()
endfunction()

# The GoogleTest binary tests_AREA out of every .cpp below the folder AREA; each test is registered as
# AREA.Suite.Name under the label AREA. Does nothing where TENON_TEST_AREAS names other areas only.
# SERIAL: its tests run one at a time, because they run in real time.
# UNLISTED: built but not registered, because its tests need another machine (tests/guest).
# SHORT: hundreds of tests that take no time, run in a few processes: AREA.part_0, ...
# EXECUTABLES: what its tests run, and is therefore built before it.
# FULL_EXECUTABLES: what only those with the label full run besides.
# PLANS: its tests read plans of tests/plans, which are therefore made before it is linked.
# FULL: GoogleTest filters of the tests that only a release needs. They get the label full in place of
# the area's.
function(tenon_test area)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SERIAL;UNLISTED;SHORT;PLANS" "" "EXECUTABLES;FULL_EXECUTABLES;FULL")
  tenon_has_area(${area} wanted)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${area}/*.cpp)
  if(NOT wanted OR NOT sources)
    return()
  endif()
  add_executable(tests_${area} ${sources})
  tenon_test_program(tests_${area} test_support ODE::ODE LCM::lcm yaml-cpp Threads::Threads
    nlohmann_json::nlohmann_json GTest::gtest_main GTest::gmock)
  if(arg_EXECUTABLES OR arg_FULL_EXECUTABLES)
    add_dependencies(tests_${area} ${arg_EXECUTABLES} ${arg_FULL_EXECUTABLES})
  endif()
  if(arg_PLANS)
    get_property(plans GLOBAL PROPERTY TENON_PLANS)
    set_property(TARGET tests_${area} APPEND PROPERTY LINK_DEPENDS ${plans})
  endif()
  if(arg_UNLISTED)
    return()
  endif()
  tenon_area_runs(${area} PROGRAMS tests_${area} ${arg_EXECUTABLES} FILES ${plans})
  if(arg_SHORT)
    tenon_test_in_parts(${area})
    return()
  endif()
  set(common TEST_PREFIX "${area}." DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
  if(arg_FULL)
    list(JOIN arg_FULL ":" full)
    gtest_discover_tests(tests_${area} ${common} TEST_FILTER "${full}"
      TEST_LIST tests_${area}_full
      PROPERTIES LABELS full TIMEOUT 3600 RUN_SERIAL ${arg_SERIAL})
    set(rest TEST_FILTER "-${full}")
  endif()
  gtest_discover_tests(tests_${area} ${common} ${rest}
    PROPERTIES LABELS ${area} TIMEOUT 600 RUN_SERIAL ${arg_SERIAL}
      ENVIRONMENT TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/threads/tsan.supp)
endfunction()

# All tests of tests_AREA in a few processes.
function(tenon_test_in_parts area)
  set(parts 4)
  math(EXPR last "${parts} - 1")
  foreach(part RANGE ${last})
    add_test(NAME ${area}.part_${part} COMMAND tests_${area} --gtest_brief=1)
    set_tests_properties(${area}.part_${part} PROPERTIES LABELS ${area} TIMEOUT 600
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part}")
  endforeach()
endfunction()

# All built files that the tests of an area run or read, for test.sh, which leaves out an area that has passed
# on the same ones.
function(tenon_area_runs area)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "PROGRAMS;FILES")
  set(files ${arg_FILES})
  foreach(program IN LISTS arg_PROGRAMS)
    list(APPEND files $<TARGET_FILE:${program}>)
  endforeach()
  list(JOIN files "\n" lines)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/areas/${area} CONTENT "${lines}\n")
endfunction()

# Whether this build is to have the tests of an area.
function(tenon_has_area area result)
  if(TENON_TEST_AREAS STREQUAL "all" OR area IN_LIST TENON_TEST_AREAS)
    set(${result} TRUE PARENT_SCOPE)
  else()
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()

# The plan NAME.tnp that tests share, made by tenon-plan, and again whenever planner, task or cell has
# changed. TASK and CELL are files of the repository, START is a start of the task (its first).
# FULL: only tests with the label full read it, so it is made by the target test_plans_full alone.
# A sanitized planner is slow, so a build with sanitizers takes the plan from TENON_PLANS_FROM.
function(tenon_plan name task)
  cmake_parse_arguments(PARSE_ARGV 2 arg "FULL" "START;CELL" "")
  if(TENON_SANITIZERS)
    if(NOT arg_FULL AND NOT EXISTS ${TENON_PLANS_FROM}/${name}.tnp)
      message(FATAL_ERROR "Tenon: ${TENON_PLANS_FROM}/${name}.tnp is missing; make it with "
                          "'cmake --preset dev && cmake --build --preset dev --target test_plans'.")
    endif()
    return()
  endif()
  set(plan ${PROJECT_BINARY_DIR}/plans/${name}.tnp)
  set(options)
  file(GLOB parts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/planner/tasks/parts/*)
  set(inputs ${PROJECT_SOURCE_DIR}/${task} ${parts})
  if(arg_START)
    list(APPEND options --start ${arg_START})
  endif()
  if(arg_CELL)
    list(APPEND options --cell ${PROJECT_SOURCE_DIR}/${arg_CELL})
    get_filename_component(folder ${PROJECT_SOURCE_DIR}/${arg_CELL} DIRECTORY)
    file(GLOB robots CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/hw/robots/*/* ${PROJECT_SOURCE_DIR}/hw/sensors/*.yaml
         ${folder}/*.yaml)
    list(APPEND inputs ${robots})
  endif()
  # However busy the machine is: the wall limit is for people, and no plan may depend on it.
  add_custom_command(
    OUTPUT ${plan}
    COMMAND tenon-plan ${PROJECT_SOURCE_DIR}/${task} ${options} --threads 1 --time-limit 86400
            --output ${plan}.new --json ${PROJECT_BINARY_DIR}/plans/${name}.json > ${name}.txt
    COMMAND ${CMAKE_COMMAND} -E rename ${plan}.new ${plan}
    DEPENDS tenon-plan ${inputs}
    WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/plans
    COMMENT "Planning ${name}"
    VERBATIM)
  if(arg_FULL)
    set_property(GLOBAL APPEND PROPERTY TENON_PLANS_FULL ${plan})
  else()
    set_property(GLOBAL APPEND PROPERTY TENON_PLANS ${plan})
  endif()
endfunction()

# ---------------------------------------------------------------------------------------------
# The final check: walks every target of the tree and holds what it really links and includes
# against the table. Call it last.
# ---------------------------------------------------------------------------------------------
function(tenon_check_house)
  tenon_collect_targets(${PROJECT_SOURCE_DIR} targets)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type STREQUAL "UTILITY")
      tenon_check_target(${target} ${type})
    endif()
  endforeach()
endfunction()

function(tenon_check_target target type)
  set(links)
  set(includes)
  set(properties INTERFACE_LINK_LIBRARIES INTERFACE_INCLUDE_DIRECTORIES
      INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
  if(NOT type STREQUAL "INTERFACE_LIBRARY")
    list(APPEND properties LINK_LIBRARIES INCLUDE_DIRECTORIES)
  endif()
  foreach(property IN LISTS properties)
    get_target_property(value ${target} ${property})
    if(value AND property MATCHES "LINK_LIBRARIES$")
      list(APPEND links ${value})
    elseif(value)
      list(APPEND includes ${value})
    endif()
  endforeach()

  # A private dependency of a static library reads $<LINK_ONLY:name>; ::@ marks a directory scope.
  list(TRANSFORM links REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1")
  list(FILTER links EXCLUDE REGEX "^::@")
  list(REMOVE_DUPLICATES links)
  tenon_check_dependencies(${target} ${links})

  list(TRANSFORM includes REPLACE "^\\$<BUILD_INTERFACE:(.*)>$" "\\1")
  # All headers that are installed are for all who use the installation.
  list(REMOVE_ITEM includes "$<INSTALL_INTERFACE:${TENON_INSTALLED_ROOT}>")
  foreach(directory IN LISTS includes)
    string(FIND "${directory}" "${PROJECT_BINARY_DIR}/roots/" position)
    if(NOT position EQUAL 0)
      message(FATAL_ERROR "Tenon: forbidden include directory: '${target}' adds '${directory}'. "
                          "Headers are reached through the include roots of the libraries that "
                          "a target uses.")
    endif()
  endforeach()
endfunction()

# All targets of a directory and of those below it.
function(tenon_collect_targets directory result)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(children DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(child IN LISTS children)
    tenon_collect_targets(${child} below)
    list(APPEND targets ${below})
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()
