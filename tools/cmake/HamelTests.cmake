# The functions of tests/CMakeLists.txt.

# Headers of installed packages that single tests NEED beyond the library:
#   hamel_jet      ceres::Jet                         hamel_mpreal   mpfr::mpreal, any number of digits
#   hamel_valijson validation by JSON schema; without it that test is left out
#   hamel_page     the report page in C++; the test brings its own report_page()
find_path(HAMEL_CERES_INCLUDE ceres/jet.h REQUIRED)
find_path(HAMEL_MPREAL_INCLUDE mpreal.h REQUIRED)
find_library(HAMEL_MPFR mpfr REQUIRED)
find_library(HAMEL_GMP gmp REQUIRED)
find_path(HAMEL_VALIJSON_INCLUDE valijson/validator.hpp)
if(HAMEL_VALIJSON_INCLUDE)
  add_library(hamel_valijson INTERFACE)
  target_include_directories(hamel_valijson SYSTEM INTERFACE ${HAMEL_VALIJSON_INCLUDE})
else()
  message(STATUS "hamel: test cli/schemas is left out: it needs libvalijson-dev (tools/setup)")
endif()
add_library(hamel_jet INTERFACE)
target_include_directories(hamel_jet SYSTEM INTERFACE ${HAMEL_CERES_INCLUDE})
add_library(hamel_mpreal INTERFACE)
target_include_directories(hamel_mpreal SYSTEM INTERFACE ${HAMEL_MPREAL_INCLUDE})
target_link_libraries(hamel_mpreal INTERFACE ${HAMEL_MPFR} ${HAMEL_GMP})
add_library(hamel_page INTERFACE)
target_sources(hamel_page INTERFACE ${PROJECT_SOURCE_DIR}/framework/pages/page.cpp)
target_link_libraries(hamel_page INTERFACE hamel::figures fmt::fmt nlohmann_json::nlohmann_json)

# Is the program configured with its report page?
if(TARGET hamel_program AND HAMEL_NODE AND HAMEL_NPM AND NOT HAMEL_REPORT_PAGE STREQUAL "OFF")
  set(hamel_page_is_made ON)
endif()

# Common to every test, example and benchmark: build/tests/<name>, the libraries.
function(hamel_test_executable target name)
  cmake_path(GET name PARENT_PATH folder)
  cmake_path(GET name FILENAME stem)
  add_executable(${target} ${name}.cpp)
  target_link_libraries(${target} PRIVATE ${ARGN})
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF HAMEL_IS_TEST ON
    OUTPUT_NAME ${stem} RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/${folder})
endfunction()

# Eigen, GoogleTest and the library, parsed once for all tests. -fpch-preprocess lets ccache see through it; -O1
# halves the time to compile, and few tests need more (HOT).
if(HAMEL_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
  set(test_options $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess> $<$<CONFIG:Release>:-O1>)
  file(CONFIGURE OUTPUT pch/empty.cpp CONTENT "")
  add_library(hamel_test_pch OBJECT ${CMAKE_CURRENT_BINARY_DIR}/pch/empty.cpp)
  target_link_libraries(hamel_test_pch PRIVATE hamel::hamel hamel_build_options GTest::gmock)
  target_compile_options(hamel_test_pch PRIVATE ${test_options})
  # A precompiled header knows the headers of #pragma once by the sum of their bytes. ccache takes sources for equal
  # that are so once comments are gone, and would hand out the precompiled header of other bytes ("redefinition of
  # class ..."); in this mode it compares the headers themselves.
  set_target_properties(hamel_test_pch PROPERTIES CXX_EXTENSIONS OFF HAMEL_IS_TEST ON
    CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND};-E;env;CCACHE_DEPEND=1;${CMAKE_CXX_COMPILER_LAUNCHER}")
  target_precompile_headers(hamel_test_pch PRIVATE
    <Eigen/Dense> <gtest/gtest.h> <gmock/gmock.h> <hamel/hamel.hpp>
    <cmath> <functional> <optional> <random> <sstream> <string> <vector>)

  # tests/cli/program.hpp, for tests that run the program: these see no header of the library, and are neither
  # optimised nor sanitized, since all that they test is in the program.
  add_library(hamel_test_program STATIC cli/program.cpp)
  if(hamel_page_is_made)  # tests of pages skip where the program says that it has none
    set_source_files_properties(cli/program.cpp PROPERTIES COMPILE_DEFINITIONS HAMEL_PAGE_IS_MADE)
  endif()
  target_link_libraries(hamel_test_program PUBLIC GTest::gmock nlohmann_json::nlohmann_json)
  if(HAMEL_SANITIZE)
    target_compile_definitions(hamel_test_program PUBLIC HAMEL_PROGRAM_IS_SANITIZED)
  else()
    target_link_libraries(hamel_test_program PUBLIC hamel_build_options)
  endif()
  set(program_options $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess> $<$<CONFIG:Release>:-O0>)
  target_compile_features(hamel_test_program PUBLIC cxx_std_20)
  target_compile_options(hamel_test_program PRIVATE ${program_options})
  set_target_properties(hamel_test_program PROPERTIES CXX_EXTENSIONS OFF
    CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND};-E;env;CCACHE_DEPEND=1;${CMAKE_CXX_COMPILER_LAUNCHER}")
  target_precompile_headers(hamel_test_program PRIVATE
    <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp>
    <algorithm> <cmath> <filesystem> <fstream> <map> <sstream> <string> <vector>)
endif()

# tests/<name>.cpp -> build/tests/<name>, ctest <name>.
#   LABELS slow ...   PROGRAM   runs build/tools/hamel; the environment has its path, HAMEL_PROGRAM, and that
#                               of the source tree, HAMEL_SOURCE. Sees the library where it NEEDS hamel::hamel
#   HOT               compiled with full optimisation (-O1 under sanitizers), and without the precompiled header
#   NEEDS target ...  further libraries to link
#   PLAIN             left out of sanitized builds: it is about numbers or words, and others there run the same code
function(hamel_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PROGRAM;HOT;PLAIN" "TIMEOUT" "LABELS;NEEDS")
  if(HAMEL_SANITIZE AND (arg_PLAIN OR "slow" IN_LIST arg_LABELS))
    return()
  endif()
  if(arg_PROGRAM AND NOT TARGET hamel_program)
    message(STATUS "hamel: test ${name} is left out: it runs the program (HAMEL_BUILD_TOOLS)")
    return()
  endif()
  string(REPLACE "/" "_" target test_${name})
  if(arg_PROGRAM)
    list(PREPEND arg_NEEDS hamel_test_program)
  endif()
  if(arg_PROGRAM AND NOT "hamel::hamel" IN_LIST arg_NEEDS)
    hamel_test_executable(${target} ${name} ${arg_NEEDS} GTest::gtest_main)
    target_compile_options(${target} PRIVATE ${program_options})
    target_precompile_headers(${target} REUSE_FROM hamel_test_program)
  else()
    hamel_test_executable(${target} ${name} hamel::hamel hamel_build_options GTest::gmock GTest::gtest_main ${arg_NEEDS})
    if(NOT arg_HOT)
      target_compile_options(${target} PRIVATE ${test_options})
      target_precompile_headers(${target} REUSE_FROM hamel_test_pch)
    endif()
  endif()
  if(arg_HOT)
    set_target_properties(${target} PROPERTIES HAMEL_IS_TEST OFF)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  add_test(NAME ${name} COMMAND ${target})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
  if(arg_PROGRAM)
    add_dependencies(${target} hamel_program)
    set(environment "HAMEL_PROGRAM=$<TARGET_FILE:hamel_program>" "HAMEL_SOURCE=${PROJECT_SOURCE_DIR}"
        "HAMEL_REPORT_PAGE=${HAMEL_REPORT_PAGE}")
    if(HAMEL_SANITIZE)
      set(leaks ${PROJECT_SOURCE_DIR}/tests/leaks.supp)
      list(APPEND environment "LSAN_OPTIONS=suppressions=${leaks}:print_suppressions=0")
    endif()
    set_tests_properties(${name} PROPERTIES ENVIRONMENT "${environment}")
  endif()
endfunction()

# tests/examples/<stem>.cpp -> build/tests/examples/<stem>, ctest examples/<stem>. As PLAIN tests.
function(hamel_example stem)
  if(HAMEL_SANITIZE)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "ARGS;LABELS")
  hamel_test_executable(example_${stem} examples/${stem} hamel::hamel hamel_build_options)
  target_compile_options(example_${stem} PRIVATE $<$<CONFIG:Release>:-O1>)
  add_test(NAME examples/${stem} COMMAND example_${stem} ${arg_ARGS}
           WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/examples)
  set_tests_properties(examples/${stem} PROPERTIES LABELS "example;${arg_LABELS}" TIMEOUT 120)
endfunction()

# tests/benchmarks/<stem>.cpp -> build/tests/benchmarks/<stem>; ctest only checks that it runs,
# with the argument after QUICK, else that of Google Benchmark.
function(hamel_benchmark stem)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "QUICK" "")
  if(NOT arg_QUICK)
    set(arg_QUICK --benchmark_min_time=0.001)
  endif()
  find_package(benchmark 1.7 REQUIRED)
  hamel_test_executable(benchmark_${stem} benchmarks/${stem}
    hamel::hamel hamel_build_options benchmark::benchmark benchmark::benchmark_main)
  add_test(NAME benchmarks/${stem} COMMAND benchmark_${stem} ${arg_QUICK})
  set_tests_properties(benchmarks/${stem} PROPERTIES LABELS benchmark TIMEOUT 120)
endfunction()

# tests/compile_errors/<stem>.cpp must fail to compile with a message that matches its first line,
#   // expect: regular expression
# seeing <hamel/hamel.hpp> and all layers, or only one layer and those it links: `// layer: framework`.
# The mistake is inside `#ifdef MISTAKE`: without that macro the file must compile. Files that see all layers do so
# together, each in a namespace of its own, as the test compile_errors/without_mistakes.
function(hamel_compile_errors)
  set(together "#include <hamel/hamel.hpp>\n")
  foreach(stem IN LISTS ARGN)
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/compile_errors/${stem}.cpp)
    file(STRINGS ${source} layer REGEX "^// layer: " LIMIT_COUNT 1)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    if(layer MATCHES "^// layer: ([a-z]+)")
      hamel_expect_compile_error(${stem} ${source} hamel_${CMAKE_MATCH_1} "WITHOUT;WITH")
    else()
      hamel_expect_compile_error(${stem} ${source} hamel_umbrella "WITH")
      string(APPEND together "namespace without_${stem} {\n#include \"${source}\"\n}\n")
    endif()
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/compile_errors/without_mistakes.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT "${together}")
  hamel_expect_compile_error(without_mistakes ${source} hamel_umbrella "WITHOUT")
endfunction()
function(hamel_expect_compile_error stem source layer mistake)
  # Never built: it carries the include directories of all that the layer links.
  add_library(compile_error_${stem} OBJECT EXCLUDE_FROM_ALL ${source})
  target_link_libraries(compile_error_${stem} PRIVATE ${layer})
  add_test(NAME compile_errors/${stem}
    COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER} -DSOURCE=${source} "-DMISTAKE=${mistake}"
            "-DINCLUDES=$<TARGET_PROPERTY:compile_error_${stem},INCLUDE_DIRECTORIES>"
            -P ${PROJECT_SOURCE_DIR}/tools/cmake/expect_compile_error.cmake)
  set_tests_properties(compile_errors/${stem} PROPERTIES LABELS compile_error TIMEOUT 600)
endfunction()

# tests/framework/rooms.cmake, with the include directories that the sources of each layer are compiled with.
function(hamel_rooms_test)
  set(content "")
  foreach(layer ${HAMEL_ROOMS} groups solvers mechanisms systems)
    set(property INCLUDE_DIRECTORIES)
    get_target_property(type hamel_${layer} TYPE)
    if(type STREQUAL "INTERFACE_LIBRARY")
      set(property INTERFACE_INCLUDE_DIRECTORIES)
    endif()
    string(APPEND content "set(includes_${layer} \"$<TARGET_PROPERTY:hamel_${layer},${property}>\")\n")
  endforeach()
  set(includes ${CMAKE_CURRENT_BINARY_DIR}/framework/rooms_$<CONFIG>.cmake)
  file(GENERATE OUTPUT ${includes} CONTENT "${content}")
  add_test(NAME framework/rooms
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DCOMPILER=${CMAKE_CXX_COMPILER}
            -DINCLUDES=${includes} -P ${CMAKE_CURRENT_SOURCE_DIR}/framework/rooms.cmake)
  set_tests_properties(framework/rooms PROPERTIES LABELS compile_error)
endfunction()

# tests/consumers/<project>: configured, built and tested as a user would, against the installed tree and with
# each of the compilers that is there (tests/consumers/run).
function(hamel_consumer project)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "COMPILERS;LABELS")
  add_test(NAME consumers/${project}
    COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/consumers/run ${PROJECT_BINARY_DIR} ${project} ${arg_COMPILERS})
  set_tests_properties(consumers/${project} PROPERTIES LABELS "consumer;${arg_LABELS}" TIMEOUT 1800)
endfunction()

# tests/consumers/subdirectory: the same with add_subdirectory of the clone.
function(hamel_consumer_of_the_clone)
  set(build ${CMAKE_CURRENT_BINARY_DIR}/consumers/subdirectory)
  add_test(NAME consumers/subdirectory
    COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumers/subdirectory ${build}
            --build-generator ${CMAKE_GENERATOR} --build-options -DHAMEL_SOURCE=${PROJECT_SOURCE_DIR}
            -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_BUILD_TYPE=Debug
            --test-command ${build}/consumer)
  set_tests_properties(consumers/subdirectory PROPERTIES LABELS consumer TIMEOUT 900)
endfunction()

# pytest <files of tools/python/tests>: ctest python/<name>.
function(hamel_python_test name)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/tools/python/tests/ OUTPUT_VARIABLE files)
  get_target_property(python hamel_python hamel_interpreter)
  add_test(NAME python/${name} COMMAND ${python} -m pytest -q -p no:cacheprovider ${files})
  set_tests_properties(python/${name} PROPERTIES TIMEOUT 600 ENVIRONMENT
    "HAMEL_PROGRAM=$<TARGET_FILE:hamel_program>;PYTHONPATH=${PROJECT_BINARY_DIR}/tools/python;PYTHONDONTWRITEBYTECODE=1")
endfunction()

# node <arguments>, in the build's copy of tools/report: ctest page/<name>. Status 77, no browser, is a
# skipped test, but a failure where HAMEL_REPORT_PAGE is ON, as it is in CI.
function(hamel_page_script name)
  add_test(NAME page/${name} COMMAND ${HAMEL_NODE} ${ARGN}
           WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/tools/report)
  set_tests_properties(page/${name} PROPERTIES LABELS page TIMEOUT 1200 COST 1000)
  if(NOT HAMEL_REPORT_PAGE STREQUAL "ON")
    set_tests_properties(page/${name} PROPERTIES SKIP_RETURN_CODE 77)
  endif()
endfunction()

# Tests of pages begin first (COST): they wait more than they work, and would run alone at the end.
# hamel_page(<name> <file> <arguments of hamel>): ctest page/<name>/write runs the program, which writes
# the file into the folder page of the tests' build.
function(hamel_page name file)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/page)
  file(MAKE_DIRECTORY ${folder})
  add_test(NAME page/${name}/write COMMAND hamel_program ${ARGN} WORKING_DIRECTORY ${folder})
  set_tests_properties(page/${name}/write PROPERTIES
    LABELS page TIMEOUT 300 COST 2000 FIXTURES_SETUP page_${name})
  set_property(DIRECTORY APPEND PROPERTY hamel_page_names page_${name})
  set_property(DIRECTORY APPEND PROPERTY hamel_page_files ${folder}/${file})
endfunction()

# ctest page/<name>: headless Chromium looks at the pages of the hamel_page calls since the last such test.
function(hamel_look_at_pages name)
  get_property(pages DIRECTORY PROPERTY hamel_page_names)
  get_property(files DIRECTORY PROPERTY hamel_page_files)
  set_property(DIRECTORY PROPERTY hamel_page_names)
  set_property(DIRECTORY PROPERTY hamel_page_files)
  hamel_page_script(${name} test/render.mjs ${files})
  set_tests_properties(page/${name} PROPERTIES FIXTURES_REQUIRED "${pages}")
endfunction()

# tests/fuzz/<stem>.cpp -> build/tests/fuzz/<stem>. It sees the headers of the systems but links no kernels: the
# schemes that it needs are compiled, erased, in tests/fuzz/registry.cpp.
function(hamel_fuzz_options target)
  target_link_libraries(${target} PRIVATE
    hamel::study hamel::mechanisms hamel::solvers fmt::fmt hamel_build_options)
  target_include_directories(${target} PRIVATE
    $<TARGET_PROPERTY:hamel_systems,INTERFACE_INCLUDE_DIRECTORIES>)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()
function(hamel_fuzz_library stem)
  add_library(fuzz_${stem} OBJECT EXCLUDE_FROM_ALL fuzz/${stem}.cpp)
  hamel_fuzz_options(fuzz_${stem})
endfunction()
function(hamel_fuzzer stem)
  add_executable(fuzz_${stem} EXCLUDE_FROM_ALL fuzz/${stem}.cpp)
  hamel_fuzz_options(fuzz_${stem})
  target_link_libraries(fuzz_${stem} PRIVATE fuzz_registry -fsanitize=fuzzer)
  set_target_properties(fuzz_${stem} PROPERTIES
    OUTPUT_NAME ${stem} RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/fuzz)
endfunction()
