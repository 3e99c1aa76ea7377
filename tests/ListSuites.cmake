# Writes the CTest file of one test executable: a test a suite. After it is linked:
#   cmake -D EXECUTABLE=... -D OUTPUT=... -D TIMEOUT=... -P ListSuites.cmake
execute_process(COMMAND ${EXECUTABLE} --gtest_list_tests OUTPUT_VARIABLE listed
                RESULT_VARIABLE failed TIMEOUT 60)
if(failed)
  message(FATAL_ERROR "${EXECUTABLE} --gtest_list_tests: ${failed}")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${listed}")
if(NOT suites)
  message(FATAL_ERROR "${EXECUTABLE} holds no tests")
endif()
set(script "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "\n|\\.$" "" suite "${suite}")
  string(APPEND script "add_test([=[${suite}]=] [=[${EXECUTABLE}]=] [=[--gtest_filter=${suite}.*]=])\n"
                       "set_tests_properties([=[${suite}]=] PROPERTIES TIMEOUT ${TIMEOUT})\n")
endforeach()
file(WRITE ${OUTPUT} "${script}")
