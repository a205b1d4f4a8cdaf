# Settings every target shares: language level, warnings, one include spelling (<waymark/core/graph.hpp>) in the
# build tree and in the installed one.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# One visibility for all, as they share a precompiled header: what a library shows says WAYMARK_EXPORT.
# clang takes the visibility of a function from the namespace of its definition, so that it would hide all functions of core:
# what it builds hides nothing.
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  set(CMAKE_CXX_VISIBILITY_PRESET hidden)
  set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")

# <waymark/ROOM/header.hpp> is found through links in the build tree to the source folders.
set(WAYMARK_INCLUDE_DIR "${PROJECT_BINARY_DIR}/include")
file(MAKE_DIRECTORY "${WAYMARK_INCLUDE_DIR}/waymark")
foreach(room core types_se2 solvers plugins formats tools)
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/${room}" "${WAYMARK_INCLUDE_DIR}/waymark/${room}" SYMBOLIC)
endforeach()

configure_file(tools/cmake/version.hpp.in "${WAYMARK_INCLUDE_DIR}/waymark/version.hpp" @ONLY)

add_library(waymark_settings INTERFACE)
target_include_directories(waymark_settings INTERFACE
  $<BUILD_INTERFACE:${WAYMARK_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(waymark_settings INTERFACE cxx_std_20)
set_target_properties(waymark_settings PROPERTIES EXPORT_NAME settings)
# Not for those who build us as a part of theirs: their warnings are their own affair.
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(waymark_settings INTERFACE $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wconversion>)
  if(NOT (CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID MATCHES "Clang"))  # it warns of the constants of merged sources
    target_compile_options(waymark_settings INTERFACE $<BUILD_INTERFACE:-Wshadow>)
  endif()
  # g++ collects garbage whenever its memory has grown by a share; from a GB on, a build takes a tenth less time. Half a GB
  # or its own rule where the jobs that ninja runs at once would not find so much.
  include("${CMAKE_CURRENT_LIST_DIR}/available_memory.cmake")
  waymark_available_memory_MB(memory_MB)
  cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
  math(EXPR memory_of_a_job_MB "${memory_MB} / (${processors} + 2)")
  if(memory_of_a_job_MB GREATER 2500)
    set(uncollected_kB 1048576)
  elseif(memory_of_a_job_MB GREATER 1500)
    set(uncollected_kB 524288)
  endif()
  if(uncollected_kB)
    target_compile_options(waymark_settings INTERFACE
      $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=${uncollected_kB}>>)
  endif()
endif()
if(WAYMARK_WARNINGS_AS_ERRORS)
  target_compile_options(waymark_settings INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()

# What everything here is compiled with: a plugin may be compiled with the same (waymark_add_plugin.cmake).
string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
get_directory_property(options COMPILE_OPTIONS)
list(JOIN options " " options)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}} ${options}" WAYMARK_CXX_FLAGS)
set_property(GLOBAL PROPERTY WAYMARK_CXX_FLAGS "${WAYMARK_CXX_FLAGS}")

# Relocations are read-only once the program runs, and bound at its start: nothing can be written over them later.
if(PROJECT_IS_TOP_LEVEL AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
  add_link_options(-Wl,-z,relro,-z,now)
endif()

# The presets ask for these two; neither changes the program that is built.
if(WAYMARK_FAST_TOOLS)
  find_program(WAYMARK_MOLD mold)
  if(WAYMARK_MOLD)
    add_link_options(-fuse-ld=mold)
  endif()
  find_program(WAYMARK_CCACHE ccache)
  if(WAYMARK_CCACHE)
    # The cache must be told that precompiled headers may be trusted to be what they were.
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND};-E;env;CCACHE_SLOPPINESS=pch_defines,time_macros;${WAYMARK_CCACHE}")
  endif()
endif()

# All libraries share a precompiled header, those in whose inner loops the time goes a second one, because g++ optimises a
# source as its precompiled header was, whatever its own options say. The owner of a header has no definition of its own, so
# that it fits every other target.
find_package(nlohmann_json REQUIRED)
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "// The owner of the precompiled header needs a source.\n")
foreach(owner waymark_precompiled waymark_precompiled_hot)
  add_library(${owner} OBJECT "${PROJECT_BINARY_DIR}/precompiled.cpp")
  target_link_libraries(${owner} PRIVATE waymark_settings Eigen3::Eigen nlohmann_json::nlohmann_json)
  target_precompile_headers(${owner} PRIVATE <Eigen/Core> <algorithm> <array> <functional> <map> <memory>
    <optional> <span> <string> <string_view> <variant> <vector>)
endforeach()
target_precompile_headers(waymark_precompiled PRIVATE <chrono> <filesystem> <nlohmann/json.hpp>)
target_compile_options(waymark_precompiled PRIVATE $<$<CONFIG:Release>:-O1>)

# waymark_not_merged(FILES...): a build that merges sources (CMAKE_UNITY_BUILD) compiles these one by one: their inner loops
# are compiled for several processors, and that code must not depend on its neighbours.
function(waymark_not_merged)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# waymark_cold(TARGET): it has no inner loops, and is optimised little: a whole `waymark run` then takes 1 % more
# instructions, and a build a quarter less time.
function(waymark_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  # clang refuses a header of another visibility, such as a plugin has.
  get_target_property(type ${target} TYPE)
  if(NOT (type STREQUAL MODULE_LIBRARY AND CMAKE_CXX_COMPILER_ID MATCHES "Clang"))
    target_precompile_headers(${target} REUSE_FROM waymark_precompiled)
  endif()
endfunction()

# waymark_library(NAME [SHARED] [HOT] [UNITS COUNT] [WITHOUT PATHS...]): a library of every *.cpp below the calling
# CMakeLists.txt, but for the folders and files given, with the shared settings and the alias waymark::NAME. HOT: it has inner
# loops. The others are cold. UNITS: how many sources of about one size a merged build makes of them; every further one
# compiles the same headers and templates again, for 3 to 10 s.
function(waymark_library name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "SHARED;HOT" "UNITS" "WITHOUT")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" *.cpp)
  foreach(path ${ARG_WITHOUT})
    list(FILTER sources EXCLUDE REGEX "^${path}(/|$)")
  endforeach()
  if(ARG_SHARED)
    add_library(waymark_${name} SHARED ${sources})
  else()
    add_library(waymark_${name} STATIC ${sources})
  endif()
  add_library(waymark::${name} ALIAS waymark_${name})
  set_target_properties(waymark_${name} PROPERTIES EXPORT_NAME ${name})
  if(ARG_UNITS)
    list(LENGTH sources count)
    math(EXPR size "(${count} + ${ARG_UNITS} - 1) / ${ARG_UNITS}")
    set_target_properties(waymark_${name} PROPERTIES UNITY_BUILD_BATCH_SIZE ${size})
  endif()
  target_link_libraries(waymark_${name} PUBLIC waymark_settings)
  if(ARG_HOT)
    target_precompile_headers(waymark_${name} REUSE_FROM waymark_precompiled_hot)
  else()
    waymark_cold(waymark_${name})
  endif()
endfunction()
