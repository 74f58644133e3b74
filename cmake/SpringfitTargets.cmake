# One target springfit::<component> per component, and what is installed of each.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include("${CMAKE_CURRENT_LIST_DIR}/SpringfitCompiled.cmake")

# springfit_add_component(<name>): the INTERFACE target of a component's headers.
function(springfit_add_component component)
  set(headers)
  foreach(room IN LISTS SPRINGFIT_${component}_ROOMS)
    file(GLOB_RECURSE room_headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/springfit/${room}/*.hpp")
    list(APPEND headers ${room_headers})
  endforeach()
  list(TRANSFORM SPRINGFIT_${component}_HEADERS PREPEND "${PROJECT_SOURCE_DIR}/include/springfit/" OUTPUT_VARIABLE more_headers)
  list(APPEND headers ${more_headers})
  add_library(springfit_${component} INTERFACE)
  target_sources(springfit_${component} INTERFACE
                 FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/include" FILES ${headers})
  target_link_libraries(springfit_${component} INTERFACE ${SPRINGFIT_${component}_LINKS})
  if(component STREQUAL "core")
    target_compile_features(springfit_core INTERFACE cxx_std_20)
  endif()
endfunction()

function(springfit_install_component component)
  install(TARGETS springfit_${component} EXPORT springfit-${component} FILE_SET HEADERS)
  install(EXPORT springfit-${component} NAMESPACE springfit:: FILE springfit-${component}-targets.cmake
          DESTINATION ${CMAKE_INSTALL_DATADIR}/cmake/springfit)
endfunction()

set(springfit_wanted core ${SPRINGFIT_COMPONENTS})
if("all" IN_LIST springfit_wanted)
  set(springfit_wanted ${SPRINGFIT_ALL_COMPONENTS})
endif()
list(REMOVE_DUPLICATES springfit_wanted)
foreach(component IN LISTS springfit_wanted)
  springfit_find_component(${component})
  if(NOT springfit_${component}_FOUND)
    if(component STREQUAL "core" OR component IN_LIST SPRINGFIT_COMPONENTS)
      message(FATAL_ERROR "springfit::${component} was asked for: ${springfit_${component}_REASON}")
    endif()
    message(STATUS "springfit::${component}: left out (${springfit_${component}_REASON})")
    continue()
  endif()
  message(STATUS "springfit::${component}: available")
  if(component STREQUAL "compiled")
    springfit_add_compiled()
  elseif(component STREQUAL "compiled_cgal")
    springfit_add_compiled_cgal()
  else()
    springfit_add_component(${component})
  endif()
  add_library(springfit::${component} ALIAS springfit_${component})
  set_target_properties(springfit_${component} PROPERTIES EXPORT_NAME ${component})
  if(SPRINGFIT_INSTALL)
    springfit_install_component(${component})
  endif()
endforeach()

if(SPRINGFIT_INSTALL)
  # The compiled components are of one kind of processor.
  set(any_processor ARCH_INDEPENDENT)
  if(TARGET springfit_compiled OR TARGET springfit_compiled_cgal)
    set(any_processor)
  endif()
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/springfit-config-version.cmake"
                                   COMPATIBILITY SameMinorVersion ${any_processor})
  install(FILES cmake/springfit-config.cmake cmake/SpringfitComponents.cmake
                "${PROJECT_BINARY_DIR}/springfit-config-version.cmake"
          DESTINATION ${CMAKE_INSTALL_DATADIR}/cmake/springfit)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

# Flags of our own programs; users of the headers are not touched by them.
add_library(springfit_program_options INTERFACE)
target_compile_options(springfit_program_options INTERFACE -Wall -Wextra -Wshadow -Wno-unknown-pragmas)
# GCC 12 takes its own AVX-512 intrinsics for uses of what was never set (its bug 105593); Clang still looks for such uses.
target_compile_options(springfit_program_options INTERFACE
                       "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-uninitialized>")
if(SPRINGFIT_NATIVE)
  target_compile_options(springfit_program_options INTERFACE -march=native)
endif()
