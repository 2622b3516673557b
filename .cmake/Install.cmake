# What `cmake --install` puts where, and the Debian packages of it. Three components:
#
#   runtime   programs, manual pages, completion, documents, task, robot and cell files     package tenon
#   dev       headers, static libraries, find_package(tenon)                                package libtenon-dev
#   python    the Python package                                                            package python3-tenon
#
# Files lie below share/tenon as they lie in the repository, so that commands read the same in both.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(mains GLOBAL PROPERTY TENON_MAINS)
install(TARGETS ${mains} RUNTIME COMPONENT runtime)

set(data ${CMAKE_INSTALL_DATADIR}/tenon)
install(DIRECTORY planner/tasks DESTINATION ${data}/planner COMPONENT runtime)
install(DIRECTORY hw/cells hw/drives hw/robots DESTINATION ${data}/hw COMPONENT runtime)
install(DIRECTORY hw/sensors DESTINATION ${data}/hw COMPONENT runtime FILES_MATCHING PATTERN "*.yaml")
install(DIRECTORY sim/experiments DESTINATION ${data}/sim COMPONENT runtime FILES_MATCHING PATTERN "*.yaml"
        PATTERN results EXCLUDE)
install(DIRECTORY sim/experiments/results DESTINATION ${data}/sim/experiments COMPONENT runtime)
install(DIRECTORY lcmtypes DESTINATION ${data} COMPONENT runtime FILES_MATCHING PATTERN "*.lcm"
        PATTERN received EXCLUDE)
install(DIRECTORY tests/examples DESTINATION ${data}/tests COMPONENT runtime FILES_MATCHING PATTERN "*.cpp")
install(DIRECTORY shared/config/schemas DESTINATION ${data}/shared/config COMPONENT runtime)
install(PROGRAMS demo.sh DESTINATION ${data} COMPONENT runtime)
# What one of them links to is installed too, or is no link.
foreach(document README.md planner/FIRST_TASK.md planner/HOW_IT_PLANS.md planner/README.md executor/README.md
                 executor/WATCH.md hw/README.md hw/PROTOCOL.md hw/YOUR_ARM.md sim/CI.md sim/README.md lcmtypes/README.md
                 shared/ARCHITECTURE.md shared/README.md shared/plan/FORMAT.md shared/drawing/page/README.md)
  get_filename_component(folder ${document} DIRECTORY)
  install(FILES ${document} DESTINATION ${data}/${folder} COMPONENT runtime)
endforeach()

foreach(folder planner executor hw sim shared)
  install(DIRECTORY ${folder}/pictures DESTINATION ${data}/${folder} COMPONENT runtime)
endforeach()

# Manual pages and completion are what the installed programs say of themselves.
find_program(GZIP gzip REQUIRED)
mark_as_advanced(GZIP)
list(JOIN mains " " mains_text)
install(CODE "
  set(root \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
  file(MAKE_DIRECTORY \${root}/man/man1 \${root}/bash-completion/completions)
  separate_arguments(mains UNIX_COMMAND \"${mains_text}\")
  foreach(main IN LISTS mains)
    set(page \${root}/man/man1/\${main}.1)
    set(program ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/\${main})
    execute_process(COMMAND \${program} --man OUTPUT_FILE \${page} COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${GZIP} -9nf \${page} COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \${program} --bash-completion COMMAND_ERROR_IS_FATAL ANY
                    OUTPUT_FILE \${root}/bash-completion/completions/\${main})
    message(STATUS \"Installing: \${page}.gz and the completion of \${main}\")
  endforeach()" COMPONENT runtime)

# --- for programs that use the libraries -----------------------------------------------------------------
install(TARGETS ${TENON_LIBRARIES} EXPORT tenon
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/tenon COMPONENT dev)
foreach(folder shared planner executor hw sim)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${folder}/*.h)
  list(FILTER headers EXCLUDE REGEX "/main_[a-z_]+\\.h$")
  foreach(header IN LISTS headers)
    get_filename_component(folder_of ${header} DIRECTORY)
    install(FILES ${header} DESTINATION ${TENON_INSTALLED_ROOT}/${folder_of} COMPONENT dev)
  endforeach()
endforeach()
install(DIRECTORY ${PROJECT_BINARY_DIR}/roots/lcmtypes/lcmtypes DESTINATION ${TENON_INSTALLED_ROOT} COMPONENT dev)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/tenon)
install(EXPORT tenon NAMESPACE tenon:: FILE tenon-targets.cmake DESTINATION ${package} COMPONENT dev)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/tenon-config-version.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES .cmake/package/tenon-config.cmake .cmake/FindLCM.cmake .cmake/FindMicroHttpd.cmake .cmake/FindODE.cmake
              ${PROJECT_BINARY_DIR}/package/tenon-config-version.cmake
        DESTINATION ${package} COMPONENT dev)

# --- for Python; where Debian's looks below /usr. Elsewhere PYTHONPATH has to name it. -----------------------
install(DIRECTORY shared/python/tenon DESTINATION lib/python3/dist-packages COMPONENT python FILES_MATCHING PATTERN "*.py")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/package/VERSION CONTENT "@PROJECT_VERSION@\n" @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/VERSION DESTINATION lib/python3/dist-packages/tenon COMPONENT python)
install(FILES shared/python/README.md DESTINATION ${data}/shared/python COMPONENT python)

# --- Debian packages: cpack --config build/release/CPackConfig.cmake ---------------------------------------
foreach(component_and_name IN ITEMS runtime:tenon dev:libtenon-dev python:python3-tenon)
  string(REPLACE ":" ";" pair ${component_and_name})
  list(GET pair 0 component)
  list(GET pair 1 name)
  install(CODE "
    set(source ${PROJECT_SOURCE_DIR})
    set(gzip ${GZIP})
    set(name ${name})
    set(version ${PROJECT_VERSION})
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/${name}\")
    include(${PROJECT_SOURCE_DIR}/.cmake/package/documents.cmake)" COMPONENT ${component})
endforeach()

set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/.cmake/package/maintainer.cmake)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tenon)
set(CPACK_COMPONENTS_ALL runtime dev python)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME tenon)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "plan how to fit parts together by touch, and execute it
 An offline planner searches over beliefs and writes guarded moves; a real-time
 executor drives an arm over CAN by them; a virtual arm answers on the same
 protocol, so that the whole chain runs without hardware.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libtenon-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "libeigen3-dev, libode-dev, liblcm-dev, liblcm-bin, libyaml-cpp-dev, liburdfdom-dev, libconsole-bridge-dev, libcli11-dev, nlohmann-json3-dev, libmicrohttpd-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "planner and executor as libraries of C++
 Headers, static libraries and find_package(tenon): planner/planner.h takes a
 task and gives a plan, executor/plan_executor.h takes a plan and feedback and
 gives setpoints.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tenon)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.9), python3-numpy")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "read what Tenon writes into numpy
 Plans of guarded moves, run logs, results and truths of Tenon's programs as
 numpy arrays. Pure Python; needs neither the programs nor LCM.")
include(CPack)
