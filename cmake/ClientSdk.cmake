# SPDX-License-Identifier: GPL-2.0-or-later
# What programs outside of this tree build with: one static library of clients and NML channels, its headers, and files for
# pkg-config and CMake. Installed with the rest, or alone by `cmake --install BUILD --component client_sdk`.
set(sdk_libraries base language diagnostics runtime ini messages mailbox client nml_config nml_message nml_buffer nml_net nml_bridge nml_remote)
foreach(library ${sdk_libraries})
  get_target_property(type mw_${library} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    list(APPEND sdk_objects $<TARGET_OBJECTS:mw_${library}>)
  endif()
endforeach()
add_library(millwright_client STATIC ${sdk_objects})
set_target_properties(millwright_client PROPERTIES LINKER_LANGUAGE CXX)
install(TARGETS millwright_client ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client_sdk)
foreach(folder base runtime messages clients/nml)
  get_filename_component(parent ${folder} DIRECTORY)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/src/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/millwright-client/${parent}
    COMPONENT client_sdk FILES_MATCHING PATTERN "*.hh" PATTERN test EXCLUDE PATTERN bench EXCLUDE PATTERN charts EXCLUDE
    PATTERN ini EXCLUDE PATTERN language EXCLUDE PATTERN options EXCLUDE)
endforeach()
file(RELATIVE_PATH sdk_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${CMAKE_SOURCE_DIR}/cmake/millwright-client.pc.in ${CMAKE_BINARY_DIR}/install/millwright-client.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/install/millwright-client.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT client_sdk)
install(FILES ${CMAKE_SOURCE_DIR}/cmake/MillwrightClientConfig.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/MillwrightClient COMPONENT client_sdk)
