# The components that are compiled once: what others instantiate of core's templates, and CGAL's.

# springfit_compiled_sources(<variable> <list>...): one unit for each list, a file .ipp as those of include/springfit/compiled.
function(springfit_compiled_sources variable)
  set(sources)
  foreach(list IN LISTS ARGN)
    get_filename_component(name "${list}" NAME_WE)
    set(source "${CMAKE_CURRENT_BINARY_DIR}/compiled/${name}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT [[
// Written by CMake: the instantiations that @name@.ipp declares.
#include <springfit/compiled/compiled.hpp>

#undef SPRINGFIT_INSTANTIATION
#define SPRINGFIT_INSTANTIATION template
#include "@list@"
]] @ONLY)
    list(APPEND sources "${source}")
  endforeach()
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# springfit_add_instantiations(<target> [FLOAT]): a static library of the instantiations in double, or float, that
# include/springfit/compiled lists.
function(springfit_add_instantiations target)
  file(GLOB lists CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/springfit/compiled/*.ipp")
  if("FLOAT" IN_LIST ARGN)
    list(FILTER lists INCLUDE REGEX "_float\\.ipp$")
  else()
    list(FILTER lists EXCLUDE REGEX "_float\\.ipp$")
  endif()
  springfit_compiled_sources(sources ${lists})
  add_library(${target} STATIC ${sources})
  target_link_libraries(${target} PUBLIC springfit::core)
endfunction()

# springfit::compiled: core's templates in the plane and in space, in double and float (two libraries, since most programs
# need one).
function(springfit_add_compiled)
  springfit_add_instantiations(springfit_compiled_double)
  springfit_add_instantiations(springfit_compiled_float FLOAT)
  target_link_libraries(springfit_compiled_float PUBLIC springfit_compiled_double)
  if(SPRINGFIT_NATIVE) # vectors and their alignment are of one kind in all of a program
    target_compile_options(springfit_compiled_double PUBLIC -march=native)
  endif()
  target_precompile_headers(springfit_compiled_double PRIVATE <springfit/compiled/compiled.hpp>)
  target_precompile_headers(springfit_compiled_float REUSE_FROM springfit_compiled_double)
  file(GLOB lists CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/springfit/compiled/*.ipp")
  add_library(springfit_compiled INTERFACE)
  target_sources(springfit_compiled INTERFACE FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/include"
                 FILES ${lists} "${PROJECT_SOURCE_DIR}/include/springfit/compiled/compiled.hpp")
  target_link_libraries(springfit_compiled INTERFACE springfit_compiled_float springfit_compiled_double)
  if(SPRINGFIT_INSTALL)
    install(TARGETS springfit_compiled_double springfit_compiled_float EXPORT springfit-compiled)
  endif()
endfunction()

# springfit::compiled_cgal: what CGAL does for springfit; its users see neither CGAL's headers nor its -frounding-math.
# Each unit takes at most 1.5 GB to compile: the mesher alone is two.
function(springfit_add_compiled_cgal)
  set(sources)
  foreach(header surface_impl mesh_3 remove_slivers instances/tetrahedralize instances/triangulate instances/interpolation)
    get_filename_component(name ${header} NAME)
    set(source "${PROJECT_BINARY_DIR}/compiled_cgal/${name}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "#include <springfit/cgal/detail/${header}.hpp>\n")
    list(APPEND sources "${source}")
  endforeach()
  add_library(springfit_compiled_cgal STATIC ${sources})
  # (CGAL itself, not springfit::cgal: the installed library then asks for no other component.)
  target_link_libraries(springfit_compiled_cgal PUBLIC springfit::core PRIVATE CGAL::CGAL)
  set(include "${PROJECT_SOURCE_DIR}/include")
  list(TRANSFORM SPRINGFIT_compiled_cgal_HEADERS PREPEND "${include}/springfit/cgal/" OUTPUT_VARIABLE headers)
  target_sources(springfit_compiled_cgal PUBLIC FILE_SET HEADERS BASE_DIRS "${include}" FILES ${headers})
  target_compile_definitions(springfit_compiled_cgal PUBLIC SPRINGFIT_COMPILED_CGAL)
  target_compile_options(springfit_compiled_cgal PRIVATE
                         -O1 # -O3 takes far longer to compile, and meshes little faster
                         -ffp-contract=off # the same meshes on every processor
                         # GCC keeps 1 GB of what Boost's macros expand to, for its messages, and is slow to reuse memory.
                         "$<$<CXX_COMPILER_ID:GNU>:-ftrack-macro-expansion=0;SHELL:--param ggc-min-expand=30>")
  set_target_properties(springfit_compiled_cgal PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(SPRINGFIT_NATIVE) # its users too: Eigen aligns memory by the processor's vectors
    target_compile_options(springfit_compiled_cgal PUBLIC -march=native)
  endif()
endfunction()
