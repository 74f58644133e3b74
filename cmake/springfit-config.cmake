# find_package(springfit [COMPONENTS core cgal cholmod compiled compiled_cgal ipopt io parallel search] [OPTIONAL_COMPONENTS ...])
# Without COMPONENTS: core. Each component is one target, springfit::<component>; core is always there.

include("${CMAKE_CURRENT_LIST_DIR}/SpringfitComponents.cmake")

set(springfit_wanted core ${springfit_FIND_COMPONENTS})
list(REMOVE_DUPLICATES springfit_wanted)
foreach(springfit_component IN LISTS springfit_wanted)
  springfit_find_component(${springfit_component})
  set(springfit_targets "${CMAKE_CURRENT_LIST_DIR}/springfit-${springfit_component}-targets.cmake")
  if(springfit_${springfit_component}_FOUND AND NOT EXISTS "${springfit_targets}")
    set(springfit_${springfit_component}_FOUND FALSE)
    set(springfit_${springfit_component}_REASON "springfit was installed without it")
  endif()
  if(springfit_${springfit_component}_FOUND)
    include("${springfit_targets}")
  elseif(springfit_component STREQUAL "core" OR springfit_FIND_REQUIRED_${springfit_component})
    set(springfit_FOUND FALSE)
    string(APPEND springfit_NOT_FOUND_MESSAGE
           "springfit::${springfit_component}: ${springfit_${springfit_component}_REASON}. ")
  endif()
endforeach()
