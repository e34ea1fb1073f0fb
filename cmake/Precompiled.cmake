# SPDX-License-Identifier: GPL-2.0-or-later
# Headers of the standard library, GoogleTest and pybind11 that are parsed once for all sources with the same flags: that is
# half of the time of a clean build. The preset dev does without: it checks that sources include what they use.
option(MW_PRECOMPILED "Precompile headers of libraries" ON)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(MW_PRECOMPILED_FLAGS -fpch-preprocess)  # for ccache
else()
  set(MW_PRECOMPILED_FLAGS "SHELL:-Xclang -fno-pch-timestamp")
endif()
set(MW_PRECOMPILED_FOLDER ${CMAKE_SOURCE_DIR}/cmake/precompiled)

# mw_precompiled_headers(KIND HEADER): the target mw_pch_KIND, whose flags must be those of its users.
function(mw_precompiled_headers kind header)
  if(NOT MW_PRECOMPILED)
    return()
  endif()
  if(kind MATCHES "test|program")
    add_executable(mw_pch_${kind} ${MW_PRECOMPILED_FOLDER}/empty.cc)
    set_target_properties(mw_pch_${kind} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/test/precompiled)
  else()
    add_library(mw_pch_${kind} OBJECT ${MW_PRECOMPILED_FOLDER}/empty.cc)
  endif()
  target_compile_options(mw_pch_${kind} PRIVATE ${MW_PRECOMPILED_FLAGS})
  target_precompile_headers(mw_pch_${kind} PRIVATE ${MW_PRECOMPILED_FOLDER}/${header})
  # By this ccache knows the header: another tree's is as good, as long as the libraries are of one version.
  file(READ ${MW_PRECOMPILED_FOLDER}/${header} text)
  file(READ ${MW_PRECOMPILED_FOLDER}/standard.hh standard)
  string(SHA256 sum "${CMAKE_CXX_COMPILER_VERSION} ${GTest_VERSION} ${pybind11_VERSION} ${kind} ${CMAKE_BUILD_TYPE} ${text} ${standard}")
  file(WRITE ${CMAKE_BINARY_DIR}/CMakeFiles/mw_pch_${kind}.dir/cmake_pch.hxx.gch.sum "${sum}\n")
  file(WRITE ${CMAKE_BINARY_DIR}/CMakeFiles/mw_pch_${kind}.dir/cmake_pch.hxx.pch.sum "${sum}\n")
endfunction()

# mw_use_precompiled(TARGET KIND): TARGET's sources find the headers of KIND parsed.
function(mw_use_precompiled target kind)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.c$")  # C has none
  if(MW_PRECOMPILED AND TARGET mw_pch_${kind} AND NOT sources)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${MW_PRECOMPILED_FLAGS}>)
    target_precompile_headers(${target} REUSE_FROM mw_pch_${kind})
  endif()
endfunction()
