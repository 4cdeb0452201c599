# helixnav::core::version() and commit(): a source file that every build brings up to date but that only changes, and is
# only recompiled, when the commit did.
set(helixnav_version_source ${PROJECT_BINARY_DIR}/generated/version.cpp)
add_custom_target(helixnav_version
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DHELIXNAV_VERSION=${PROJECT_VERSION}
          -DINPUT=${PROJECT_SOURCE_DIR}/core/version.cpp.in -DOUTPUT=${helixnav_version_source}
          -P ${PROJECT_SOURCE_DIR}/cmake/write_version.cmake
  BYPRODUCTS ${helixnav_version_source}
  COMMENT "Reading the git commit"
  VERBATIM)
# Otherwise every commit would recompile its neighbours in a unity build.
set_source_files_properties(${helixnav_version_source} TARGET_DIRECTORY helixnav_core
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_sources(helixnav_core PRIVATE ${helixnav_version_source})
add_dependencies(helixnav_core helixnav_version)
