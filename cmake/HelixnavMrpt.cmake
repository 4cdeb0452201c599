# HELIXNAV_HAS_MRPT: whether what needs MRPT is built. What was found is reported in either case.
set(HELIXNAV_WITH_MRPT AUTO CACHE STRING "Build what runs inside MRPT programs: AUTO (when MRPT is there), ON, OFF")
set_property(CACHE HELIXNAV_WITH_MRPT PROPERTY STRINGS AUTO ON OFF)

set(HELIXNAV_HAS_MRPT FALSE)
if(HELIXNAV_WITH_MRPT STREQUAL "AUTO" OR HELIXNAV_WITH_MRPT)
  set(HELIXNAV_HAS_MRPT TRUE)
  # mrpt-apps asks CMake for mrpt-hwdrivers, which Debian's package of the former does not pull in.
  foreach(part slam topography gui apps)
    find_package(mrpt-${part} 2.5 CONFIG QUIET)
    if(NOT mrpt-${part}_FOUND)
      set(HELIXNAV_HAS_MRPT FALSE)
      string(CONCAT missing "mrpt-${part} is missing (Debian: libmrpt-slam-dev libmrpt-topography-dev libmrpt-gui-dev "
        "libmrpt-apps-dev libmrpt-hwdrivers-dev)")
    endif()
  endforeach()
endif()

if(HELIXNAV_HAS_MRPT)
  message(STATUS "HelixNav inside MRPT: built, with MRPT ${mrpt-slam_VERSION}")
elseif(HELIXNAV_WITH_MRPT STREQUAL "AUTO")
  message(STATUS "HelixNav inside MRPT: not built, ${missing}")
elseif(HELIXNAV_WITH_MRPT)
  message(FATAL_ERROR "HELIXNAV_WITH_MRPT is ${HELIXNAV_WITH_MRPT}, and ${missing}")
else()
  message(STATUS "HelixNav inside MRPT: not built, HELIXNAV_WITH_MRPT is ${HELIXNAV_WITH_MRPT}")
endif()
