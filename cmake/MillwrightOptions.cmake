# SPDX-License-Identifier: GPL-2.0-or-later
# Compiler flags and the places where programs, modules and headers are built (the run-in-place layout).
option(MW_TESTS "Build the tests" ON)
# Off where each source shall show that it includes what it uses: in the presets dev, asan and tsan.
option(MW_UNITY "Compile several sources of a test as one" ON)
option(MW_SHOP "Build millwright shop, where PostgreSQL's and curl's libraries are installed" ON)
option(MW_BENCH "Build the benchmarks" OFF)
option(MW_FUZZ "Build the fuzz targets (clang)" OFF)
option(MW_ASSERTS "Keep asserts in optimised builds" OFF)
set(MW_SANITIZE "" CACHE STRING "Sanitizers for -fsanitize=, comma separated")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()

set(CMAKE_CXX_STANDARD 23)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_SCAN_FOR_MODULES OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(MW_INCLUDE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/include)
# Programs find their libraries beside themselves, in place and installed alike.
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../lib")

add_compile_options(-Wall -Wextra -Wshadow -Werror -ffp-contract=off -fvisibility=hidden)
# Between signed and unsigned of one width nothing is lost; what loses digits or range is written out.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> $<$<COMPILE_LANGUAGE:CXX>:-Wconversion> $<$<COMPILE_LANGUAGE:CXX>:-Wno-sign-conversion>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 reports these on inlined library code where nothing is wrong.
  add_compile_options(-Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds -Wno-dangling-pointer)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # libstdc++ 12 uses its own deprecated get_temporary_buffer inside stable_sort.
  add_compile_options(-Wno-deprecated-declarations)
endif()
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")
set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O2 -g1")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_C_FLAGS_RELEASE "-O2 -DNDEBUG")
# Release builds optimise some components as a whole (mw_optimise_whole); all else is linked as it was compiled.
set(MW_LINK_TIME OFF)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  set(MW_LINK_TIME ON)
  add_link_options(-fno-lto)
endif()
if(NOT MW_ASSERTS)
  add_compile_definitions($<$<NOT:$<CONFIG:Debug>>:NDEBUG>)
endif()
if(MW_SANITIZE)
  # Memory is watched, speed is not: it compiles in two thirds of the time.
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
  set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -g1")
  add_compile_options(-fsanitize=${MW_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${MW_SANITIZE})
  if(MW_SANITIZE MATCHES "undefined")
    # Realtime code has no RTTI, which the vptr check needs.
    add_compile_options(-fno-sanitize-recover=undefined -fno-sanitize=vptr)
  endif()
endif()
if(MW_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)  # coverage for libFuzzer, in the libraries too
endif()
