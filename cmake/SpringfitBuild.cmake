# Settings of springfit's own build, where it is the top-level project.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

# As many compilers at a time as there are processors, but no more than fit into memory: a unit takes up to 1.5 GB.
# (Ninja alone would start two more than there are processors.)
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY) # MiB
if(EXISTS /sys/fs/cgroup/memory.max) # a container's share
  file(STRINGS /sys/fs/cgroup/memory.max limit REGEX "^[0-9]+$")
  if(limit)
    math(EXPR limit "${limit} / 1048576")
    if(limit LESS memory)
      set(memory ${limit})
    endif()
  endif()
endif()
math(EXPR compilers "${memory} / 1500")
if(compilers GREATER processors)
  set(compilers ${processors})
elseif(compilers LESS 1)
  set(compilers 1)
endif()
set_property(GLOBAL APPEND PROPERTY JOB_POOLS springfit_compilers=${compilers})
set(CMAKE_JOB_POOL_COMPILE springfit_compilers)
