# SPDX-License-Identifier: BSD-3-Clause
# The licences of libraries whose code the compiler puts into the program and the library. They are
# installed beside Carrom's own, because most ask that copies go along. Where a library's licence
# lies differs by system: Debian has it by the name of the package, conda and Arch by that of the
# library, and a prefix or a copy of the sources beside the headers.

# install_license(NAME FOLDER PACKAGE...): the first file that is found, beside the FOLDER of
# headers or under the name of a package
function(install_license name include)
  set(places ${include} ${include}/.. ${include}/../share/licenses/${name}
             ${include}/../share/doc/${name} ${include}/../../../info/licenses)
  foreach(package ${ARGN})
    list(APPEND places /usr/share/doc/${package} /usr/share/licenses/${package}
                       ${include}/../share/licenses/${package} ${include}/../share/doc/${package})
  endforeach()
  find_file(CARROM_LICENSE_${name}
            NAMES copyright LICENSE LICENSE.txt LICENSE.md LICENSE.MIT LICENSE.rst COPYING
            PATHS ${places} NO_DEFAULT_PATH DOC "The licence of ${name}, which is installed")
  mark_as_advanced(CARROM_LICENSE_${name})
  if(CARROM_LICENSE_${name})
    install(FILES ${CARROM_LICENSE_${name}} DESTINATION ${CMAKE_INSTALL_DOCDIR}/licenses
            RENAME ${name}.txt)
  else()
    message(STATUS "No licence of ${name} is installed; try: -DCARROM_LICENSE_${name}=FILE")
  endif()
endfunction()

foreach(library "fmt;fmt::fmt;libfmt-dev"
                "tomlplusplus;tomlplusplus::tomlplusplus;libtomlplusplus-dev"
                "CLI11;CLI11::CLI11;libcli11-dev"
                "nlohmann_json;nlohmann_json::nlohmann_json;nlohmann-json3-dev;nlohmann-json"
                "highway;hwy::hwy;libhwy-dev" "xxhash;PkgConfig::xxhash;libxxhash-dev;xxhash")
  list(POP_FRONT library name target)
  set(include /usr/include)
  if(TARGET ${target})
    get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
    if(folders)
      list(GET folders 0 include)
    endif()
  endif()
  install_license(${name} ${include} ${library} ${name})
endforeach()
install_license(random123 ${RANDOM123_INCLUDE_DIR} librandom123-dev)
