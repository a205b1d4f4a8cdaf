# Compiles one file, which must be refused with the sentence in its first line as the first error, and no second one.
# cmake "-DCOMPILER=PROGRAM;FLAG..." -DSOURCE=FILE -P refused.cmake
file(STRINGS ${SOURCE} first LIMIT_COUNT 1)
string(REPLACE "// error: " "" sentence "${first}")
execute_process(COMMAND ${COMPILER} ${SOURCE} RESULT_VARIABLE result OUTPUT_VARIABLE told ERROR_VARIABLE told)
if(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles")
endif()
foreach(character "\;" "[" "]")  # CMake takes them for list syntax
  string(REPLACE "${character}" " " told "${told}")
endforeach()
string(REGEX MATCHALL "[^\n]* error: [^\n]*" errors "${told}")
list(LENGTH errors count)
string(FIND "${errors}" "${sentence}" place)
if(NOT count EQUAL 1 OR place EQUAL -1)
  message(FATAL_ERROR "expected one error, '${sentence}', got ${count}:\n${told}")
endif()
