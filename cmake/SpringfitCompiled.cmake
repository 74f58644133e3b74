# The components that are compiled once: what others instantiate of core's templates, and CGAL's.

# springfit_compiled_sources(<variable> <name>...): one unit for each include/springfit/compiled/<name>.ipp.
function(springfit_compiled_sources variable)
  set(sources)
  foreach(name IN LISTS ARGN)
    set(source "${PROJECT_BINARY_DIR}/compiled/${name}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT [[
// Written by CMake: the instantiations that springfit/compiled/@name@.ipp declares.
#include <springfit/compiled/compiled.hpp>

#undef SPRINGFIT_INSTANTIATION
#define SPRINGFIT_INSTANTIATION template
#include <springfit/compiled/@name@.ipp>
]] @ONLY)
    list(APPEND sources "${source}")
  endforeach()
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# springfit::compiled: core's templates for the plane and space, in double and float.
function(springfit_add_compiled)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/compiled/stub.cpp" CONTENT "// nothing yet\n")
  add_library(springfit_compiled STATIC "${PROJECT_BINARY_DIR}/compiled/stub.cpp")
  target_link_libraries(springfit_compiled PUBLIC springfit::core)
endfunction()

# springfit::compiled_cgal: what CGAL does for springfit; its users need not see CGAL's headers.
function(springfit_add_compiled_cgal)
  add_library(springfit_compiled_cgal STATIC "${PROJECT_BINARY_DIR}/compiled/stub.cpp")
  target_link_libraries(springfit_compiled_cgal PUBLIC springfit::core PRIVATE springfit::cgal)
endfunction()
