# waymark_add_plugin(NAME SOURCES...): the plugin module NAME.so, for `waymark --plugin`. The same function makes the
# modules of this repository and is installed for plugins built elsewhere. waymark_install_plugin(NAME) installs one,
# waymark_check_plugin(NAME) tests one.
include_guard(GLOBAL)
cmake_policy(VERSION 3.25)

# waymark_refused_flag(FLAG RESULT): why the loader would refuse a plugin built with this flag, empty where it would not.
function(waymark_refused_flag flag result)
  set(reason "")
  if(flag MATCHES "^-march=(native|x86-64-v[34])$|^-mavx")
    set(reason "it changes the alignment of Eigen's types and with it the layout of what the plugin shares with waymark")
  elseif(flag MATCHES "^-(ffast-math|Ofast|funsafe-math-optimizations)$")
    set(reason "it drops infinities, NaN and the order of sums, and switches the whole process to flush-to-zero when the plugin is loaded")
  elseif(flag MATCHES "^-D_GLIBCXX_DEBUG$|^-D_GLIBCXX_DEBUG=")
    set(reason "it changes the layout of the standard library's containers")
  endif()
  set(${result} "${reason}" PARENT_SCOPE)
endfunction()

# waymark_check_plugin_flags(NAME): stops where the flags of the calling folder would make a plugin that waymark refuses.
# A flag that waymark itself was built with (global property WAYMARK_CXX_FLAGS) makes no difference between the two.
function(waymark_check_plugin_flags name)
  set(places CMAKE_CXX_FLAGS CMAKE_MODULE_LINKER_FLAGS)
  foreach(config ${CMAKE_BUILD_TYPE} ${CMAKE_CONFIGURATION_TYPES})
    string(TOUPPER "${config}" config)
    list(APPEND places CMAKE_CXX_FLAGS_${config} CMAKE_MODULE_LINKER_FLAGS_${config})
  endforeach()
  set(COMPILE_OPTIONS "")
  if(NOT CMAKE_SCRIPT_MODE_FILE)
    get_directory_property(COMPILE_OPTIONS COMPILE_OPTIONS)
    list(JOIN COMPILE_OPTIONS " " COMPILE_OPTIONS)
  endif()
  get_property(common GLOBAL PROPERTY WAYMARK_CXX_FLAGS)
  separate_arguments(common UNIX_COMMAND "${common}")
  foreach(place ${places} COMPILE_OPTIONS)
    separate_arguments(flags UNIX_COMMAND "${${place}}")
    foreach(flag ${flags})
      waymark_refused_flag("${flag}" reason)
      if(reason AND NOT flag IN_LIST common)
        message(FATAL_ERROR
          "waymark_add_plugin(${name}): waymark would refuse a plugin built with ${flag}: ${reason}. Remove ${flag} from ${place}.")
      endif()
    endforeach()
  endforeach()
endfunction()

function(waymark_add_plugin name)
  waymark_check_plugin_flags(${name})
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE waymark::types_se2)
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_compile_definitions(${name} PRIVATE WAYMARK_PLUGIN_MODULE)
  # Hidden: what the plugin shares with its host is the descriptor, marked in core/registry/plugin.hpp.
  set_target_properties(${name} PROPERTIES
    PREFIX "" CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# waymark_install_plugin(NAME): `cmake --install` puts the module into the folder where the program of the prefix looks.
# The prefix is that of the found package; CMAKE_INSTALL_PREFIX and `--prefix` say otherwise. Call it after find_package(waymark).
function(waymark_install_plugin name)
  if(CMAKE_INSTALL_PREFIX_INITIALIZED_TO_DEFAULT)
    set(CMAKE_INSTALL_PREFIX "${waymark_PREFIX}" CACHE PATH "Prefix of the found waymark" FORCE)
  endif()
  install(TARGETS ${name} LIBRARY DESTINATION "${waymark_PLUGIN_SUBFOLDER}")
endfunction()

# waymark_check_plugin(NAME): a test that tries everything that the plugin registers, by the program of the found waymark.
# In a build of waymark itself it is the program of the build.
function(waymark_check_plugin name)
  if(TARGET waymark)
    set(program $<TARGET_FILE:waymark>)
  else()
    set(program "${waymark_PREFIX}/bin/waymark")
  endif()
  add_test(NAME "${name}: conformance" COMMAND "${program}" check --all --plugin $<TARGET_FILE:${name}>)
endfunction()
