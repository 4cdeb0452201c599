# Install rules and the CMake package: find_package(helixnav) gives one target helixnav::<room> per room.
include(CMakePackageConfigHelpers)

set(helixnav_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/helixnav)
get_property(helixnav_rooms GLOBAL PROPERTY HELIXNAV_ROOMS)

# The libraries are static, so whoever links them must find what they link privately, too. This names, for a target of
# somebody else's, the lines of the package config that find it again.
function(helixnav_find_lines target out)
  if(target MATCHES "^PkgConfig::(.+)$")
    # The prefix given to pkg_check_modules names the module; its cache entry remembers which.
    set(lines "find_dependency(PkgConfig)\npkg_check_modules(${CMAKE_MATCH_1} REQUIRED QUIET IMPORTED_TARGET ${${CMAKE_MATCH_1}_MODULE_NAME})")
  elseif(target MATCHES "^mrpt::(.+)$")
    set(lines "find_dependency(mrpt-${CMAKE_MATCH_1})")
  elseif(target MATCHES "^([A-Za-z0-9_]+)::")
    set(lines "find_dependency(${CMAKE_MATCH_1})")
  else()
    set(lines "")
  endif()
  set(${out} "${lines}" PARENT_SCOPE)
endfunction()

# Rooms that link MRPT are a component of the package: who does not ask for it needs no MRPT.
set(helixnav_optional_rooms mrpt_adapter)

set(HELIXNAV_TARGETS "")
foreach(kind FIND_LINES OPTIONAL_FIND_LINES OPTIONAL_TARGETS)
  set(HELIXNAV_${kind} "")
endforeach()
foreach(room IN LISTS helixnav_rooms)
  if(room IN_LIST helixnav_optional_rooms)
    set(prefix OPTIONAL_)
    set(export helixnavOptionalTargets)
  else()
    set(prefix "")
    set(export helixnavTargets)
  endif()
  list(APPEND HELIXNAV_${prefix}TARGETS helixnav::${room})
  get_target_property(libraries helixnav_${room} INTERFACE_LINK_LIBRARIES)
  foreach(library IN LISTS libraries)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" library "${library}")
    if(library MATCHES "^helixnav::" OR library MATCHES "BUILD_INTERFACE")
      continue()
    endif()
    helixnav_find_lines("${library}" lines)
    list(APPEND HELIXNAV_${prefix}FIND_LINES ${lines})
  endforeach()
  install(TARGETS helixnav_${room} EXPORT ${export} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
list(REMOVE_DUPLICATES HELIXNAV_FIND_LINES)
list(JOIN HELIXNAV_FIND_LINES "\n" HELIXNAV_FIND_LINES)
list(REMOVE_DUPLICATES HELIXNAV_OPTIONAL_FIND_LINES)
list(JOIN HELIXNAV_OPTIONAL_FIND_LINES "\n    " HELIXNAV_OPTIONAL_FIND_LINES)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/helixnavConfig.cmake.in
  ${PROJECT_BINARY_DIR}/generated/helixnavConfig.cmake INSTALL_DESTINATION ${helixnav_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/helixnavConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/helixnavConfig.cmake
  ${PROJECT_BINARY_DIR}/generated/helixnavConfigVersion.cmake DESTINATION ${helixnav_package_dir})
install(EXPORT helixnavTargets NAMESPACE helixnav:: DESTINATION ${helixnav_package_dir})
if(HELIXNAV_OPTIONAL_TARGETS)
  install(EXPORT helixnavOptionalTargets NAMESPACE helixnav:: DESTINATION ${helixnav_package_dir})
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
