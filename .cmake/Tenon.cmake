# The rules of the house: who may use whom, and the functions that declare targets by these rules.
#
#   tenon_library(NAME [EXCEPT FOLDER...] [PUBLIC DEP...] [PRIVATE DEP...])
#   tenon_main(NAME SOURCE [DEP...])
#   tenon_lcm_types(NAME)
#   tenon_test(AREA [SERIAL|UNLISTED])
#   tenon_test_program(NAME [DEP...])     for benchmarks and fuzzers
#   tenon_check_house()
#
# A dependency that is not in the table below stops the configure step, whether it is declared with
# these functions or slipped in with target_link_libraries().

# ---------------------------------------------------------------------------------------------
# Who may use whom. One row per target: everything that it may link, and therefore include.
# ---------------------------------------------------------------------------------------------
set(TENON_LIBRARIES shared shared_config lcmtypes planner executor hw sim)

set(TENON_MAY_USE_shared        Eigen3::Eigen)
set(TENON_MAY_USE_shared_config shared yaml-cpp urdfdom::urdfdom_model
                                console_bridge::console_bridge nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_lcmtypes      LCM::headers)
set(TENON_MAY_USE_planner       shared Threads::Threads nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_executor      shared lcmtypes LCM::lcm Threads::Threads
                                nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_hw            shared Threads::Threads nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_sim           shared ODE::ODE Threads::Threads nlohmann_json::nlohmann_json)

# The mains compose. What is common to all of them:
set(TENON_MAY_USE_any_main      shared Threads::Threads CLI11::CLI11 nlohmann_json::nlohmann_json)
set(TENON_MAY_USE_tenon-plan     planner sim shared_config)
set(TENON_MAY_USE_tenon-inspect  planner sim shared_config)
set(TENON_MAY_USE_tenon-exec     executor hw shared_config)
set(TENON_MAY_USE_tenon-monitor  executor lcmtypes shared_config LCM::lcm)
set(TENON_MAY_USE_tenon-sim      sim hw shared_config)
# The evaluation runs executor and virtual arm in lockstep inside one process.
set(TENON_MAY_USE_tenon-evaluate sim executor hw shared_config)
set(TENON_MAY_USE_tenon-can      hw shared_config)

# Everything under tests/ may use any library, and never a main.
set(TENON_MAY_USE_tests ${TENON_LIBRARIES} test_support Eigen3::Eigen yaml-cpp ODE::ODE LCM::lcm
    Threads::Threads nlohmann_json::nlohmann_json GTest::gtest GTest::gmock GTest::gtest_main
    GTest::gmock_main orocos-kdl benchmark::benchmark benchmark::benchmark_main)

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
function(tenon_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER" "EXCEPT;PUBLIC;PRIVATE")
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
  target_include_directories(${name} PUBLIC ${PROJECT_BINARY_DIR}/roots/${name})
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
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
  target_include_directories(${name} SYSTEM INTERFACE ${root})
  target_link_libraries(${name} INTERFACE LCM::headers)
endfunction()

# What every program under tests/ gets: all libraries, and the places of things as definitions:
#   TENON_SOURCE_DIR        the repository
#   TENON_BIN_DIR           the folder of the executables
#   TENON_PLAN_EXE, ...     each executable; the test program is built after it
function(tenon_test_program name)
  set_target_properties(${name} PROPERTIES TENON_ROW tests)
  tenon_check_dependencies(${name} ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_BINARY_DIR}/roots/tests)
  target_compile_definitions(${name} PRIVATE
    TENON_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    TENON_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}"
    TENON_VERSION="${PROJECT_VERSION}")
  get_property(mains GLOBAL PROPERTY TENON_MAINS)
  foreach(main IN LISTS mains)
    string(TOUPPER ${main} symbol)
    string(REPLACE "-" "_" symbol ${symbol})
    target_compile_definitions(${name} PRIVATE ${symbol}_EXE="$<TARGET_FILE:${main}>")
    add_dependencies(${name} ${main})
  endforeach()
  target_link_libraries(${name} PRIVATE ${TENON_LIBRARIES} ${ARGN})
endfunction()

# The GoogleTest binary tests_AREA out of every .cpp below the folder AREA; each test is registered as
# AREA.Suite.Name under the label AREA.
# SERIAL: its tests run one at a time, because they run in real time.
# UNLISTED: built but not registered, because its tests need another machine (tests/guest).
function(tenon_test area)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SERIAL;UNLISTED" "" "")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${area}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(tests_${area} ${sources})
  tenon_test_program(tests_${area} test_support ODE::ODE LCM::lcm yaml-cpp Threads::Threads
    nlohmann_json::nlohmann_json GTest::gtest_main GTest::gmock)
  if(arg_UNLISTED)
    return()
  endif()
  gtest_discover_tests(tests_${area}
    TEST_PREFIX "${area}."
    DISCOVERY_MODE PRE_TEST
    DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${area} TIMEOUT 600 RUN_SERIAL ${arg_SERIAL})
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
