# One way to declare libraries, programs and tests, so that warnings and include paths are the same everywhere.

function(beckon_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Off: designated initialisers leave fields out on purpose; g++ 12's -Wrestrict errs on std::string.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    -Wno-unused-parameter -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()

# beckon_library(NAME SOURCES... LINK LIBRARIES...)
function(beckon_library name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_UNPARSED_ARGUMENTS})
  beckon_compile_options(${name})
  target_link_libraries(${name} PUBLIC ${ARG_LINK})
endfunction()

# beckon_program(NAME SOURCES... LINK LIBRARIES... [PACKAGE NAME]): installed to bin, in the package of its own name or that
# one
function(beckon_program name)
  cmake_parse_arguments(ARG "" "PACKAGE" "LINK" ${ARGN})
  if(NOT ARG_PACKAGE)
    set(ARG_PACKAGE ${name})
  endif()
  add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
  beckon_compile_options(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${ARG_PACKAGE})
endfunction()

# beckon_test(NAME SOURCES... LINK LIBRARIES... LABEL unit|integration|hardware): a GoogleTest program
function(beckon_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "LINK" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
  beckon_compile_options(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gmock GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE BECKON_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
    PROPERTIES ENVIRONMENT BECKON_SHARE=${PROJECT_BINARY_DIR}/share/beckon LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT} SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
endfunction()

# beckon_fuzzer(NAME FUNCTION HEADER SOURCES... LINK LIBRARIES...): a libFuzzer program that feeds FUNCTION, which
# HEADER declares; part of the target fuzzers
function(beckon_fuzzer name function header)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_executable(${name} EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tests/fuzzer.cpp ${ARG_UNPARSED_ARGUMENTS})
  beckon_compile_options(${name})
  target_compile_definitions(${name} PRIVATE BECKON_HARNESS=${function} BECKON_HARNESS_HEADER="${header}")
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  if(NOT TARGET fuzzers)
    add_custom_target(fuzzers)
  endif()
  add_dependencies(fuzzers ${name})
endfunction()

# beckon_share(FILES... [FOLDER NAME]): data that programs find through SharedFile(); in the build tree and installed
function(beckon_share)
  cmake_parse_arguments(ARG "" "FOLDER" "" ${ARGN})
  foreach(file ${ARG_UNPARSED_ARGUMENTS})
    get_filename_component(name ${file} NAME)
    configure_file(${file} ${PROJECT_BINARY_DIR}/share/beckon/${ARG_FOLDER}/${name} COPYONLY)
    install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/beckon/${ARG_FOLDER} COMPONENT beckon-base)
  endforeach()
endfunction()

# beckon_core_library(NAME SOURCES... LINK LIBRARIES...): a library that a test keeps pure, free of LCM, SQLite,
# devices, files, clocks, loggers and threads
function(beckon_core_library name)
  beckon_library(${name} ${ARGN})
  get_target_property(sources ${name} SOURCES)
  list(TRANSFORM sources PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(GLOBAL APPEND PROPERTY BECKON_CORE_SOURCES ${sources})
endfunction()
