# cmake -DCOMPILER=c++ -DSOURCE=x.cpp -DINCLUDES=a;b -P this
# Passes when SOURCE does not compile and the compiler's words match its line `// expect: <regex>`.
file(STRINGS ${SOURCE} expected REGEX "^// expect: " LIMIT_COUNT 1)
if(NOT expected)
  message(FATAL_ERROR "${SOURCE} has no line `// expect: <regular expression>`")
endif()
string(REGEX REPLACE "^// expect: " "" expected "${expected}")
list(TRANSFORM INCLUDES PREPEND -I)
list(TRANSFORM INCLUDES REPLACE "^-I(.*eigen3.*)$" "-isystem\\1")
set(command ${COMPILER} -std=c++20 -fsyntax-only -fdiagnostics-color=never ${INCLUDES})

file(STRINGS ${SOURCE} has_control REGEX "^#if.*MISTAKE")
if(has_control)
  execute_process(COMMAND ${command} ${SOURCE}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "does not compile even without the mistake:\n${output}")
  endif()
endif()

execute_process(COMMAND ${command} -DMISTAKE ${SOURCE}
                RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(status EQUAL 0)
  message(FATAL_ERROR "compiles, but must not; expected: ${expected}")
elseif(NOT output MATCHES "${expected}")
  message(FATAL_ERROR "does not compile, but not for the reason expected: ${expected}\n${output}")
endif()
message("refused as expected: ${CMAKE_MATCH_0}")
