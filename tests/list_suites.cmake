# Script: asks the test PROGRAM for its suites and writes to OUTPUT a CTest case FOLDER.<suite> for each. A process for each
# suite and not for each test, because programs that link MRPT take longer to start than most tests to run; instances of a
# suite with parameters and types run together. Suites named …Campaign, statistics over many drives, have the label
# `campaign`, too, and start first together with those that are known to be long.
cmake_minimum_required(VERSION 3.25)
set(long_suites apps.Associate apps.CalibrateProgram apps.Fusing apps.SearchSettings apps.ShippedVehicleProgram apps.Smooth
  apps.TeamCampaignParts apps.TeamWholeReplay mrpt_adapter.Feed mrpt_adapter.Outputs supervisor.Closing supervisor.Guarantee
  supervisor.JoinSessions supervisor.SmoothDrive)

# No sanitizer looks for leaks in a program that only lists.
execute_process(COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 ${PROGRAM} --gtest_list_tests
  RESULT_VARIABLE status OUTPUT_VARIABLE listing ERROR_VARIABLE errors)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} does not list its tests: ${status} ${errors}")
endif()

string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." headings "${listing}")
set(suites "")
foreach(heading IN LISTS headings)
  string(REGEX REPLACE "[\n.]" "" full "${heading}")
  # Instance/Suite or Suite/0; the suite itself is the part that is a name and no number.
  if(full MATCHES "^([^/]+)/[0-9]+$")
    set(suite ${CMAKE_MATCH_1})
  else()
    string(REGEX REPLACE "^.*/([^/0-9][^/]*)(/[0-9]+)?$" "\\1" suite "${full}")
  endif()
  list(APPEND suites ${suite})
  list(APPEND filter_${suite} "${full}.*")
endforeach()
list(REMOVE_DUPLICATES suites)

set(text "")
foreach(suite IN LISTS suites)
  set(name ${FOLDER}.${suite})
  set(labels ${FOLDER})
  set(cost 0)
  if(name IN_LIST long_suites)
    set(cost 100)
  endif()
  if(suite MATCHES "Campaign$")
    list(APPEND labels campaign)
    set(cost 200)
  endif()
  list(JOIN filter_${suite} ":" filter)
  string(APPEND text "add_test([=[${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${filter}]=])\n"
    "set_tests_properties([=[${name}]=] PROPERTIES LABELS [=[${labels}]=] COST ${cost})\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
