# cmake -DROOT=... -P readme.cmake: the first ```cpp and ```toml blocks of README.md are files of tests/examples; the
# README has at most 150 lines, none longer than 160 characters.
file(READ ${ROOT}/README.md text)

function(same_block language file)
  file(READ ${ROOT}/tests/examples/${file} expected)
  string(FIND "${text}" "```${language}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "README.md has no ```${language} block")
  endif()
  string(LENGTH "```${language}\n" opening)
  math(EXPR begin "${begin} + ${opening}")
  string(SUBSTRING "${text}" ${begin} -1 rest)
  string(FIND "${rest}" "```\n" length)
  string(SUBSTRING "${rest}" 0 ${length} block)
  if(NOT block STREQUAL expected)
    message(FATAL_ERROR "The first ${language} block of README.md is not tests/examples/${file}")
  endif()
endfunction()
same_block(cpp suslov.cpp)
same_block(toml cart_and_trailer.toml)

execute_process(COMMAND awk "length($0) > 160 || NR > 150 { print FILENAME \":\" FNR }" README.md
                WORKING_DIRECTORY ${ROOT} OUTPUT_VARIABLE long COMMAND_ERROR_IS_FATAL ANY)
if(long)
  message(FATAL_ERROR "Lines beyond 160 characters, or beyond the 150th:\n${long}")
endif()
