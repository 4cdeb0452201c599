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
  # In a unity build: with eight sources a group, CMake's own choice, the supervisor takes a quarter more processor time.
  # What includes MRPT is large already.
  if(NOT room STREQUAL mrpt_adapter)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 16)
  endif()
  helixnav_warnings(${target})
  set_property(GLOBAL APPEND PROPERTY HELIXNAV_ROOMS ${room})
endfunction()

# Warnings of our own code; never exported to whoever links us.
function(helixnav_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
    $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond>)
endfunction()
