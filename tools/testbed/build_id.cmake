# Which code is this? Run at each build; writes OUT only when the answer has changed.
#   cmake -DSOURCE=folder -DOUT=file -P build_id.cmake
# The commit is for people. The code is a hash of the folders that decide results, changes that are
# not committed included: commits of documentation or tests leave it alone.
set(folders sim sky nav tools/testbed)
set(commit "unknown")
set(code "unknown")
execute_process(COMMAND git rev-parse --short=12 HEAD WORKING_DIRECTORY ${SOURCE}
  OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(NOT failed)
  execute_process(COMMAND git ls-tree HEAD -- ${folders} WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE trees)
  execute_process(COMMAND git diff --no-ext-diff --no-color HEAD -- ${folders}
    WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE changes)
  set(commit "${head}")
  if(NOT changes STREQUAL "")
    string(APPEND commit "-changed")
  endif()
  string(SHA256 code "${trees}${changes}")
  string(SUBSTRING ${code} 0 12 code)
endif()
set(text "// Written by build_id.cmake.
#include \"tools/testbed/build_id.h\"

namespace polnav::testbed {

BuildId ThisBuild() { return {.commit = \"${commit}\", .code = \"${code}\"}; }

}  // namespace polnav::testbed
")
set(before "")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
