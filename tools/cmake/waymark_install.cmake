# What `cmake --install` puts where. Components: runtime (program, shared library), dev (headers, static libraries, CMake
# and pkg-config files, plugin template), plugins (modules that are not built into the program), python (the package).
include(CMakePackageConfigHelpers)

set(cmake_folder "${CMAKE_INSTALL_LIBDIR}/cmake/waymark")

# While the version is 0.x, each minor version may break the ABI (plugins/README.md, "ABI and versions").
set_target_properties(waymark_core PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
# The program finds the library beside it, wherever the prefix is; packages set CMAKE_SKIP_INSTALL_RPATH. The build tree
# (bin and lib) has the same run path: one that CMake changes at installation ends with a colon, an empty entry, and the
# linker would look for libraries in the present folder.
file(RELATIVE_PATH bin_to_lib "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set(run_path "$ORIGIN/${bin_to_lib}" "$ORIGIN/../lib")
list(REMOVE_DUPLICATES run_path)
set_target_properties(waymark PROPERTIES INSTALL_RPATH "${run_path}" BUILD_WITH_INSTALL_RPATH ON)

install(TARGETS waymark RUNTIME COMPONENT runtime)
install(TARGETS waymark_core waymark_types_se2 waymark_solvers waymark_formats waymark_drive waymark_plugins
                waymark_settings EXPORT waymark_targets
  LIBRARY COMPONENT runtime NAMELINK_COMPONENT dev
  ARCHIVE COMPONENT dev)
foreach(name ${WAYMARK_MODULE_NAMES})
  install(TARGETS waymark_module_${name} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/waymark/plugins" COMPONENT plugins)
endforeach()

# The package of Python, where Debian's looks for it below /usr.
if(TARGET waymark_python)
  set(WAYMARK_PYTHON_FOLDER lib/python3/dist-packages CACHE STRING "Folder of Python packages, below the prefix")
  file(RELATIVE_PATH package_to_lib "${CMAKE_INSTALL_PREFIX}/${WAYMARK_PYTHON_FOLDER}/waymark" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set_target_properties(waymark_python PROPERTIES INSTALL_RPATH "$ORIGIN/${package_to_lib};$ORIGIN/../../lib"
    BUILD_WITH_INSTALL_RPATH ON)  # as the program
  install(TARGETS waymark_python LIBRARY DESTINATION "${WAYMARK_PYTHON_FOLDER}/waymark" COMPONENT python)
  install(DIRECTORY tools/python/waymark DESTINATION "${WAYMARK_PYTHON_FOLDER}" COMPONENT python
    FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
endif()

# Headers under the spelling of the build tree, <waymark/core/graph/graph.hpp>: those of the two lists and the version.
include(public_headers)
foreach(header ${WAYMARK_PUBLIC_HEADERS} ${WAYMARK_INCLUDED_HEADERS})
  get_filename_component(folder "${header}" DIRECTORY)
  install(FILES "${PROJECT_SOURCE_DIR}/${header}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/waymark/${folder}" COMPONENT dev)
endforeach()
install(FILES "${WAYMARK_INCLUDE_DIR}/waymark/version.hpp" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/waymark" COMPONENT dev)

set(WAYMARK_PLUGIN_FOLDER "${CMAKE_INSTALL_LIBDIR}/waymark/plugins")
configure_package_config_file(tools/cmake/waymark_config.cmake.in "${PROJECT_BINARY_DIR}/package/waymark-config.cmake"
  INSTALL_DESTINATION "${cmake_folder}" PATH_VARS WAYMARK_PLUGIN_FOLDER)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/package/waymark-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(EXPORT waymark_targets NAMESPACE waymark:: DESTINATION "${cmake_folder}" COMPONENT dev)
install(FILES
  "${PROJECT_BINARY_DIR}/package/waymark-config.cmake" "${PROJECT_BINARY_DIR}/package/waymark-config-version.cmake"
  tools/cmake/waymark_add_plugin.cmake tools/cmake/FindCholmod.cmake tools/cmake/FindCXSparse.cmake
  tools/cmake/FindGeographicLib.cmake
  DESTINATION "${cmake_folder}" COMPONENT dev)

# pkg-config: static libraries in link order, then what the backends need.
set(WAYMARK_PC_LIBRARIES -lwaymark_plugins -lwaymark_formats -lwaymark_solvers)
if(WAYMARK_WITH_CHOLMOD)
  list(APPEND WAYMARK_PC_LIBRARIES -lcholmod)
endif()
if(WAYMARK_WITH_CSPARSE)
  list(APPEND WAYMARK_PC_LIBRARIES -lcxsparse)
endif()
list(JOIN WAYMARK_PC_LIBRARIES " " WAYMARK_PC_LIBRARIES)
set(pc_folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
file(RELATIVE_PATH WAYMARK_PC_TO_PREFIX "/prefix/${pc_folder}" "/prefix")
string(REGEX REPLACE "/$" "" WAYMARK_PC_TO_PREFIX "${WAYMARK_PC_TO_PREFIX}")
configure_file(tools/cmake/waymark_core.pc.in "${PROJECT_BINARY_DIR}/package/waymark-core.pc" @ONLY)
configure_file(tools/cmake/waymark.pc.in "${PROJECT_BINARY_DIR}/package/waymark.pc" @ONLY)
configure_file(tools/cmake/waymark_drive.pc.in "${PROJECT_BINARY_DIR}/package/waymark-drive.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/package/waymark-core.pc" "${PROJECT_BINARY_DIR}/package/waymark.pc"
              "${PROJECT_BINARY_DIR}/package/waymark-drive.pc"
  DESTINATION "${pc_folder}" COMPONENT dev)

# The documents, as they link to each other, and the bundled drive.
set(WAYMARK_DOC_FOLDER "${CMAKE_INSTALL_DATADIR}/doc/waymark-doc")
install(DIRECTORY core types_se2 solvers formats plugins tools examples DESTINATION "${WAYMARK_DOC_FOLDER}" COMPONENT doc
  FILES_MATCHING PATTERN "*.md" PATTERN "report.png" PATTERN "setup" EXCLUDE PATTERN "detail" EXCLUDE)
install(DIRECTORY examples/berlin_potsdamer_platz examples/drives examples/extensions examples/plugin_template examples/programs examples/live
                  examples/python examples/tutorial DESTINATION "${WAYMARK_DOC_FOLDER}/examples" COMPONENT doc)
# As `systemctl enable --now waymark-live` wants it; it is off until then.
install(FILES examples/live/waymark-live.service DESTINATION lib/systemd/system COMPONENT runtime)
install(FILES README.md CONTRIBUTING.md DESTINATION "${WAYMARK_DOC_FOLDER}" COMPONENT doc)
install(DIRECTORY examples/plugin_template examples/extensions examples/programs DESTINATION "${CMAKE_INSTALL_DATADIR}/waymark" COMPONENT dev)
