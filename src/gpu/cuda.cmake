# SPDX-License-Identifier: BSD-3-Clause
# -DCARROM_CUDA=ON: nvcc compiles the kernels to one object of the module gpu. nvcc is called
# itself, and not as a language of CMake, because the packages of PyPI have no folder layout that
# CMake's own search finds.

find_program(CARROM_NVCC nvcc HINTS ENV CUDA_HOME ENV CUDA_PATH PATHS /usr/local/cuda
             PATH_SUFFIXES bin DOC "NVIDIA's compiler, version 12 or 13")
if(NOT CARROM_NVCC)
  message(FATAL_ERROR "CARROM_CUDA needs nvcc, version 12 or 13; try: -DCARROM_NVCC=FILE, or the "
                      "packages of PyPI that docs/start/install.md names")
endif()
execute_process(COMMAND ${CARROM_NVCC} --version OUTPUT_VARIABLE nvcc_version)
string(REGEX MATCH "release ([0-9]+)[.]([0-9]+)" _ "${nvcc_version}")
set(nvcc_version ${CMAKE_MATCH_1}.${CMAKE_MATCH_2})
if(nvcc_version VERSION_LESS 12)
  message(FATAL_ERROR "CARROM_CUDA needs nvcc 12 or 13; ${CARROM_NVCC} is ${nvcc_version}")
endif()

# Version 13 has dropped the first, and 12.8 has brought the last. The last one is also kept as
# text, which drivers translate for later GPUs.
set(architectures 75 80 86 89 90)
if(nvcc_version VERSION_LESS 13)
  list(PREPEND architectures 70)
endif()
if(NOT nvcc_version VERSION_LESS 12.8)
  list(APPEND architectures 100 120)
endif()
set(CARROM_CUDA_ARCHITECTURES ${architectures} CACHE STRING "Architectures of GPUs, as in 90;100")
set(nvcc_architectures)
foreach(architecture ${CARROM_CUDA_ARCHITECTURES})
  list(APPEND nvcc_architectures
       -gencode=arch=compute_${architecture},code=sm_${architecture})
endforeach()
list(GET CARROM_CUDA_ARCHITECTURES -1 last)
list(APPEND nvcc_architectures -gencode=arch=compute_${last},code=compute_${last})

# A product that is fused with a sum would give other bits than the CPU, so -fmad=false. A function
# of the host that a kernel calls is an error.
set(nvcc_flags -std=c++20 -O3 -fmad=false --expt-relaxed-constexpr
               -Werror=cross-execution-space-call -Xcompiler=-ffp-contract=off,-fno-fast-math)
if(CARROM_SHARED OR CMAKE_POSITION_INDEPENDENT_CODE)
  list(APPEND nvcc_flags -Xcompiler=-fPIC)
endif()

set(cuda_object ${CMAKE_CURRENT_BINARY_DIR}/cuda_device.o)
set(cuda_includes "$<TARGET_PROPERTY:carrom_gpu,INCLUDE_DIRECTORIES>")
add_custom_command(
  OUTPUT ${cuda_object}
  COMMAND ${CARROM_NVCC} -ccbin ${CMAKE_CXX_COMPILER} ${nvcc_flags} ${nvcc_architectures}
          "-I$<JOIN:${cuda_includes},;-I>" -MD -MF ${cuda_object}.d -MT ${cuda_object}
          -c ${CMAKE_CURRENT_SOURCE_DIR}/cuda_device.cu -o ${cuda_object}
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/cuda_device.cu DEPFILE ${cuda_object}.d
  COMMENT "Compiling the kernels for GPUs ${CARROM_CUDA_ARCHITECTURES}"
  COMMAND_EXPAND_LISTS VERBATIM)
set_source_files_properties(${cuda_object} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)

# The static runtime asks for a driver when it is used, so the program starts without one.
get_filename_component(cuda_root ${CARROM_NVCC} DIRECTORY)
find_library(CARROM_CUDART cudart_static REQUIRED DOC "NVIDIA's static runtime library"
             HINTS ${cuda_root}/../lib64 ${cuda_root}/../lib
                   ${cuda_root}/../targets/x86_64-linux/lib)
find_package(Threads REQUIRED)
add_library(carrom_cuda_device STATIC EXCLUDE_FROM_ALL ${cuda_object})
set_target_properties(carrom_cuda_device PROPERTIES LINKER_LANGUAGE CXX)
target_link_libraries(carrom_cuda_device PUBLIC ${CARROM_CUDART} Threads::Threads ${CMAKE_DL_LIBS}
                                                rt)
target_compile_definitions(carrom_cuda_device INTERFACE CARROM_HAS_CUDA)
target_link_libraries(carrom_gpu PUBLIC carrom_cuda_device)
