# One definition of every type. A name that two headers define in one namespace does not compile: one source file includes
# all of them. What sources define is compared at link time: gcc's -Wodr looks at the types of all objects of the program.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/core/*.hpp"
  "${PROJECT_SOURCE_DIR}/types_se2/*.hpp" "${PROJECT_SOURCE_DIR}/solvers/*.hpp" "${PROJECT_SOURCE_DIR}/plugins/*.hpp"
  "${PROJECT_SOURCE_DIR}/formats/*.hpp" "${PROJECT_SOURCE_DIR}/tools/*.hpp")
list(FILTER headers EXCLUDE REGEX "^tools/python/")  # they need pybind11; the sources of the module are compiled merged
list(TRANSFORM headers REPLACE "(.+)" "#include <waymark/\\1>\n")
list(JOIN headers "" all_headers)
file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/all_headers.cpp" CONTENT "${all_headers}")
find_package(CLI11 REQUIRED)
find_package(yaml-cpp REQUIRED)
add_library(waymark_all_headers OBJECT "${CMAKE_CURRENT_BINARY_DIR}/all_headers.cpp")
target_compile_options(waymark_all_headers PRIVATE -O0)
target_link_libraries(waymark_all_headers PRIVATE waymark::reproduction waymark::inspection waymark::simulation
  waymark::benchmark waymark::report waymark::plugins waymark::solvers CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json yaml-cpp)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  # A whole build with LTO, ten minutes on two cores: a third of all tests. So it is run by `ctest --preset test -C Slow -R twice`.
  # Without it merged batches and the file of all headers find most twins.
  add_test(NAME "house: no type is defined twice among the objects of the program" CONFIGURATIONS Slow
    COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/one_definition"
      --build-generator "${CMAKE_GENERATOR}" --build-target waymark --build-noclean --build-options
      -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_BUILD_TYPE=None -DCMAKE_UNITY_BUILD=ON
      -DCMAKE_CXX_FLAGS=-O0\ -flto=auto\ -w\ -Wodr -DCMAKE_EXE_LINKER_FLAGS=-Werror=odr -DCMAKE_SHARED_LINKER_FLAGS=-Werror=odr
      -DWAYMARK_BUILD_TESTS=OFF -DWAYMARK_BUILD_BENCHMARKS=OFF -DWAYMARK_BUILD_EXAMPLES=OFF)
  set_tests_properties("house: no type is defined twice among the objects of the program" PROPERTIES TIMEOUT 2700)
endif()
