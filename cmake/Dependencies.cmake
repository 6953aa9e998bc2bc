# Debian packages that ship no usable CMake or pkg-config file, as imported targets. Called by the folders
# that need them, so that a machine builds only what it runs.

# OpenCV's modules without its meta package: beckon_find_opencv(core imgproc) -> opencv::core opencv::imgproc
function(beckon_find_opencv)
  find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
  foreach(module ${ARGN})
    if(NOT TARGET opencv::${module})
      find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
      add_library(opencv::${module} UNKNOWN IMPORTED GLOBAL)
      set_target_properties(opencv::${module} PROPERTIES IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY})
      target_include_directories(opencv::${module} SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
    endif()
  endforeach()
endfunction()

# PCL's libraries without its CMake package, which wants VTK, Qt and MPI: beckon_find_pcl(common filters)
function(beckon_find_pcl)
  find_path(PCL_INCLUDE_DIR pcl/pcl_config.h PATH_SUFFIXES pcl-1.13 pcl-1.14 pcl-1.15 REQUIRED)
  foreach(module ${ARGN})
    if(NOT TARGET pcl::${module})
      find_library(PCL_${module}_LIBRARY pcl_${module} REQUIRED)
      add_library(pcl::${module} UNKNOWN IMPORTED GLOBAL)
      set_target_properties(pcl::${module} PROPERTIES IMPORTED_LOCATION ${PCL_${module}_LIBRARY})
      target_include_directories(pcl::${module} SYSTEM INTERFACE ${PCL_INCLUDE_DIR})
      target_link_libraries(pcl::${module} INTERFACE Eigen3::Eigen)
    endif()
  endforeach()
endfunction()
