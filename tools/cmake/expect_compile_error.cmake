# cmake -DCOMPILER=c++ -DSOURCE=<file> -DINCLUDES=a;b -DMISTAKE=WITHOUT;WITH -P this
# WITHOUT: passes when SOURCE compiles. WITH the macro MISTAKE: when it does not, and the compiler's first error, after
# which it stops, matches SOURCE's line `// expect: <regex>`.
cmake_minimum_required(VERSION 3.25)
list(TRANSFORM INCLUDES PREPEND -I)
list(TRANSFORM INCLUDES REPLACE "^-I(.*eigen3.*)$" "-isystem\\1")
set(command ${COMPILER} -std=c++20 -fsyntax-only -fdiagnostics-color=never ${INCLUDES})

if(WITHOUT IN_LIST MISTAKE)
  execute_process(COMMAND ${command} ${SOURCE}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "does not compile even without the mistake:\n${output}")
  endif()
endif()

if(WITH IN_LIST MISTAKE)
  file(STRINGS ${SOURCE} expected REGEX "^// expect: " LIMIT_COUNT 1)
  if(NOT expected)
    message(FATAL_ERROR "${SOURCE} has no line `// expect: <regular expression>`")
  endif()
  string(REGEX REPLACE "^// expect: " "" expected "${expected}")
  execute_process(COMMAND ${command} -Wfatal-errors -DMISTAKE ${SOURCE}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX MATCH "[^\n]*error: [^\n]*" first_error "${output}")
  # clang's words, as g++ has them
  string(REGEX REPLACE "static_assert failed[^\"]*\"(.*)\"$" "static assertion failed: \\1" first_error "${first_error}")
  string(REGEX REPLACE "'([^']*)' file not found" "\\1: No such file" first_error "${first_error}")
  if(status EQUAL 0)
    message(FATAL_ERROR "compiles, but must not; expected: ${expected}")
  elseif(NOT first_error MATCHES "${expected}")
    message(FATAL_ERROR "does not compile, but not for the reason expected: ${expected}\n${output}")
  endif()
  message("refused as expected: ${first_error}")
endif()
