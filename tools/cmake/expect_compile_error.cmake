# cmake -DCOMPILER=c++ -DSOURCE=<file> -DINCLUDES=a;b -P this
# Passes when SOURCE does not compile and the compiler's first error matches `// expect: <regex>`.
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${SOURCE} expected REGEX "^// expect: " LIMIT_COUNT 1)
if(NOT expected)
  message(FATAL_ERROR "${SOURCE} has no line `// expect: <regular expression>`")
endif()
string(REGEX REPLACE "^// expect: " "" expected "${expected}")
list(TRANSFORM INCLUDES PREPEND -I)
list(TRANSFORM INCLUDES REPLACE "^-I(.*eigen3.*)$" "-isystem\\1")
set(command ${COMPILER} -std=c++20 -fsyntax-only -fdiagnostics-color=never ${INCLUDES})

execute_process(COMMAND ${command} ${SOURCE}
                RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "does not compile even without the mistake:\n${output}")
endif()

execute_process(COMMAND ${command} -DMISTAKE ${SOURCE}
                RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
string(REGEX MATCH "[^\n]*error: [^\n]*" first_error "${output}")
if(status EQUAL 0)
  message(FATAL_ERROR "compiles, but must not; expected: ${expected}")
elseif(NOT first_error MATCHES "${expected}")
  message(FATAL_ERROR "does not compile, but not for the reason expected: ${expected}\n${output}")
endif()
message("refused as expected: ${first_error}")
