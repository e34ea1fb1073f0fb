# SPDX-License-Identifier: GPL-2.0-or-later
# One function per kind of target, so that every folder's CMake file reads as a list of what is in it.
include(CMakeParseArguments)

# Flags of code that runs in a realtime thread (docs/developer/architecture.md, "Realtime").
set(MW_REALTIME_FLAGS $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions> $<$<COMPILE_LANGUAGE:CXX>:-fno-rtti>)
set_property(GLOBAL PROPERTY MW_REALTIME_TARGETS "")

# mw_library(NAME SOURCES a.cc ... [DEPENDS mw_base ...] [PRIVATE_DEPENDS ...])
# A static library mw_NAME; includes are rooted at src/ and at the top of the tree. Without SOURCES it is header-only.
function(mw_library name)
  cmake_parse_arguments(A "REALTIME" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(A_SOURCES)
    add_library(mw_${name} STATIC ${A_SOURCES})
    target_include_directories(mw_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
    target_link_libraries(mw_${name} PUBLIC ${A_DEPENDS} PRIVATE ${A_PRIVATE_DEPENDS})
    if(NOT A_REALTIME)
      mw_use_precompiled(mw_${name} library)
    endif()
  else()
    add_library(mw_${name} INTERFACE)
    target_include_directories(mw_${name} INTERFACE ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
    target_link_libraries(mw_${name} INTERFACE ${A_DEPENDS})
  endif()
endfunction()

# mw_realtime_library(NAME ...): as mw_library, for code that the servo thread runs: no exceptions, no RTTI,
# and its undefined symbols are checked against tools/realtime_symbols.txt by the test lint.symbols.
function(mw_realtime_library name)
  mw_library(${name} REALTIME ${ARGN})
  target_compile_options(mw_${name} PRIVATE ${MW_REALTIME_FLAGS})
  if(MW_LINK_TIME)
    target_compile_options(mw_${name} PRIVATE -flto -ffat-lto-objects)
  endif()
  mw_use_precompiled(mw_${name} realtime)
  set_property(GLOBAL APPEND PROPERTY MW_REALTIME_TARGETS mw_${name})
endfunction()

# mw_planner_library(NAME ...): as mw_library, for code of the planner, which is part of a realtime component but does not
# run in the servo thread: no exceptions, no RTTI; it may allocate until its tables have the size of its windows.
function(mw_planner_library name)
  mw_library(${name} REALTIME ${ARGN})
  target_compile_options(mw_${name} PRIVATE ${MW_REALTIME_FLAGS})
  mw_use_precompiled(mw_${name} realtime)
endfunction()

# mw_component(NAME SOURCES ... [DEPENDS ...]): a realtime HAL component, lib/NAME.so, loaded by `loadrt NAME`.
function(mw_component name)
  cmake_parse_arguments(A "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(comp_${name} MODULE ${A_SOURCES})
  set_target_properties(comp_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name})
  target_compile_options(comp_${name} PRIVATE ${MW_REALTIME_FLAGS})
  target_compile_definitions(comp_${name} PRIVATE RTAPI=1)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(comp_${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fno-gnu-unique>)
  endif()
  # Static libraries linked in stay private to the module.
  target_link_options(comp_${name} PRIVATE -Wl,--exclude-libs,ALL)
  target_link_libraries(comp_${name} PRIVATE mw_hal_api ${A_DEPENDS})
  set_property(GLOBAL APPEND PROPERTY MW_REALTIME_TARGETS comp_${name})
  install(TARGETS comp_${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/millwright/modules)
endfunction()

# mw_optimise_whole(NAME): a component in which functions of one library are compiled into those of another.
# The servo functions take 0.91 to 0.94 of the instructions so.
function(mw_optimise_whole name)
  if(MW_LINK_TIME)
    target_compile_options(comp_${name} PRIVATE -flto)
    # Only -flto itself undoes the -fno-lto of all else; the number is that of its processes.
    target_link_options(comp_${name} PRIVATE -flto -flto=2)
  endif()
endfunction()

# mw_program(NAME SOURCES ... DEPENDS ...): bin/NAME.
function(mw_program name)
  cmake_parse_arguments(A "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE ${A_DEPENDS})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# Tests are compiled without optimisation, which would take half of their time; what they test is compiled with it.
set(MW_TEST_FLAGS -O0)

# mw_unite(TARGET): several of its sources are compiled as one, which parses their common headers once.
function(mw_unite target)
  if(MW_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
  endif()
endfunction()

# mw_test(NAME SOURCES ... DEPENDS ... [LABELS ...] [TIMEOUT s] [COMPONENTS and2 ...] [ROWS C10 ...] [APART]
# [OPTIMISED]): a GoogleTest program, one CTest test per case. COMPONENTS are built first. ROWS are the rows of docs/developer/requirements.md
# that it tests: labels row-C10 (ctest -L row-C10). The sources of one that is
# APART give different things one name; one that is OPTIMISED computes much itself.
function(mw_test name)
  if(NOT MW_TESTS)
    return()
  endif()
  cmake_parse_arguments(A "APART;OPTIMISED" "TIMEOUT" "SOURCES;DEPENDS;LABELS;COMPONENTS;ROWS" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE ${A_DEPENDS} GTest::gtest GTest::gtest_main)
  if(A_OPTIMISED)
    mw_use_precompiled(${name} optimised_test)
  else()
    target_compile_options(${name} PRIVATE ${MW_TEST_FLAGS})
    mw_use_precompiled(${name} test)
  endif()
  if(NOT A_APART)
    mw_unite(${name})
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/test)
  foreach(component ${A_COMPONENTS})
    add_dependencies(${name} comp_${component})
  endforeach()
  if(NOT A_TIMEOUT)
    set(A_TIMEOUT 120)
  endif()
  # Sanitizers slow tests down several times.
  if(MW_SANITIZE)
    math(EXPR A_TIMEOUT "4 * ${A_TIMEOUT}")
  endif()
  if(NOT A_LABELS)
    set(A_LABELS unit)
  endif()
  list(TRANSFORM A_ROWS PREPEND row-)
  list(APPEND A_LABELS ${A_ROWS})
  # Kill tests measure the timing of a realtime process: no other test may run at the same time.
  set(serial FALSE)
  if("kill" IN_LIST A_LABELS)
    set(serial TRUE)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT ${A_TIMEOUT} LABELS "${A_LABELS}" RUN_SERIAL ${serial})
endfunction()

# mw_bench(NAME SOURCES ... DEPENDS ...): a Google Benchmark program, bench/NAME in the build folder.
function(mw_bench name)
  if(NOT MW_BENCH)
    return()
  endif()
  cmake_parse_arguments(A "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE ${A_DEPENDS} benchmark::benchmark benchmark::benchmark_main)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
endfunction()

# mw_fuzz(NAME SOURCES ... DEPENDS ...): a libFuzzer program, fuzz/NAME in the build folder.
function(mw_fuzz name)
  if(NOT MW_FUZZ)
    return()
  endif()
  cmake_parse_arguments(A "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE ${A_DEPENDS})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz)
endfunction()
