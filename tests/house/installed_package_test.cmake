# Script: installs BUILD_DIR into WORK_DIR, moves what was installed, builds the consumer with find_package(helixnav) there
# and runs it. The consumer is the program of the README, word for word. WITH_MRPT: then the example of a program inside
# MRPT, too.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(status)
    list(JOIN ARGN " " command)
    message(NOTICE "${output}")
    message(FATAL_ERROR "failed: ${command}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(READ ${SOURCE_DIR}/README.md readme)
file(READ ${CMAKE_CURRENT_LIST_DIR}/consumer/consumer.cpp program)
string(FIND "${readme}" "${program}" position)
if(position EQUAL -1)
  message(FATAL_ERROR "README.md does not show consumer/consumer.cpp as it is")
endif()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/prefix)

file(GLOB_RECURSE package_files ${WORK_DIR}/prefix/*.cmake ${WORK_DIR}/prefix/*.pc)
foreach(file IN LISTS package_files)
  file(STRINGS ${file} lines)
  string(REGEX MATCH "[; \">]/[^; \"]*\\.(a|so)" library "${lines}")
  if(library)
    message(FATAL_ERROR "${file} names a library by its path: ${library}")
  endif()
  foreach(path IN ITEMS ${SOURCE_DIR} ${BUILD_DIR})
    string(FIND "${lines}" "${path}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} names the folder that it was built from or in, ${path}")
    endif()
  endforeach()
endforeach()

run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/build
  -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --parallel 2)
run(${WORK_DIR}/build/consumer)
if(NOT output MATCHES "^[1-9][0-9]* landmarks, robot at ")
  message(FATAL_ERROR "the consumer said: ${output}")
endif()

# As the consumer without CMake.
find_program(PKG_CONFIG NAMES pkg-config pkgconf REQUIRED)
file(GLOB_RECURSE pc ${WORK_DIR}/prefix/helixnav.pc)
run(${PKG_CONFIG} --cflags --libs ${pc})
separate_arguments(flags UNIX_COMMAND "${output}")
run(${CXX_COMPILER} -std=c++17 ${CMAKE_CURRENT_LIST_DIR}/consumer/consumer.cpp -o ${WORK_DIR}/by_pkg_config ${flags})
run(${WORK_DIR}/by_pkg_config)
if(NOT output MATCHES "^[1-9][0-9]* landmarks, robot at ")
  message(FATAL_ERROR "the consumer by pkg-config said: ${output}")
endif()

# For this very processor, where Eigen left to itself aligns to 32 or 64 bytes, as the libraries were not compiled: the same
# landmarks, by pkg-config and by CMake.
string(REGEX MATCH "^[0-9]+ landmarks" landmarks "${output}")
set(for_this_processor -O2 -DNDEBUG -march=native)
run(${CXX_COMPILER} -std=c++17 ${for_this_processor} ${CMAKE_CURRENT_LIST_DIR}/consumer/consumer.cpp
  -o ${WORK_DIR}/native_by_pkg_config ${flags})
list(JOIN for_this_processor " " for_this_processor)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/build "-DCMAKE_CXX_FLAGS=${for_this_processor}")
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --target consumer)
foreach(native IN ITEMS native_by_pkg_config build/consumer)
  run(${WORK_DIR}/${native})
  if(NOT output MATCHES "^${landmarks}, robot at [-0-9]")
    message(FATAL_ERROR "compiled with -march=native, ${native} said: ${output}; without: ${landmarks}")
  endif()
endforeach()

# A component that is not there is named, and those that are.
file(WRITE ${WORK_DIR}/wrong/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES CXX)\n"
  "find_package(helixnav REQUIRED COMPONENTS core nonsense)\n")
execute_process(COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${WORK_DIR}/wrong -B ${WORK_DIR}/wrong/build
  -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE output)
string(REGEX REPLACE "[ \n]+" " " output "${output}")
if(NOT status OR NOT output MATCHES "no component 'nonsense' is installed; there are: core association ")
  message(FATAL_ERROR "asked for a component that is not there, CMake said: ${output}")
endif()

# Who does not ask for it does not meet MRPT.
file(STRINGS ${WORK_DIR}/build/CMakeCache.txt met REGEX "^mrpt-")
if(met)
  message(FATAL_ERROR "the consumer looked for MRPT: ${met}")
endif()
if(WITH_MRPT)
  file(READ ${SOURCE_DIR}/docs/mrpt.md page)
  file(READ ${SOURCE_DIR}/examples/mrpt_own_loop/main.cpp program)
  string(REGEX REPLACE "^(//[^\n]*\n)+" "" program "${program}")
  string(FIND "${page}" "${program}" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "docs/mrpt.md does not show examples/mrpt_own_loop/main.cpp as it is")
  endif()
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE_DIR}/examples/mrpt_own_loop -B ${WORK_DIR}/example
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/example)
  run(${CMAKE_COMMAND} -E chdir ${WORK_DIR}/example ./mrpt_own_loop)
  if(NOT output MATCHES "12 landmarks, robot at ")
    message(FATAL_ERROR "the example said: ${output}")
  endif()
endif()
