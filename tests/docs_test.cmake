# Checks the documents: cmake -D ROOT=<repository> -P docs_test.cmake
#   - links and images of README.md, CONTRIBUTING.md and docs/*.md that are not to other sites resolve;
#   - files and folders that they name in backticks exist;
#   - CONTRIBUTING.md says of every folder of src/ what it is;
#   - tests that docs/method.md names exist, and so do long options of README.md and docs/method.md.
cmake_minimum_required(VERSION 3.22)

set(failures "")
set(checked 0)

macro(check condition what)
  math(EXPR checked "${checked} + 1")
  if(NOT (${condition}))
    string(APPEND failures "  ${what}\n")
  endif()
endmacro()

file(GLOB documents RELATIVE ${ROOT} ${ROOT}/docs/*.md)
list(PREPEND documents README.md CONTRIBUTING.md)

# All tests as Suite.Name, and all that the command line says of its options.
set(tests "")
file(GLOB sources ${ROOT}/tests/*_test.cpp)
foreach(source IN LISTS sources)
  file(READ ${source} text)
  string(REGEX MATCHALL "TEST(_F|_P)?\\([A-Za-z0-9]+,[ \n]*[A-Za-z0-9]+\\)" found "${text}")
  foreach(test IN LISTS found)
    string(REGEX REPLACE "^TEST(_F|_P)?\\(([A-Za-z0-9]+),[ \n]*([A-Za-z0-9]+)\\)$" "\\2.\\3" name
                         "${test}")
    list(APPEND tests ${name})
  endforeach()
endforeach()
set(options "--help")
file(GLOB sources ${ROOT}/apps/cli/*.cpp)
foreach(source IN LISTS sources)
  file(READ ${source} text)
  string(REGEX MATCHALL "--[a-z][a-z-]+" found "${text}")
  list(APPEND options ${found})
endforeach()

foreach(document IN LISTS documents)
  file(READ ${ROOT}/${document} text)
  # Brackets and semicolons mean something to CMake's lists.
  string(REPLACE "](" "@link@" text "${text}")
  string(REGEX REPLACE "[][;]" " " text "${text}")
  get_filename_component(folder ${ROOT}/${document} DIRECTORY)

  string(REGEX MATCHALL "(@link@|src=\")[^)\"]+" links "${text}")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^(@link@|src=\")" "" link "${link}")
    if(link MATCHES "^(https?:|#)")
      continue()
    endif()
    string(REGEX REPLACE "#.*" "" link "${link}")
    check("EXISTS;${folder}/${link}" "${document}: there is no ${link}")
  endforeach()

  string(REGEX MATCHALL "`[^`\n]+`" codes "${text}")
  foreach(code IN LISTS codes)
    string(REGEX REPLACE "`" "" code "${code}")
    if(code MATCHES "^(apps|benchmarks|docs|examples|include|scripts|src|tests)/[A-Za-z0-9_./-]*")
      check("EXISTS;${ROOT}/${CMAKE_MATCH_0}" "${document}: there is no ${CMAKE_MATCH_0}")
    elseif(code MATCHES "^[A-Z][A-Za-z0-9]*\\.[A-Z][A-Za-z0-9]*$" AND NOT code MATCHES "\\.(H|CPP)$")
      check("${code};IN_LIST;tests" "${document}: there is no test ${code}")
    endif()
  endforeach()

  if(document MATCHES "README|method")
    string(REGEX REPLACE "`cmake [^`]*`" "" text "${text}")  # which has options of its own
    string(REGEX MATCHALL "[ `]--[a-z][a-z-]+" found "${text}")
    foreach(option IN LISTS found)
      string(REGEX REPLACE "^[ `]" "" option "${option}")
      check("${option};IN_LIST;options" "${document}: there is no option ${option}")
    endforeach()
  endif()
endforeach()

file(READ ${ROOT}/CONTRIBUTING.md text)
file(GLOB folders RELATIVE ${ROOT} ${ROOT}/src/*)
foreach(folder IN LISTS folders)
  if(IS_DIRECTORY ${ROOT}/${folder})
    string(FIND "${text}" "${folder}/" at)
    check("NOT;at;EQUAL;-1" "CONTRIBUTING.md does not say what ${folder} is")
  endif()
endforeach()

if(checked LESS 200)
  string(APPEND failures "  only ${checked} things to check were found\n")
endif()
if(failures)
  message(FATAL_ERROR "The documents name what does not exist:\n${failures}")
endif()
message(STATUS "${checked} names and links are good")
