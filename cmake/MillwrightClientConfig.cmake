# SPDX-License-Identifier: GPL-2.0-or-later
# find_package(MillwrightClient) gives the target Millwright::client.
include(CMakeFindDependencyMacro)
find_dependency(fmt)
find_dependency(Threads)
get_filename_component(millwright_libdir ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
find_path(MILLWRIGHT_CLIENT_INCLUDE messages/client/client.hh
  PATHS ${millwright_libdir}/../include/millwright-client ${millwright_libdir}/../../include/millwright-client NO_DEFAULT_PATH REQUIRED)
if(NOT TARGET Millwright::client)
  add_library(Millwright::client STATIC IMPORTED)
  set_target_properties(Millwright::client PROPERTIES
    IMPORTED_LOCATION ${millwright_libdir}/libmillwright_client.a INTERFACE_INCLUDE_DIRECTORIES ${MILLWRIGHT_CLIENT_INCLUDE}
    INTERFACE_LINK_LIBRARIES "fmt::fmt;Threads::Threads" INTERFACE_COMPILE_FEATURES cxx_std_23)
endif()
