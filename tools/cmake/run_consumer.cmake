# Configures, builds and runs tests/consumers/KIND in build/tests/consumers/KIND.
#   installed      against a fresh `cmake --install` of HAMEL_BUILD into build/consumer-prefix
#   subdirectory   with add_subdirectory of HAMEL_SOURCE
set(build ${HAMEL_BUILD}/tests/consumers/${KIND})
if(KIND STREQUAL "installed")
  set(prefix ${HAMEL_BUILD}/consumer-prefix)
  file(REMOVE_RECURSE ${prefix} ${build})  # nothing of an older installation may help
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${HAMEL_BUILD} --prefix ${prefix} --config ${CONFIG}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  set(how -DCMAKE_PREFIX_PATH=${prefix})
  set(CMAKE_BUILD_TYPE ${CONFIG})
else()
  file(REMOVE ${build}/CMakeCache.txt)
  set(how -DHAMEL_SOURCE=${HAMEL_SOURCE} -DCMAKE_CXX_COMPILER_LAUNCHER=${CCACHE})
  set(CMAKE_BUILD_TYPE Debug)  # compiles fastest; nothing else here tries this build type
endif()
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${build} -G ${GENERATOR} ${how}
          -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${build} --parallel 2 COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${build}/consumer WORKING_DIRECTORY ${build} COMMAND_ERROR_IS_FATAL ANY)
