# mmgrasp_module(name [LINK targets...]): every .cpp below cpp/src/<name>/ as an object library that joins libmmgrasp.
# mmgrasp_library(): the one shared library made of all modules.
# mmgrasp_ompl_plugin(): the private plugin that alone links OMPL (docs/methods/plan.md says why).
set_property(GLOBAL PROPERTY MMGRASP_MODULES "")

add_library(mmgrasp_flags INTERFACE)
target_compile_options(mmgrasp_flags INTERFACE -Wall -Wextra -Wpedantic -Wno-psabi)
if(MMGRASP_SANITIZE)
  # The assertions of Eigen and of the standard library find what stays inside an allocation.
  target_compile_options(mmgrasp_flags INTERFACE -fsanitize=${MMGRASP_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -UNDEBUG
                         -D_GLIBCXX_ASSERTIONS)
  target_link_options(mmgrasp_flags INTERFACE -fsanitize=${MMGRASP_SANITIZE})
  # Under AddressSanitizer Eigen would align by hand what the third-party libraries then release with plain free().
  target_compile_definitions(mmgrasp_flags INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

function(mmgrasp_module name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/cpp/src/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/ompl_plugin/")
  if(NOT sources)
    return()
  endif()
  add_library(mmgrasp_${name} OBJECT ${sources})
  target_include_directories(mmgrasp_${name} PUBLIC ${CMAKE_SOURCE_DIR}/cpp/include
                             PRIVATE ${CMAKE_SOURCE_DIR}/cpp/src)
  target_compile_definitions(mmgrasp_${name} PRIVATE MMGRASP_BUILDING)
  target_link_libraries(mmgrasp_${name} PUBLIC Eigen3::Eigen PRIVATE ${ARG_LINK} mmgrasp_flags)
  set_property(GLOBAL APPEND PROPERTY MMGRASP_MODULES ${name})
  set_property(GLOBAL APPEND PROPERTY MMGRASP_LINK ${ARG_LINK})
endfunction()

function(mmgrasp_library)
  get_property(modules GLOBAL PROPERTY MMGRASP_MODULES)
  get_property(link GLOBAL PROPERTY MMGRASP_LINK)
  add_library(mmgrasp SHARED)
  add_library(mmgrasp::mmgrasp ALIAS mmgrasp)
  foreach(module ${modules})
    target_sources(mmgrasp PRIVATE $<TARGET_OBJECTS:mmgrasp_${module}>)
  endforeach()
  target_include_directories(mmgrasp PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/cpp/include>
                             $<INSTALL_INTERFACE:include>)
  target_compile_features(mmgrasp PUBLIC cxx_std_17)
  target_link_libraries(mmgrasp PUBLIC Eigen3::Eigen
                        PRIVATE $<BUILD_INTERFACE:${link}> $<BUILD_INTERFACE:mmgrasp_flags>)
  set_target_properties(mmgrasp PROPERTIES LINKER_LANGUAGE CXX
                        VERSION ${MMGRASP_ABI} SOVERSION ${MMGRASP_ABI}
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib BUILD_RPATH_USE_ORIGIN ON INSTALL_RPATH $ORIGIN)
endfunction()

function(mmgrasp_ompl_plugin)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/cpp/src/plan/ompl_plugin/*.cpp)
  if(NOT sources)
    return()
  endif()
  find_package(ompl REQUIRED)
  # OMPL_LIBRARIES also lists Boost's development files, which nothing here needs.
  find_library(MMGRASP_OMPL_LIBRARY ompl HINTS ${OMPL_LIBRARY_DIRS} REQUIRED)
  add_library(mmgrasp_ompl MODULE ${sources})
  # Of the public headers it may use those of core/detail that need the standard library alone.
  target_include_directories(mmgrasp_ompl PRIVATE ${CMAKE_SOURCE_DIR}/cpp/src ${CMAKE_SOURCE_DIR}/cpp/include)
  target_include_directories(mmgrasp_ompl SYSTEM PRIVATE ${OMPL_INCLUDE_DIRS})
  target_link_libraries(mmgrasp_ompl PRIVATE ${MMGRASP_OMPL_LIBRARY} Eigen3::Eigen mmgrasp_flags)
  set_target_properties(mmgrasp_ompl PROPERTIES PREFIX "lib" LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
  add_dependencies(mmgrasp mmgrasp_ompl)
endfunction()
