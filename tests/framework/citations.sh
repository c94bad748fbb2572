#!/usr/bin/env bash
# usage: citations.sh ROOT. What comments and READMEs cite exists: files and folders of this repository, links of
# READMEs with their headings, and equations (M...), each defined once in framework/schemes/README.md and listed
# in its table.
#
# A path is cited by any of its endings, stated_frame.hpp or schemes/README.md, and a program by its path without an
# extension, also in the build's folder. Names that begin with my_, own_ or mine, and NAMES, are placeholders.
set -euo pipefail
cd "$1"

paths=$(mktemp)
trap 'rm -f "$paths"' EXIT
find . -type d \( -name 'build*' -o -name .git -o -name node_modules \) -prune -o -type f -print |
  sed 's|^\./||' >"$paths"

grep -E '^(framework|groups|solvers|systems|tests|tools)/|^[^/]*$' "$paths" |
  grep -E '\.(hpp|cpp|md|cmake|mjs|sh|toml)$|CMakeLists\.txt$' | xargs awk -v paths="$paths" '
  function report(what) { print FILENAME ":" FNR ": " what; wrong = 1 }
  function parent(path) { return path ~ "/" ? substr(path, 1, match(path, "/[^/]*$") - 1) : "" }
  function anchor(heading) {
    heading = tolower(heading)
    gsub(/[^a-z0-9_ \200-\377-]/, "", heading)
    gsub(/ /, "-", heading)
    return heading
  }
  function exists(path) {
    sub("^(\\.\\./|\\./)+", "", path); sub("^build/", "", path); sub("^hamel/", "", path); sub("[/.]+$", "", path)
    return path in known || path ".cpp" in known || path ".hpp" in known || path ".sh" in known || path ".cmake" in known
  }
  BEGIN {
    while ((getline path < paths) > 0) {
      for (rest = path; ; rest = substr(rest, index(rest, "/") + 1)) {  # every ending, of the folders too
        known[rest] = 1
        for (folder = parent(rest); folder != ""; folder = parent(folder)) known[folder] = 1
        if (rest !~ "/") break
      }
      if (path ~ /[.]md$/) {
        while ((getline line < path) > 0) if (sub(/^#+ /, "", line)) known[path "#" anchor(line)] = 1
        close(path)
      }
    }
  }
  { text = $0 }
  FILENAME ~ /\.(hpp|cpp|mjs)$/ { if (!sub("^.*(^|[^:])//", "", text)) next }
  FILENAME ~ /(\.(cmake|sh|toml)|CMakeLists\.txt)$/ { if (!sub("^[^#]*(^|[ \t])#", "", text)) next }
  {
    for (rest = text; match(rest, /\(M[0-9]+\)/); rest = substr(rest, RSTART + RLENGTH)) {
      equation = substr(rest, RSTART + 1, RLENGTH - 2)
      if (FILENAME != "framework/schemes/README.md") { if (!(equation in cited)) cited[equation] = FILENAME ":" FNR }
      else if (text ~ /^\|/) ++listed[equation]
      else if (text ~ "^    \\(" equation "\\)" && RSTART == 5) ++defined[equation]
      else cited[equation] = FILENAME ":" FNR
    }
    for (rest = text; match(rest, /[A-Za-z0-9_.\/*-]*[A-Za-z0-9_*-]\.(hpp|cpp|md|cmake|mjs)/); rest = substr(rest, RSTART + RLENGTH)) {
      path = substr(rest, RSTART, RLENGTH)
      if (path ~ /\*/ || path ~ /(^|\/)(my_|own_|mine)/ || substr(rest, RSTART + RLENGTH, 1) ~ /[A-Za-z0-9_]/) continue
      if (!exists(path)) report("there is no " path)
    }
    for (rest = text; match(rest, /(^|[ `("])(build\/)?(framework|groups|solvers|systems|tests|tools)\/[A-Za-z0-9_.\/-]+/); rest = substr(rest, RSTART + RLENGTH)) {
      path = substr(rest, RSTART, RLENGTH)
      sub(/^[ `("]/, "", path)
      if (path ~ /\/((my_|own_|mine)|[A-Z]+[.]?$)/ || substr(rest, RSTART + RLENGTH, 1) ~ /[<*{]/) continue
      if (!exists(path)) report("there is no " path)
    }
  }
  FILENAME ~ /\.md$/ {
    for (rest = text; match(rest, /\]\([^)]+/); rest = substr(rest, RSTART + RLENGTH)) {
      link = substr(rest, RSTART + 2, RLENGTH - 2)
      if (link ~ /^https?:/ || link !~ /^[A-Za-z0-9_.\/#-]+$/) continue
      path = link ~ /^#/ ? FILENAME link : parent(FILENAME) "/" link
      sub("^/", "", path)
      while (sub("(^|/)[^/.]+/\\.\\./", "/", path)) sub("^/", "", path)
      sub("/$", "", path)
      if (!(path in known)) report("the link leads nowhere: " link)
    }
  }
  END {
    for (equation in cited) if (!(equation in defined)) { print cited[equation] ": there is no equation (" equation ")"; wrong = 1 }
    for (equation in defined) if (defined[equation] != 1 || listed[equation] != 1) {
      print "framework/schemes/README.md: (" equation ") is defined " defined[equation] " times, listed " listed[equation] + 0; wrong = 1
    }
    for (equation in listed) if (!(equation in defined)) { print "framework/schemes/README.md: (" equation ") is listed, not defined"; wrong = 1 }
    count = 0
    for (equation in defined) ++count
    if (count < 40) { print "only " count " equations found"; wrong = 1 }
    exit wrong
  }'
