# cmake -DROOT=<source tree> -DCOMPILER=c++ -DINCLUDES=<file> -P rooms.cmake
#
# A layer sees the layers that the arrows lead to, and no other: with its include directories every public header of
# the former is found, and none of the latter. INCLUDES names a file that sets includes_<layer> for each layer.
# Also: no include by a relative path, which would lead around the roots; no stem twice.
cmake_minimum_required(VERSION 3.25)
include(${INCLUDES})

# ---- the arrows: what a layer's own lines may include, beside itself --------------------------------
set(sees_lie)
set(sees_io)
set(sees_mechanics lie io)
set(sees_schemes mechanics ${sees_mechanics})
set(sees_loop schemes ${sees_schemes})
set(sees_run loop ${sees_loop})
set(sees_study run ${sees_run})
set(sees_analysis run ${sees_run})
set(sees_check run ${sees_run})
set(sees_groups lie)
set(sees_solvers loop ${sees_loop})
set(sees_systems run ${sees_run} groups solvers)
set(rooms lie io mechanics schemes loop run study analysis check)
set(layers ${rooms} groups solvers systems)

set(failed "")
macro(fail text)
  string(APPEND failed "  ${text}\n")
endmacro()

# ---- the folders of framework/ are these rooms --------------------------------------------------------
file(GLOB folders RELATIVE ${ROOT}/framework LIST_DIRECTORIES true ${ROOT}/framework/*)
foreach(folder ${folders})
  if(IS_DIRECTORY ${ROOT}/framework/${folder} AND NOT folder IN_LIST rooms)
    fail("framework/${folder} is not one of the rooms that this test knows")
  endif()
endforeach()

# ---- every pair of layers ------------------------------------------------------------------------------
foreach(layer ${layers})
  set(path_${layer} ${layer})
  if(layer IN_LIST rooms)
    set(path_${layer} framework/${layer})
  endif()
  file(GLOB_RECURSE headers_${layer} RELATIVE ${ROOT} ${ROOT}/${path_${layer}}/*.hpp)
  if(NOT headers_${layer})
    fail("${path_${layer}} has no header")
  endif()
endforeach()

execute_process(COMMAND mktemp -d OUTPUT_VARIABLE folder OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
foreach(layer ${layers})
  set(text "")
  foreach(other ${layers})
    foreach(header ${headers_${other}})
      if(other STREQUAL layer OR other IN_LIST sees_${layer})
        string(APPEND text "#if !__has_include(<hamel/${header}>)\n#error does not see ${header}\n#endif\n")
      else()
        string(APPEND text "#if __has_include(<hamel/${header}>)\n#error sees ${header}\n#endif\n")
      endif()
    endforeach()
  endforeach()
  file(WRITE ${folder}/${layer}.cpp "${text}")
  list(TRANSFORM includes_${layer} PREPEND -I)
  execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only ${includes_${layer}} ${folder}/${layer}.cpp
                  RESULT_VARIABLE status ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    string(REGEX MATCHALL "#error [^\n]*" errors "${errors}")
    list(REMOVE_DUPLICATES errors)
    list(LENGTH errors count)
    list(SUBLIST errors 0 3 errors)
    list(JOIN errors "; " errors)
    string(REPLACE "#error " "" errors "${errors}")
    fail("${layer}: ${errors} (${count} headers)")
  endif()
endforeach()
file(REMOVE_RECURSE ${folder})

# ---- includes and stems ---------------------------------------------------------------------------------
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/framework/*.[hc]pp ${ROOT}/groups/*.[hc]pp
     ${ROOT}/solvers/*.[hc]pp ${ROOT}/systems/*.[hc]pp)
foreach(file ${files})
  file(STRINGS ${ROOT}/${file} quoted REGEX "^ *# *include +\"")
  if(quoted)
    fail("${file}: ${quoted}: expected <hamel/...>")
  endif()
  cmake_path(GET file FILENAME name)  # a header and its source count as one
  if(DEFINED first_${name})
    fail("${name} is the name of ${first_${name}} and of ${file}")
  endif()
  set(first_${name} ${file})
endforeach()

if(failed)
  message(FATAL_ERROR "The rooms are not kept apart:\n${failed}")
endif()
