# Warnings, sanitizers and the one way a library or a test is added.

add_library(fisherhill_flags INTERFACE)
target_compile_options(fisherhill_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow
  # GCC 12 sees overruns inside std::string that are not there (its bugs 105329 and 105651)
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict>
  $<$<BOOL:${FISHERHILL_WARNINGS_AS_ERRORS}>:-Werror>
  # and, at -O1 and by what happens to be inlined, matrices that are not set though they are; told, no error
  $<$<AND:$<BOOL:${FISHERHILL_WARNINGS_AS_ERRORS}>,$<CXX_COMPILER_ID:GNU>>:-Wno-error=maybe-uninitialized>)
if(FISHERHILL_SANITIZE)
  target_compile_options(fisherhill_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(fisherhill_flags INTERFACE -fsanitize=address,undefined)
endif()
# In tests a local may be called as another file's helper; the others are GCC 12's false alarms (its
# bug 105651, and Eigen's temporaries of AD scalars).
add_library(fisherhill_test_flags INTERFACE)
target_compile_options(fisherhill_test_flags INTERFACE -Wno-shadow
  $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow -Wno-maybe-uninitialized>
  # a test's own code is not what takes long to run
  $<$<CONFIG:Release>:-O1>)

# Headers that nearly every file of a kind reads, parsed once per kind. Files must not rely on them:
# the check that every public header compiles alone builds without.
set(standard_headers <algorithm> <cmath> <functional> <limits> <memory> <optional> <stdexcept>
  <string> <vector> <Eigen/Dense>)

# fisherhill_batched(target [size]): its files are compiled several at a time, 6 unless told, so that
# Eigen's and others' templates are instantiated once for all of them: less than half the time of a build
# from nothing. Names in anonymous namespaces are therefore unique in a target.
function(fisherhill_batched target)
  set(size 6)
  if(ARGC GREATER 1)
    set(size ${ARGV1})
  endif()
  if(FISHERHILL_BATCHES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
  endif()
endfunction()

# fisherhill_test(name [BATCH size] [FILES file...] [BATCHES list...] [LABELS label...] LIBS lib...): the
# files, or name.cc, become one test program, and every TEST in it one ctest case. They are compiled one by
# one, `size` at a time, or as the named lists of files say. Those labelled slow are built only with
# FISHERHILL_SLOW_TESTS.
function(fisherhill_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "BATCH;TIMEOUT" "BATCHES;FILES;LABELS;LIBS")
  if("slow" IN_LIST arg_LABELS AND NOT FISHERHILL_SLOW_TESTS)
    return()
  endif()
  foreach(batch IN LISTS arg_BATCHES)
    list(APPEND arg_FILES ${${batch}})
    set_source_files_properties(${${batch}} PROPERTIES UNITY_GROUP ${batch})
  endforeach()
  if(NOT arg_FILES)
    set(arg_FILES ${name}.cc)
  endif()
  if(NOT TARGET test_headers)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test_headers.cc CONTENT "")
    add_library(test_headers OBJECT ${PROJECT_BINARY_DIR}/test_headers.cc)
    target_link_libraries(test_headers
      PRIVATE fisherhill_flags fisherhill_test_flags Eigen3::Eigen GTest::gmock)
    # as its users are
    set_target_properties(test_headers PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_precompile_headers(test_headers PRIVATE
      ${standard_headers} <filesystem> <gmock/gmock.h> <gtest/gtest.h>)
  endif()
  add_executable(${name} ${arg_FILES})
  if(arg_BATCH)
    fisherhill_batched(${name} ${arg_BATCH})
  endif()
  if(arg_BATCHES AND FISHERHILL_BATCHES)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_precompile_headers(${name} REUSE_FROM test_headers)
  target_link_libraries(${name}
    PRIVATE fisherhill_flags fisherhill_test_flags ${arg_LIBS} GTest::gmock GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE
    FISHERHILL_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FISHERHILL_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS "${arg_LABELS}")
endfunction()

# fisherhill_count_allocations(test): support::allocations() tells how often memory was taken by malloc() or
# operator new.
function(fisherhill_count_allocations test)
  set(counter ${PROJECT_SOURCE_DIR}/tests/support/allocations.cc)
  target_sources(${test} PRIVATE ${counter})
  set_source_files_properties(${counter} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_options(${test} PRIVATE -Wl,--wrap=malloc,--wrap=aligned_alloc)
endfunction()
