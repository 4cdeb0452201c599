# What `./dev package` puts into .deb files, one per component: program, library with headers, Python module. Man pages are
# written by help2man from the program's help.
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_PACKAGE_NAME helixnav)
set(CPACK_PACKAGE_CONTACT "HelixNav developers <helixnav@packages.invalid>" CACHE STRING "Maintainer in the .deb files")
# From the commit, so that apt-get treats a package built later as newer, which it is.
execute_process(COMMAND ${CMAKE_COMMAND} -E env TZ=UTC git -C ${PROJECT_SOURCE_DIR} log -1
  --date=format-local:%Y%m%d%H%M%S --format=+git%cd.%h OUTPUT_VARIABLE helixnav_of_commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION}${helixnav_of_commit})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tools dev)
if(HELIXNAV_WITH_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each has its own
set(about "HelixNav keeps an exact landmark map with a compressed EKF at a cost per\nstep that does not grow with the map, finds \
out when data association has\nbecome ambiguous, resolves it with a particle filter and a constellation\nof landmarks, and \
goes on with one consistent map.\n\n")

# helixnav_deb(<component> <package> <section> <summary> <what it holds>)
macro(helixnav_deb component package section summary holds)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${about}${holds}")
  install(FILES ${PROJECT_SOURCE_DIR}/packaging/copyright DESTINATION share/doc/${package} COMPONENT ${component})
  install(FILES ${pages}/changelog.gz ${pages}/changelog.Debian.gz DESTINATION share/doc/${package}
    COMPONENT ${component})
endmacro()

# The date of the commit, so that the same commit gives the same changelog.
find_program(GZIP gzip REQUIRED)
set(pages ${PROJECT_BINARY_DIR}/packaging)
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%aD OUTPUT_VARIABLE HELIXNAV_PACKAGE_DATE ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%h OUTPUT_VARIABLE HELIXNAV_PACKAGE_COMMIT ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT HELIXNAV_PACKAGE_DATE)
  string(TIMESTAMP HELIXNAV_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
configure_file(${PROJECT_SOURCE_DIR}/packaging/changelog.Debian.in ${pages}/changelog.Debian @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${pages}/changelog COPYONLY)
execute_process(COMMAND ${GZIP} -9nf changelog changelog.Debian WORKING_DIRECTORY ${pages} COMMAND_ERROR_IS_FATAL ANY)

helixnav_deb(tools helixnav science "landmark navigation with a compressed EKF - program"
  "This package holds the program, its manual pages, documentation and examples.")
helixnav_deb(dev libhelixnav-dev libdevel "landmark navigation with a compressed EKF - library"
  "This package holds static libraries, headers, CMake's and pkg-config's files.")
helixnav_deb(python python3-helixnav python "landmark navigation with a compressed EKF - Python"
  "This package holds the module helixnav for Python 3.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libsuitesparse-dev, coinor-libclp-dev, \
coinor-libcoinutils-dev, libarchive-dev, libmatio-dev, libtomlplusplus-dev, nlohmann-json3-dev, libssl-dev, zlib1g-dev, \
pkg-config")
if(HELIXNAV_WITH_PYTHON)
  math(EXPR next "${HELIXNAV_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${HELIXNAV_PYTHON_MINOR}), python3 (<< 3.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/python/postinst
    ${PROJECT_SOURCE_DIR}/packaging/python/prerm)
endif()

find_program(HELP2MAN help2man REQUIRED)
set(man ${PROJECT_BINARY_DIR}/man)
add_custom_command(OUTPUT ${man}/helixnav.1.gz
  COMMAND ${PROJECT_SOURCE_DIR}/packaging/write_man_pages.sh $<TARGET_FILE:helixnav_cli> ${man}
  DEPENDS helixnav_cli ${PROJECT_SOURCE_DIR}/packaging/write_man_pages.sh
  COMMENT "Writing the manual pages" VERBATIM)
add_custom_target(helixnav_man ALL DEPENDS ${man}/helixnav.1.gz)
install(DIRECTORY ${man}/ DESTINATION share/man/man1 COMPONENT tools)
install(FILES ${PROJECT_SOURCE_DIR}/packaging/helixnav.bash-completion
  DESTINATION share/bash-completion/completions RENAME helixnav COMPONENT tools)
# The changelog is installed as Debian requires.
file(READ README.md readme)
string(REPLACE "(CHANGELOG.md)" "(changelog.gz)" readme "${readme}")
file(CONFIGURE OUTPUT ${pages}/README.md CONTENT "${readme}" @ONLY)
install(FILES ${pages}/README.md CONTRIBUTING.md DESTINATION share/doc/helixnav COMPONENT tools)
install(DIRECTORY docs DESTINATION share/doc/helixnav COMPONENT tools PATTERN Doxyfile EXCLUDE)
install(DIRECTORY examples DESTINATION share/doc/helixnav COMPONENT tools USE_SOURCE_PERMISSIONS)
install(DIRECTORY tests/house/consumer DESTINATION share/doc/libhelixnav-dev/examples COMPONENT dev)

include(CPack)
