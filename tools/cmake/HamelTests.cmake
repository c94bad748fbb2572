# What tests/CMakeLists.txt adds its lines with.

set(HAMEL_SCRIPTS ${PROJECT_SOURCE_DIR}/tools/cmake)

# Optional libraries of single tests; a test that NEEDS one that is missing is left out, and said so.
#   hamel_jet      ceres::Jet, headers only            hamel_mpreal   mpfr::mpreal, any number of digits
find_path(HAMEL_CERES_INCLUDE ceres/jet.h)
if(HAMEL_CERES_INCLUDE)
  add_library(hamel_jet INTERFACE)
  target_include_directories(hamel_jet SYSTEM INTERFACE ${HAMEL_CERES_INCLUDE})
endif()
find_path(HAMEL_MPREAL_INCLUDE mpreal.h)
find_library(HAMEL_MPFR mpfr)
find_library(HAMEL_GMP gmp)
if(HAMEL_MPREAL_INCLUDE AND HAMEL_MPFR AND HAMEL_GMP)
  add_library(hamel_mpreal INTERFACE)
  target_include_directories(hamel_mpreal SYSTEM INTERFACE ${HAMEL_MPREAL_INCLUDE})
  target_link_libraries(hamel_mpreal INTERFACE ${HAMEL_MPFR} ${HAMEL_GMP})
endif()

if(HAMEL_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)

  # Eigen and GoogleTest, parsed once for all tests.
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/pch/empty.cpp "")
  add_library(hamel_test_pch OBJECT ${CMAKE_CURRENT_BINARY_DIR}/pch/empty.cpp)
  target_precompile_headers(hamel_test_pch PRIVATE
    <Eigen/Dense> <gtest/gtest.h> <gmock/gmock.h>
    <cmath> <functional> <optional> <random> <sstream> <string> <vector>)
endif()

# What every test, example and benchmark has in common. -fpch-preprocess lets ccache see through a
# precompiled header; -O1 halves the time to compile, and few tests need more (HOT).
function(hamel_test_settings target)
  target_link_libraries(${target} PRIVATE hamel::hamel hamel_build_options)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()
function(hamel_pch_settings target)
  target_link_libraries(${target} PRIVATE GTest::gtest GTest::gmock)
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess> $<$<CONFIG:Release>:-O1>)
  hamel_test_settings(${target})
endfunction()
if(HAMEL_BUILD_TESTS)
  hamel_pch_settings(hamel_test_pch)
endif()

function(hamel_all_targets_exist result what)
  set(${result} TRUE PARENT_SCOPE)
  foreach(target IN LISTS ARGN)
    if(NOT TARGET ${target})
      message(STATUS "hamel: ${what} is left out: it needs ${target}")
      set(${result} FALSE PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# tests/<name>.cpp -> build/tests/<name>, ctest <name>.
#   LABELS slow ...   PROGRAM   runs build/tools/hamel, whose path is in the environment: HAMEL_PROGRAM
#   HOT               compiled with full optimisation, and without the precompiled header
#   NEEDS target ...  libraries to link; where one is missing the test is left out
function(hamel_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PROGRAM;HOT" "TIMEOUT" "LABELS;NEEDS")
  if(arg_PROGRAM)
    list(APPEND arg_NEEDS hamel_program)
  endif()
  hamel_all_targets_exist(complete "test ${name}" ${arg_NEEDS})
  if(NOT complete)
    return()
  endif()
  cmake_path(GET name PARENT_PATH folder)
  cmake_path(GET name FILENAME stem)
  string(REPLACE "/" "_" target test_${name})

  add_executable(${target} ${name}.cpp)
  if(arg_HOT)
    target_link_libraries(${target} PRIVATE GTest::gtest GTest::gmock)
    hamel_test_settings(${target})
  else()
    hamel_pch_settings(${target})
    target_precompile_headers(${target} REUSE_FROM hamel_test_pch)
  endif()
  target_link_libraries(${target} PRIVATE GTest::gtest_main)
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${stem} RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/${folder})

  add_test(NAME ${name} COMMAND ${target})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
  if(arg_PROGRAM)
    add_dependencies(${target} hamel_program)
    set_tests_properties(${name} PROPERTIES ENVIRONMENT HAMEL_PROGRAM=$<TARGET_FILE:hamel_program>)
    list(REMOVE_ITEM arg_NEEDS hamel_program)
  endif()
  target_link_libraries(${target} PRIVATE ${arg_NEEDS})
endfunction()

# tests/examples/<name>.cpp -> build/tests/examples/<name>, ctest examples/<name>.
function(hamel_example name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "ARGS;LABELS")
  set(target example_${name})
  add_executable(${target} examples/${name}.cpp)
  hamel_test_settings(${target})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/examples)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${folder})
  add_test(NAME examples/${name} COMMAND ${target} ${arg_ARGS} WORKING_DIRECTORY ${folder})
  set_tests_properties(examples/${name} PROPERTIES LABELS "example;${arg_LABELS}" TIMEOUT 120)
endfunction()

# tests/benchmarks/<name>.cpp -> build/tests/benchmarks/<name>; ctest only sees that it runs.
function(hamel_benchmark name)
  find_package(benchmark 1.7 QUIET)
  hamel_all_targets_exist(complete "benchmark ${name}" benchmark::benchmark)
  if(NOT complete)
    return()
  endif()
  set(target benchmark_${name})
  add_executable(${target} benchmarks/${name}.cpp)
  hamel_test_settings(${target})
  target_link_libraries(${target} PRIVATE benchmark::benchmark benchmark::benchmark_main)
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/benchmarks)
  add_test(NAME benchmarks/${name} COMMAND ${target} --benchmark_min_time=0.001)
  set_tests_properties(benchmarks/${name} PROPERTIES LABELS benchmark TIMEOUT 120)
endfunction()

# tests/compile_errors/<name>.cpp must fail to compile with a message that matches its first line,
#   // expect: regular expression
# seeing <hamel/hamel.hpp> and all layers, or only the layers below one: `// layer: framework`.
# Where the file tests `#ifdef MISTAKE`, it must also compile without that macro.
function(hamel_compile_error name)
  set(source ${CMAKE_CURRENT_SOURCE_DIR}/compile_errors/${name}.cpp)
  set(target hamel_umbrella)
  file(STRINGS ${source} layer REGEX "^// layer: " LIMIT_COUNT 1)
  if(layer MATCHES "^// layer: ([a-z]+)")
    set(target hamel_${CMAKE_MATCH_1})
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  add_test(NAME compile_errors/${name}
    COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER} -DSOURCE=${source}
            "-DINCLUDES=$<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>"
            -P ${HAMEL_SCRIPTS}/expect_compile_error.cmake)
  set_tests_properties(compile_errors/${name} PROPERTIES LABELS compile_error TIMEOUT 120)
endfunction()

# tests/consumers/<kind>: configured, built and run as a user would.
function(hamel_consumer kind)
  add_test(NAME consumers/${kind}
    COMMAND ${CMAKE_COMMAND} -DKIND=${kind} -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/consumers/${kind}
            -DHAMEL_SOURCE=${PROJECT_SOURCE_DIR} -DHAMEL_BUILD=${PROJECT_BINARY_DIR}
            -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER}
            -DCONFIG=$<CONFIG> "-DLAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}"
            -P ${HAMEL_SCRIPTS}/run_consumer.cmake)
  set_tests_properties(consumers/${kind} PROPERTIES LABELS consumer TIMEOUT 900)
endfunction()

# Every source of the tree is in a list: a forgotten test is a test that never runs.
function(hamel_source_lists_test)
  add_test(NAME source_lists
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -P ${HAMEL_SCRIPTS}/source_lists.cmake)
endfunction()

# The page in headless Chromium. Status 77, no browser, is a skipped test, but a failure in CI.
function(hamel_report_page_test)
  set(script ${PROJECT_SOURCE_DIR}/tools/report/test/render.mjs)
  if(NOT TARGET hamel_program OR NOT HAMEL_NODE OR NOT EXISTS ${script})
    message(STATUS "hamel: test report_page is left out: it needs the program and node")
    return()
  endif()
  add_test(NAME report_page
    COMMAND ${HAMEL_NODE} test/render.mjs WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/tools/report)
  set_tests_properties(report_page PROPERTIES LABELS page TIMEOUT 180)
  if(NOT HAMEL_REPORT_PAGE STREQUAL "ON")
    set_tests_properties(report_page PROPERTIES SKIP_RETURN_CODE 77)
  endif()
endfunction()
