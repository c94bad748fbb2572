# cmake -DSOURCE=<source tree> -DINPUT=<template> -DOUTPUT=<source> -DVERSION=x.y.z -P this
# Runs at every build (some 20 ms); the file changes, and is compiled again, only when the commit does, or what
# is not committed of the sources that results depend on: a hash of that follows "-dirty".
set(GIT_HASH unknown)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)  # not the repository around a copy of this project
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                  RESULT_VARIABLE status)
  if(status EQUAL 0)
    set(GIT_HASH ${hash})
  endif()
  if(GIT_HASH MATCHES "-dirty$")
    set(sources CMakeLists.txt framework groups solvers systems tools/cmake ":!*.md")
    execute_process(COMMAND ${GIT} -C ${SOURCE} diff --binary --no-ext-diff HEAD -- ${sources}
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    execute_process(COMMAND ${GIT} -C ${SOURCE} ls-files --others --exclude-standard -- ${sources}
                    OUTPUT_VARIABLE added OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    string(REPLACE "\n" ";" added "${added}")
    foreach(path IN LISTS added)
      file(SHA256 ${SOURCE}/${path} hash)
      string(APPEND changes "${path} ${hash}\n")
    endforeach()
    if(changes)
      string(SHA256 stamp "${changes}")
      string(SUBSTRING ${stamp} 0 8 stamp)
      string(APPEND GIT_HASH "-${stamp}")
    endif()
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
