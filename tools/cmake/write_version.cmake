# cmake -DSOURCE=<source tree> -DINPUT=version.cpp.in -DOUTPUT=version.cpp -DVERSION=x.y.z -P this
# Runs at every build (some 20 ms); the file changes, and is compiled again, only when the commit does.
set(GIT_HASH unknown)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)  # not the repository that a copy of us may stand in
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                  RESULT_VARIABLE status)
  if(status EQUAL 0)
    set(GIT_HASH ${hash})
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
