# A build in a container uses the memory of its control group, not that of the machine.
# cmake -D module=... -D folder=... -P available_memory.cmake
cmake_minimum_required(VERSION 3.20)
include("${module}")

# Writes the files of a group: what it is called, and its limits.
function(group name)
  file(REMOVE_RECURSE "${folder}")
  file(WRITE "${folder}/proc/self/cgroup" "${name}\n")
  foreach(limit IN LISTS ARGN)
    string(REPLACE "=" ";" limit "${limit}")
    list(GET limit 0 path)
    list(GET limit 1 bytes)
    file(WRITE "${folder}/sys/fs/cgroup/${path}" "${bytes}\n")
  endforeach()
endfunction()

function(expect memory_MB)
  waymark_group_memory_MB(found ROOT "${folder}")
  if(NOT found STREQUAL memory_MB)
    message(SEND_ERROR "the limit is '${found}' MB, not '${memory_MB}'")
  endif()
endfunction()

group("0::/" "memory.max=4294967296")
expect("4096")
group("0::/a/b" "a/b/memory.max=max" "a/memory.max=2147483648")  # the group around it has the limit
expect("2048")
group("0::/a/b" "a/b/memory.max=1073741824" "a/memory.max=2147483648")
expect("1024")
group("4:memory:/docker/1234" "memory/memory.limit_in_bytes=3221225472")  # a path of the host
expect("3072")
group("0::/" "memory.max=max")
expect("")
group("3:cpuset:/")
expect("")
file(REMOVE_RECURSE "${folder}")
