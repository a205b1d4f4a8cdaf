# The memory that a build may use: a container may have less than its machine.

# Sets `result` to the least limit, in MB, of the control group of this process and of those around it; empty if they
# have none. ROOT: in front of /proc and /sys, for tests.
function(waymark_group_memory_MB result)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "ROOT" "")
  set(least "")
  set(groups "")
  if(EXISTS "${ARG_ROOT}/proc/self/cgroup")
    file(STRINGS "${ARG_ROOT}/proc/self/cgroup" groups)
  endif()
  foreach(group IN LISTS groups)
    if(group MATCHES "^0::(/.*)$")  # version 2
      set(folder "${ARG_ROOT}/sys/fs/cgroup")
      set(name memory.max)
    elseif(group MATCHES "^[0-9]+:memory:(/.*)$")  # version 1
      set(folder "${ARG_ROOT}/sys/fs/cgroup/memory")
      set(name memory.limit_in_bytes)
    else()
      continue()
    endif()
    # In a container the path may be that of the host, and not there.
    cmake_path(SET path NORMALIZE "${CMAKE_MATCH_1}")
    while(TRUE)
      if(EXISTS "${folder}${path}/${name}")
        file(STRINGS "${folder}${path}/${name}" limit LIMIT_COUNT 1)
        if(limit MATCHES "^[0-9]+$")  # not "max"
          math(EXPR limit_MB "${limit} / 1048576")
          if("${least}" STREQUAL "" OR limit_MB LESS least)
            set(least ${limit_MB})
          endif()
        endif()
      endif()
      if("${path}" STREQUAL "/")
        break()
      endif()
      cmake_path(GET path PARENT_PATH path)
    endwhile()
  endforeach()
  set(${result} "${least}" PARENT_SCOPE)
endfunction()

# Sets `result` to the memory of the machine in MB, or to the limit of its control group if that is less.
function(waymark_available_memory_MB result)
  cmake_host_system_information(RESULT memory_MB QUERY TOTAL_PHYSICAL_MEMORY)
  waymark_group_memory_MB(limit_MB)
  if(NOT limit_MB STREQUAL "" AND limit_MB LESS memory_MB)
    set(memory_MB ${limit_MB})
  endif()
  set(${result} ${memory_MB} PARENT_SCOPE)
endfunction()
