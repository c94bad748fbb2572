# Bundles tools/report into one HTML page with npm and node, and embeds it as a string in a source.
#
#   cmake -DSOURCE=tools/report -DWORK=build/tools/report -DOUTPUT=<source> -DMODE=AUTO|ON|OFF
#         -DNODE=... -DNPM=... -P this
#
# Everything happens in WORK, a copy: the source tree stays clean. Where the page cannot be made, mode
# AUTO writes an empty string and says why; WORK/page.html is then missing, so the next build tries
# again.
cmake_minimum_required(VERSION 3.25)

function(write_source page)  # leaves the file alone where nothing changed
  if(page MATCHES [[\)hamel_page"]])
    message(FATAL_ERROR "the page contains the delimiter that it is embedded with")
  endif()
  file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"// Written by tools/cmake/build_report_page.cmake: ${WORK}/page.html.
#include <string_view>

namespace hamel::pages {

std::string_view report_page();

std::string_view report_page() {
  static constexpr char page[] = R\"hamel_page(@page@)hamel_page\";
  return {page, sizeof(page) - 1};
}

}  // namespace hamel::pages
")
endfunction()

function(without_page reason)
  if(MODE STREQUAL "ON")
    message(FATAL_ERROR "hamel: no report page: ${reason}")
  endif()
  message("hamel is built WITHOUT its report page: ${reason}")
  file(REMOVE ${WORK}/page.html)
  write_source("")
endfunction()

if(MODE STREQUAL "OFF")
  file(WRITE ${WORK}/page.html "")
  write_source("")
  return()
elseif(NOT NODE OR NOT NPM)
  without_page("node or npm is not installed (tools/setup installs them)")
  return()
endif()

file(COPY ${SOURCE}/ DESTINATION ${WORK} PATTERN node_modules EXCLUDE PATTERN dist EXCLUDE)

# The packages, again only when the lock file has changed.
file(SHA256 ${SOURCE}/package-lock.json lock)
set(stamp ${WORK}/node_modules/.hamel-lock)
set(installed "")
if(EXISTS ${stamp})
  file(READ ${stamp} installed)
endif()
if(NOT installed STREQUAL lock)
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1
    WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    without_page("npm ci failed:\n${output}")
    return()
  endif()
  file(WRITE ${stamp} ${lock})
endif()

execute_process(
  COMMAND ${NODE} build.mjs ${WORK}/page.html
  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  # A mistake of this project, not of the machine: always an error.
  message(FATAL_ERROR "hamel: node build.mjs failed in ${WORK}:\n${output}")
endif()
file(READ ${WORK}/page.html page)
write_source("${page}")
