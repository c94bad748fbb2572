# cmake -DCOMPILER=c++ -DINCLUDES=<directories> -P door_by_name.cmake
#
# <hamel/simulate.hpp> reaches no header of Eigen, Ceres, fmt, JSON or TOML: preprocessed, it has none of their lines, and
# not many more lines than the standard headers bring (63,480 in all with GCC 12).
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND mktemp -d OUTPUT_VARIABLE folder OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${folder}/door.cpp "#include <hamel/simulate.hpp>\n")
list(TRANSFORM INCLUDES PREPEND -I)
execute_process(COMMAND ${COMPILER} -std=c++20 -E ${INCLUDES} ${folder}/door.cpp
                OUTPUT_FILE ${folder}/door.ii COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${folder}/door.ii markers REGEX "^# [0-9]+ \"")
file(STRINGS ${folder}/door.ii lines REGEX "^[^#]")
file(REMOVE_RECURSE ${folder})
set(found "")
foreach(package Eigen ceres fmt nlohmann "toml\\+\\+" muParser hdf5 boost)
  set(hits ${markers})
  list(FILTER hits INCLUDE REGEX "/${package}[./]")
  if(hits)
    list(GET hits 0 first)
    string(APPEND found "  ${package}: ${first}\n")
  endif()
endforeach()
list(LENGTH lines count)
message(STATUS "<hamel/simulate.hpp>: ${count} lines")
if(found)
  message(FATAL_ERROR "<hamel/simulate.hpp> reaches headers of packages:\n${found}")
endif()
if(count GREATER 66000)
  message(FATAL_ERROR "<hamel/simulate.hpp> has ${count} lines, expected at most 66000")
endif()
