include(GNUInstallDirs)

# helixnav_module(<room> DEPENDS <targets…> PRIVATE_DEPENDS <targets…>)
# Folder = namespace = target (helixnav::<room>) = include path (helixnav/<room>/…).
function(helixnav_module room)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/*.cpp)
  set(target helixnav_${room})
  add_library(${target} STATIC ${sources})
  add_library(helixnav::${room} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${room} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
  helixnav_warnings(${target})
  set_property(GLOBAL APPEND PROPERTY HELIXNAV_ROOMS ${room})
endfunction()

# Warnings for our own code; never exported to those who link us. In a unity build a source is an included file and sees
# the constants of the sources before it: shadowing them, and types of unnamed namespaces in fields, are not faults there.
function(helixnav_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wnon-virtual-dtor -Wold-style-cast
    $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond>)
  get_target_property(unity ${target} UNITY_BUILD)
  if(NOT unity)
    target_compile_options(${target} PRIVATE -Wshadow)
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -Wshadow=local -Wno-subobject-linkage)
  endif()
endfunction()
